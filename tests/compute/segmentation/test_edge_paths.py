"""Borders along edges at all levels at once: short, near the level sets, and every part stays."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from compute import MODES, analyze, label_branches, skeleton
from compute.errors import MeshError
from compute.segmentation.borders.creases import crease_costs
from compute.surface.cleaning import clean_surface
from compute.surface.mesh import TriangleMesh, connected_pieces
from tests.compute.registration.shapes import lumpy_ball
from tests.shapes import icosphere, joined, lathe, star


def bumpy_rod(n_around=16, n_along=40):
    """A rod with three bulges, of rings around its axis."""
    along = np.linspace(0.02, np.pi - 0.02, n_along)
    radius = np.sin(along) * (1 + 0.35 * np.cos(4 * along))
    return lathe(np.stack([radius, 3 * along], axis=1), n_around)


def border_length(mesh, labels):
    edges = mesh.edges
    ends = mesh.vertices[edges.vertices[edges.shared]]
    apart = np.diff(labels[edges.neighbours], axis=1).ravel() != 0
    return np.linalg.norm(ends[apart, 1] - ends[apart, 0], axis=1).sum()


@pytest.fixture(scope="module")
def analyses():
    random = np.random.default_rng(3)
    ball = star(n_arms=5, n_subdivisions=4)
    mesh = TriangleMesh(ball.vertices + random.normal(scale=0.01, size=ball.vertices.shape), ball.triangles)
    return {borders: analyze(mesh, borders=borders) for borders in ("edges", "exact")}


@pytest.fixture(scope="module")
def trees(analyses):
    return {borders: analysis.part_tree() for borders, analysis in analyses.items()}


def test_borders_are_shorter_and_about_as_long_as_the_level_sets(analyses):
    edges, exact = (analyses[borders].segment() for borders in ("edges", "exact"))
    mesh = analyses["edges"].mesh
    smooth = sum(
        np.linalg.norm(np.diff(np.vstack([line.points, line.points[:1]]), axis=0), axis=1).sum()
        for line in edges.borders
    )
    assert border_length(mesh, edges.labels) < 0.85 * border_length(mesh, exact.labels)
    assert 0.9 * smooth < border_length(mesh, edges.labels) < 1.15 * smooth


@pytest.mark.parametrize("mode", MODES)
def test_the_same_parts_are_there_at_every_level_each_in_one_piece(analyses, trees, mode):
    mesh = analyses["edges"].mesh
    for level in range(trees["exact"].hierarchy.n_levels):
        edges, exact = (label_branches(trees[borders], level=level, mode=mode) for borders in ("edges", "exact"))
        np.testing.assert_array_equal(edges.parts.id, exact.parts.id)
        labels = edges.of_faces(trees["edges"])
        left, right = mesh.edges.neighbours[(np.diff(labels[mesh.edges.neighbours], axis=1) == 0).ravel()].T
        pieces = connected_pieces(left, right, len(labels))
        assert all(len(np.unique(pieces[labels == part])) == 1 for part in edges.parts.id if part)


def test_labels_are_nested_as_the_arcs_are(trees):
    """What is inside a part at one level is inside a subtree: no level gives a face to two parts."""
    for tree, arc in zip(trees["edges"].trees, trees["edges"].arcs_of_faces, strict=True):
        assert ((arc >= 0) & (arc < len(tree.parent))).all()
    for level in range(1, trees["edges"].hierarchy.n_levels):
        parts = label_branches(trees["edges"], level=level).parts
        assert parts.area.sum() == pytest.approx(trees["edges"].branches[0].area.sum())


def test_few_faces_change_their_part(trees):
    before, after = (label_branches(trees[borders]).of_faces(trees[borders]) for borders in ("exact", "edges"))
    # Borders move into the creases around the arms.
    assert 0 < (before != after).mean() < 0.1


@pytest.mark.parametrize("mode", MODES)
def test_what_is_computed_from_parts_does_not_depend_on_how_they_are_shown(analyses, mode):
    edges, exact = analyses["edges"], analyses["exact"]
    labels = exact.segment(mode=mode).labels
    np.testing.assert_array_equal(edges.exact_labels(edges.segment(mode=mode).labels), labels)
    np.testing.assert_array_equal(edges.exact_labels(labels), labels)
    np.testing.assert_array_equal(exact.exact_labels(labels), labels)
    shown = skeleton(edges, labels=edges.segment(mode=mode).labels)
    np.testing.assert_array_equal(shown.joints, skeleton(exact, labels=labels).joints)


def test_a_part_that_was_put_between_a_border_and_its_level_set_stays(analyses, trees):
    edges = analyses["edges"]
    labels = edges.segment().labels.copy()
    (pieces,) = trees["edges"].branches
    face = np.flatnonzero((pieces.arc != pieces.shown)[pieces.of_face])[0]
    labels[face] = own = labels.max() + 1
    assert (edges.exact_labels(labels) == own).sum() == 1


def test_borders_of_a_symmetric_shape_are_symmetric():
    ball = icosphere(4)
    arms = np.exp(-12 * np.linalg.norm(np.abs(ball.vertices[:, None]) - np.eye(3)[:2], axis=2) ** 2).sum(axis=1)
    mesh = TriangleMesh(ball.vertices * (1 + 2 * arms)[:, None], ball.triangles)
    centres = mesh.vertices[mesh.triangles].mean(axis=1)
    labels = analyze(mesh).segment().labels
    assert len(np.unique(labels)) == 5
    for flip in ([-1, 1, 1], [1, -1, 1], [1, 1, -1]):
        distance, image = cKDTree(centres).query(centres * flip)
        assert distance.max() < 1e-9
        assert len(np.unique(np.stack([labels, labels[image]]), axis=1).T) == 5


@pytest.fixture(scope="module")
def ball_with_steep_arms():
    """A ball with five arms that begin at a crease, and which faces lie in the arms."""
    ball = icosphere(4)
    axes = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]])
    angle = np.arccos(np.clip((ball.vertices @ axes.T).max(axis=1), -1, 1))
    height = np.clip((0.55 - angle) / 0.3, 0, 1)
    mesh = TriangleMesh(ball.vertices * (1 + height**2 * (3 - 2 * height))[:, None], ball.triangles)
    return mesh, angle[mesh.triangles].mean(axis=1) < 0.55


def test_borders_settle_in_creases(ball_with_steep_arms):
    mesh, is_in_arm = ball_with_steep_arms
    wrong = {
        borders: mesh.areas @ ((analyze(mesh, borders=borders).segment().labels > 0) != is_in_arm)
        for borders in ("edges", "exact")
    }
    assert wrong["exact"] > 0.1 * mesh.areas[is_in_arm].sum()
    assert wrong["edges"] < 0.03 * mesh.areas[is_in_arm].sum()


def test_a_crease_is_one_whichever_way_faces_are_wound(ball_with_steep_arms):
    mesh, _ = ball_with_steep_arms
    wound = np.random.default_rng(1).random(len(mesh.triangles)) < 0.5
    mixed = TriangleMesh(mesh.vertices, np.where(wound[:, None], mesh.triangles[:, ::-1], mesh.triangles))
    np.testing.assert_array_equal(analyze(mixed).segment().labels, analyze(mesh).segment().labels)


def test_creases_cost_less_and_ridges_do_not():
    """A wavy cylinder: edges around it cost less in its valleys than elsewhere."""
    along = np.linspace(0, 4 * np.pi, 161)
    mesh = lathe(np.stack([2 + 0.5 * np.cos(2 * along), along], axis=1), 80)
    costs = crease_costs(clean_surface(mesh), n_rings=80)
    middle = mesh.vertices[mesh.edges.vertices[mesh.edges.shared]].mean(axis=1)
    radius = np.linalg.norm(middle[:, :2], axis=1)
    assert (costs[radius > 2.1] == 1).all()
    assert costs[radius < 1.55].min() < 0.8
    assert (crease_costs(clean_surface(mesh), n_rings=0) == 1).all()


def test_blunt_parts_keep_two_thirds_of_their_area():
    """On a lump the border is the shorter the higher it lies; it must not close over the tip."""
    analysis = analyze(lumpy_ball())
    for level in range(1, analysis.hierarchy.n_levels):
        shown = analysis.segment(level=level, mode="features").labels
        whole = np.bincount(analysis.exact_labels(shown), analysis.mesh.areas)
        assert (np.bincount(shown, analysis.mesh.areas, len(whole)) > 0.6 * whole).all()


def test_borders_follow_rings_of_edges():
    """On a bumpy rod of rings of quads, each border is a ring, though the field is not quite the same all around."""
    mesh = bumpy_rod()
    axis = mesh.vertices[:, np.ptp(mesh.vertices, axis=0).argmax()]
    across = mesh.vertices[:, np.ptp(mesh.vertices, axis=0).argmin()]
    values = np.cos(2 * axis) + 0.02 * axis + 0.04 * across

    def n_steps(borders):
        labels = analyze(mesh, field=values, borders=borders).segment(level=2).labels
        apart = (np.diff(labels[mesh.edges.neighbours], axis=1) != 0).ravel()
        ends = axis[mesh.edges.vertices[mesh.edges.shared[apart]]]
        return (np.abs(ends[:, 1] - ends[:, 0]) > 1e-6).sum()

    assert n_steps("exact") > 0
    assert n_steps("edges") == 0


def test_parts_that_faces_follow_from_afar_stay():
    """A small ball beside an arm is not analyzed and follows it; the arm keeps faces of its own."""
    body, ball = star(n_subdivisions=3), icosphere(1)
    mesh = joined(body, TriangleMesh(0.02 * ball.vertices + [3.5, 0, 0], ball.triangles))
    trees = [analyze(mesh, shells="largest", borders=borders).part_tree() for borders in ("edges", "exact")]
    for level in range(trees[0].hierarchy.n_levels):
        parts = [label_branches(tree, level=level).parts for tree in trees]
        np.testing.assert_array_equal(parts[0].id, parts[1].id)


def test_borders_of_another_name_are_refused():
    with pytest.raises(MeshError, match="edges"):
        analyze(star(n_subdivisions=1), borders="smooth")
