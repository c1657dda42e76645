"""An octopus with a bulbous mantle, a head with two eyes and eight tapering arms."""

import numpy as np
from numpy.typing import NDArray

from .character import Character, Plan, build
from .rig import Bone, Point, Pose, both_sides, with_mirrored_bones
from .solids import Body, Solid, with_mirrored_solids

Floats = NDArray[np.float64]

# Arms are counted from the front; degrees from the front towards the left.
ARM_DIRECTIONS = {"arm_1": 22.0, "arm_2": 67.0, "arm_3": 113.0, "arm_4": 158.0}
BONES_OF_ARM = 8
# Length and thickness at the root and at the tip, in metres.
ARM_LENGTH, ARM_ROOT, ARM_TIP = 1.20, 0.098, 0.024
ROOT_DISTANCE, ROOT_HEIGHT = 0.17, 0.256

BODY_BONES = (
    Bone("head", None, (0.0, 0.0, 0.20), (0.0, 0.02, 0.48)),
    Bone("mantle", "head", (0.0, 0.02, 0.48), (0.0, 0.25, 1.05)),
)
BODY = (
    Solid("head", (0.0, 0.0, 0.325), (0.0, 0.015, 0.43), (0.155, 0.135), blend=0.05),
    Solid("head", (0.088, -0.075, 0.475), (0.095, -0.090, 0.490), (0.066, 0.062), blend=0.04),
    Solid("head", (0.118, -0.122, 0.498), (0.118, -0.122, 0.498), (0.040, 0.040), blend=0.006),
    Solid("mantle", (0.0, 0.120, 0.74), (0.0, 0.215, 0.87), (0.235, 0.205), (1.03, 1.0, 1.0), blend=0.10),
)


def octopus(n_vertices: int = 8000) -> Character:
    """Return an octopus with about ``n_vertices`` vertices, at least 4000.

    Raises
    ------
    ValueError
        If that is too few for the tips of the arms.
    """
    return build(_plan(), n_vertices)


def _plan() -> Plan:
    arms = {name: _arm_joints(direction) for name, direction in ARM_DIRECTIONS.items()}
    bones = with_mirrored_bones((*BODY_BONES, *(bone for arm in arms.items() for bone in _arm_bones(*arm))))
    solids = with_mirrored_solids((*BODY, *(solid for arm in arms.items() for solid in _arm_solids(*arm))))
    return Plan(
        name="octopus",
        bones=bones,
        body=Body(solids),
        poses=POSES,
        part_of_bone={bone.name: _part(bone.name) for bone in bones},
        fine_part_of_bone={bone.name: bone.name if bone.name == "mantle" else _part(bone.name) for bone in bones},
    )


def _part(bone: str) -> str:
    """Return head (with the mantle) or the arm."""
    return bone[:5] + bone[-2:] if bone.startswith("arm") else "head"


def _arm_joints(direction: float) -> Floats:
    """(9, 3) joints of an arm that falls to the ground, runs along it and lifts its tip."""
    along = np.linspace(0.0, 1.0, BONES_OF_ARM + 1)
    slope = np.radians(np.interp(along[:-1], [0.0, 0.25, 0.5, 0.75, 1.0], [-26.0, -18.0, -4.0, 16.0, 50.0]))
    steps = ARM_LENGTH / BONES_OF_ARM * np.column_stack([np.cos(slope), np.sin(slope)])
    way = np.cumsum([(ROOT_DISTANCE, ROOT_HEIGHT), *steps], axis=0)
    # Each arm swings a little to the back as it goes out.
    heading = np.radians(direction + 10.0 * along**2)
    return np.column_stack([way[:, 0] * np.sin(heading), -way[:, 0] * np.cos(heading), way[:, 1]])


def _arm_bones(arm: str, joints: Floats) -> list[Bone]:
    names = [f"{arm}_{i}.L" for i in range(1, BONES_OF_ARM + 1)]
    parents = ["head", *names[:-1]]
    return [Bone(names[i], parents[i], _point(joints[i]), _point(joints[i + 1])) for i in range(BONES_OF_ARM)]


def _arm_solids(arm: str, joints: Floats) -> list[Solid]:
    radii = ARM_ROOT + (ARM_TIP - ARM_ROOT) * np.linspace(0.0, 1.0, BONES_OF_ARM + 1) ** 0.8
    joints = joints.copy()
    joints[0] *= (0.5, 0.5, 1.0)
    return [
        Solid(
            f"{arm}_{i + 1}.L",
            _point(joints[i]),
            _point(joints[i + 1]),
            (float(radii[i]), float(radii[i + 1])),
            blend=0.05 if i == 0 else 0.008,
        )
        for i in range(BONES_OF_ARM)
    ]


def _point(values: Floats) -> Point:
    x, y, z = values
    return (float(x), float(y), float(z))


def _bend(arm: str, upwards: float, sideways: float, bones: range = range(1, BONES_OF_ARM + 1)) -> dict[str, Point]:
    """Return the angles that bend each of some bones of a left arm upwards and towards the front, in degrees."""
    heading = np.radians(ARM_DIRECTIONS[arm])
    # Upwards is about the horizontal axis across the arm.
    axis = upwards * np.array([-np.cos(heading), -np.sin(heading), 0.0])
    return {f"{arm}_{i}.L": (float(axis[0]), float(axis[1]), -sideways) for i in bones}


def _all_arms(upwards: float, sideways: float, bones: range) -> dict[str, Point]:
    return {name: angles for arm in ARM_DIRECTIONS for name, angles in _bend(arm, upwards, sideways, bones).items()}


POSES = {
    "rest": Pose(),
    "swim": Pose(
        both_sides(_all_arms(-9.0, 0.0, range(1, 5)) | _all_arms(-12.0, 8.0, range(5, 9)))
        | {"mantle": (12.0, 0.0, 0.0)},
        shift=(0.0, 0.0, 1.0),
    ),
    "reach": Pose(
        both_sides(_all_arms(0.0, 7.0, range(2, 9)))
        | _bend("arm_1", 13.0, 0.0, range(1, 5))
        | _bend("arm_1", -12.0, 0.0, range(5, 9))
        | _bend("arm_2", 9.0, 10.0)
        | {"mantle": (-6.0, 6.0, 0.0)}
    ),
    "curl": Pose(
        both_sides(_all_arms(-3.0, 0.0, range(1, 4)) | _all_arms(22.0, 0.0, range(5, 9))), shift=(0.0, 0.0, 0.06)
    ),
}
