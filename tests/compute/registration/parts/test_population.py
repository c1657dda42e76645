"""Equal label, same part: on other triangulations, with parts too many or too few, in any executor."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from multiprocessing import get_context

import numpy as np
import pytest
from scipy.spatial import cKDTree

from compute.analysis.analysis import Analysis
from compute.analysis.analyze import analyze
from compute.errors import Cancelled, RegistrationError
from compute.registration.eigenfunctions.matching import match_surfaces
from compute.registration.parts import population
from compute.registration.parts.part_matching import with_first_free
from compute.registration.parts.population import CONTRADICTS, register
from compute.surface.mesh import TriangleMesh
from tests.compute.registration.shapes import LUMPS, lumpy_ball, moved, shuffled

# Four equal ones, which nothing tells apart.
ARMS = tuple((axis, 0.6, 0.3) for axis in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)))
HORN = ((-1, 0, 0.3), 1.0, 0.25)


@pytest.fixture(scope="module")
def ball():
    return analyze(lumpy_ball())


@pytest.fixture(scope="module")
def finer():
    return analyze(shuffled(lumpy_ball(4))[0], order=1)


@pytest.fixture(scope="module")
def horned():
    return analyze(shuffled(lumpy_ball(lumps=(*LUMPS, HORN)))[0])


def middles(mesh: TriangleMesh) -> np.ndarray:
    return mesh.vertices[mesh.triangles].mean(axis=1)


def agreement(analysis: Analysis, labels: np.ndarray, reference: Analysis, expected: np.ndarray) -> float:
    """Return the share of area on which labels are those of the nearest triangle of the reference."""
    nearest = cKDTree(middles(reference.mesh)).query(middles(analysis.mesh))[1]
    return analysis.mesh.areas[labels == expected[nearest]].sum() / analysis.mesh.areas.sum()


def test_another_triangulation_gets_the_same_parts(ball, finer):
    own, other = register([ball, finer])
    assert set(other.parts.id) == set(own.parts.id)
    assert agreement(finer, other.labels, ball, own.labels) > 0.97


def test_the_reference_keeps_its_parts(ball, finer):
    expected = finer.segment(level=2, mode="features")
    _, reference = register([ball, finer], reference=1, level=2)
    np.testing.assert_array_equal(reference.labels, expected.labels)


def test_parts_are_found_at_whatever_level_they_stand(ball):
    """A lump that is the last but one here is the largest there, so the levels do not agree."""
    other = analyze(shuffled(lumpy_ball(lumps=(*LUMPS[:3], (LUMPS[3][0], 1.3, 0.3))))[0])
    own, registered = register([ball, other], level=3)
    assert set(registered.parts.id) == set(own.parts.id)


def test_a_part_too_many_gets_a_label_that_no_other_shape_has(ball, horned):
    twice = analyze(shuffled(moved(horned.mesh), seed=5)[0])
    plain, first, second = register([ball, horned, twice])
    extra = [set(one.parts.id) - set(plain.parts.id) for one in (first, second)]
    assert [len(ids) for ids in extra] == [1, 1]
    assert extra[0].isdisjoint(extra[1])
    at_horn = cKDTree(middles(horned.mesh)).query(3 * np.array(HORN[0]))[1]
    assert first.labels[at_horn] in extra[0]


def test_a_part_that_is_missing_is_left_out(ball, horned):
    full, plain = register([horned, ball])
    assert set(plain.parts.id) < set(full.parts.id)


def test_tables_count_what_the_labels_say(ball, horned):
    _, other = register([ball, horned])
    ids, counts = np.unique(other.labels, return_counts=True)
    np.testing.assert_array_equal(other.parts.id, ids)
    np.testing.assert_array_equal(other.parts.n_triangles, counts)


def test_poses_with_one_topology_correspond_by_number(ball):
    bent = ball.mesh.vertices + 0.1 * np.sin(ball.mesh.vertices[:, [1, 2, 0]])
    own, other = register([ball, analyze(TriangleMesh(bent, ball.mesh.triangles))])
    np.testing.assert_array_equal(own.labels, other.labels)
    np.testing.assert_array_equal(own.parts.id, other.parts.id)


@pytest.mark.parametrize("pool", [pytest.param(ThreadPoolExecutor, marks=pytest.mark.long), ProcessPoolExecutor])
def test_executors_give_what_a_loop_gives(ball, finer, pool):
    # Processes are spawned, as they are inside Blender, where forking is not safe.
    options = {"mp_context": get_context("spawn")} if pool is ProcessPoolExecutor else {}
    with pool(max_workers=2, **options) as executor:
        results = register([ball, finer, finer], executor=executor)
    for result, expected in zip(results, register([ball, finer, finer]), strict=True):
        np.testing.assert_array_equal(result.labels, expected.labels)


@pytest.mark.filterwarnings("ignore:Sending large graph")
def test_a_cluster_gives_what_a_loop_gives(ball, finer):
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        cluster.get_client() as client,
    ):
        results = register([ball, finer, finer], executor=client.get_executor())
    for result, expected in zip(results, register([ball, finer, finer]), strict=True):
        np.testing.assert_array_equal(result.labels, expected.labels)


def test_progress_is_told_after_each_pair(ball, finer):
    told = []
    register([ball, finer, finer], progress=lambda fraction, text: told.append((fraction, text)))
    assert told[-1] == (1.0, "Registered 2 of 2 shapes")


def test_two_shapes_are_matched_once(ball, finer, monkeypatch):
    calls = []

    def counted(*shapes, **options):
        calls.append(shapes)
        return match_surfaces(*shapes, **options)

    monkeypatch.setattr(population, "match_surfaces", counted)
    register([ball, finer])
    assert len(calls) == 1
    register([ball, finer, finer])
    assert len(calls) == 4


def test_a_matching_that_is_sure_and_wrong_is_put_right_by_the_others(ball, finer, monkeypatch):
    _, right = register([ball, finer])
    other = analyze(shuffled(moved(ball.mesh), seed=5)[0])

    def wrong_for_finer(source, target, *shapes, **options):
        found = match_surfaces(source, target, *shapes, **options)
        is_wrong = source is ball.surface and target is finer.surface
        return replace(found.alternatives[0], confidence=0.95) if is_wrong else found

    monkeypatch.setattr(population, "match_surfaces", wrong_for_finer)
    _, alone = register([ball, finer])
    assert agreement(finer, alone.labels, finer, right.labels) < 0.9
    _, result, _ = register([ball, finer, other])
    assert agreement(finer, result.labels, finer, right.labels) > 0.97
    assert result.warnings == ()


def test_a_matching_that_is_not_sure_is_told(ball):
    star = analyze(lumpy_ball(lumps=ARMS))
    assert register([star, analyze(shuffled(star.mesh)[0])])[1].warnings[0].startswith("Its matching is right with")


def test_a_matching_that_contradicts_the_others_is_told(ball, finer, monkeypatch):
    def agreed(reference, targets, matchings, match_pairs, progress):
        return [matchings[0], replace(matchings[1], is_consistent=False)]

    monkeypatch.setattr(population, "agreed_matchings", agreed)
    assert [one.warnings for one in register([ball, finer, finer])] == [(), (), (CONTRADICTS,)]


@pytest.mark.parametrize("place", range(3))
def test_a_mesh_with_few_functions_costs_no_other(ball, finer, place):
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    shapes = [ball, finer]
    shapes.insert(place, analyze(TriangleMesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])))
    assert [len(one.labels) for one in register(shapes)] == [len(one.mesh.triangles) for one in shapes]


@pytest.mark.parametrize("text", ["Matched 1 of 2", "Compared 1 of 1", "Comparing with", "Registered 1 of 2"])
def test_every_stage_can_be_cancelled(ball, finer, text):
    def cancel(fraction, told):
        if told.startswith(text):
            raise Cancelled

    with pytest.raises(Cancelled):
        register([ball, finer, finer], progress=cancel)


def test_parts_without_a_partner_are_numbered_from_a_free_label():
    cuts = [np.array([0, 1, 7, 3]), np.array([9, 2, 0])]
    renumbered = with_first_free(cuts, highest_shared=3, first_free=20)
    assert [cut.tolist() for cut in renumbered] == [[0, 1, 20, 3], [21, 2, 0]]


@pytest.mark.parametrize("reference", [3, -1, 1.0, "0", None])
def test_a_reference_that_is_not_there_is_refused(ball, reference):
    with pytest.raises(RegistrationError, match=f"no shape {reference} to register to"):
        register([ball], reference=reference)


@pytest.mark.parametrize(
    ("points", "told"),
    [
        (5, "as a list"),
        ([], "for 0 shapes, and 2"),
        ([None], "for 1 shapes, and 2"),
        ([None] * 3, "for 3 shapes, and 2"),
    ],
)
def test_points_that_are_not_given_for_each_of_the_others_are_refused(ball, points, told):
    with pytest.raises(RegistrationError, match=told):
        register([ball, ball, ball], points=points)


def test_what_is_wrong_with_points_is_told_of_their_shape(ball):
    with pytest.raises(RegistrationError, match="Shape 2: Point 1 names vertex 99999 of the target"):
        register([ball, ball, ball], reference=1, points=[None, [[0, 99999]]])


@pytest.mark.parametrize("reference", [0, 1])
def test_a_shape_that_was_analyzed_shell_by_shell_is_told_by_its_number(ball, reference):
    two = TriangleMesh(
        np.vstack([ball.mesh.vertices, ball.mesh.vertices + 9]),
        np.vstack([ball.mesh.triangles, ball.mesh.triangles + len(ball.mesh.vertices)]),
    )
    with pytest.raises(RegistrationError, match="Shape 1: Each loose part"):
        register([ball, analyze(two, shells="separate")], reference=reference)
