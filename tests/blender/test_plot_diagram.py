"""The picture of the diagram, and the complex as curves and dots."""

import bpy
import numpy as np
import pytest

from compute import TriangleMesh, analyze
from tests.blender.conftest import everything_on


@pytest.fixture(scope="module")
def analysis(star):
    return analyze(TriangleMesh(np.float32(star.vertices), star.triangles))


def picture_of(image: bpy.types.Image) -> np.ndarray:
    pixels = np.empty(image.size[0] * image.size[1] * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], 4)


def is_near(picture: np.ndarray, colour: tuple[float, ...]) -> np.ndarray:
    return np.abs(picture[..., :3] - colour).max(axis=-1) < 0.02


def test_every_feature_has_a_dot_in_the_picture(star_object, analysis):
    assert bpy.ops.eigenparts.plot_diagram() == {"FINISHED"}
    picture = picture_of(bpy.data.images["Diagram of star"])
    from scipy.ndimage import label

    red = is_near(picture, (0.8, 0.2, 0.067))
    _, n_pieces = label(red)
    diagram = analysis.diagram
    assert (picture[..., 3] == 1).all()
    # One more stands in the legend; dots may overlap.
    assert 2 <= n_pieces <= len(diagram.maxima) + 1
    # A disk of radius 7 has 154 pixels.
    assert red.sum() <= 160 * (len(diagram.maxima) + 1)


def test_plotting_again_draws_over_our_image_and_leaves_others_alone(star_object):
    own = bpy.data.images.new("Diagram of star", 8, 8)
    bpy.ops.eigenparts.plot_diagram()
    bpy.ops.eigenparts.plot_diagram()
    assert tuple(own.size) == (8, 8)
    assert len(bpy.data.images) == 2
    assert not any(image.is_dirty for image in bpy.data.images if image is not own)


def test_plotting_and_tracing_change_nothing_on_the_mesh(star_object):
    before = everything_on(star_object.data)
    bpy.ops.eigenparts.plot_diagram()
    bpy.ops.eigenparts.trace_complex()
    assert everything_on(star_object.data) == before
    assert len(bpy.data.fonts) == 0
    assert not [curve for curve in bpy.data.curves if curve.name.startswith("Eigenparts")]


@pytest.mark.parametrize("level", [0, 2, -1])
def test_the_complex_in_the_scene_is_that_of_the_engine(star_object, analysis, level):
    assert bpy.ops.eigenparts.trace_complex(level=level) == {"FINISHED"}
    found = analysis.complex_at_level(None if level < 0 else level)
    parts = {obj["eigenparts_role"]: obj for obj in bpy.data.collections["Complex of star"].objects}
    assert len(parts["rising"].data.splines) == found.separatrices.rises.sum()
    assert len(parts["falling"].data.splines) == (~found.separatrices.rises).sum()
    ball = 16 * 9
    for kind, role in enumerate(("minimum", "saddle", "maximum")):
        assert len(parts[role].data.vertices) == ball * (found.critical_points.kind == kind).sum()
    assert all(obj.parent == star_object for obj in parts.values())


def test_the_complex_is_that_of_the_level_that_is_shown(star_object, analysis):
    bpy.ops.eigenparts.analyze()
    star_object.data.eigenparts.level = 1
    bpy.ops.eigenparts.trace_complex()
    maxima = next(o for o in bpy.data.collections["Complex of star"].objects if o["eigenparts_role"] == "maximum")
    shown, default = (int((analysis.complex_at_level(level).critical_points.kind == 2).sum()) for level in (1, None))
    assert len(maxima["places"]) == 3 * shown
    assert shown < default


def test_lines_lie_on_the_mesh(star_object):
    bpy.ops.eigenparts.trace_complex()
    for role in ("rising", "falling", "level"):
        curve = next(o for o in bpy.data.collections["Complex of star"].objects if o["eigenparts_role"] == role).data
        for spline in curve.splines:
            for point in list(spline.points)[:: max(len(spline.points) // 7, 1)]:
                _, nearest, _, _ = star_object.closest_point_on_mesh(point.co.xyz)
                assert (nearest - point.co.xyz).length < 1e-4


def test_tracing_again_replaces_the_lines_and_keeps_what_the_user_put_beside(star_object):
    bpy.ops.eigenparts.trace_complex()
    collection = bpy.data.collections["Complex of star"]
    note = bpy.data.objects.new("note", None)
    collection.objects.link(note)
    n_before = len(collection.objects)
    bpy.ops.eigenparts.trace_complex(level=1)
    assert len(collection.objects) == n_before
    assert note.name in collection.objects


def test_an_unknown_level_is_refused_with_a_sentence(star_object):
    with pytest.raises(RuntimeError, match="Level 1000 does not exist"):
        bpy.ops.eigenparts.trace_complex(level=1000)
    assert "Complex of star" not in bpy.data.collections
