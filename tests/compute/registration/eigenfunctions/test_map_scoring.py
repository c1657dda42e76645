"""Scores of maps: the identity has the best, torn and twisted ones worse."""

from dataclasses import replace

import numpy as np
import pytest

from compute.registration.eigenfunctions.hypotheses import Hypotheses
from compute.registration.eigenfunctions.map_scoring import (
    DOUBTFUL_COST,
    MapScorer,
    confidence_of,
    distinct_candidates,
    fit_of,
    ranked,
)
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from tests.compute.registration.shapes import lumpy_ball, quick

FLIP = np.diag([1.0, -1, 1, 1, 1, -1, 1, 1])


@pytest.fixture(scope="module")
def candidates():
    """The identity and a map with two signs flipped, of a ball to itself."""
    shape = spectral_shape(quick(lumpy_ball(2)).matching_basis)
    maps = np.stack([np.eye(8), FLIP])
    return MapScorer(shape, shape, (9, 12, 17)).score(Hypotheses(maps, np.ones(2), np.ones(2), np.zeros(2)))


def test_the_identity_commutes_keeps_orientation_and_tears_nothing(candidates):
    best = candidates[0]
    np.testing.assert_array_equal(best.nearest, np.arange(len(best.nearest)))
    assert best.commutation == pytest.approx(0, abs=1e-12)
    assert (best.symmetric, best.alternating, best.curvature) == pytest.approx((1, 1, 1))
    assert best.orientation > 0.95
    assert best.tearing == 0


def test_a_wrong_map_costs_more(candidates):
    assert candidates[1].cost > 100 * candidates[0].cost
    assert ranked(candidates[::-1]) == candidates


def test_an_inside_out_map_is_last_whatever_it_costs(candidates):
    turned = replace(candidates[0], orientation=-1.0)
    assert ranked([turned, replace(candidates[0], commutation=1e6)])[-1] is turned
    assert fit_of(turned) == 0


def test_the_doubtful_cost_halves_the_fit(candidates):
    factor = DOUBTFUL_COST / replace(candidates[0], commutation=1.0).cost
    assert fit_of(replace(candidates[0], commutation=factor)) == pytest.approx(0.5)


def test_a_rival_as_good_takes_all_confidence(candidates):
    best, other = candidates
    assert confidence_of(best, [best]) > 0.99
    assert confidence_of(best, [best, replace(best, functional_map=other.functional_map)]) == 0


def test_maps_that_differ_little_are_one(candidates):
    best, other = candidates
    again = replace(best, functional_map=best.functional_map + 1e-3)
    assert distinct_candidates([best, again], 3) == [best]
    assert distinct_candidates([best, again, other], 3)[0] is best
