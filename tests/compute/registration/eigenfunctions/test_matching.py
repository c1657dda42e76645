"""Order, sign, mixing and handedness, against shapes whose matching is known."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from compute.analysis.analyze import analyze
from compute.errors import Cancelled, RegistrationError
from compute.registration.eigenfunctions.matching import match, match_shapes
from compute.registration.eigenfunctions.spectral_shape import SpectralShape, spectral_shape
from compute.registration.eigenfunctions.zoomout import nearest_points, with_constant
from compute.surface.assignment import cheapest_assignment
from compute.surface.mesh import TriangleMesh
from examples import hand, quadruped
from tests.compute.registration.shapes import (
    PAIRED_LUMPS,
    landed_vertices,
    lumpy_ball,
    mirror_image,
    moved,
    quick,
    shuffled,
)
from tests.shapes import icosphere, torus


@pytest.fixture(scope="module")
def ball():
    return quick(lumpy_ball())


@pytest.fixture(scope="module")
def paired():
    return quick(lumpy_ball(lumps=PAIRED_LUMPS))


def shape_of(analysis) -> SpectralShape:
    return spectral_shape(analysis.matching_basis)


def share_at(matching, source, target, expected) -> float:
    """Return the share of the target's vertices that land within 2 % of the size of an expected vertex."""
    nodes = source.matching_basis.nodes
    away = nodes[landed_vertices(matching, source, target)] - source.mesh.vertices[expected]
    return (np.linalg.norm(away, axis=1) < 0.02 * np.sqrt(source.mesh.areas.sum())).mean()


def test_a_moved_scaled_and_shuffled_copy_is_recovered_exactly(ball):
    copy, order = shuffled(moved(ball.mesh))
    target = quick(copy)
    matching = match(ball, target)
    assert matching.confidence > 0.9
    np.testing.assert_allclose(np.abs(matching.map[:20, :20]), np.eye(20), atol=5e-3)
    np.testing.assert_array_equal(landed_vertices(matching, ball, target), order)


@pytest.mark.parametrize("change", ["flip", "switch", "mix"])
def test_functions_that_are_flipped_switched_or_mixed_are_put_right(ball, change):
    rotation = np.eye(20)
    if change == "flip":
        rotation[[1, 4, 5, 11], [1, 4, 5, 11]] = -1
    elif change == "switch":
        rotation[[2, 3, 7, 8]] = rotation[[3, 2, 8, 7]]
    else:
        rotation[3:5, 3:5] = [[0.8, -0.6], [0.6, 0.8]]
    shape = shape_of(ball)
    changed = shape.functions.copy()
    changed[:, 1:21] = shape.functions[:, 1:21] @ rotation.T
    values = shape.values.copy()
    if change == "mix":
        values[4:6] = values[4:6].mean()
    matching = match_shapes(replace(shape, values=values), replace(shape, functions=changed, values=values))
    np.testing.assert_allclose(matching.map[:20, :20], rotation, atol=1e-6)
    assert matching.confidence > 0.9


def test_inverted_winding_does_not_mirror(ball):
    target = quick(TriangleMesh(ball.mesh.vertices, ball.mesh.triangles[:, ::-1]))
    matching = match(ball, target)
    assert share_at(matching, ball, target, np.arange(642)) == 1


def test_left_lands_on_left_of_a_mirrored_copy(paired):
    """The body is its own mirror image, so the copy is the body itself with its vertices swapped."""
    copy, order = shuffled(mirror_image(paired.mesh))
    target = quick(copy)
    swapped = nearest_vertices(mirror_image(paired.mesh).vertices, paired.mesh.vertices)
    assert share_at(match(paired, target), paired, target, swapped[order]) > 0.99


def test_left_lands_on_right_of_a_mirrored_copy_where_asked(paired):
    copy, order = shuffled(mirror_image(paired.mesh))
    target = quick(copy)
    matching = match(paired, target, mirrored=True)
    assert matching.mirrored
    assert share_at(matching, paired, target, order) > 0.99


def test_shapes_of_one_topology_correspond_by_number(ball):
    bent = TriangleMesh(ball.mesh.vertices * [1, 1, 1.2], ball.mesh.triangles)
    matching = match(ball, quick(bent))
    assert matching.same_topology
    assert matching.confidence == 1
    np.testing.assert_array_equal(matching.order[:6], np.arange(6))


def test_switching_ellipsoids_are_put_in_order():
    """Y20 stands before the pair Y1+-1 at rz = 2.78 and behind it at 2.74 (Reuter 2009, Figure 2)."""
    sphere = icosphere(4)
    early, late = (quick(shuffled(TriangleMesh(sphere.vertices * [1, 1, rz], sphere.triangles))[0])
                   for rz in (2.74, 2.78))  # fmt: skip
    matching = match(early, late)
    along = [np.flatnonzero(_depends_on_z_alone(analysis))[1] for analysis in (early, late)]
    assert along[0] != along[1]
    assert matching.order[along[0]] == along[1]


@pytest.mark.parametrize(
    ("n_arms", "width"),
    [pytest.param(5, 0.25, id="starfish"), pytest.param(8, 0.15, id="octopus", marks=pytest.mark.long)],
)
def test_equal_arms_go_round_in_order_and_leave_doubt(n_arms, width):
    arms = [(np.cos(angle), np.sin(angle), 0.3) for angle in 2 * np.pi * np.arange(n_arms) / n_arms]
    star = lumpy_ball(4, tuple((arm, 1.5, width) for arm in arms))
    source, target = quick(star), quick(shuffled(star)[0])
    matching = match(source, target)
    landed = source.matching_basis.nodes[landed_vertices(matching, source, target)]
    tips = nearest_vertices(3 * np.array(arms), target.mesh.vertices)
    angle = np.arctan2(landed[tips, 1], landed[tips, 0])
    steps = np.diff(np.append(angle, angle[0])) % (2 * np.pi)
    np.testing.assert_allclose(steps, 2 * np.pi / n_arms, atol=0.2)
    assert matching.confidence < 0.5
    assert matching.alternatives


def test_a_coarser_version_of_another_size_is_the_same_shape(paired):
    finer, coarser = quick(lumpy_ball(4, PAIRED_LUMPS)), quick(moved(lumpy_ball(2, PAIRED_LUMPS)))
    for source, target in ((paired, finer), (finer, paired), (paired, coarser), (coarser, paired)):
        matching = match(source, target)
        assert matching.confidence > 0.5
        back = match(target, source)
        np.testing.assert_allclose((back.map @ matching.map)[:10, :10], np.eye(10), atol=0.25)


def test_an_open_version_is_the_same_shape(paired):
    """The tip of the tail is cut off: what is left has a border, and less area; left stays left."""
    centres = paired.mesh.vertices[paired.mesh.triangles].mean(axis=1)
    tail = np.array([0, -1, 0.5]) / np.linalg.norm([0, -1, 0.5])
    stays = centres @ tail < 0.8 * (centres @ tail).max()
    opened = quick(shuffled(TriangleMesh(paired.mesh.vertices, paired.mesh.triangles[stays]))[0])
    order = shuffled(paired.mesh)[1]
    matching = match(paired, opened)
    assert matching.confidence > 0.5
    assert match(opened, paired).confidence > 0.5
    here, there = shape_of(paired), shape_of(opened)
    is_vertex = there.node < len(order)
    landed = here.positions[nearest_points(with_constant(matching.map), here.functions, there.functions[is_vertex])]
    true = paired.mesh.vertices[order[there.node[is_vertex]]]
    is_aside = np.abs(true[:, 0]) > 0.2
    assert (landed[:, 0] * true[:, 0] > 0)[is_aside].mean() > 0.98


def test_spheres_can_be_matched_in_any_way_so_none_is_sure():
    coarse, fine = icosphere(2), moved(icosphere(3))
    assert match(quick(coarse), quick(fine)).confidence < 0.5


@pytest.mark.parametrize("character", [quadruped, hand])
def test_shapes_that_have_nothing_in_common_are_not_matched_with_confidence(character):
    made = character(1500)
    source = quick(TriangleMesh(made.mesh_in_pose("rest"), split(made.quads)))
    assert match(source, quick(torus())).confidence < 0.1


@pytest.mark.parametrize("number", [1, 2, 5, 8])
def test_a_given_sign_is_kept_even_if_no_matching_fits_it(ball, number):
    """A shape without symmetry has one right sign for each function; the other one is given here."""
    target = quick(shuffled(ball.mesh)[0])
    best = match(ball, target)
    flipped = match(ball, target, flips={number: -int(best.signs[number - 1])})
    assert flipped.signs[number - 1] == -best.signs[number - 1]
    assert flipped.confidence < 0.5


def test_functions_to_match_point_where_the_eigenfunctions_do(paired):
    own = analyze(paired.mesh)
    vertices = np.arange(len(paired.mesh.vertices))
    shown, matched = (basis.functions[vertices] for basis in (own.eigenbasis, own.matching_basis))
    n_shared = min(shown.shape[1], 12)
    assert ((shown[:, :n_shared] * matched[:, :n_shared]).sum(axis=0) > 0).all()


def test_progress_rises_to_the_end_and_is_told_often(paired):
    told = []
    match(paired, quick(shuffled(paired.mesh)[0]), progress=lambda fraction, text: told.append(fraction))
    assert told == sorted(told)
    assert told[0] >= 0
    assert told[-1] <= 1
    assert len(told) > 100


@pytest.mark.parametrize("word", ["finite elements", "Measuring", "Searching", "Refining"])
def test_a_match_can_be_cancelled_at_every_step(word):
    def cancel(fraction, text):
        if word in text:
            raise Cancelled

    source = quick(lumpy_ball(2))
    target = quick(shuffled(source.mesh)[0])
    with pytest.raises(Cancelled):
        match(source, target, progress=cancel)


def test_a_given_sign_is_kept_and_the_others_follow(paired):
    target = quick(shuffled(paired.mesh)[0])
    matching = match(paired, target)
    flipped = match(paired, target, flips={1: -int(matching.signs[0])})
    assert flipped.signs[0] == -matching.signs[0]
    assert flipped.confidence < matching.confidence


@pytest.mark.parametrize(
    ("flips", "sentence"), [({0: 1}, "functions 1 to"), ({99: 1}, "not that of 99"), ({1: 2}, "-1")]
)
def test_impossible_signs_are_refused_with_a_sentence(ball, flips, sentence):
    with pytest.raises(RegistrationError, match=sentence):
        match(ball, ball, flips=flips)


def nearest_vertices(points, vertices) -> np.ndarray:
    return np.linalg.norm(points[:, None] - vertices, axis=2).argmin(axis=1)


def split(quads) -> np.ndarray:
    """Return the triangles of quads."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def _depends_on_z_alone(analysis) -> np.ndarray:
    """(5,) whether each function has no part that turns once around the axis."""
    basis = analysis.matching_basis
    around = np.hypot(basis.nodes[:, 0], basis.nodes[:, 1])
    turning = np.stack([basis.nodes[:, 0], basis.nodes[:, 1]], axis=1) / np.maximum(around, 1e-9)[:, None]
    return np.abs(basis.functions[:, :5].T @ (basis.mass @ turning)).max(axis=1) < 0.1


@pytest.mark.parametrize("shape", [(4, 4), (3, 5), (5, 3), (1, 1), (0, 3)])
def test_no_other_pairs_cost_less_than_the_cheapest(shape):
    """Against all ways to pair, with entries of zero and some that are forbidden."""
    random = np.random.default_rng(sum(shape))
    for _ in range(20):
        costs = random.choice([0.0, 1e-7, 0.3, 1.0, np.inf], shape) * random.choice([-1.0, 1.0], shape)
        costs = np.where(np.isfinite(costs), costs, np.inf)
        rows, columns = cheapest_assignment(costs)
        wide = costs if shape[0] <= shape[1] else costs.T
        ways = permutations(range(wide.shape[1]), wide.shape[0])
        assert len(set(rows)) == len(set(columns)) == len(wide)
        cheapest = min(_total(wide[range(len(wide)), list(way)]) for way in ways)
        assert _total(costs[rows, columns]) == pytest.approx(cheapest, abs=1e-9)


def _total(costs: np.ndarray) -> tuple[int, float]:
    """Number of forbidden pairs and the sum of the others."""
    return int(np.isinf(costs).sum()), costs[np.isfinite(costs)].sum()


# Between two columns all rows differ by the same but for the last bit; SciPy's search never ends on these as they are.
ROUNDED_COSTS = [
    [-0.0872989864882539, -0.1251094456617118, 5.306122356828074e-07, -0.018037416073921092, 1.2244897772565136e-07],
    [-0.054525010056025884, -0.14707157482154753, 5.510204070709965e-07, -0.1091414006999765, 1.428571096535655e-07],
    [-0.07706199465601828, -0.06691897767730692, 5.714285677831851e-07, -0.07363249972654276, 1.632652680421548e-07],
    [-0.03135989894474796, -0.08005161015334993, 5.918367265528203e-07, -0.03466056892007754, 1.8367346823503135e-07],
    [-0.1375014073569056, -0.14252969977920918, 6.122448894399567e-07, -0.16046063802284988, 2.040816289286099e-07],
]


def test_costs_that_differ_by_rounding_alone_are_assigned():
    costs = np.array(ROUNDED_COSTS)
    rows, columns = cheapest_assignment(costs)
    assert costs[rows, columns].sum() == pytest.approx(
        min(costs[range(5), list(way)].sum() for way in permutations(range(5))), abs=1e-12
    )
