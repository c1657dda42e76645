"""Coarse parts first, then what they divide into."""

import numpy as np
import pytest

from compute.analysis.analyze import analyze
from compute.errors import Cancelled
from compute.registration.paper.diagram_matching import PartPairs, match_diagrams, match_tips
from compute.registration.paper.subpart_matching import match_subparts
from tests.compute.registration.shapes import lumpy_ball, moved, shuffled

# A fork and a plain arm; coarse parts are the fork and the half below.
FORKED = (((0, 0, 1), 1.5, 0.5), ((0.35, 0, 1), 1.1, 0.14), ((-0.35, 0.1, 1), 0.7, 0.14), ((1, 0, -0.5), 1.3, 0.3))


@pytest.fixture(scope="module")
def forked():
    return analyze(lumpy_ball(4, FORKED), order=1)


@pytest.fixture(scope="module")
def copy():
    mesh, order = shuffled(moved(lumpy_ball(4, FORKED)))
    return analyze(mesh, order=1), order


def coarse_pairs(source, target, level: int = 1) -> tuple[tuple, PartPairs]:
    parts = source.segment(level=level, mode="features"), target.segment(level=level, mode="features")
    return parts, match_tips(source, target, parts, match_diagrams(source, target))


def tips(analysis, whole, label, own) -> np.ndarray:
    """Return the highest vertex of each part of a part."""
    inside = np.flatnonzero(whole.labels == label)
    found = []
    for part in own.parts.id[own.parts.id > 0]:
        corners = np.unique(analysis.mesh.triangles[inside[own.labels == part]])
        centre = analysis.mesh.vertices.mean(axis=0)
        found.append(corners[np.linalg.norm(analysis.mesh.vertices[corners] - centre, axis=1).argmax()])
    return np.array(found)


def test_the_prongs_of_a_fork_are_paired_inside_the_fork(forked, copy):
    target, order = copy
    parts, pairs = coarse_pairs(forked, target)
    fork = parts[0].labels[(forked.mesh.vertices[forked.mesh.triangles[:, 0], 2]).argmax()]
    (inside,) = (one for one in match_subparts(forked, target, parts, pairs) if one.of_source == fork)
    own = tips(forked, parts[0], inside.of_source, inside.source)
    other = order[tips(target, parts[1], inside.of_target, inside.target)]
    assert len(inside.pairs.source) == 2
    sides = (inside.source, inside.pairs.source), (inside.target, inside.pairs.target)
    places = [np.searchsorted(side.parts.id[side.parts.id > 0], labels) for side, labels in sides]
    away = forked.mesh.vertices[own[places[0]]] - forked.mesh.vertices[other[places[1]]]
    assert np.linalg.norm(away, axis=1).max() < 0.1


def test_parts_without_features_are_left_out(forked):
    parts, _ = coarse_pairs(forked, forked, level=3)
    middles = forked.mesh.vertices[forked.mesh.triangles].mean(axis=1)
    plain = parts[0].labels[[(middles @ [1, 0, -0.5]).argmax()]].astype(np.int64)
    pairs = PartPairs(plain, plain, np.zeros(1))
    assert match_subparts(forked, forked, parts, pairs) == ()


def test_it_can_be_cancelled(forked):
    def cancel(fraction, text):
        raise Cancelled

    parts, pairs = coarse_pairs(forked, forked)
    with pytest.raises(Cancelled):
        match_subparts(forked, forked, parts, pairs, progress=cancel)
