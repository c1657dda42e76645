"""Maps of a population agree along its cycles: what is wrong in one is put right by the others, or told."""

from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest

from compute.errors import Cancelled
from compute.registration.eigenfunctions.matching import match_shapes, matching_shape
from compute.registration.eigenfunctions.synchronization import cheapest_in_row, pairs_in_row, synchronized
from compute.surface.mesh import TriangleMesh
from examples import humanoid
from tests.compute.registration.shapes import flat_strip, quick, shuffled


class Population:
    """A reference and three targets with their matchings; the fewer, the sooner they are computed."""

    def __init__(self, shapes):
        self.reference, *self.targets = shapes
        self.own = [match_shapes(self.reference, target) for target in self.targets]
        self.links = {pair: self.match(*pair) for pair in pairs_in_row(self.reference, self.targets)}

    def match(self, source, target):
        return match_shapes(self.targets[source], self.targets[target])

    def synchronized(self, own=None, links=None):
        return synchronized(self.reference, self.targets, own or self.own, links or self.links)


@pytest.fixture(scope="module")
def humans():
    character = humanoid(4000)
    quads = character.quads
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    poses = [TriangleMesh(character.mesh_in_pose(name), triangles) for name in ("rest", "walk", "sit", "wave")]
    return Population([matching_shape(quick(shuffled(pose, seed)[0])) for seed, pose in enumerate(poses)])


def turned(matching):
    """Return another matching of the pair as if it were the only one, and sure."""
    return replace(matching.alternatives[0], confidence=0.95)


def difference(one, other):
    """Return how far maps of the first ten functions are from each other, relative to the identity's norm."""
    return np.linalg.norm(one.map[:10, :10] - other.map[:10, :10]) / np.sqrt(10)


@pytest.mark.parametrize("wrong", range(3))
def test_a_matching_that_is_sure_and_wrong_is_put_right_by_the_others(humans, wrong):
    own = list(humans.own)
    own[wrong] = turned(own[wrong])
    assert difference(own[wrong], humans.own[wrong]) > 0.5
    for agreed, right in zip(humans.synchronized(own), humans.own, strict=True):
        assert difference(agreed, right) < 0.1
        assert agreed.confidence > 0.9
        assert agreed.is_consistent


def test_matchings_that_agree_stay(humans):
    for agreed, own in zip(humans.synchronized(), humans.own, strict=True):
        assert difference(agreed, own) < 0.1
        assert all(difference(other, agreed) > 0.3 for other in agreed.alternatives)


def test_the_order_of_the_targets_does_not_matter(humans):
    order = [2, 0, 1]
    targets = [humans.targets[number] for number in order]
    pairs = pairs_in_row(humans.reference, targets)
    assert [(order[one], order[other]) for one, other in pairs] == list(humans.links)
    links = dict(zip(pairs, humans.links.values(), strict=True))
    agreed = synchronized(humans.reference, targets, [humans.own[number] for number in order], links)
    as_given = humans.synchronized()
    for number, matching in zip(order, agreed, strict=True):
        expected = as_given[number]
        np.testing.assert_array_equal(matching.map, expected.map)
        assert matching.confidence == expected.confidence


def test_a_member_whose_only_cycle_breaks_is_in_doubt(humans):
    """Where the numbers of the first two in the row say another thing, nobody is on the side of the first."""
    (first, second), other = humans.links
    links = {(first, second): replace(turned(humans.links[first, second]), same_topology=True)}
    agreed = humans.synchronized(links=links | {other: humans.links[other]})
    assert [matching.is_consistent for matching in agreed] == [number != first for number in range(3)]
    assert agreed[first].confidence < 0.5


def test_matchings_by_numbers_are_not_touched(humans):
    by_number = replace(turned(humans.own[1]), same_topology=True, confidence=1.0)
    assert humans.synchronized([humans.own[0], by_number, humans.own[2]])[1] is by_number


def test_comparing_can_be_cancelled(humans):
    def cancel(fraction, text):
        if fraction > 0.6:
            raise Cancelled

    with pytest.raises(Cancelled):
        synchronized(humans.reference, humans.targets, humans.own, humans.links, cancel)


@pytest.mark.parametrize("sizes", [(2, 1), (3, 2, 3), (1, 3, 2, 3)])
def test_the_cheapest_row_is_that_of_trying_all(sizes):
    random = np.random.default_rng(len(sizes))
    of_places = [random.random(size) for size in sizes]
    of_links = [random.random(pair) for pair in pairwise(sizes)]

    def cost(row):
        places = sum(costs[choice] for costs, choice in zip(of_places, row, strict=True))
        return places + sum(costs[pair] for costs, pair in zip(of_links, pairwise(row), strict=True))

    rows = sorted(product(*(range(size) for size in sizes)), key=cost)
    chosen, totals = cheapest_in_row(of_places, of_links)
    assert tuple(chosen) == rows[0]
    for place, total in enumerate(totals):
        cheapest = [min(cost(row) for row in rows if row[place] == choice) for choice in range(len(total))]
        assert total == pytest.approx(cheapest)


def test_maps_that_are_equally_right_are_not_sure_because_others_are_too():
    strips = Population([matching_shape(quick(flat_strip(seed))) for seed in range(4)])
    assert [one.confidence for one in strips.synchronized()] == pytest.approx([0.5] * 3, rel=0.01)
