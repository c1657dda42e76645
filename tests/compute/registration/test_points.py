"""Pairs of points that the user gives: they settle symmetries, are kept, and noticed where they are wrong."""

import numpy as np
import pytest

from compute import correspond, match, register
from compute.errors import RegistrationError
from compute.registration.eigenfunctions.given_points import FAR
from compute.surface.mesh import TriangleMesh
from tests.compute.registration.shapes import PAIRED_LUMPS, lumpy_ball, mirror_image, moved, quick, shuffled

ARMS = np.array([(np.cos(angle), np.sin(angle), 0.3) for angle in 2 * np.pi * np.arange(5) / 5])


def vertex_at(mesh, place) -> int:
    return int(np.linalg.norm(mesh.vertices - place, axis=1).argmin())


def tips(mesh) -> list[int]:
    return [vertex_at(mesh, 3 * arm) for arm in ARMS]


@pytest.fixture(scope="module")
def starfish():
    """A star of five equal arms in two triangulations."""
    lumps = tuple((tuple(arm), 1.5, 0.25) for arm in ARMS)
    return quick(lumpy_ball(3, lumps)), quick(shuffled(lumpy_ball(4, lumps))[0])


@pytest.fixture(scope="module")
def ball():
    return quick(lumpy_ball())


@pytest.fixture(scope="module")
def copy(ball):
    """The ball under other numbers, with the vertex that each of its vertices was."""
    mesh, order = shuffled(moved(ball.mesh))
    return quick(mesh), order


@pytest.mark.parametrize("turn", range(5))
def test_one_pair_of_points_tells_which_arm_is_which(starfish, turn):
    source, target = starfish
    matching = match(source, target, points=[(tips(source.mesh)[turn], tips(target.mesh)[0])])
    assert matching.confidence > 0.5
    assert matching.warnings == ()
    landed = source.mesh.vertices[correspond(source, target, matching=matching).nearest_vertex[tips(target.mesh)]]
    np.testing.assert_allclose(landed, source.mesh.vertices[np.roll(tips(source.mesh), -turn)], atol=0.3)


def test_points_that_overrule_a_sure_matching_are_told():
    """Two arms, two legs and a head, which fit turned round, too, and a nose that tells front from back."""
    limbs = [((side * x, 0, z), height, 0.3) for side in (-1, 1) for x, z, height in ((1, 0.4, 1.2), (0.5, -1, 1.0))]
    lumps = (*limbs, ((0, 0, 1), 0.7, 0.35), ((0, 0.6, 0.8), 0.8, 0.15))
    source, target = quick(lumpy_ball(3, lumps)), quick(shuffled(lumpy_ball(4, lumps))[0])
    right, wrong = ((vertex_at(source.mesh, (2, 0, 0.8)), vertex_at(target.mesh, (x, 0, 0.8))) for x in (2, -2))
    assert match(source, target, points=[right]).warnings == ()
    led = match(source, target, points=[wrong])
    assert led.sure_without_points > 0.75
    assert led.confidence < 0.2
    assert "sure without them" in led.warnings[-1]


def test_a_swap_of_sides_that_only_a_mirror_image_allows_is_noticed():
    source, target = (quick(lumpy_ball(n, PAIRED_LUMPS)) for n in (3, 4))
    pair = vertex_at(source.mesh, (2, 1, -1.3)), vertex_at(target.mesh, (-2, 1, -1.3))
    swapped = match(source, target, points=[pair])
    assert swapped.confidence < 0.5
    assert swapped.warnings[0].startswith("Point 1 contradicts everything else")
    assert match(source, target, points=[pair], mirrored=True).confidence > 0.5


@pytest.mark.parametrize("wrong", [0, 2])
def test_a_wrong_point_is_named_and_those_that_are_right_are_followed(ball, copy, wrong):
    target, order = copy
    vertices = np.array([30, 200, 400, 600])
    points = np.stack([order[vertices], vertices], axis=1)
    assert match(ball, target, points=points).confidence > 0.9
    points[wrong, 0] = np.linalg.norm(ball.mesh.vertices - ball.mesh.vertices[points[wrong, 0]], axis=1).argmax()
    matching = match(ball, target, points=points)
    assert [sentence.split()[:2] for sentence in matching.warnings] == [["Point", str(1 + wrong)]]
    assert matching.confidence < 0.5
    assert (np.delete(matching.point_gaps, wrong) < 0.01).all()


@pytest.mark.parametrize("vertex", [100, 300, 500])
def test_a_single_wrong_point_bends_nothing_and_is_noticed(ball, copy, vertex):
    target, order = copy
    away = np.linalg.norm(ball.mesh.vertices - ball.mesh.vertices[order[vertex]], axis=1).argmax()
    matching = match(ball, target, points=[(away, vertex)])
    assert len(matching.warnings) == 1
    assert matching.confidence < 0.5
    free = match(ball, target)
    np.testing.assert_allclose(matching.map[:10, :10], free.map[:10, :10], atol=0.05)


def test_points_that_agree_with_the_numbers_leave_shapes_of_one_topology_alone(ball):
    bent = quick(TriangleMesh(ball.mesh.vertices * [1, 1, 1.2], ball.mesh.triangles))
    assert match(ball, bent, points=[(3, 3)]).same_topology
    contradicted = match(ball, bent, points=[(3, 600)])
    assert contradicted.warnings
    assert contradicted.confidence < 0.5


def test_a_pair_overrules_the_numbers_of_a_star_of_one_topology(starfish):
    source, _ = starfish
    first, second = tips(source.mesh)[:2]
    found = correspond(source, source, points=[(second, first)])
    assert not found.matching.same_topology
    assert found.nearest_vertex[first] == second
    landed = source.mesh.vertices[found.nearest_vertex[tips(source.mesh)]]
    np.testing.assert_allclose(landed, source.mesh.vertices[np.roll(tips(source.mesh), -1)], atol=0.3)


def test_points_are_kept_exactly(ball):
    """The target's points are given a little beside where they would land."""
    target, vertices = quick(lumpy_ball(2)), np.array([10, 70, 150])
    landed = correspond(ball, target).nearest_vertex[vertices]
    fans = [ball.mesh.triangles[(ball.mesh.triangles == vertex).any(axis=1)] for vertex in landed]
    beside = [next(w for w in fan.ravel() if w != v) for fan, v in zip(fans, landed, strict=True)]
    found = correspond(ball, target, points=np.stack([beside, vertices], axis=1))
    np.testing.assert_array_equal(found.nearest_vertex[vertices], beside)
    assert (found.barycentric[vertices].max(axis=1) == 1).all()
    assert (found.confidence[vertices] == 1).all()


def test_points_given_with_a_matching_are_kept_too(ball, copy):
    target, order = copy
    found = correspond(ball, target, matching=match(ball, target), points=[(order[7], 7), (order[9], 8)])
    assert found.nearest_vertex[[7, 8]].tolist() == [order[7], order[9]]
    assert found.matching.points.tolist() == [[order[7], 7], [order[9], 8]]


def test_doubles_along_a_seam_are_kept_together(ball):
    whole = lumpy_ball(2)
    double, triangles = len(whole.vertices), whole.triangles.copy()
    half = np.flatnonzero((triangles == 7).any(axis=1))[:3]
    triangles[half] = np.where(triangles[half] == 7, double, triangles[half])
    seamed = TriangleMesh(np.vstack([whole.vertices, whole.vertices[7]]), triangles)
    found = correspond(ball, quick(seamed), points=[(50, 7)])
    assert found.nearest_vertex[[7, double]].tolist() == [50, 50]


def test_a_wrong_point_is_no_sure_vertex(ball, copy):
    target, order = copy
    away = int(np.linalg.norm(ball.mesh.vertices - ball.mesh.vertices[order[100]], axis=1).argmax())
    found = correspond(ball, target, points=[(away, 100)])
    assert found.nearest_vertex[100] == away
    assert found.matching.point_gaps[0] > FAR


def test_shapes_are_registered_by_the_points_of_each(starfish):
    source, target = starfish
    turned = [register([source, target], points=[[(tips(source.mesh)[k], tips(target.mesh)[0])]]) for k in (0, 1)]
    labels = [(one[0].labels, one[1].labels) for one in turned]
    at_tip = [triangle_at(target.mesh, 3 * ARMS[0])] * 2
    of_reference = [triangle_at(source.mesh, 3 * ARMS[k]) for k in (0, 1)]
    assert [there[t] for (_, there), t in zip(labels, at_tip, strict=True)] == [
        here[t] for (here, _), t in zip(labels, of_reference, strict=True)
    ]
    assert len({int(there[at_tip[0]]) for _, there in labels}) == 2


def test_registered_shapes_warn_of_wrong_points(ball, copy):
    target, order = copy
    away = int(np.linalg.norm(ball.mesh.vertices - ball.mesh.vertices[order[100]], axis=1).argmax())
    _, told = register([ball, target], points=[[(away, 100)]])
    assert any(sentence.startswith("Point 1 ") for sentence in told.warnings)


def test_the_same_points_give_the_same_map(starfish):
    source, target = starfish
    pair = [(tips(source.mesh)[1], tips(target.mesh)[0])]
    first, second = (match(source, target, points=pair) for _ in range(2))
    np.testing.assert_array_equal(first.map, second.map)


def test_points_are_mirrored_with_the_source(ball):
    target = quick(shuffled(mirror_image(ball.mesh))[0])
    order = shuffled(ball.mesh)[1]
    matching = match(ball, target, points=[(order[5], 5)], mirrored=True)
    assert matching.confidence > 0.5
    assert matching.point_gaps[0] < 0.05


@pytest.mark.parametrize(
    ("points", "sentence"),
    [
        ([(0, 642)], "Point 1 names vertex 642 of the target, which has vertices 0 to 641"),
        ([(0, 0), (-1, 3)], "Point 2 names vertex -1 of the source"),
        ([(0, 0), (1, 0)], "Vertex 0 of the target is in two pairs"),
        ([(5, 0), (5, 1)], "Vertex 5 of the source is in two pairs"),
        ([(0.5, 1)], "pairs of whole numbers"),
        ([(0, 1, 2)], "pairs of whole numbers"),
        ([(0, 1), (2,)], "pairs of whole numbers"),
        ([("a", "b")], "pairs of whole numbers"),
        (7, "pairs of whole numbers"),
    ],
)
def test_points_that_make_no_sense_are_refused_with_a_sentence(ball, copy, points, sentence):
    for call in (match, correspond):
        with pytest.raises(RegistrationError, match=sentence):
            call(ball, copy[0], points=points)


def test_points_for_another_number_of_shapes_are_refused(ball, copy):
    with pytest.raises(RegistrationError, match="points for 2 shapes, and 1 to register"):
        register([ball, copy[0]], points=[None, None])


def test_a_vertex_without_faces_is_no_point(ball, copy):
    loose = quick(TriangleMesh(np.vstack([ball.mesh.vertices, [[0, 0, 9]]]), ball.mesh.triangles))
    for call in (match, correspond):
        with pytest.raises(RegistrationError, match="Vertex 642 of the source has no face"):
            call(loose, copy[0], points=[(642, 0)])
    with pytest.raises(RegistrationError, match="Vertex 642 of the target has no face"):
        register([copy[0], loose], points=[[(0, 642)]])


def test_a_vertex_of_a_shell_that_is_left_out_is_a_point(ball, copy):
    debris = ball.mesh.vertices[ball.mesh.triangles[:2].ravel()] * 1e-3 + [3, 0, 0]
    triangles = np.vstack([ball.mesh.triangles, np.arange(6).reshape(2, 3) + len(ball.mesh.vertices)])
    littered = quick(TriangleMesh(np.vstack([ball.mesh.vertices, debris]), triangles))
    assert len(match(littered, copy[0], points=[(642, 0)]).point_gaps) == 1


def test_alternatives_that_miss_a_point_rank_by_what_is_left_of_their_confidence(starfish):
    source, target = starfish
    matching = match(source, target, points=[(tips(source.mesh)[1], tips(target.mesh)[0])])
    left = [one.confidence for one in (matching, *matching.alternatives)]
    assert left == sorted(left, reverse=True)
    assert len(left) > 2


def test_no_points_change_nothing(ball, copy):
    free, empty = match(ball, copy[0]), match(ball, copy[0], points=[])
    np.testing.assert_array_equal(free.map, empty.map)
    assert free.confidence == empty.confidence


def triangle_at(mesh, place) -> int:
    return int(np.linalg.norm(mesh.vertices[mesh.triangles].mean(axis=1) - place, axis=1).argmin())
