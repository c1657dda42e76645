"""Characters made of loose parts: which shells belong together, and where they are bridged."""

import numpy as np
import pytest

from compute import MeshError, TriangleMesh, analyze
from compute.surface import bridged_surface, clean_surface
from tests.shapes import icosphere, joined


def ball(centre, radius, n_subdivisions=3):
    sphere = icosphere(n_subdivisions)
    return TriangleMesh(radius * sphere.vertices + centre, sphere.triangles)


def chain(gap):
    """Return a large ball and a row of three smaller ones beside it, with a gap between neighbours."""
    row = ball([0, 0, 0], 1.0)
    for k in range(3):
        row = joined(row, ball([1.3 + gap + k * (0.6 + gap), 0, 0], 0.3))
    return row


def reached(surface):
    return np.unique(surface.input_triangle)


def test_a_single_shell_is_left_as_it_is():
    single = icosphere(2)
    np.testing.assert_array_equal(bridged_surface(single).mesh.triangles, clean_surface(single).mesh.triangles)


def test_shells_that_nearly_touch_become_one_component():
    surface = bridged_surface(chain(gap=0.02))
    assert surface.n_joined == surface.n_components == 4
    assert surface.mesh.component_of_triangle.max() == 0
    assert len(reached(surface)) == 4 * 1280


def test_shells_out_of_reach_follow_what_is_next_to_them():
    surface = bridged_surface(chain(gap=0.5))
    assert surface.n_joined == 1
    assert len(reached(surface)) == 1280


def test_what_lies_on_a_shell_is_not_analyzed():
    """A skin just outside, as clothes are."""
    assert bridged_surface(joined(ball([0, 0, 0], 1.0), ball([0, 0, 0], 1.03))).n_joined == 1


def test_details_are_not_analyzed():
    assert bridged_surface(joined(ball([0, 0, 0], 1.0), ball([1.05, 0, 0], 0.05, 1))).n_joined == 1


def test_a_bridge_stands_on_a_neighbouring_shell():
    mesh = chain(gap=0.02)
    surface = bridged_surface(mesh)
    is_bridge = np.arange(len(surface.mesh.triangles)) >= len(reached(surface))
    piers = mesh.triangles[surface.input_triangle[is_bridge]]
    shared = (surface.mesh.triangles[is_bridge][:, :, None] == piers[:, None, :]).any(axis=2).sum(axis=1)
    assert is_bridge.any()
    assert (shared == 2).all()


def test_limbs_that_are_loose_are_parts_all_the_same():
    segmentation = analyze(chain(gap=0.02), order=1).segment(mode="nested")
    of_shell = segmentation.labels.reshape(4, -1)
    assert of_shell[0, 0] != of_shell[3, 0]
    assert (of_shell[3] == of_shell[3, 0]).mean() > 0.9


@pytest.mark.parametrize("scale", [1e-4, 1e4])
def test_the_unit_of_length_does_not_matter(scale):
    mesh = chain(gap=0.02)
    scaled = bridged_surface(TriangleMesh(scale * mesh.vertices, mesh.triangles))
    np.testing.assert_array_equal(scaled.mesh.triangles, bridged_surface(mesh).mesh.triangles)


def test_the_largest_shell_can_be_analyzed_alone():
    assert analyze(chain(gap=0.02), order=1, shells="largest").surface.n_joined == 1
    with pytest.raises(MeshError, match="bridged"):
        analyze(chain(gap=0.02), shells="all")
