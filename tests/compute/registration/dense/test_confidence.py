"""Who lands inside out, on another wall or amid the doubtful is doubted; who lands where it belongs is not."""

import numpy as np
import pytest

from compute import match
from compute.registration.dense.confidence import SURE, Landing, landing_confidence
from compute.registration.dense.shape_pair import ShapePair, triangle_around
from compute.registration.dense.surface_points import SurfacePoints
from compute.registration.eigenfunctions.spectral_shape import spectral_shape


@pytest.fixture(scope="module")
def pair(finer):
    """A ball and itself."""
    shape = spectral_shape(finer.matching_basis)
    return ShapePair(finer, finer, shape, shape, match(finer, finer))


def landing(pair, point, on_other_wall=None):
    """Let each vertex land on the point of the source's shape that is given for its own point."""
    shape = pair.source_shape
    triangle, corner = triangle_around(shape.triangles, len(shape.positions))
    landed = point[pair.target_points.point]
    walls = np.zeros(len(landed), dtype=bool) if on_other_wall is None else on_other_wall
    return Landing(SurfacePoints(triangle[landed], np.eye(3)[corner[landed]]), np.zeros(len(landed)), walls)


@pytest.fixture
def same(pair):
    return np.arange(len(pair.source_shape.positions))


def test_who_lands_on_itself_is_sure(pair, same):
    assert landing_confidence(pair, landing(pair, same)).min() > 0.99


def test_a_region_that_is_turned_over_is_doubted(pair, same):
    """Points of the upper part land on the nearest to their mirror images in x = 0."""
    positions = pair.source_shape.positions
    images = positions * [-1, 1, 1]
    upper = np.flatnonzero(positions[:, 2] > 0.2)
    point = same.copy()
    point[upper] = np.linalg.norm(images[upper, None] - positions[None], axis=2).argmin(axis=1)
    sure = landing_confidence(pair, landing(pair, point)) >= SURE
    place = positions[pair.target_points.point][:, 2]
    assert not sure[place > 0.25].any()
    assert sure[place < -0.2].all()


def test_who_lands_on_another_wall_is_doubted(pair, same):
    walls = np.arange(len(pair.target.mesh.vertices)) == 7
    assert landing_confidence(pair, landing(pair, same, walls)).argmin() == 7
    assert (landing_confidence(pair, landing(pair, same, walls)) < SURE).sum() == 1


def test_a_hole_among_the_doubtful_is_doubted(pair, same):
    positions = pair.target_shape.positions[pair.target_points.point]
    upper = positions[:, 2] > 0
    lone = upper & (np.arange(len(upper)) % 5 == 0)
    sure = landing_confidence(pair, landing(pair, same, upper & ~lone)) >= SURE
    assert not sure[lone & (positions[:, 2] > 0.15)].any()
    assert sure[positions[:, 2] < -0.15].all()
