"""Bones, poses and the motion they give: forward kinematics of a tree of joints."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Floats = NDArray[np.float64]
Point = tuple[float, float, float]


@dataclass(frozen=True)
class Bone:
    """A straight bone at rest, in metres; z is up and the character looks along -y, its left side towards +x.

    Attributes
    ----------
    name : str
        Ends in ``.L`` or ``.R`` for a bone that has a mirror image.
    parent : str or None
        The bone that carries this one; None for the root.
    head, tail : (3,) float
        The joint it turns about, and its far end.
    """

    name: str
    parent: str | None
    head: Point
    tail: Point


@dataclass(frozen=True)
class Pose:
    """How far each bone is turned from rest.

    Attributes
    ----------
    angles : mapping of bone name to (3,) float
        Degrees about the x, y and z axis of the character at rest, through the bone's head: first about z, then y, then
        x, then moved with the parent. Bones that are not named stay as they are.
    shift : (3,) float
        How far the whole character is moved, in metres.
    """

    angles: Mapping[str, Point] = field(default_factory=dict)
    shift: Point = (0.0, 0.0, 0.0)


def mirrored_name(name: str) -> str:
    """Return the name of the same thing on the other side; a name without a side is its own mirror image."""
    other = {".L": ".R", ".R": ".L"}.get(name[-2:])
    return name[:-2] + other if other else name


def mirrored_point(point: Point) -> Point:
    """Return a point reflected in the plane x = 0."""
    return (-point[0], point[1], point[2])


def with_mirrored_bones(bones: tuple[Bone, ...]) -> tuple[Bone, ...]:
    """Return the bones and, for each that ends in ``.L``, its mirror image."""
    right = (
        Bone(
            mirrored_name(bone.name),
            mirrored_name(bone.parent) if bone.parent else None,
            mirrored_point(bone.head),
            mirrored_point(bone.tail),
        )
        for bone in bones
        if bone.name.endswith(".L")
    )
    return (*bones, *right)


def both_sides(angles: Mapping[str, Point]) -> dict[str, Point]:
    """Return the angles of the left bones and the mirrored ones for the right bones."""
    right = {mirrored_name(name): (x, -y, -z) for name, (x, y, z) in angles.items()}
    return {**right, **angles}


def bone_motions(bones: tuple[Bone, ...], pose: Pose) -> Floats:
    """Return the rigid motion of each bone from rest to a pose.

    Parameters
    ----------
    bones : tuple of B Bone
        Parents before their children.
    pose : Pose

    Returns
    -------
    (B, 4, 4) float64
        Homogeneous matrices that act on columns of rest positions.
    """
    index = {bone.name: i for i, bone in enumerate(bones)}
    motions = np.empty((len(bones), 4, 4))
    for i, bone in enumerate(bones):
        own = rotation_about(bone.head, pose.angles.get(bone.name, (0.0, 0.0, 0.0)))
        carrier = motions[index[bone.parent]] if bone.parent else translation(pose.shift)
        motions[i] = carrier @ own
    return motions


def rotation_about(point: Point, degrees: Point) -> Floats:
    """Return the (4, 4) rotation through a point by angles about the fixed axes, z first and x last."""
    motion = np.eye(4)
    motion[:3, :3] = Rotation.from_euler("zyx", degrees[::-1], degrees=True).as_matrix()
    motion[:3, 3] = np.asarray(point) - motion[:3, :3] @ np.asarray(point)
    return motion


def translation(shift: Point) -> Floats:
    """Return the (4, 4) matrix that moves by ``shift``."""
    motion = np.eye(4)
    motion[:3, 3] = shift
    return motion
