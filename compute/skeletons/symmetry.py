"""Parts that are mirror images of each other: by reflection where a shape is symmetric in space, else by matching."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..analysis.analysis import Analysis
from ..memory import told_if_full
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
# Left and right are along x if the direction across has at least this share of it.
LEAST_ALONG_X = 0.3
REFLECTIONS = np.array([[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]])


@dataclass(frozen=True, eq=False)
class Reflection:
    """A map of a surface of n points onto itself that swaps its sides.

    Attributes
    ----------
    image : (n,) int64
        The point that each point goes to.
    triangles : (m, 3) int64
        Over these points.
    input_triangle : (m,) int64
        The triangle of the input that each of them lies in.
    """

    image: Ints
    triangles: Ints
    input_triangle: Ints


@told_if_full
def mirror_parts(analysis: Analysis, labels: NDArray[np.int32], *, progress: Progress = silent) -> Ints | None:
    """Return (P,) for each label the part that is its mirror image, itself for what lies in the middle.

    A shape that is symmetric across x, y or z is reflected; any other pose is matched with its own mirror image.

    Parameters
    ----------
    analysis : Analysis
    labels : (T,) int32
        Part of each triangle of the input.
    progress : Progress
        Called before each step; may raise `Cancelled`.

    Returns
    -------
    (P,) int64 or None
        None where the shape has no mirror symmetry that is sure.

    Raises
    ------
    RegistrationError
        If the shape is not symmetric in space and was analyzed shell by shell.

    References
    ----------
    .. [1] Ovsjanikov, Sun, Guibas, "Global Intrinsic Symmetries of Shapes", SGP 2008.

    Examples
    --------
    >>> import numpy as np
    >>> from compute import TriangleMesh, analyze, mirror_parts
    >>> height, angle = np.mgrid[-3:3:13j, 0 : 2 * np.pi : 8j][:, :, :-1].reshape(2, -1)
    >>> k, right = np.arange(84), np.arange(84).reshape(12, 7)[:, [1, 2, 3, 4, 5, 6, 0]].ravel()
    >>> triangles = np.concatenate([np.stack([k, right, right + 7], 1), np.stack([k, right + 7, k + 7], 1)])
    >>> girth = np.sqrt(9 - height**2) / 3
    >>> spindle = TriangleMesh(np.stack([girth * np.cos(angle), girth * np.sin(angle), height], 1), triangles)
    >>> analysis = analyze(spindle, field=1)
    >>> sides = (np.sin(angle)[triangles].mean(axis=1) > 0).astype(np.int32)
    >>> mirror_parts(analysis, sides).tolist()
    [1, 0]
    """
    labels = analysis.exact_labels(labels)
    progress(0.0, "Looking for symmetry")
    reflection = _reflected(analysis)
    if reflection is None:
        progress(0.2, "Matching the shape with its mirror image")
        reflection = _matched(analysis)
    return None if reflection is None else _partners(reflection, labels)


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


def _reflected(analysis: Analysis) -> Reflection | None:
    """Return the reflection of a shape onto itself; None if it does not lie on its reflection."""
    mesh = analysis.surface.mesh
    used, corners = np.unique(mesh.triangles, return_inverse=True)
    corners = corners.reshape(-1, 3)
    points = mesh.vertices[used]
    weight = np.bincount(corners.ravel(), np.repeat(mesh.areas, 3), len(used))
    centred = points - np.average(points, axis=0, weights=weight)
    tree = cKDTree(centred)
    for axes in REFLECTIONS:
        distance, image = tree.query(centred * axes)
        if np.average(distance, weights=weight) < SAME_PLACE * np.sqrt(mesh.areas.sum()):
            return Reflection(image, corners, analysis.surface.input_triangle)
    return None


def _matched(analysis: Analysis) -> Reflection | None:
    """Return the reflection of a shape onto itself by matching with its mirror image; None if that is not sure."""
    shape = spectral_shape(analysis.matching_basis)
    matching = match(analysis, analysis, mirrored=True)
    if not matching.is_sure:
        return None
    image = point_map(shape.mirrored(), shape, matching)
    return Reflection(image, shape.triangles, shape.input_triangle)


def _partners(reflection: Reflection, labels: NDArray[np.int32]) -> Ints:
    """Return (P,) the part to which most of each part is reflected, if that is mutual."""
    n_labels = int(labels.max()) + 1
    label = labels[reflection.input_triangle].astype(np.int64)
    corners = reflection.triangles.ravel()
    of_point = np.zeros(len(reflection.image), dtype=np.int64)
    of_point[corners] = np.repeat(label, 3)
    votes = np.bincount(np.repeat(label, 3) * n_labels + of_point[reflection.image[corners]], minlength=n_labels**2)
    share = votes.reshape(n_labels, n_labels) / np.maximum(np.bincount(label, minlength=n_labels) * 3, 1)[:, None]
    best = first_largest(share)
    number = np.arange(n_labels)
    is_mutual = (best[best] == number) & (share[number, best] >= LEAST_SHARE)
    return np.where(is_mutual, best, number)
