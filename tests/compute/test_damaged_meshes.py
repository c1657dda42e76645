"""Whatever is done to a mesh, there is a division of it or a sentence that says why not."""

import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

from compute import EngineError, TriangleMesh, analyze, reeb_graph
from tests.damage import DAMAGES, SHAPES, damaged
from tests.selection import draws

# Cases of each draw; each long one has others.
RANDOM = settings(
    max_examples=60, deadline=None, database=None, suppress_health_check=list(HealthCheck), print_blob=True
)
steps = st.lists(st.tuples(st.sampled_from(sorted(DAMAGES)), st.floats(0.0, 1.0)), max_size=3)
seeds = st.integers(0, 2**32 - 1)
rotations = st.integers(0, 2**32 - 1).map(lambda seed: np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0])


def divided(vertices, triangles):
    """Return the analysis, or the sentence of the refusal."""
    try:
        return analyze(TriangleMesh(vertices, triangles), order=1)
    except EngineError as refusal:
        return str(refusal)


def check(analysis):
    """Every level of both modes covers all faces with parts that are listed; what else is drawn from it exists."""
    hierarchy = analysis.hierarchy
    for level in {0, hierarchy.default_level, hierarchy.n_levels - 1}:
        for mode in ("features", "nested"):
            segmentation = analysis.segment(level=level, mode=mode)
            assert segmentation.labels.shape == (len(analysis.mesh.triangles),)
            assert set(np.unique(segmentation.labels)) <= {0, *segmentation.parts.id}
    assert np.isfinite(analysis.diagram.points).all()
    assert analysis.complex.euler_characteristic == euler_characteristic(analysis.net.triangles)
    reeb_graph(analysis, level=0)


def euler_characteristic(triangles):
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return len(np.unique(triangles)) - len(np.unique(sides, axis=0)) + len(np.unique(np.sort(triangles), axis=0))


@pytest.mark.parametrize("draw", draws(9))
def test_there_is_a_division_or_a_sentence(draw):
    @seed(draw)
    @RANDOM
    @given(shape=st.sampled_from(sorted(SHAPES)), steps=steps, number=seeds, exponent=st.integers(-5, 5))
    def check_it(shape, steps, number, exponent):
        with warnings.catch_warnings(), np.errstate(over="ignore", invalid="ignore"):
            vertices, triangles = damaged(shape, steps, number, exponent)
        first, second = divided(vertices, triangles), divided(vertices, triangles)
        if isinstance(first, str):
            assert first == second
            assert first.endswith(".")
        else:
            check(first)
            np.testing.assert_array_equal(first.segment().labels, second.segment().labels)

    check_it()


@pytest.mark.parametrize("draw", draws(4))
def test_there_is_a_division_of_each_loose_part_or_a_sentence(draw):
    @seed(draw)
    @settings(RANDOM, max_examples=20)
    @given(shapes=st.lists(st.tuples(st.sampled_from(sorted(SHAPES)), steps, seeds), min_size=2, max_size=3))
    def check_them(shapes):
        with warnings.catch_warnings(), np.errstate(over="ignore", invalid="ignore"):
            pieces = [damaged(shape, its_steps, number) for shape, its_steps, number in shapes]
        places = [vertices + np.array([9.0 * k, 0, 0]) for k, (vertices, _) in enumerate(pieces)]
        first = np.cumsum([0, *map(len, places)])
        triangles = [faces + start for (_, faces), start in zip(pieces, first, strict=False)]
        try:
            check(analyze(TriangleMesh(np.vstack(places), np.vstack(triangles)), order=1, shells="separate"))
        except EngineError as refusal:
            assert str(refusal).endswith(".")  # noqa: PT017 - a refusal is as good

    check_them()


@pytest.mark.parametrize("draw", draws(2))
@pytest.mark.parametrize("damage", ["delete_faces", "flip_faces", "merge_vertices"])
def test_most_broken_meshes_are_divided_all_the_same(damage, draw):
    rng = np.random.default_rng(draw)
    cases = [(shape, rng.random(), int(rng.integers(2**32))) for shape in SHAPES for _ in range(4)]
    outcomes = [divided(*damaged(shape, [(damage, share)], number)) for shape, share, number in cases]
    assert np.mean([not isinstance(outcome, str) for outcome in outcomes]) >= 0.8


@settings(max_examples=20, deadline=None, derandomize=True)
@given(turn=rotations, exponent=st.integers(-5, 5))
def test_unit_and_place_in_space_do_not_matter(turn, exponent):
    star = SHAPES["star"]
    expected = analyze(star, order=1).segment().labels
    moved = TriangleMesh(10.0**exponent * (star.vertices @ turn.T), star.triangles)
    found = analyze(moved, order=1).segment().labels
    pairs = np.unique(np.stack([expected, found]), axis=1)
    assert pairs.shape[1] == len(np.unique(expected)) == len(np.unique(found))
