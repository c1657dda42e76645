"""Limbs: chains of slices laid into space, with joints where they begin, bend and end."""

from dataclasses import dataclass, replace

import numpy as np

from ..surface.mesh import Floats, Ints
from ..surface.ties import CHOICE, first_largest
from .bends import Curve, joints_along, resampled
from .branching import Chain
from .slices import Slices

# A limb whose first ring lies nearer to the hub than this many of its radii begins in the hub itself.
ROOTED = 0.9
# A limb turns about a point this many of its radii deeper than where it comes free of the body, as shoulders, hips and
# knuckles do.
DEPTH = 0.75
# But no deeper than this fraction of the way to the joint before it.
MOST_OF_WAY = 0.7


@dataclass(frozen=True, eq=False)
class Limb:
    """A row of n bones from a hub to a tip or to another hub.

    Attributes
    ----------
    start, end : int
        Hubs; the end is -1 for a tip.
    joints : (n, 3) float64
        The ends of the bones, the first hub left out.
    radius, part : (n,)
        Of each bone's end, and the part each bone lies in.
    slices : (s,) int64
        Of the chain, in their order.
    bone_of_slice : (s,) int64
        The bone that each slice lies around.
    """

    start: int
    end: int
    joints: Floats
    radius: Floats
    part: Ints
    slices: Ints
    bone_of_slice: Ints


@dataclass(frozen=True, eq=False)
class Ends:
    """The two ends of a chain.

    Attributes
    ----------
    start, end : int
        Numbers of hubs; the end is -1 for a tip.
    places : (P, 2, 3) float64
        In each pose.
    parts : (2,) tuple of int
        Of the hubs; -1 for a tip.
    """

    start: int
    end: int
    places: Floats
    parts: tuple[int, int]


@dataclass(frozen=True, eq=False)
class Trace:
    """The middle line of a chain with the joints on it.

    Attributes
    ----------
    chain : Chain
    ends : Ends
    curve : Curve
    joints : (n + 1,) int64
        Points of the curve, both ends among them.
    has_carrier : bool
        Whether its first bone lies in the hub's part and carries the limb.
    point_of_slice : (s,) int64
        The point of the curve that each slice lies at.
    borders : (b,) int64
        Points at which the chain comes free of a hub or passes into another part.
    parts : (n,) int64, optional
        The part each bone lies in, if that is settled.
    """

    chain: Chain
    ends: Ends
    curve: Curve
    joints: Ints
    has_carrier: bool
    point_of_slice: Ints
    borders: Ints
    parts: Ints | None = None


def trace_limb(chain: Chain, ends: Ends, slices: Slices, centres: Floats, n_pieces: int) -> Trace:
    """Return the middle line of a chain with the joints on it.

    Parameters
    ----------
    chain : Chain
    ends : Ends
    slices : Slices
    centres : (P, S, 3) float64
        Of the slices in each pose.
    n_pieces : int
        Bones that a long straight stretch is divided into.
    """
    radius = slices.radius[chain.slices]
    places = np.concatenate([ends.places[:, :1], centres[:, chain.slices], ends.places[:, 1:]], axis=1)
    curve, length = resampled(places, np.concatenate([radius[:1], radius, radius[-1:]]))
    last = len(curve.along) - 1
    point = np.minimum(np.searchsorted(curve.along, (1 - CHOICE) * length), last)
    borders = _borders(chain, ends, slices, places, radius)
    at_borders = np.setdiff1d(point[borders], [0, last])
    joints = joints_along(curve, np.concatenate([[0], at_borders, [last]]), n_pieces)
    return Trace(
        chain=chain,
        ends=ends,
        curve=curve,
        joints=joints,
        has_carrier=bool((borders == 1).any()),
        point_of_slice=point[1:-1],
        borders=at_borders,
    )


def with_equal_joints(traces: list[Trace], slices: Slices, partner: Ints) -> list[Trace]:
    """Return the traces, those of limbs that are mirror images of each other with joints at the same places."""
    of_part = {int(slices.part[trace.chain.slices[-1]]): trace for trace in traces if trace.ends.end < 0}
    equal = {}
    for part, trace in of_part.items():
        other = of_part.get(int(partner[part])) if part < len(partner) else None
        if other is not None and other is not trace:
            joints = _agreed(*sorted([trace.joints, other.joints], key=lambda joints: (len(joints), *joints)))
            equal[trace] = replace(trace, joints=joints, has_carrier=trace.has_carrier or other.has_carrier)
    return [equal.get(trace, trace) for trace in traces]


def _agreed(fewer: Ints, more: Ints) -> Ints:
    """Return the mean of two rows of joints, or the longer one."""
    return more if len(fewer) < len(more) else np.unique((fewer + more + 1) // 2)


def lay_limb(trace: Trace, slices: Slices) -> Limb:
    """Return the bones along a chain."""
    chain, ends, curve, joints = trace.chain, trace.ends, trace.curve, trace.joints
    bone = np.searchsorted(joints[1:-1], trace.point_of_slice, side="right")
    part = trace.parts
    if part is None:
        part = _main_parts(bone, slices.part[chain.slices], slices.length[chain.slices], len(joints) - 1, ends)
        part[0] = ends.parts[0] if trace.has_carrier else part[0]
    places = curve.places[0, joints].copy()
    for first in (np.flatnonzero(part[1:] != part[:-1]) + 1).tolist():
        if part[first - 1] == ends.parts[0]:
            places[first] = _deeper(curve, *joints[first - 1 : first + 2].tolist())
    return Limb(
        start=ends.start,
        end=ends.end,
        joints=places[1:],
        radius=curve.radius[joints[1:]],
        part=part,
        slices=chain.slices,
        bone_of_slice=bone,
    )


def _deeper(curve: Curve, before: int, joint: int, following: int) -> Floats:
    """Return the place about which a limb turns that leaves its hub's part at a joint: deeper, along its axis."""
    place = curve.places[0, joint]
    # The axis of the limb shows a little further out, where nothing of the body is left.
    beyond = np.searchsorted(curve.along, curve.along[joint] + 2 * curve.radius[joint])
    axis = curve.places[0, min(int(beyond), following)] - place
    depth = min(DEPTH * float(curve.radius[joint]), MOST_OF_WAY * _gap(curve.places[0, before], place))
    return place - depth * axis / max(float(np.linalg.norm(axis)), np.finfo(float).tiny)


def _borders(chain: Chain, ends: Ends, slices: Slices, places: Floats, radius: Floats) -> Ints:
    """Return the points, counted from the start of the chain, at which it passes into another part."""
    part = slices.part[chain.slices]
    changes = np.flatnonzero(np.diff(part)) + 2
    borders = [int(change) for change in changes]
    is_limb = ends.end < 0 or part[0] != ends.parts[0]
    if is_limb and np.linalg.norm(places[0, 1] - places[0, 0]) > ROOTED * radius[0]:
        borders.append(1)
    if ends.end >= 0 and part[-1] != ends.parts[1] and _gap(places[0, -1], places[0, -2]) > ROOTED * radius[-1]:
        borders.append(len(part))
    return np.array(sorted(borders), dtype=np.int64)


def _gap(first: Floats, second: Floats) -> float:
    return float(np.linalg.norm(second - first))


def _main_parts(bone: Ints, part: Ints, length: Floats, n_bones: int, ends: Ends) -> Ints:
    """Return the part that most of each bone's slices are in; bones without slices lie in the hub next to them."""
    n_parts = int(part.max()) + 1
    shares = np.bincount(bone * n_parts + part, length, n_bones * n_parts).reshape(n_bones, n_parts)
    main = first_largest(shares)
    empty = np.flatnonzero(shares.sum(axis=1) == 0)
    main[empty] = np.where(empty < np.min(bone), ends.parts[0], ends.parts[1])
    return main
