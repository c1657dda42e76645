"""Skinning weights by diffusion on the surface, and linear blend skinning."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import splu

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Width of the passage between two bones, in radii of the limb.
SOFTNESS = 0.5
# Two implicit steps: one leaves long tails, many cost time.
STEPS = 2
# Influences below this are dropped, as exporters and artists do.
LEAST_WEIGHT = 0.01


def diffused_weights(vertices: Floats, triangles: Ints, bone_of_vertex: Ints, n_bones: int, radius: Floats) -> Floats:
    """Return weights that pass smoothly from bone to bone.

    The indicator of each bone's own vertices is diffused on the surface over a distance in proportion to the
    thickness of the limb, so weights sum to one and never jump across a gap, as between two fingers.

    Parameters
    ----------
    vertices : (V, 3) float64
    triangles : (T, 3) int
    bone_of_vertex : (V,) int
    n_bones : int
    radius : (V,) float64
        Thickness of the limb at each vertex.

    Returns
    -------
    (V, B) float64
    """
    width = SOFTNESS * _smoothed(vertices, triangles, radius)
    stiffness, mass = _stiffness_and_mass(vertices, triangles, (width**2)[triangles].mean(axis=1))
    factor = splu((mass + stiffness / STEPS).tocsc())
    weights = np.eye(n_bones)[bone_of_vertex]
    for _ in range(STEPS):
        weights = factor.solve(np.ascontiguousarray(mass @ weights))
    weights[weights < LEAST_WEIGHT] = 0.0
    return weights / weights.sum(axis=1, keepdims=True)


def blend_skinning(vertices: Floats, weights: Floats, motions: Floats) -> Floats:
    """Return the vertices moved by the weighted mean of the bones' motions.

    Parameters
    ----------
    vertices : (V, 3) float64
    weights : (V, B) float64
    motions : (B, 4, 4) float64

    Returns
    -------
    (V, 3) float64
    """
    blended = (weights @ motions[:, :3].reshape(len(motions), 12)).reshape(-1, 3, 4)
    return np.einsum("vij,vj->vi", blended[:, :, :3], vertices) + blended[:, :, 3]


def _smoothed(vertices: Floats, triangles: Ints, values: Floats) -> Floats:
    """Return values diffused over about their own size, so that the width of passages has no jumps."""
    stiffness, mass = _stiffness_and_mass(vertices, triangles, (values**2)[triangles].mean(axis=1))
    return splu((mass + stiffness).tocsc()).solve(mass @ values)


def _stiffness_and_mass(vertices: Floats, triangles: Ints, conductivity: Floats) -> tuple[csc_array, csc_array]:
    """Return the stiffness and the lumped mass matrix of linear elements, (V, V) each."""
    corners = vertices[triangles]
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    double_area = np.linalg.norm(np.cross(opposite[:, 0], opposite[:, 1]), axis=1)
    local = np.einsum("tik,tjk->tij", opposite, opposite) * (0.5 * conductivity / double_area)[:, None, None]
    rows, columns = np.repeat(triangles, 3, axis=1), np.tile(triangles, (1, 3))
    shape = (len(vertices), len(vertices))
    stiffness = coo_array((local.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsc()
    lumped = np.bincount(triangles.ravel(), np.repeat(double_area / 6.0, 3), len(vertices))
    return stiffness, csc_array(diags_array(lumped))
