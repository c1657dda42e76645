"""A fixed choice of eigenfunctions where the eigenvalue alone leaves it open: signs, and bases of eigenspaces."""

import numpy as np
from scipy.sparse import csr_array

from ..surface.mesh import Floats

# Eigenvalues closer than this, relatively, count as one: the solver cannot tell their functions apart (its tolerance is
# the same), and rounding mixes them.
DEGENERATE = 1e-6

# A function whose third moment is below this part of the absolute one looks the same with both signs.
SYMMETRIC = 1e-3


def fixed_basis(values: Floats, functions: Floats, mass: csr_array, nodes: Floats) -> Floats:
    """Return eigenfunctions that span the same eigenspaces, chosen by rules that do not depend on the solver.

    The basis of a multiple eigenvalue comes from projecting fixed waves in space. A single function gets the sign that
    makes its third moment positive or, where symmetry makes that zero, the one of such a wave.

    Parameters
    ----------
    values : (k,) float64
        Ascending, in units of 1 / area.
    functions : (N, k) float64
        Orthonormal in ``mass``.
    mass : (N, N) sparse
        In units of the area.
    nodes : (N, 3) float64
        In units of the root of the area.
    """
    weights = mass @ np.ones(len(nodes))
    centred = np.where(weights[:, None] > 0, nodes, 0)
    centred = centred - weights @ centred
    fixed = functions.copy()
    ends = np.append(np.flatnonzero(np.diff(values) > DEGENERATE * values[1:]) + 1, len(values))
    for first, end in zip(np.append(0, ends[:-1]), ends, strict=True):
        alone = _third_moment(functions[:, first], weights) if end - first == 1 else 0
        if alone:
            fixed[:, first] *= np.sign(alone)
        else:
            waves = mass @ _waves(centred, end - first, np.sqrt(values[first]))
            fixed[:, first:end] = functions[:, first:end] @ _towards(functions[:, first:end].T @ waves)
    return fixed


def _waves(nodes: Floats, count: int, frequency: float) -> Floats:
    """Return (N, count) waves that vary about as fast as a function of this frequency, in directions without a plan."""
    random = np.random.default_rng(count)
    directions = random.standard_normal((3, count))
    return np.cos(frequency * nodes @ directions + random.uniform(0, np.pi, count))


def _towards(projections: Floats) -> Floats:
    """Return the rotation whose columns lie along projections, each as far as those before leave it free."""
    rotation, upper = np.linalg.qr(projections)
    return rotation * np.where(np.diag(upper) < 0, -1.0, 1.0)


def _third_moment(function: Floats, weights: Floats) -> float:
    """Return the integral of the cube of a function, 0 where it is as good as zero."""
    cube = function * function * function
    moment = float(weights @ cube)
    return moment if abs(moment) > SYMMETRIC * (weights @ np.abs(cube)) else 0.0
