"""What happens to meshes that are too large for cubic elements."""

from functools import cache

import numpy as np
import pytest

from compute import memory
from compute.analysis.analyze import analyze
from compute.errors import MeshError
from compute.fem import order_choice
from compute.fem.eigenbasis import solve_eigenbasis
from compute.fem.order_choice import BYTES_PER_UNKNOWN, choose_order, memory_of_functions
from compute.surface.mesh import TriangleMesh
from examples import humanoid
from tests.shapes import icosphere, joined, star


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
    give(monkeypatch, 642 * BYTES_PER_UNKNOWN - 1)
    with pytest.raises(MeshError, match=r"642 vertices takes about 2\.7 MB of memory, and 2\.7 MB are free; decimate"):
        choose_order(mesh)
    give(monkeypatch, 642 * BYTES_PER_UNKNOWN)
    assert choose_order(mesh).order == 1


def give(monkeypatch, n_bytes):
    """Leave so much memory."""
    for module in (memory, order_choice):
        monkeypatch.setattr(module, "available_memory", lambda: n_bytes)


@pytest.mark.parametrize("order", ["auto", 1, 2, 3])
@pytest.mark.parametrize("shells", ["bridged", "largest", "separate"])
def test_an_analysis_with_any_order_is_refused_where_it_does_not_fit(monkeypatch, order, shells):
    mesh = joined(icosphere(3), TriangleMesh(icosphere(2).vertices + 9, icosphere(2).triangles))
    analyze(mesh, order=order, shells=shells)
    give(monkeypatch, 1e5)
    with pytest.raises(MeshError, match=r"takes about .* of memory, and 0.1 MB are free; (take a lower|decimate)"):
        analyze(mesh, order=order, shells=shells)


def test_more_functions_than_fit_are_refused(monkeypatch):
    give(monkeypatch, memory_of_functions(642, 30))
    solve_eigenbasis(icosphere(3), 30, order=1)
    with pytest.raises(MeshError, match="100 eigenfunctions of 642 vertices"):
        solve_eigenbasis(icosphere(3), 100, order=1)


def test_as_many_functions_as_unknowns_need_full_matrices():
    assert memory_of_functions(10_000, 9000) >= 3 * 8 * 10_000**2


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
