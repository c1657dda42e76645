"""A chain of rings: a body with as many handles as one likes."""

import numpy as np

from .character import Character, Plan, build
from .rig import Bone, Point, Pose
from .solids import Body, Solid

# Metres: from the middle of a ring to the middle of its tube, the tube, and from ring to ring.
RING_RADIUS, TUBE_RADIUS, SPACING = 0.20, 0.075, 0.43
# Straight pieces of a ring.
PIECES = 32


def handles(genus: int = 2, n_vertices: int = 4000) -> Character:
    """Return ``genus`` rings in a row, each grown together with the next: Euler characteristic 2 - 2 genus.

    Raises
    ------
    ValueError
        If the genus is below 1.
    """
    if genus < 1:
        raise ValueError("A body with handles has at least one.")
    return build(_plan(genus), n_vertices)


def _plan(genus: int) -> Plan:
    centres = SPACING * (np.arange(genus) - 0.5 * (genus - 1))
    names = [f"ring_{i + 1}" for i in range(genus)]
    bones = tuple(
        Bone(name, parent, (float(x) - 0.5 * SPACING, 0.0, 0.0), (float(x) + 0.5 * SPACING, 0.0, 0.0))
        for name, parent, x in zip(names, [None, *names], centres, strict=False)
    )
    solids = tuple(solid for name, x in zip(names, centres, strict=True) for solid in _ring(name, float(x)))
    own_part = {name: name for name in names}
    return Plan("handles", bones, Body(solids, symmetric=False), _poses(names), own_part, own_part, genus=genus)


def _ring(bone: str, x: float) -> list[Solid]:
    """Return the pieces of a ring in the plane y = 0; the first one is blended with the ring before."""
    angle = 2.0 * np.pi * (np.arange(PIECES + 1) + 0.5) / PIECES + np.pi
    points: list[Point] = [(x + RING_RADIUS * float(np.cos(a)), 0.0, RING_RADIUS * float(np.sin(a))) for a in angle]
    radii = (TUBE_RADIUS, TUBE_RADIUS)
    return [Solid(bone, points[i], points[i + 1], radii, blend=0.004) for i in range(PIECES)]


def _poses(names: list[str]) -> dict[str, Pose]:
    """Return rest, and the chain bent and twisted by as much at each joint."""
    return {
        "rest": Pose(),
        "bent": Pose({name: (0.0, 0.0, 30.0) for name in names[1:]}),
        "twisted": Pose({name: (25.0, 0.0, 0.0) for name in names[1:]}),
    }
