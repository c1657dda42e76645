"""Which part is the mirror image of which: by reflection where a shape is symmetric in space, else by matching."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..analysis import Analysis
from ..progress import Progress, silent
from ..registration.dense.point_map import point_map
from ..registration.eigenfunctions.matching import match
from ..registration.eigenfunctions.spectral_shape import spectral_shape
from ..surface.mesh import Floats, Ints
from ..surface.ties import first_largest
from .embedding import Skeleton

# A reflected shape lies on itself if its points are this near to others, in units of the root of the area.
SAME_PLACE = 0.01
# Two parts are mirror images if each lands on the other with at least this share of its area.
LEAST_SHARE = 0.6
# A matching of this confidence is likely right.
SURE = 0.5
# Left and right are told by x if the way across has at least this share of it.
LEAST_ALONG_X = 0.3
REFLECTIONS = np.array([[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]])


def mirror_parts(analysis: Analysis, labels: NDArray[np.int32], *, progress: Progress = silent) -> Ints | None:
    """Return (P,) for each label the part that is its mirror image, itself for what lies in the middle.

    A shape that is symmetric across x, y or z is reflected; any other pose is matched with its own mirror image.

    Parameters
    ----------
    analysis : Analysis
    labels : (T,) int32
        Part of each triangle of the input.
    progress : Progress
        Told before each step; may raise `Cancelled`.

    Returns
    -------
    (P,) int64 or None
        None where the shape has no mirror symmetry that is sure.
    """
    progress(0.0, "Looking for symmetry")
    landing = _reflected(analysis)
    if landing is None:
        progress(0.2, "Matching the shape with its mirror image")
        landing = _matched(analysis)
    return None if landing is None else _partners(*landing, labels)


def sides(skeleton: Skeleton, partner: Ints) -> Ints:
    """Return (P,) for each label +1 for left, -1 for right and 0 for what has no side.

    Left is towards +x, as of a character that looks along -y; where the sides lie across x, towards +y or +z.
    """
    side = np.zeros(len(partner), dtype=np.int64)
    starts = {part: start for part in range(len(partner)) if (start := _start_of(skeleton, part)) is not None}
    pairs = [(p, q) for p, q in enumerate(partner.tolist()) if p < q and p in starts and q in starts]
    if not pairs:
        return side
    across = np.array([starts[p] - starts[q] for p, q in pairs])
    _, _, axes = np.linalg.svd(across, full_matrices=False)
    axis = axes[0]
    leading = 0 if abs(axis[0]) >= LEAST_ALONG_X else int(np.abs(axis).argmax())
    is_left = across @ axis * np.sign(axis[leading]) > 0
    for (p, q), left in zip(pairs, is_left.tolist(), strict=True):
        side[p], side[q] = (1, -1) if left else (-1, 1)
    return side


def _start_of(skeleton: Skeleton, part: int) -> Floats | None:
    """Return where the first bone of a part begins."""
    bones = np.flatnonzero(skeleton.part[1:] == part) + 1
    return skeleton.joints[skeleton.parent[bones[0]]] if len(bones) else None


def _reflected(analysis: Analysis) -> tuple[Ints, Ints, Ints] | None:
    """Return the landing of a shape that lies on its own reflection; None if it does not."""
    mesh = analysis.surface.mesh
    used, corners = np.unique(mesh.triangles, return_inverse=True)
    corners = corners.reshape(-1, 3)
    points = mesh.vertices[used]
    weight = np.bincount(corners.ravel(), np.repeat(mesh.areas, 3), len(used))
    centred = points - np.average(points, axis=0, weights=weight)
    tree = cKDTree(centred)
    for reflection in REFLECTIONS:
        distance, landing = tree.query(centred * reflection)
        if np.average(distance, weights=weight) < SAME_PLACE * np.sqrt(mesh.areas.sum()):
            return landing, corners, analysis.surface.input_triangle
    return None


def _matched(analysis: Analysis) -> tuple[Ints, Ints, Ints] | None:
    """Return the landing of a shape by matching with its mirror image; None if that is not sure."""
    shape = spectral_shape(analysis.matching_basis)
    matching = match(analysis, analysis, mirrored=True)
    if matching.confidence < SURE:
        return None
    landing = point_map(shape.mirrored(), shape, matching)
    return landing, shape.triangles, shape.input_triangle


def _partners(landing: Ints, corners: Ints, input_triangle: Ints, labels: NDArray[np.int32]) -> Ints:
    """Return the part that most of each part lands on, if that is mutual.

    Parameters
    ----------
    landing : (n,) int64
        The point that each point lands on.
    corners : (m, 3) int64
        Triangles over these points.
    input_triangle : (m,) int64
        The triangle of the input that each lies in.
    labels : (T,) int32
    """
    n_labels = int(labels.max()) + 1
    label = labels[input_triangle].astype(np.int64)
    of_point = np.zeros(len(landing), dtype=np.int64)
    of_point[corners.ravel()] = np.repeat(label, 3)
    votes = np.bincount(np.repeat(label, 3) * n_labels + of_point[landing[corners.ravel()]], minlength=n_labels**2)
    share = votes.reshape(n_labels, n_labels) / np.maximum(np.bincount(label, minlength=n_labels) * 3, 1)[:, None]
    best = first_largest(share)
    number = np.arange(n_labels)
    is_mutual = (best[best] == number) & (share[number, best] >= LEAST_SHARE)
    return np.where(is_mutual, best, number)
