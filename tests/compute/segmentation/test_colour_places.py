"""Places in a list of colours: parts that are shown together look different, and stay as they are."""

from itertools import combinations

import numpy as np
import pytest

from compute import MODES, VisibleParts, analyze, colour_places, label_branches, places_at_all_levels, visible_parts
from tests.selection import draws
from tests.shapes import star


def test_what_is_seen_first_has_the_first_colours():
    together = [VisibleParts((1, 7)), VisibleParts((1, 2, 7, 9))]
    assert colour_places(together, 19) == {1: 0, 7: 1, 2: 2, 9: 3}


def test_parts_that_are_never_seen_together_may_look_alike():
    together = [VisibleParts((1, 2)), VisibleParts((1, 3))]
    assert colour_places(together, 3) == {1: 0, 2: 1, 3: 1}


def test_beyond_the_last_colour_neighbours_differ():
    """A row of parts, of which each touches the next two, with three colours."""
    parts = tuple(range(1, 31))
    touching = frozenset((part, part + step) for part in parts for step in (1, 2) if part + step <= 30)
    places = colour_places([VisibleParts(parts, touching)], 3)
    assert all(places[first] != places[second] for first, second in touching)
    assert np.bincount(list(places.values())).tolist() == [10, 10, 10]


def test_what_has_a_place_keeps_it_and_what_is_new_gives_way():
    assert colour_places([VisibleParts((1, 2, 3))], 19, {2: 0, 5: 4}) == {2: 0, 5: 4, 1: 1, 3: 2}


def test_places_of_the_same_colour_are_given_anew():
    """As when two parts of different levels are shown at once, each in a limb with a level of its own."""
    assert colour_places([VisibleParts((1, 2))], 19, {1: 3, 2: 3}) == {1: 3, 2: 0}


@pytest.mark.parametrize("seed", draws(1))
def test_no_two_parts_of_a_level_look_alike(seed):
    """A star of bumpy arms: at every level in both modes, all parts differ, or neighbours if there are too many."""
    mesh, n_colours = star(n_arms=6, n_subdivisions=2), 19
    values = mesh.vertices @ [0.3, 0.2, 1] + np.random.default_rng(seed).normal(scale=0.4, size=len(mesh.vertices))
    part_tree = analyze(mesh, field=values).part_tree()
    places = places_at_all_levels(part_tree, n_colours)
    for mode in MODES:
        for level in range(part_tree.hierarchy.n_levels):
            shown = visible_parts(label_branches(part_tree, level=level, mode=mode), part_tree)
            pairs = combinations(shown.parts, 2) if len(shown.parts) <= n_colours else shown.touching
            assert all(places[first] != places[second] for first, second in pairs)
            assert colour_places([shown], n_colours, places) == places
