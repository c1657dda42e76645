"""Signed orders that are known are found."""

from dataclasses import replace

import numpy as np
import pytest

from compute.registration.eigenfunctions.hypotheses import (
    Effort,
    find_hypotheses,
    nearest_orthogonal,
    spectrum_of,
)
from compute.registration.eigenfunctions.spectral_shape import spectral_shape
from tests.compute.registration.shapes import lumpy_ball, quick

QUICK = Effort(levels=(6, 8), beam_width=50)


@pytest.fixture(scope="module")
def spectrum():
    return spectrum_of(spectral_shape(quick(lumpy_ball(2)).matching_basis))


def test_a_shape_agrees_best_with_itself(spectrum):
    found = find_hypotheses(spectrum, spectrum, QUICK)
    np.testing.assert_allclose(found.maps[0], np.eye(8), atol=1e-6)
    assert found.total[0] == pytest.approx(2)
    assert (np.diff(found.total) <= 0).all()


def test_functions_that_were_flipped_and_switched_are_found(spectrum):
    signs = np.where(np.isin(np.arange(18), [1, 4, 6]), -1.0, 1.0)
    change = (np.eye(18) * signs)[[0, 2, 1, *range(3, 18)]]
    target = replace(spectrum, moments=spectrum.moments.rotated(change))
    np.testing.assert_allclose(find_hypotheses(spectrum, target, QUICK).maps[0], change[:8, :8], atol=0.05)


def test_the_search_begins_with_given_signs(spectrum):
    """The right ones fit exactly; with all of them wrong nothing does."""
    right, wrong = (find_hypotheses(spectrum, spectrum, QUICK, dict.fromkeys(range(6), sign)) for sign in (1, -1))
    assert right.total[0] == pytest.approx(2)
    assert wrong.total[0] < 1.95


def test_the_nearest_orthogonal_matrix_undoes_a_stretch():
    rotation = np.linalg.qr(np.random.default_rng(0).normal(size=(5, 5)))[0]
    stretch = np.diag([0.5, 1, 2, 3, 4.0])
    np.testing.assert_allclose(nearest_orthogonal((rotation @ stretch)[None])[0], rotation, atol=1e-12)
