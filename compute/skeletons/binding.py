"""Weights that bind a mesh to its bones: the bones' own regions, softened over about the thickness of the limb."""

import numpy as np
from scipy.sparse import coo_array, csc_array, diags_array
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from ..analysis.analysis import Analysis
from ..errors import FieldError
from ..memory import require_memory, told_if_full
from ..surface.mesh import Floats, Ints, TriangleMesh
from ..surface.ties import ROUNDING
from .embedding import Skeleton

# Width of the passage from bone to bone in radii of the limb; it is also kept shorter than the bone.
SOFTNESS = 0.6
# Two implicit steps of diffusion: one leaves long tails, many cost time.
STEPS = 2
# Bones that move a vertex, at the most, as game engines want it, and the least weight that is kept.
MOST_BONES = 4
LEAST_WEIGHT = 0.01
# Triangles flatter than this fraction of the mean area count as if they had it.
LEAST_AREA = 1e-4
# Peak memory for each vertex, and for each of its weights (docs/method.md).
BYTES_PER_VERTEX = 2500
BYTES_PER_WEIGHT = 64
TOO_LARGE = (
    "Weights of {:,} bones for {:,} vertices take about {} of memory, and {} are free; decimate the mesh or close other"
    " programs."
)


@told_if_full
def binding_weights(analysis: Analysis, skeleton: Skeleton, *, softness: float = SOFTNESS) -> Floats:
    """Return the weight with which each bone moves each vertex.

    Parameters
    ----------
    analysis : Analysis
    skeleton : Skeleton
        Of this analysis.
    softness : float
        Width over which weights pass from one bone to the next, in radii of the limb.

    Returns
    -------
    (V, J) float64
        The column of each bone is that of the joint it ends in; the root's is 0. Every row sums to one, with at most
        four bones.

    References
    ----------
    .. [1] Baran, Popović, "Automatic Rigging and Animation of 3D Characters", SIGGRAPH 2007: weights by diffusion.

    Examples
    --------
    >>> import numpy as np
    >>> from compute import TriangleMesh, analyze, binding_weights, skeleton
    >>> height, angle = np.mgrid[-3:3:13j, 0 : 2 * np.pi : 8j][:, :, :-1].reshape(2, -1)
    >>> k, right = np.arange(84), np.arange(84).reshape(12, 7)[:, [1, 2, 3, 4, 5, 6, 0]].ravel()
    >>> triangles = np.concatenate([np.stack([k, right, right + 7], 1), np.stack([k, right + 7, k + 7], 1)])
    >>> girth = np.sqrt(9 - height**2) / 3
    >>> spindle = TriangleMesh(np.stack([girth * np.cos(angle), girth * np.sin(angle), height], 1), triangles)
    >>> analysis = analyze(spindle, field=1)
    >>> halves = (height[triangles].mean(axis=1) > 0).astype(np.int32)
    >>> weights = binding_weights(analysis, skeleton(analysis, labels=halves))
    >>> weights.shape, bool(np.allclose(weights.sum(axis=1), 1))
    ((91, 3), True)
    """
    if not (np.isfinite(softness) and softness >= 0):
        raise FieldError(f"The softness of weights is a finite number, zero or more, not {softness}.")
    n_bones, n_vertices = len(skeleton.joints) - 1, len(analysis.mesh.vertices)
    require_memory(n_vertices * (BYTES_PER_VERTEX + BYTES_PER_WEIGHT * n_bones), TOO_LARGE, n_bones, n_vertices)
    surface = analysis.surface.mesh
    used, triangles = np.unique(surface.triangles, return_inverse=True)
    mesh = TriangleMesh(surface.vertices[used], triangles.reshape(-1, 3))
    owner = skeleton.bone_of_vertex[used]
    width = softness * _widths(skeleton)[owner]
    hard = (owner[:, None] == np.arange(len(skeleton.joints))).astype(np.float64)
    weights = _few(diffused(mesh, hard, width))
    return weights[_place_of_input(analysis, used)]


def _widths(skeleton: Skeleton) -> Floats:
    """Return (J,) the radius of each bone's limb, or a third of its length where that is less."""
    start = np.maximum(skeleton.parent, 0)
    length = np.linalg.norm(skeleton.joints - skeleton.joints[start], axis=1)
    return np.minimum(np.minimum(skeleton.radius, skeleton.radius[start]), np.where(length > 0, length / 3, np.inf))


def diffused(mesh: TriangleMesh, values: Floats, width: Floats) -> Floats:
    """Return values (V, n) after heat has spread by a width (V,) that changes over the surface; constants stay."""
    conductivity = (width**2)[mesh.triangles].mean(axis=1) / STEPS
    system, mass = _system(mesh, conductivity)
    factor = splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True})
    for _ in range(STEPS):
        values = factor.solve(mass[:, None] * values)
    return values


def _system(mesh: TriangleMesh, conductivity: Floats) -> tuple[csc_array, Floats]:
    """Return mass + stiffness of linear elements (V, V), with a conductivity for each triangle, and the mass (V,)."""
    corners = mesh.vertices[mesh.triangles]
    opposite = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    area = np.maximum(mesh.areas, LEAST_AREA * mesh.areas.mean())
    local = np.einsum("tik,tjk->tij", opposite, opposite) * (conductivity / (4 * area))[:, None, None]
    rows, columns = np.repeat(mesh.triangles, 3, axis=1), np.tile(mesh.triangles, (1, 3))
    n = len(mesh.vertices)
    mass: Floats = np.bincount(mesh.triangles.ravel(), np.repeat(area / 3, 3), n).astype(np.float64)
    stiffness = coo_array((local.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n))
    return csc_array(stiffness.tocsc() + diags_array(mass)), mass


def _few(weights: Floats) -> Floats:
    """Return the largest weights of each row only, as shares of their sum."""
    if weights.shape[1] > MOST_BONES:
        least = np.partition(weights, -MOST_BONES, axis=1)[:, -MOST_BONES, None]
        is_larger = weights > least + ROUNDING
        is_tied = ~is_larger & (weights >= least - ROUNDING)
        n_left = MOST_BONES - is_larger.sum(axis=1, keepdims=True)
        weights = np.where(is_larger | (is_tied & (is_tied.cumsum(axis=1) <= n_left)), weights, 0.0)
    weights = np.where(weights < LEAST_WEIGHT, 0.0, weights)
    return weights / weights.sum(axis=1, keepdims=True)


def _place_of_input(analysis: Analysis, used: Ints) -> Ints:
    """Return (V,) for each vertex of the input its place among the used ones, the nearest for what is loose."""
    vertices = analysis.mesh.vertices
    place = np.full(len(vertices), -1)
    place[used] = np.arange(len(used))
    place = place[analysis.surface.vertex_of_input]
    loose = np.flatnonzero(place < 0)
    if len(loose):
        place[loose] = cKDTree(vertices[used]).query(vertices[loose])[1]
    return place
