"""Confidence is a probability: rivals share it, and what is left is for none of them."""

from dataclasses import replace

import numpy as np
import pytest

from compute import analyze, match
from compute.registration.eigenfunctions.confidence import (
    COST_WEIGHT,
    DOUBTFUL_COST,
    TIE,
    evidence_of,
    probabilities,
)
from compute.registration.eigenfunctions.map_scoring import LEAST_COST, Candidate
from tests.compute.registration.shapes import flat_strip

# Scores under which the cost is the commutation.
GOOD = Candidate(
    start=np.eye(8),
    functional_map=np.eye(9),
    nearest=np.arange(9),
    symmetric=0.02,
    alternating=0.02,
    commutation=1e-8,
    orientation=1.0,
    curvature=0.05,
    tearing=0.997,
)


def costing(cost: float) -> Candidate:
    return replace(GOOD, commutation=cost)


def chances(candidates, curvature):
    return probabilities(candidates, [evidence_of(*pair) for pair in zip(candidates, curvature, strict=True)])


def test_a_cheap_map_without_rivals_is_nearly_sure():
    assert chances([costing(1e-9)], [0.8])[0] > 0.99


def test_at_the_doubtful_cost_it_is_as_likely_that_no_map_is_right():
    assert chances([costing(DOUBTFUL_COST)], [0.8]) == pytest.approx([0.5])


def test_rivals_as_good_share_what_there_is():
    assert chances([costing(1e-8)] * 5, [0.8] * 5) == pytest.approx([0.2] * 5, rel=0.01)


def test_costs_below_what_a_shape_fits_itself_by_say_nothing():
    assert chances([costing(1e-30), costing(LEAST_COST)], [0.8, 0.8]) == pytest.approx([0.5, 0.5], rel=0.01)


def test_evidence_that_differs_by_less_than_between_equally_right_maps_decides_nothing():
    tied, told = ([costing(1e-7), costing(1e-7 * np.exp(gap / COST_WEIGHT))] for gap in (0.9 * TIE, 2 * TIE))
    assert chances(tied, [0.8, 0.8]) == pytest.approx([0.5, 0.5], rel=0.03)
    assert chances(told, [0.8, 0.8])[0] > 0.55


@pytest.mark.parametrize("seed", range(3))
def test_maps_that_are_equally_right_are_none_of_them_sure(seed):
    matching = match(*(analyze(flat_strip(one)) for one in (seed, 10 + seed)))
    assert matching.confidence == pytest.approx(0.5, rel=0.01)
    assert matching.alternatives[0].confidence == matching.confidence


def test_of_equal_costs_the_finer_curvature_is_likelier():
    right, turned = chances([costing(1e-7), costing(1e-7)], [0.85, 0.65])
    assert right > 0.9
    assert right + turned < 1


def test_a_torn_map_has_no_chance_whatever_it_costs():
    torn = replace(GOOD, commutation=1e-12, orientation=-1.0)
    found = chances([torn, costing(1e-6)], [0.9, 0.5])
    assert found[0] == 0
    assert found[1] > 0.5
    assert chances([torn], [0.9]) == pytest.approx([0])
