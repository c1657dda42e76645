"""Self-maps and rivals: what a shape looks like when turned is found, and competes in every match."""

import numpy as np
import pytest

from compute.registration.eigenfunctions.map_scoring import MapScorer, distance_of
from compute.registration.eigenfunctions.matching import match
from compute.registration.eigenfunctions.self_maps import find_rivals, find_self_maps, promising
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from compute.registration.eigenfunctions.zoomout import nearest_points, with_constant
from tests.compute.registration.shapes import landed_vertices, lumpy_ball, moved, quick, shuffled

# Like a person that stands: a head, arms and legs that fit themselves after half a turn, and a nose that does not.
STANDING = (
    *(((side, 0, 0.4), 1.2, 0.25) for side in (-1, 1)),
    *(((0.5 * side, 0, -1), 1.0, 0.3) for side in (-1, 1)),
    ((0, 0, 1), 0.7, 0.35),
)
NOSE = ((0, 0.6, 0.8), 0.12, 0.15)


def shape_of(mesh):
    return spectral_shape(quick(mesh).matching_basis)


@pytest.fixture(scope="module")
def person():
    return shape_of(lumpy_ball(3, (*STANDING, NOSE)))


def turns_round(functional_map, source, target) -> bool:
    """Whether a map takes the target's sides, left and right of x = 0, to the other side of the source."""
    points = target.samples
    landed = nearest_points(functional_map, source.functions, target.functions[points])
    return float((source.positions[landed, 0] * target.positions[points, 0]).sum()) < 0


def test_a_person_fits_itself_after_half_a_turn(person):
    assert any(turns_round(one, person, person) for one in find_self_maps(person))


def test_all_rotations_of_a_star_are_rivals():
    arms = [(np.cos(angle), np.sin(angle), 0.3) for angle in 2 * np.pi * np.arange(5) / 5]
    star = shape_of(lumpy_ball(4, tuple((arm, 1.5, 0.25) for arm in arms)))
    tips = np.array([(star.positions @ np.array(arm)).argmax() for arm in arms])
    unturned = MapScorer(star, star).score(np.eye(16)[None])
    steps = set()
    for start in find_rivals(unturned, star.self_maps):
        landed = star.positions[nearest_points(with_constant(start), star.functions, star.functions[tips])]
        angle = np.arctan2(landed[:, 1], landed[:, 0])
        steps.add(round(float(np.median((angle - 2 * np.pi * np.arange(5) / 5) % (2 * np.pi)) / (2 * np.pi / 5))) % 5)
    assert steps >= {1, 2, 3, 4}


def test_the_right_map_is_a_rival_of_the_turned_one(person):
    """Of a search that has found nothing but the turned map."""
    half_turn = next(one for one in find_self_maps(person) if turns_round(one, person, person))
    scorer = MapScorer(person, person)
    turned = scorer.score(half_turn[None, 1:17, 1:17])
    rivals = scorer.score(find_rivals(turned, [half_turn]))
    assert any(distance_of(rival.functional_map, np.eye(len(rival.functional_map))) < 0.1 for rival in rivals)


def test_of_many_rivals_the_best_are_tried(person):
    """The identity among reflected and turned starts, none of which fits as well."""
    others = [np.diag(np.where(np.arange(16) % number == 0, -1.0, 1.0)) for number in range(2, 8)]
    starts = np.stack([*others, np.eye(16)])
    kept = promising(starts, person, person)
    assert len(kept) < len(starts)
    assert any(np.array_equal(one, np.eye(16)) for one in kept)
    np.testing.assert_array_equal(promising(starts[-2:], person, person), starts[-2:])


def test_no_rival_is_one_of_the_candidates(person):
    candidates = MapScorer(person, person).score(np.eye(16)[None])
    assert len(find_rivals(candidates, [])) == 0


def test_a_nose_tells_front_from_back():
    finer = lumpy_ball(4, (*STANDING, NOSE))
    mesh, was = shuffled(moved(finer), seed=3)
    source, target = quick(lumpy_ball(3, (*STANDING, NOSE))), quick(mesh)
    matching = match(source, target)
    landed = source.matching_basis.nodes[landed_vertices(matching, source, target)]
    is_nose = finer.vertices[was] @ NOSE[0] > 1.05 * np.linalg.norm(NOSE[0])
    is_nose &= finer.vertices[was, 1] > 0.4
    assert (landed[is_nose, 1] > 0).all()
    assert matching.confidence > 0.5
    assert sum(other.confidence for other in matching.alternatives) + matching.confidence <= 1
