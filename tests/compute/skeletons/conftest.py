"""Characters with their rigs, analyzed once."""

import numpy as np
import pytest

from compute import TriangleMesh, analyze
from examples import humanoid, octopus


@pytest.fixture(scope="session")
def human():
    return humanoid(6000)


@pytest.fixture(scope="session")
def human_analysis(human):
    return analyze(TriangleMesh(human.vertices, human.triangles), order=2)


@pytest.fixture(scope="session")
def kraken():
    return octopus(5000)


@pytest.fixture(scope="session")
def kraken_analysis(kraken):
    return analyze(TriangleMesh(kraken.vertices, kraken.triangles), order=1)


@pytest.fixture(params=["human", "kraken"])
def rigged(request):
    """A character and its analysis."""
    return request.getfixturevalue(request.param), request.getfixturevalue(f"{request.param}_analysis")


def winding_numbers(points, mesh):
    """Return how often a closed mesh winds around each point: 1 inside, 0 outside (van Oosterom and Strackee 1983)."""
    a, b, c = (mesh.vertices[mesh.triangles[:, k]][None] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(side, axis=2) for side in (a, b, c))
    volume = np.einsum("ptj,ptj->pt", a, np.cross(b, c))
    dot = [np.einsum("ptj,ptj->pt", *pair) for pair in ((a, b), (b, c), (c, a))]
    angle = 2 * np.arctan2(volume, la * lb * lc + dot[0] * lc + dot[1] * la + dot[2] * lb)
    return angle.sum(axis=1) / (4 * np.pi)


def leaves(skeleton):
    """Return the joints at which no bone begins."""
    return np.setdiff1d(np.arange(1, len(skeleton.joints)), skeleton.parent)
