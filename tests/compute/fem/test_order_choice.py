"""What happens to meshes that are too large for cubic elements."""

from functools import cache

import numpy as np
import pytest

from compute.analysis.analyze import analyze
from compute.errors import MeshError
from compute.fem import order_choice
from compute.fem.eigenbasis import solve_eigenbasis
from compute.fem.order_choice import BYTES_PER_UNKNOWN, choose_order
from compute.memory import available_memory
from compute.surface.mesh import TriangleMesh
from examples import humanoid
from tests.shapes import icosphere, star


def test_the_order_falls_as_the_budget_does():
    mesh = icosphere(2)
    n_unknowns = [len(solve_eigenbasis(mesh, 3, order=order).nodes) for order in (3, 2)]
    budgets = [n_unknowns[0] * BYTES_PER_UNKNOWN, n_unknowns[1] * BYTES_PER_UNKNOWN, 0]
    choices = [choose_order(mesh, budget) for budget in budgets]
    assert [choice.order for choice in choices] == [3, 2, 1]
    assert [choice.warning is None for choice in choices] == [True, False, False]
    assert choose_order(mesh, budgets[0] - 1).order == 2


def test_a_mesh_too_large_for_the_memory_is_refused_before_the_work(monkeypatch):
    mesh = icosphere(3)
    monkeypatch.setattr(order_choice, "available_memory", lambda: 642 * order_choice.LEAST_BYTES_PER_VERTEX - 1)
    with pytest.raises(MeshError, match="642 vertices takes about"):
        choose_order(mesh)
    monkeypatch.setattr(order_choice, "available_memory", lambda: 642 * order_choice.LEAST_BYTES_PER_VERTEX)
    assert choose_order(mesh).order == 1


def test_the_memory_at_hand_is_known_here():
    assert 1e8 < available_memory() < float("inf")


def five_arms():
    return star(n_subdivisions=5)


def figure():
    character = humanoid(6000)
    return TriangleMesh(character.vertices, character.triangles)


@cache
def labels_of(surface, order):
    return analyze(surface(), order=order).segment().labels


@pytest.mark.parametrize("surface", [five_arms, figure])
@pytest.mark.parametrize("order", [1, 2])
def test_parts_agree_with_those_of_cubic_elements_on_97_percent_of_the_area(surface, order):
    mesh = surface()
    cubic, other = labels_of(surface, 3), analyze(mesh, order=order).segment().labels
    shared = np.zeros((cubic.max() + 1, other.max() + 1))
    np.add.at(shared, (cubic, other), mesh.areas)
    assert shared.max(axis=1).sum() >= 0.97 * mesh.areas.sum()
    assert cubic.max() == other.max()
