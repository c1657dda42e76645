import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from compute import Cancelled, FieldError, LevelError, TriangleMesh, analyze
from compute.choices import MODES
from tests.shapes import icosphere, joined, rectangle, star, torus


@pytest.fixture(scope="module")
def analysis():
    return analyze(star())


def n_pieces(mesh, chosen):
    """Return into how many pieces the chosen triangles fall."""
    left, right = mesh.edges.neighbours.T
    inside = chosen[left] & chosen[right]
    n = len(mesh.triangles)
    graph = coo_array((np.ones(inside.sum()), (left[inside], right[inside])), shape=(n, n))
    return len(np.unique(connected_components(graph, directed=False)[1][chosen]))


def test_a_star_has_its_arms_and_a_body(analysis):
    segmentation = analysis.segment()
    assert segmentation.n_parts == 6
    centres = analysis.mesh.vertices[analysis.mesh.triangles].mean(axis=1)
    for part in segmentation.parts.id[1:]:
        tip = analysis.net.positions[segmentation.parts.extremum[segmentation.parts.id == part]][0]
        inside = centres[segmentation.labels == part]
        assert (inside @ tip > 0).all()


def test_labels_cover_every_triangle_and_fill_the_table(analysis):
    segmentation = analysis.segment(level=3)
    ids, count = np.unique(segmentation.labels, return_counts=True)
    np.testing.assert_array_equal(ids, segmentation.parts.id)
    np.testing.assert_array_equal(count, segmentation.parts.n_triangles)
    area = np.bincount(segmentation.labels, analysis.mesh.areas)[ids]
    np.testing.assert_allclose(segmentation.parts.area, area)


@pytest.mark.parametrize("field", ["diffusion", 1, 4])
@pytest.mark.parametrize("mode", MODES)
def test_parts_are_connected_and_counted_at_every_level(field, mode):
    analysis = analyze(star(), field=field)
    for level in range(analysis.hierarchy.n_levels):
        segmentation = analysis.segment(level=level, mode=mode)
        ids, count = np.unique(segmentation.labels, return_counts=True)
        assert dict(zip(ids, count, strict=True)) == dict(
            zip(segmentation.parts.id, segmentation.parts.n_triangles, strict=True)
        )
        for part in ids[ids > 0]:
            assert n_pieces(analysis.mesh, segmentation.labels == part) == 1


def test_the_default_mode_is_the_first_one(analysis):
    level = analysis.hierarchy.n_levels - 1
    np.testing.assert_array_equal(
        analysis.segment(level=level).labels, analysis.segment(level=level, mode=MODES[0]).labels
    )
    assert [line.part for line in analysis.borders()] == [line.part for line in analysis.borders(mode=MODES[0])]


@pytest.mark.parametrize("mode", MODES)
def test_a_part_only_shrinks_when_the_level_rises(analysis, mode):
    """Its number stays, and cuts move towards its tip."""
    for level in range(1, analysis.hierarchy.n_levels - 1):
        coarse, fine = (analysis.segment(level=each, mode=mode).labels for each in (level, level + 1))
        for part in set(coarse.tolist()) - {0}:
            assert set(coarse[fine == part].tolist()) <= {part}


@pytest.mark.parametrize("mode", MODES)
def test_level_zero_is_all_body(analysis, mode):
    assert set(analysis.segment(level=0, mode=mode).labels.tolist()) == {0}


@pytest.mark.parametrize("mode", MODES)
def test_the_number_of_parts_is_reached(analysis, mode):
    for n_parts in (1, 3, 4, 5, 6):
        segmentation = analysis.segment(n_parts=n_parts, mode=mode)
        assert segmentation.n_parts == n_parts == len(set(segmentation.labels.tolist()))
        assert segmentation.warnings == ()


def test_a_number_of_parts_that_cannot_be_reached_is_undercut_with_a_warning(analysis):
    segmentation = analysis.segment(n_parts=2)
    assert segmentation.n_parts == 1
    assert "exactly 2 parts" in segmentation.warnings[0]
    assert analysis.segment(n_parts=500).n_parts < 500


def test_a_threshold_is_a_fraction_of_the_range(analysis):
    assert analysis.segment(threshold=1.0).n_parts == 1
    level = int((analysis.hierarchy.persistence >= 0.1 * analysis.field.value_range).sum())
    assert analysis.segment(threshold=0.1).level == level


@pytest.mark.parametrize("scale", [1e-5, 1e5])
def test_neither_scale_nor_rotation_change_the_parts(analysis, scale):
    rotation = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    rotation *= np.linalg.det(rotation)
    turned = analyze(TriangleMesh(scale * analysis.mesh.vertices @ rotation, analysis.mesh.triangles))
    np.testing.assert_array_equal(turned.segment().labels, analysis.segment().labels)


def test_the_order_of_vertices_does_not_change_the_parts(analysis):
    order = np.random.default_rng(0).permutation(len(analysis.mesh.vertices))
    shuffled = TriangleMesh(analysis.mesh.vertices[order], np.argsort(order)[analysis.mesh.triangles])
    same = analyze(shuffled).segment().labels == analysis.segment().labels
    assert analysis.mesh.areas[same].sum() > 0.999 * analysis.mesh.areas.sum()


def test_polygons_get_the_labels_of_their_triangles(analysis):
    """Two triangles to a face: a face is in a part if more than half of it is."""
    n_triangles = len(analysis.mesh.triangles)
    faces = np.arange(n_triangles) // 2
    (branches,) = analysis.part_tree(faces).branches
    assert len(branches.of_face) == n_triangles // 2
    assert branches.area.sum() == pytest.approx(analysis.mesh.areas.sum())


def test_a_sphere_is_one_part_without_features():
    analysis = analyze(icosphere(3))
    assert analysis.hierarchy.n_levels == 1
    assert analysis.segment().n_parts == 1
    assert "no features" in analysis.warnings[0]


def test_triangles_that_repeat_others_or_have_collapsed_are_counted():
    mesh = star()
    odd = np.array([mesh.triangles[5], mesh.triangles[5][::-1], [0, 0, 1]])
    assert analyze(mesh).warnings == ()
    (told,) = analyze(TriangleMesh(mesh.vertices, np.vstack([mesh.triangles, odd]))).warnings
    assert "collapsed or repeat others: 3;" in told


def test_small_shells_follow_what_they_lie_on():
    body = star()
    tip = body.vertices[np.argmax(body.vertices[:, 0])]
    jewel = TriangleMesh(0.05 * icosphere(1).vertices + tip, icosphere(1).triangles)
    analysis = analyze(joined(body, jewel))
    labels = analysis.segment().labels
    nearest = analysis.mesh.vertices[body.triangles].mean(axis=1) @ [1, 0, 0]
    assert set(labels[-80:].tolist()) == {int(labels[np.argmax(nearest)])}
    assert "2 loose parts" in analysis.warnings[0]


@pytest.mark.parametrize(("mesh", "characteristic"), [(icosphere(2), 2), (torus(), 0), (rectangle(8, 6), 1)])
def test_the_index_sum_is_the_euler_characteristic(mesh, characteristic):
    assert analyze(mesh, field=4).complex.euler_characteristic == characteristic


def test_progress_never_falls_and_ends_at_one():
    told = []
    analyze(star(), progress=lambda fraction, text: told.append(fraction))
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert len(told) > 10


@pytest.mark.parametrize("moment", [0.0, 0.3, 0.6, 0.9])
def test_any_progress_report_can_cancel(moment):
    def stop(fraction, text):
        if fraction >= moment:
            raise Cancelled

    with pytest.raises(Cancelled):
        analyze(star(), progress=stop)


def test_two_runs_agree_to_the_last_bit():
    first, second = analyze(star()), analyze(star())
    np.testing.assert_array_equal(first.field.values, second.field.values)


def test_refuses_several_choices_at_once(analysis):
    with pytest.raises(LevelError, match="not several"):
        analysis.segment(level=1, n_parts=3)


@pytest.mark.parametrize("n_parts", [0, -3])
def test_refuses_less_than_one_part(analysis, n_parts):
    with pytest.raises(LevelError, match="at least 1"):
        analysis.segment(n_parts=n_parts)


def test_refuses_an_unknown_order():
    with pytest.raises(FieldError, match='"auto"'):
        analyze(star(), order="cubic")


def test_parts_end_where_a_handle_begins_if_asked_to():
    """A standing torus has one maximum and nothing to cut; its two essential saddles cut off top and bottom."""
    mesh = torus()
    analysis = analyze(mesh, field=mesh.vertices[:, 0])
    assert analysis.segment(mode="features").n_parts == 1
    ended = analysis.segment(essential=True, mode="features")
    assert ended.n_parts == 3
    assert set(ended.parts.saddle[1:]) == set(analysis.complex.essential.loops.ravel())
