"""How far bones reach into the ends of limbs."""

import numpy as np
import pytest

from compute import analyze
from compute.skeletons.interior import Interior
from compute.skeletons.sliced_shape import slice_shape
from compute.skeletons.tips import (
    REACHES,
    Tip,
    hidden_crown,
    reaching,
    tip_of_chain,
    tips_of_parts,
    widest_slice,
    with_straight_tips,
)
from compute.surface.cleaning import clean_surface
from tests.compute.skeletons.shapes import chain, slices_of, spindle
from tests.shapes import icosphere


@pytest.fixture(scope="module")
def shape():
    analysis = analyze(spindle(49, 24), field=1, order=1)
    upper = (analysis.mesh.vertices[analysis.mesh.triangles].mean(axis=1)[:, 2] > 0).astype(np.int32)
    return slice_shape(analysis, upper, None, [])


def test_either_half_of_a_spindle_has_its_tip(shape):
    tips = tips_of_parts(shape.analysis, shape.graph, shape.slices, None)
    assert sorted(tips.values()) == [0, 1]
    heights = shape.analysis.net.positions[shape.graph.vertex[list(tips)], 2]
    np.testing.assert_array_equal(heights > 0, [part == 1 for part in tips.values()])


def test_a_straight_limb_reaches_towards_its_extremum(shape):
    low, high = shape.graph.arcs[0]
    tip = tip_of_chain(chain(low, high, *shape.slices.of_arc(0)), shape)
    assert tip.last == shape.slices.of_arc(0)[-1]
    end, pole = shape.centres[0, tip.last], shape.analysis.net.positions[shape.graph.vertex[high]]
    np.testing.assert_allclose(tip.places[0], end + REACHES[0] * (pole - end), atol=1e-9)


def test_a_limb_that_never_comes_near_its_farthest_point_ends_in_a_cavity(shape):
    """Half a line hides the crown at the far pole, the whole line does not."""
    of_arc = shape.slices.of_arc(0)
    whole, turning = chain(0, 1, *of_arc), shape.centres[0].copy()
    assert hidden_crown(whole, shape.slices, turning, shape.triangle_centres) is None
    half = len(of_arc) // 2
    turning[of_arc[half:]] = turning[of_arc[half - 1 :: -1]][: len(of_arc) - half]
    crown = hidden_crown(whole, shape.slices, turning, shape.triangle_centres)
    farthest = np.linalg.norm(shape.triangle_centres - turning[of_arc[0]], axis=1).argmax()
    np.testing.assert_allclose(shape.triangle_centres[crown, 2], shape.triangle_centres[farthest, 2], atol=1e-6)


def test_the_widest_slice_is_looked_for_in_the_outer_half():
    slices = slices_of([6], girth=[9, 8, 7, 1, 3, 2])
    assert widest_slice(chain(0, 1, 0, 1, 2, 3, 4, 5), slices) == 4


def test_a_tip_reaches_as_far_as_it_stays_inside():
    ball = Interior.of(clean_surface(icosphere(3)))
    places = [reaching(np.zeros((1, 3)), np.array([[0.1, 0.2, height]]), ball)[0, 2] for height in (1.1, 1.6, 5)]
    assert places == pytest.approx([0.85 * 1.1, 0.5 * 1.6, 0.0])


def test_slices_behind_the_last_one_lie_evenly_on_the_way_to_the_tip():
    centres = np.random.default_rng(0).normal(size=(2, 5, 3))
    limb = chain(0, 1, 0, 1, 2, 3)
    straight = with_straight_tips(centres, {limb: Tip(np.full((2, 3), 7.0), 1)})
    np.testing.assert_allclose(straight[:, 2], centres[:, 1] + (7 - centres[:, 1]) / 3)
    np.testing.assert_allclose(straight[:, 3], centres[:, 1] + 2 * (7 - centres[:, 1]) / 3)
    np.testing.assert_array_equal(straight[:, [0, 1, 4]], centres[:, [0, 1, 4]])
