"""Coarser levels of a problem: aggregates that hang together, functions that are carried exactly, and the inverse."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from compute.errors import SpectrumError
from compute.fem import multigrid as module
from compute.fem.aggregation import aggregates, carrying, centres
from compute.fem.assembly import mass_matrix, stiffness_matrix
from compute.fem.multigrid import multigrid, order_in_space
from compute.fem.shift_invert import SHIFT
from compute.fem.space import function_space
from compute.surface.mesh import TriangleMesh
from tests.shapes import icosphere, joined, rectangle, star


def matrices(mesh):
    space = function_space(mesh, 1)
    return stiffness_matrix(space), mass_matrix(space)


def levels_of(grid):
    while grid is not None:
        yield grid
        grid = grid.coarser and grid.coarser.levels


@pytest.fixture
def _small(monkeypatch):
    monkeypatch.setattr(module, "COARSEST_UNKNOWNS", 100)


@pytest.mark.parametrize("mesh", [icosphere(4), star(), rectangle(40, 30), rectangle(60, 10, width=1.0, height=5.0)])
def test_every_aggregate_hangs_together_and_has_several_unknowns(mesh):
    stiffness, _ = matrices(mesh)
    aggregate = aggregates(stiffness)
    sizes = np.bincount(aggregate)
    assert sizes.min() > 0
    assert sizes.mean() > 3
    tails, heads = mesh.edges.vertices[np.diff(aggregate[mesh.edges.vertices], axis=1)[:, 0] == 0].T
    inside = csr_array((np.ones(len(tails)), (tails, heads)), shape=stiffness.shape)
    assert connected_components(inside, directed=False)[0] == len(sizes)


def test_sheets_that_lie_on_one_another_share_nothing():
    sheet = rectangle(30, 20)
    above = TriangleMesh(sheet.vertices + np.array([0, 0, 1e-9]), sheet.triangles)
    both = joined(sheet, above)
    stiffness, _ = matrices(both)
    aggregate = aggregates(stiffness)
    up = carrying(stiffness, aggregate, both.vertices, centres(aggregate, both.vertices))
    is_above = np.arange(len(both.vertices)) >= len(sheet.vertices)
    assert not set(aggregate[is_above]) & set(aggregate[~is_above])
    assert not set(up[is_above].indices) & set(up[~is_above].indices)


def test_constants_are_carried_exactly_and_linear_functions_nearly_so():
    mesh = rectangle(40, 40, width=1.0, height=1.0)
    stiffness, _ = matrices(mesh)
    aggregate = aggregates(stiffness)
    coarse = centres(aggregate, mesh.vertices)
    up = carrying(stiffness, aggregate, mesh.vertices, coarse)
    np.testing.assert_allclose(up @ np.ones(len(coarse)), 1, atol=1e-12)
    inside = np.all(np.abs(mesh.vertices[:, :2] - mesh.vertices[:, :2].mean(axis=0)) < 0.4, axis=1)
    assert np.abs(up @ coarse - mesh.vertices)[inside].max() < 0.2 / 40


@pytest.mark.usefixtures("_small")
def test_each_level_is_the_one_above_on_fewer_functions():
    levels = list(levels_of(multigrid(*matrices(icosphere(4)), icosphere(4).vertices)))
    sizes = [grid.level.n_unknowns for grid in levels]
    assert len(sizes) == 3
    assert all(3 * coarse < fine for fine, coarse in pairwise(sizes))
    for above, below in pairwise(levels):
        up = above.coarser.prolongation
        for name in ("stiffness", "mass"):
            difference = up.T @ getattr(above.level, name) @ up - getattr(below.level, name)
            assert np.abs(difference.toarray()).max() < 1e-12 * np.abs(getattr(above.level, name).data).max() * 100


@pytest.mark.usefixtures("_small")
@pytest.mark.parametrize("mesh", [icosphere(4), star(), rectangle(60, 10, width=1.0, height=5.0)])
def test_the_approximate_inverse_is_symmetric_and_leaves_half_of_the_error(mesh):
    stiffness, mass = matrices(mesh)
    grid = multigrid(stiffness, mass, mesh.vertices)
    operator = stiffness - SHIFT * mass
    random = np.random.default_rng(0)
    columns = random.standard_normal((len(mesh.vertices), 4))
    products = columns.T @ grid.approximate_inverse(columns)
    np.testing.assert_allclose(products, products.T, rtol=1e-3, atol=1e-4 * np.abs(products).max())
    for _ in range(5):
        before = np.einsum("ij,ij->j", columns, operator @ columns)
        columns = columns - grid.approximate_inverse(operator @ columns)
        after = np.einsum("ij,ij->j", columns, operator @ columns)
        assert np.all(after < 0.75**2 * before)


@pytest.mark.usefixtures("_small")
def test_what_does_not_hang_together_has_no_levels():
    apart = csr_array(np.diag(np.ones(200)))
    with pytest.raises(SpectrumError, match="hangs together by slivers"):
        multigrid(apart, apart, np.zeros((200, 3)))


def test_the_order_in_space_does_not_depend_on_the_numbering():
    positions = np.random.default_rng(0).random((500, 3))
    order = np.random.default_rng(1).permutation(500)
    first, second = (places[order_in_space(places)] for places in (positions, positions[order]))
    np.testing.assert_array_equal(first, second)
    steps = np.linalg.norm(np.diff(first, axis=0), axis=1)
    assert steps.mean() < 0.4 * np.linalg.norm(np.diff(positions, axis=0), axis=1).mean()
