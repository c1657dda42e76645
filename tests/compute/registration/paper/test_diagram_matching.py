"""The paper's way: what persistence diagrams and tips tell, and what they cannot."""

from dataclasses import replace

import numpy as np
import pytest

from compute.analysis.analysis import Analysis
from compute.analysis.analyze import analyze
from compute.errors import RegistrationError
from compute.registration.paper.diagram_matching import match_diagrams, match_tips, separated_points
from tests.compute.registration.shapes import PAIRED_LUMPS, lumpy_ball, moved, shuffled


@pytest.fixture(scope="module")
def ball():
    return analyze(lumpy_ball())


@pytest.fixture(scope="module")
def copy():
    mesh, order = shuffled(moved(lumpy_ball()))
    return analyze(mesh), order


def true_signs(source: Analysis, target: Analysis, order: np.ndarray) -> np.ndarray:
    own, other = source.eigenbasis.functions[order, :6], target.eigenbasis.functions[: len(order), :6]
    return np.sign((own * other).sum(axis=0))


@pytest.mark.parametrize("metric", ["hausdorff", "bottleneck"])
def test_order_and_signs_of_a_shape_without_symmetry_are_found(ball, copy, metric):
    target, order = copy
    matching = match_diagrams(ball, target, metric=metric)
    np.testing.assert_array_equal(matching.order, np.arange(6))
    np.testing.assert_array_equal(matching.signs, true_signs(ball, target, order))


def test_the_sign_of_a_function_across_the_symmetry_stays_open():
    body = analyze(lumpy_ball(lumps=PAIRED_LUMPS))
    functions = body.eigenbasis.functions[:, :6]
    mirrored = np.array([-1, 1, 1]) * body.mesh.vertices
    partner = np.linalg.norm(body.mesh.vertices[:, None] - mirrored, axis=2).argmin(axis=1)
    vertices = np.arange(len(partner))
    is_odd = (functions[vertices] * functions[partner]).sum(axis=0) < 0
    assert is_odd.any()
    np.testing.assert_array_equal(match_diagrams(body, body).is_open, is_odd)


def test_a_negated_function_has_the_mirrored_diagram(ball):
    negated = replace(ball.eigenbasis, functions=-ball.eigenbasis.functions)
    for points, mirrored in zip(separated_points(ball.eigenbasis, 4), separated_points(negated, 4), strict=True):
        np.testing.assert_allclose(np.sort(points, axis=0), np.sort(-mirrored, axis=0), atol=1e-12)


def test_tips_pair_the_same_parts(ball, copy):
    target, _ = copy
    pairs = match_tips(
        ball, target, (ball.segment(mode="features"), target.segment(mode="features")), match_diagrams(ball, target)
    )
    np.testing.assert_array_equal(pairs.source, pairs.target)
    assert pairs.distance.max() < 1e-3


def test_an_unknown_metric_is_refused(ball):
    with pytest.raises(RegistrationError, match="bottleneck"):
        match_diagrams(ball, ball, metric="euclid")
