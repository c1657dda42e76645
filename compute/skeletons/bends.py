"""Joints along a limb: at necks, at bends of one or more poses, and between them where it is long and straight."""

from dataclasses import dataclass

import numpy as np

from ..surface.mesh import Floats, Ints
from ..surface.ties import first_least

# Points of the middle line of a limb.
N_POINTS = 48
# Rounds of averaging: on coarse meshes slices come in whole rings of triangles, which blurs girths most.
PLACE_ROUNDS, GIRTH_ROUNDS = 3, 8
# What a joint must save of a limb's deviation from its bones: the integral along the limb of the squared distance,
# all lengths in radii of the limb. A bend of 30 degrees in the middle of a limb of ten radii saves 5.5.
BEND = 0.8
# A neck is thinner than this fraction of the limb on either side of it: wrists 0.6, knees 0.95.
NECK = 0.82
# Bones longer than this many radii can be divided.
SLENDER = 7.0
# Bends nearer than this many radii to another joint are not worth a bone.
LEAST_LENGTH = 1.5
# Borders of parts are joints even nearer, but not nearer than this.
SHORTEST = 0.75


@dataclass(frozen=True, eq=False)
class Curve:
    """The middle line of a limb at points evenly spaced along it, in one or more poses.

    Attributes
    ----------
    places : (P, n, 3) float64
        In P poses, the first of which is the given one.
    radius : (n,) float64
    along : (n,) float64
        Length from the start to each point.
    """

    places: Floats
    radius: Floats
    along: Floats


def resampled(places: Floats, radius: Floats) -> tuple[Curve, Floats]:
    """Return a curve through points (P, n, 3), smoothed and evenly spaced, and the length (n,) up to each of them.

    The first and the last point are no slices but the ends of the limb, up to which nothing is smoothed.
    """
    smooth = np.concatenate([places[:, :1], _averaged(places[:, 1:-1], PLACE_ROUNDS), places[:, -1:]], axis=1)
    steps = np.linalg.norm(np.diff(smooth[0], axis=0), axis=1)
    # Equal places would make the length ambiguous.
    length = np.append(0.0, np.cumsum(np.maximum(steps, 1e-9 * max(steps.sum(), np.finfo(float).tiny))))
    along = np.linspace(0, length[-1], N_POINTS)
    curves = [np.stack([np.interp(along, length, column) for column in pose.T], axis=1) for pose in smooth]
    girth = np.interp(along, length, radius)
    return Curve(np.stack(curves), _averaged(girth[None, :, None], GIRTH_ROUNDS)[0, :, 0], along), length


def joints_along(curve: Curve, fixed: Ints, n_pieces: int = 1) -> Ints:
    """Return the points of a curve at which it has joints, both ends among them.

    Parameters
    ----------
    curve : Curve
    fixed : (f,) int64
        Points that are joints in any case, rising, the ends among them.
    n_pieces : int
        Bones that a long straight stretch is divided into.
    """
    joints = fixed
    for joints_within in (_necks, _bends):
        spans = zip(joints[:-1].tolist(), joints[1:].tolist(), strict=True)
        joints = np.unique(np.concatenate([joints, *(joints_within(curve, *span) for span in spans)]))
    joints = _spaced(curve, joints, fixed)
    spans = zip(joints[:-1].tolist(), joints[1:].tolist(), strict=True)
    return np.unique(np.concatenate([joints, *(_pieces(curve, *span, n_pieces) for span in spans)]))


def _averaged(values: Floats, rounds: int) -> Floats:
    """Return values (P, n, d) with the ripples of single slices taken out along n; the ends stay."""
    for _ in range(rounds if values.shape[1] > 2 else 0):
        inner = (values[:, :-2] + 2 * values[:, 1:-1] + values[:, 2:]) / 4
        values = np.concatenate([values[:, :1], inner, values[:, -1:]], axis=1)
    return values


def _necks(curve: Curve, start: int, end: int) -> Ints:
    """Return the thinnest place strictly between two joints, if the limb is thicker on both its sides."""
    radius = curve.radius[start : end + 1]
    before, after = np.maximum.accumulate(radius), np.maximum.accumulate(radius[::-1])[::-1]
    depth = radius / np.minimum(before, after)
    thinnest = int(first_least(depth))
    if not depth[thinnest] < NECK or _is_near(curve, start, start + thinnest, end):
        return np.zeros(0, dtype=np.int64)
    neck = start + thinnest
    return np.concatenate([_necks(curve, start, neck), [neck], _necks(curve, neck, end)]).astype(np.int64)


def _bends(curve: Curve, start: int, end: int) -> Ints:
    """Return the joints between two others that approximate the curve best, each worth its cost."""
    n = end - start + 1
    cost = _deviations(curve, start, end)
    least, before = np.full(n, np.inf), np.zeros(n, dtype=np.int64)
    least[0] = 0.0
    for point in range(1, n):
        total = least[:point] + cost[:point, point] + BEND
        before[point] = first_least(total)
        least[point] = total[before[point]]
    path = [n - 1]
    while path[-1] > 0:
        path.append(int(before[path[-1]]))
    inner = [start + point for point in path[-2:0:-1] if not _is_near(curve, start, start + point, end)]
    return np.array(inner, dtype=np.int64)


def _deviations(curve: Curve, start: int, end: int) -> Floats:
    """Return (n, n) the deviation of the curve from the straight line between any two of its points."""
    places, radius = curve.places[:, start : end + 1], curve.radius[start : end + 1]
    n = places.shape[1]
    # A tip is thin without bending any finer for it.
    radius = np.maximum(radius, np.median(radius) / 2)
    step = curve.along[1] / radius
    chord = places[:, None] - places[:, :, None]
    unit = chord / np.maximum(np.linalg.norm(chord, axis=-1, keepdims=True), np.finfo(float).tiny)
    # Axes: pose, first point, last point, point between.
    across = places[:, None, None, :, :] - places[:, :, None, None, :]
    along = np.einsum("pijkd,pijd->pijk", np.broadcast_to(across, (len(places), n, n, n, 3)), unit)
    square = np.einsum("pikd,pikd->pik", across[:, :, 0], across[:, :, 0])[:, :, None] - along**2
    number = np.arange(n)
    between = (number > number[:, None, None]) & (number < number[:, None])
    total: Floats = np.einsum("pijk,ijk->ij", np.maximum(square, 0), between * (step / radius**2))
    return total


def _pieces(curve: Curve, start: int, end: int, n_pieces: int) -> Ints:
    """Return the joints that divide a straight bone evenly, if it is long; at slight bends if there are any."""
    length = curve.along[end] - curve.along[start]
    if length <= SLENDER * float(np.median(curve.radius[start : end + 1])):
        return np.zeros(0, dtype=np.int64)
    return np.round(np.linspace(start, end, n_pieces + 1)[1:-1]).astype(np.int64)


def _spaced(curve: Curve, joints: Ints, fixed: Ints) -> Ints:
    """Return the joints without those that make bones shorter than the limb is thick; fixed ones stay longest."""
    kept = joints.tolist()
    by_worth = [joint for joint in kept if joint not in fixed] + fixed[1:-1].tolist()
    for joint in by_worth:
        place = kept.index(joint)
        if _is_near(curve, kept[place - 1], joint, kept[place + 1], SHORTEST if joint in fixed else LEAST_LENGTH):
            del kept[place]
    return np.array(kept, dtype=np.int64)


def _is_near(curve: Curve, start: int, point: int, end: int, radii: float = LEAST_LENGTH) -> bool:
    distance = min(curve.along[point] - curve.along[start], curve.along[end] - curve.along[point])
    return bool(distance < radii * curve.radius[point])
