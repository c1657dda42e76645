"""A stylised human with hands and feet, 1.7 m tall, at rest in a T-pose."""

from .character import Character, Plan, build
from .hand import FINGER_NAMES, hand_bones, hand_solids
from .magnifier import Magnifier
from .rig import Bone, Pose, both_sides, with_mirrored_bones
from .solids import Body, Solid, with_mirrored_solids

SHOULDER, ELBOW, WRIST = (0.175, 0.012, 1.305), (0.425, 0.022, 1.305), (0.665, 0.012, 1.305)
HIP, KNEE, ANKLE, BALL = (0.090, 0.005, 0.890), (0.103, -0.005, 0.485), (0.112, 0.022, 0.085), (0.124, -0.105, 0.030)

SPINE_BONES = (
    Bone("hips", None, (0.0, 0.01, 0.92), (0.0, 0.01, 1.02)),
    Bone("spine", "hips", (0.0, 0.01, 1.02), (0.0, 0.01, 1.13)),
    Bone("chest", "spine", (0.0, 0.01, 1.13), (0.0, 0.02, 1.32)),
    Bone("neck", "chest", (0.0, 0.02, 1.36), (0.0, 0.01, 1.45)),
    Bone("head", "neck", (0.0, 0.01, 1.45), (0.0, 0.01, 1.71)),
)
LIMB_BONES = (
    Bone("clavicle.L", "chest", (0.03, 0.005, 1.315), SHOULDER),
    Bone("upper_arm.L", "clavicle.L", SHOULDER, ELBOW),
    Bone("forearm.L", "upper_arm.L", ELBOW, WRIST),
    *hand_bones(WRIST, "forearm.L"),
    Bone("thigh.L", "hips", HIP, KNEE),
    Bone("shin.L", "thigh.L", KNEE, ANKLE),
    Bone("foot.L", "shin.L", ANKLE, BALL),
    Bone("toes.L", "foot.L", BALL, (0.130, -0.175, 0.026)),
)

TORSO = (
    Solid("hips", (-0.045, 0.012, 0.935), (0.045, 0.012, 0.935), (0.100, 0.100), (1.0, 0.92, 1.0)),
    Solid("hips", (0.062, 0.052, 0.885), (0.062, 0.052, 0.885), (0.080, 0.080), blend=0.06),
    Solid("spine", (0.0, 0.006, 0.99), (0.0, 0.004, 1.12), (0.104, 0.098), (1.12, 0.86, 1.0), blend=0.08),
    Solid("chest", (0.0, 0.006, 1.15), (0.0, 0.012, 1.25), (0.112, 0.118), (1.20, 0.86, 1.0), blend=0.08),
    Solid("chest", (0.060, -0.045, 1.232), (0.060, -0.045, 1.232), (0.062, 0.062), (1.15, 0.80, 0.85), blend=0.05),
    Solid("chest", (0.075, 0.045, 1.24), (0.075, 0.045, 1.24), (0.072, 0.072), (1.0, 0.9, 1.15), blend=0.06),
    Solid("clavicle.L", (0.035, 0.020, 1.330), (0.165, 0.014, 1.312), (0.052, 0.050), blend=0.06),
)
HEAD = (
    Solid("neck", (0.0, 0.022, 1.33), (0.0, 0.010, 1.48), (0.058, 0.052), blend=0.06),
    Solid("head", (0.0, 0.022, 1.590), (0.0, 0.022, 1.590), (0.120, 0.120), (0.95, 1.06, 1.04), blend=0.03),
    Solid("head", (0.0, -0.020, 1.545), (0.0, -0.052, 1.468), (0.090, 0.044), (0.98, 1.0, 1.0), blend=0.05),
    Solid("head", (0.046, -0.052, 1.522), (0.046, -0.052, 1.522), (0.044, 0.044), blend=0.04),
    Solid("head", (0.0, -0.103, 1.572), (0.0, -0.120, 1.534), (0.009, 0.0165), blend=0.022),
    Solid("head", (0.041, -0.086, 1.578), (0.041, -0.086, 1.578), (0.024, 0.024), (1.15, 0.8, 0.9), blend=0.008),
    Solid("head", (0.112, 0.024, 1.568), (0.105, 0.016, 1.538), (0.028, 0.020), (0.45, 0.85, 1.0), blend=0.014),
)
ARM = (
    Solid("upper_arm.L", (0.190, 0.012, 1.300), (0.235, 0.014, 1.303), (0.061, 0.053), blend=0.05),
    Solid("upper_arm.L", (0.230, 0.014, 1.304), ELBOW, (0.050, 0.040), blend=0.03),
    Solid("upper_arm.L", (0.290, 0.010, 1.308), (0.340, 0.012, 1.308), (0.046, 0.043), (1.0, 1.05, 1.0), blend=0.03),
    Solid("forearm.L", ELBOW, WRIST, (0.040, 0.0255), (1.0, 1.0, 0.95), blend=0.02),
    Solid("forearm.L", (0.470, 0.014, 1.304), (0.530, 0.012, 1.304), (0.043, 0.036), blend=0.03),
)
LEG = (
    Solid("thigh.L", HIP, KNEE, (0.094, 0.056), blend=0.05),
    Solid("thigh.L", (0.094, -0.022, 0.76), (0.099, -0.020, 0.64), (0.072, 0.060), blend=0.05),
    Solid("shin.L", KNEE, ANKLE, (0.054, 0.0345), blend=0.03),
    Solid("shin.L", (0.105, 0.022, 0.385), (0.109, 0.026, 0.285), (0.051, 0.040), blend=0.04),
    Solid("foot.L", (0.111, 0.042, 0.046), (0.113, 0.020, 0.075), (0.041, 0.038), blend=0.03),
    Solid("foot.L", (0.113, 0.004, 0.058), BALL, (0.042, 0.0315), (1.12, 1.0, 0.92), blend=0.03),
    Solid("toes.L", BALL, (0.129, -0.150, 0.026), (0.032, 0.026), (1.35, 1.0, 0.85), blend=0.02),
)

COARSE = {
    "torso": ("hips", "spine", "chest", "clavicle.L", "clavicle.R"),
    "head": ("neck", "head"),
}
LEG_BONES = ("thigh", "shin", "foot", "toes")

RELAXED_FINGERS = {f"{name}_{i}.L": (0.0, 12.0, 0.0) for name in FINGER_NAMES if name != "thumb" for i in (1, 2, 3)}
FIST = {f"{name}_{i}.L": (0.0, 55.0, 0.0) for name in FINGER_NAMES if name != "thumb" for i in (1, 2, 3)}

POSES = {
    "rest": Pose(),
    "stand": Pose(
        both_sides({"clavicle.L": (0.0, 14.0, 0.0), "upper_arm.L": (0.0, 56.0, 0.0), "forearm.L": (0.0, 0.0, -18.0)})
        | both_sides(RELAXED_FINGERS)
    ),
}


def humanoid(n_vertices: int = 8000) -> Character:
    """Return a human with about ``n_vertices`` vertices.

    Raises
    ------
    ValueError
        If that is too few to keep the fingers whole and apart.
    """
    return build(_plan(), n_vertices)


def _plan() -> Plan:
    bones = with_mirrored_bones((*SPINE_BONES, *LIMB_BONES))
    solids = with_mirrored_solids((*TORSO, *HEAD, *ARM, *hand_solids(WRIST), *LEG))
    return Plan(
        name="humanoid",
        bones=bones,
        body=Body(solids),
        poses=POSES,
        part_of_bone={bone.name: _part(bone.name) for bone in bones},
        fine_part_of_bone={bone.name: _fine_part(bone.name) for bone in bones},
        magnifier=Magnifier(begin=0.50, full=0.72, factor=3.0, centre=(0.01, 1.305)),
    )


def _part(bone: str) -> str:
    """Return head, torso, arm.L, arm.R, leg.L or leg.R."""
    for part, bones in COARSE.items():
        if bone in bones:
            return part
    stem, side = bone[:-2], bone[-2:]
    return ("leg" if stem in LEG_BONES else "arm") + side


def _fine_part(bone: str) -> str:
    """Return head, neck, torso, upper_arm.L, forearm.L, hand.L, index.L ... thigh.L, shin.L, foot.L."""
    if bone in COARSE["torso"]:
        return "torso"
    if bone.startswith("toes"):
        return "foot" + bone[-2:]
    finger = bone.split("_")[0]
    return finger + bone[-2:] if finger in FINGER_NAMES else bone
