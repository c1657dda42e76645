"""Persistence pairs against GUDHI, against the paper's own loop and against theorems."""

import gudhi
import numpy as np
import pytest

from compute.msc.cohomology import cocycles_of
from compute.msc.morse_smale import FieldTopology, MorseSmaleComplex
from compute.surface.mesh import TriangleMesh
from tests.compute.msc import surfaces
from tests.compute.msc.reference import pairs_of_the_paper
from tests.compute.msc.surfaces import closed_surface, diagram_of, noise, topology, waves, with_holes
from tests.selection import draws
from tests.shapes import icosphere, joined, rectangle, torus

# Random fields of each draw.
N_FIELDS = 15
ODD_COMPLEXES = [
    surfaces.cones_sharing_their_tip,
    surfaces.three_sheets_on_an_edge,
    surfaces.sphere_with_a_wall,
    surfaces.projective_plane,
    surfaces.annulus,
    lambda: joined(torus(12, 8), rectangle(6, 5), surfaces.projective_plane()),
    lambda: surfaces.with_holes(torus(12, 8), np.random.default_rng(3), 0.4),
]


def fields_of(draw):
    """Return the seeds of the random fields of a draw."""
    return range(draw * N_FIELDS, (draw + 1) * N_FIELDS)


def filtration(mesh: TriangleMesh, values: np.ndarray) -> gudhi.SimplexTree:
    tree = gudhi.SimplexTree()
    corners = mesh.triangles
    sides = mesh.edges.vertices
    vertices = np.unique(corners)
    tree.insert_batch(vertices[None].astype(np.int32), values[vertices])
    tree.insert_batch(sides.T.astype(np.int32), values[sides].max(axis=1))
    tree.insert_batch(corners.T.astype(np.int32), values[corners].max(axis=1))
    return tree


def same_points(ours: np.ndarray, theirs: np.ndarray) -> None:
    ours, theirs = (np.asarray(points, dtype=float).reshape(-1, 2) for points in (ours, theirs))
    assert len(ours) == len(theirs)
    for column in (0, 1):
        ours, theirs = (points[np.lexsort((points[:, 1 - column], points[:, column]))] for points in (ours, theirs))
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-12)


def same_as_gudhi(ours: FieldTopology, mesh: TriangleMesh, values: np.ndarray, is_closed: bool) -> None:
    diagram, tree = MorseSmaleComplex(ours).diagram, filtration(mesh, values)
    tree.compute_persistence(homology_coeff_field=2, persistence_dim_max=True)
    assert tuple(tree.betti_numbers()) + (0,) * (3 - len(tree.betti_numbers())) == cocycles_of(ours.links).betti
    for dimension in range(3 if is_closed else 1):
        same_points(diagram.intervals(dimension), tree.persistence_intervals_in_dimension(dimension))
    tree.extend_filtration()
    ordinary, relative, *extended = tree.extended_persistence(homology_coeff_field=2)
    extended = extended[0] + extended[1]
    theirs = [(ordinary, 0), (relative, 1), (extended, 0), (extended, 1)]
    for points, (found, dimension) in zip(diagram.extended_intervals(), theirs, strict=True):
        # GUDHI leaves out points on the diagonal.
        off_diagonal = points[points[:, 0] != points[:, 1]]
        same_points(off_diagonal, [interval for d, interval in found if d == dimension])


@pytest.mark.parametrize("draw", draws(3))
@pytest.mark.parametrize("field", [noise, waves])
@pytest.mark.parametrize("genus", [0, 1, 2, 3])
def test_closed_surfaces_have_gudhis_ordinary_and_extended_pairs(genus, field, draw):
    mesh = closed_surface(genus)
    for seed in fields_of(draw):
        values = field(mesh, np.random.default_rng(seed))
        same_as_gudhi(topology(mesh, values), mesh, values, is_closed=True)


@pytest.mark.parametrize("draw", draws(3))
@pytest.mark.parametrize("field", [noise, waves])
@pytest.mark.parametrize("genus", [0, 1, 2, 3])
def test_surfaces_with_boundary_have_gudhis_extended_pairs(genus, field, draw):
    for seed in fields_of(draw):
        rng = np.random.default_rng(seed)
        mesh = with_holes(closed_surface(genus), rng)
        values = field(mesh, rng)
        same_as_gudhi(topology(mesh, values), mesh, values, is_closed=False)


@pytest.mark.parametrize("draw", draws(3))
@pytest.mark.parametrize("number", range(len(ODD_COMPLEXES)))
def test_complexes_that_are_no_surfaces_have_gudhis_extended_pairs(number, draw):
    mesh = ODD_COMPLEXES[number]()
    for seed in fields_of(draw):
        values = noise(mesh, np.random.default_rng(seed))
        same_as_gudhi(topology(mesh, values), mesh, values, is_closed=False)


@pytest.mark.parametrize("field", [noise, waves])
@pytest.mark.parametrize("genus", [0, 2])
def test_pairs_are_those_of_the_papers_loop(genus, field):
    mesh = closed_surface(genus)
    for seed in range(10):
        values = field(mesh, np.random.default_rng(seed))
        ours = topology(mesh, values)
        pairs = {*zip(ours.minima.extremum, ours.minima.saddle, strict=True)}
        pairs |= {*zip(ours.maxima.extremum, ours.maxima.saddle, strict=True)}
        assert pairs == pairs_of_the_paper(mesh.triangles, values)


@pytest.mark.parametrize("genus", [0, 1, 2, 3])
def test_genus_g_leaves_2g_saddles_in_g_pairs(genus):
    mesh = closed_surface(genus)
    essential = topology(mesh, noise(mesh, np.random.default_rng(0))).essential
    assert len(essential.loops) == 2 * genus
    assert len(essential.handles) == genus
    np.testing.assert_array_equal(np.sort(essential.loops, axis=0)[:, 0], np.sort(essential.handles.ravel()))


def test_handle_of_a_standing_torus_reaches_from_the_lower_to_the_upper_saddle():
    mesh = torus(48, 24, radius=3, thickness=1)
    diagram = diagram_of(mesh, mesh.vertices[:, 0])
    np.testing.assert_allclose(diagram.components, [[-4, 4]])
    np.testing.assert_allclose(np.sort(diagram.loops, axis=0), [[-2, -2], [2, 2]], atol=1e-12)
    assert len(diagram.points) == 0


def test_constant_field_has_no_pairs_and_keeps_the_loops():
    mesh = closed_surface(2)
    diagram = diagram_of(mesh, np.full(len(mesh.vertices), 7.0))
    assert len(diagram.points) == 0
    assert (diagram.essential == 7).all()
    assert len(diagram.essential) == 1 + 4


@pytest.mark.parametrize("draw", draws(3))
def test_plateaus_have_gudhis_pairs(draw):
    mesh = icosphere(2)
    for seed in fields_of(draw):
        steps = np.random.default_rng(seed).integers(0, 4, len(mesh.vertices)).astype(float)
        same_as_gudhi(topology(mesh, steps), mesh, steps, is_closed=True)
