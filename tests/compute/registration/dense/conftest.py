"""A lumpy ball in two triangulations, with the dense maps between them."""

import pytest

from compute import correspond
from tests.compute.registration.shapes import lumpy_ball, quick


@pytest.fixture(scope="module")
def ball():
    return quick(lumpy_ball(2))


@pytest.fixture(scope="module")
def finer():
    """The same surface with other triangles."""
    return quick(lumpy_ball(3))


@pytest.fixture(scope="module")
def to_finer(ball, finer):
    return correspond(ball, finer)


@pytest.fixture(scope="module")
def to_ball(ball, finer):
    return correspond(finer, ball)
