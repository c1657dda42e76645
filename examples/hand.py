"""A left hand, by itself or on an arm: the fingers point along x, the thumb towards -y, the palm down."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .character import Character, Plan, build
from .rig import Bone, Point, Pose
from .solids import Body, Solid


@dataclass(frozen=True)
class Finger:
    """A finger of three bones, in metres from the wrist of a hand that is 0.2 long.

    Attributes
    ----------
    name : str
    base : (3,) float
        The knuckle.
    splay, slope : float
        Degrees from straight ahead towards +y, and downwards at the first bone.
    lengths : (3,) float
        Of the bones.
    radii : (2,) float
        At the knuckle and at the tip.
    """

    name: str
    base: Point
    splay: float
    slope: float
    lengths: tuple[float, float, float]
    radii: tuple[float, float]

    @property
    def joints(self) -> NDArray[np.float64]:
        """(4, 3) knuckle, two joints and the tip; each bone is bent down a little more than the one before."""
        slope = np.radians(self.slope + np.array([0.0, 7.0, 14.0]))
        splay = np.radians(self.splay)
        forward = np.array([np.cos(splay), np.sin(splay)])
        steps = np.column_stack([np.cos(slope)[:, None] * forward, -np.sin(slope)]) * np.array(self.lengths)[:, None]
        return np.array(self.base) + np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])


FINGERS = (
    Finger("index", (0.095, -0.040, 0.000), -13.0, 4.0, (0.043, 0.028, 0.022), (0.0118, 0.0090)),
    Finger("middle", (0.100, -0.013, 0.003), -4.0, 3.0, (0.048, 0.032, 0.024), (0.0121, 0.0092)),
    Finger("ring", (0.096, 0.014, 0.001), 5.5, 4.0, (0.044, 0.029, 0.023), (0.0116, 0.0088)),
    Finger("little", (0.086, 0.038, -0.005), 17.0, 6.0, (0.034, 0.022, 0.019), (0.0104, 0.0080)),
    Finger("thumb", (0.034, -0.034, -0.010), -52.0, 14.0, (0.040, 0.032, 0.025), (0.0150, 0.0112)),
)
FINGER_NAMES = tuple(finger.name for finger in FINGERS)


def hand(n_vertices: int = 5000) -> Character:
    """Return a left hand with a wrist and about ``n_vertices`` vertices, at least 1500; it is not symmetric.

    Raises
    ------
    ValueError
        If that is too few to keep the fingers whole and apart.
    """
    return build(_plan(), n_vertices)


def hand_bones(wrist: Point, parent: str, size: float = 1.0) -> tuple[Bone, ...]:
    """Return the bone of the palm and three bones for each finger, from a wrist on."""
    palm = Bone("hand.L", parent, wrist, _placed((0.09, 0.0, 0.0), wrist, size))
    return (palm, *(bone for finger in FINGERS for bone in _finger_bones(finger, wrist, size)))


def hand_solids(wrist: Point, size: float = 1.0) -> tuple[Solid, ...]:
    """Return the flesh of a hand from a wrist on."""
    return (*_palm_solids(wrist, size), *(solid for finger in FINGERS for solid in _finger_solids(finger, wrist, size)))


def curled(degrees: float, names: tuple[str, ...] = FINGER_NAMES[:4]) -> dict[str, Point]:
    """Return the angles that bend all joints of some fingers of a left hand towards the palm."""
    return {f"{name}_{i}.L": (0.0, degrees, 0.0) for name in names for i in (1, 2, 3)}


def _plan() -> Plan:
    wrist = (0.0, 0.0, 0.0)
    bones = (Bone("forearm.L", None, (-0.10, 0.0, 0.0), wrist), *hand_bones(wrist, "forearm.L"))
    forearm = Solid("forearm.L", (-0.07, 0.0, 0.0), (0.0, 0.0, 0.0), (0.033, 0.026), (1.0, 1.0, 0.9))
    fingers = {bone.name: bone.name.split("_")[0] + ".L" for bone in bones if "_" in bone.name}
    return Plan(
        name="hand",
        bones=bones,
        body=Body((forearm, *hand_solids(wrist)), symmetric=False),
        poses=POSES,
        part_of_bone={"forearm.L": "palm.L", "hand.L": "palm.L", **fingers},
        fine_part_of_bone={bone.name: bone.name for bone in bones},
    )


def _finger_bones(finger: Finger, wrist: Point, size: float) -> list[Bone]:
    joints = [_placed(joint, wrist, size) for joint in finger.joints]
    names = [f"{finger.name}_{i}.L" for i in (1, 2, 3)]
    parents = ["hand.L", *names[:2]]
    return [Bone(names[i], parents[i], joints[i], joints[i + 1]) for i in range(3)]


def _finger_solids(finger: Finger, wrist: Point, size: float) -> list[Solid]:
    """Return three rounded cones; the last ends where its ball touches the tip."""
    joints = finger.joints
    radii = np.interp(np.cumsum([0.0, *finger.lengths]), [0.0, sum(finger.lengths)], finger.radii)
    last = joints[3] - joints[2]
    joints[3] -= radii[3] * last / np.linalg.norm(last)
    # The flesh of a finger reaches back into the palm, else the web between two fingers would be a notch.
    joints[0] -= 0.3 * (joints[1] - joints[0])
    blends = (0.009, 0.004, 0.004)
    return [
        Solid(
            f"{finger.name}_{i + 1}.L",
            _placed(joints[i], wrist, size),
            _placed(joints[i + 1], wrist, size),
            (size * radii[i], size * radii[i + 1]),
            blend=size * blends[i],
        )
        for i in range(3)
    ]


def _palm_solids(wrist: Point, size: float) -> list[Solid]:
    """Return a ray from the wrist to each knuckle, and the balls of the thumb and of the little finger."""
    rays = [((0.002, 0.35 * f.base[1], 0.0), f.base, (0.0215, 1.22 * f.radii[0])) for f in FINGERS if f.name != "thumb"]
    balls = [
        ((0.022, -0.016, -0.006), (0.048, -0.043, -0.013), (0.0190, 0.0160)),
        ((0.022, 0.016, -0.005), (0.060, 0.028, -0.008), (0.0180, 0.0150)),
    ]
    return [
        Solid(
            "hand.L",
            _placed(start, wrist, size),
            _placed(end, wrist, size),
            (size * radii[0], size * radii[1]),
            scale=(1.0, 1.0, 0.9),
            blend=size * 0.016,
        )
        for start, end, radii in [*rays, *balls]
    ]


def _placed(point: Point, wrist: Point, size: float) -> Point:
    x, y, z = np.asarray(wrist) + size * np.asarray(point)
    return (float(x), float(y), float(z))


POSES = {
    "rest": Pose(),
    "grip": Pose(curled(38.0) | {"thumb_1.L": (-25.0, 0.0, 0.0), "thumb_2.L": (0.0, 0.0, 25.0)}),
    "fist": Pose(curled(56.0) | {"thumb_1.L": (-35.0, 0.0, 10.0), "thumb_2.L": (0.0, 0.0, 35.0)}),
    "point": Pose(curled(54.0, FINGER_NAMES[1:4]) | {"thumb_1.L": (-30.0, 0.0, 10.0), "thumb_2.L": (0.0, 0.0, 30.0)}),
    "victory": Pose(
        curled(54.0, FINGER_NAMES[2:4])
        | {
            "thumb_1.L": (-30.0, 0.0, 20.0),
            "thumb_2.L": (0.0, 0.0, 40.0),
            "index_1.L": (0.0, -5.0, -6.0),
            "middle_1.L": (0.0, -5.0, 12.0),
        }
    ),
}
