"""Nodes within each other's flesh are one hub."""

import numpy as np
import pytest

from compute.skeletons.hubs import gathered_hubs, hub_numbers, joined_hubs
from tests.compute.skeletons.shapes import chain, slices_of

# Two tips on either side: 0 and 1 at node 4, 2 and 3 at node 5, and a chain between the nodes.
CHAINS = [chain(4, 0, 0), chain(4, 1, 1), chain(5, 2, 2), chain(5, 3, 3), chain(4, 5, 4, 5)]
TIPS = {0, 1, 2, 3}


def centres(distance):
    """Return the places of the slices: both nodes' ends on the x axis, so far apart."""
    return np.array([[[x, 0, 0] for x in (0, 0, distance, distance, 0, distance)]], dtype=float)


@pytest.mark.parametrize(("distance", "n_hubs"), [(0.5, 1), (0.99, 1), (1.01, 2), (5, 2)])
def test_nodes_nearer_than_the_radius_are_one(distance, n_hubs):
    slices = slices_of([6], girth=2 * np.pi)
    hubs = gathered_hubs(CHAINS, TIPS, slices, centres(distance))
    assert len(hubs) == n_hubs
    assert sorted(sorted(hub.nodes) for hub in hubs) == ([[4, 5]] if n_hubs == 1 else [[4], [5]])


def test_a_hub_lies_in_the_mean_of_the_rings_that_leave_it_by_girth():
    slices = slices_of([6], girth=[1, 3, 1, 1, 1, 1])
    places = centres(9.0)
    places[0, 1, 1] = 1.0
    hub = next(hub for hub in gathered_hubs(CHAINS, TIPS, slices, places) if hub.nodes == {4})
    np.testing.assert_allclose(hub.places[0], [0, 3 / 5, 0])
    assert hub.radius == pytest.approx(3 / (2 * np.pi))


def test_chains_that_are_known_to_lie_within_join_their_nodes_however_far():
    (hub,) = joined_hubs({4, 5}, CHAINS[4:], CHAINS, slices_of([6]), centres(100))
    assert hub.nodes == {4, 5}
    assert len(joined_hubs({4, 5}, [], CHAINS, slices_of([6]), centres(0))) == 2


def test_every_node_has_the_number_of_its_hub():
    hubs = gathered_hubs(CHAINS, TIPS, slices_of([6]), centres(9))
    number = hub_numbers(hubs)
    assert all(node in hubs[number[node]].nodes for node in (4, 5))
    assert set(number) == {4, 5}
