"""A stylised human with hands and feet, 1.7 m tall, at rest in a T-pose."""

from .character import Character, Plan, build
from .hand import FINGER_NAMES, hand_bones, hand_solids
from .humanoid_poses import POSES
from .magnifier import Magnifier, Magnifiers
from .rig import Bone, with_mirrored_bones
from .solids import Body, Solid, with_mirrored_solids

SHOULDER, ELBOW, WRIST = (0.175, 0.012, 1.305), (0.425, 0.022, 1.305), (0.665, 0.012, 1.305)
HIP, KNEE, ANKLE, BALL = (0.084, 0.008, 0.880), (0.103, -0.005, 0.485), (0.112, 0.022, 0.085), (0.124, -0.105, 0.030)

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
    Solid("hips", (-0.045, 0.014, 0.930), (0.045, 0.014, 0.930), (0.092, 0.092), (1.0, 0.95, 1.05)),
    Solid("hips", (0.060, 0.050, 0.882), (0.060, 0.050, 0.882), (0.078, 0.078), blend=0.05),
    Solid("spine", (0.0, 0.010, 0.97), (0.0, 0.008, 1.12), (0.094, 0.090), (1.14, 0.88, 1.0), blend=0.05),
    Solid("chest", (0.0, 0.012, 1.13), (0.0, 0.014, 1.25), (0.100, 0.116), (1.20, 0.88, 1.0), blend=0.04),
    Solid("chest", (0.062, -0.036, 1.225), (0.075, -0.030, 1.255), (0.058, 0.056), (1.15, 0.9, 0.95), blend=0.05),
    Solid("chest", (0.080, 0.045, 1.25), (0.080, 0.045, 1.25), (0.066, 0.066), (1.0, 0.9, 1.2), blend=0.05),
    Solid("clavicle.L", (0.035, 0.020, 1.325), (0.160, 0.014, 1.310), (0.050, 0.052), blend=0.05),
)
HEAD = (
    Solid("neck", (0.0, 0.028, 1.33), (0.0, 0.016, 1.50), (0.054, 0.050), blend=0.06),
    Solid("head", (0.0, 0.022, 1.592), (0.0, 0.022, 1.592), (0.118, 0.118), (0.95, 1.07, 1.04), blend=0.02),
    Solid("head", (0.0, -0.020, 1.545), (0.0, -0.064, 1.464), (0.088, 0.037), (0.98, 1.0, 1.0), blend=0.03),
    Solid("head", (0.046, -0.054, 1.520), (0.046, -0.054, 1.520), (0.042, 0.042), blend=0.04),
    Solid("head", (0.0, -0.108, 1.578), (0.0, -0.121, 1.538), (0.010, 0.0185), blend=0.018),
    Solid("head", (0.042, -0.092, 1.580), (0.042, -0.092, 1.580), (0.0265, 0.0265), (1.12, 0.8, 0.95), blend=0.005),
    Solid("head", (0.0, -0.094, 1.494), (0.0, -0.094, 1.494), (0.022, 0.022), (1.35, 0.8, 0.5), blend=0.010),
    Solid("head", (0.117, 0.034, 1.578), (0.108, 0.022, 1.540), (0.033, 0.020), (0.42, 0.8, 1.0), blend=0.008),
)
ARM = (
    Solid("upper_arm.L", (0.186, 0.012, 1.301), (0.240, 0.014, 1.304), (0.061, 0.050), blend=0.04),
    Solid("upper_arm.L", (0.230, 0.014, 1.305), ELBOW, (0.048, 0.039), blend=0.02),
    Solid("upper_arm.L", (0.300, 0.010, 1.306), (0.340, 0.012, 1.306), (0.044, 0.041), (1.0, 1.05, 1.0), blend=0.02),
    Solid("forearm.L", ELBOW, WRIST, (0.039, 0.025), (1.0, 1.0, 0.95), blend=0.008),
    Solid("forearm.L", (0.475, 0.014, 1.304), (0.530, 0.012, 1.304), (0.041, 0.035), blend=0.02),
)
LEG = (
    Solid("thigh.L", HIP, KNEE, (0.084, 0.051), blend=0.05),
    Solid("thigh.L", (0.088, -0.006, 0.82), (0.099, -0.016, 0.60), (0.074, 0.054), blend=0.03),
    Solid("shin.L", KNEE, ANKLE, (0.051, 0.033), blend=0.008),
    Solid("shin.L", (0.104, 0.010, 0.430), (0.110, 0.027, 0.270), (0.049, 0.037), blend=0.03),
    Solid("foot.L", (0.111, 0.044, 0.044), (0.113, 0.022, 0.075), (0.039, 0.036), blend=0.02),
    Solid("foot.L", (0.113, 0.004, 0.056), BALL, (0.040, 0.031), (1.12, 1.0, 0.92), blend=0.025),
    Solid("toes.L", BALL, (0.129, -0.150, 0.025), (0.032, 0.026), (1.35, 1.0, 0.85), blend=0.015),
)

COARSE = {
    "torso": ("hips", "spine", "chest", "clavicle.L", "clavicle.R"),
    "head": ("neck", "head"),
}
LEG_BONES = ("thigh", "shin", "foot", "toes")

# The T-pose keeps the hands and the face apart from all else, so each can be meshed finer.
HANDS = Magnifier(axis=0, begin=0.50, full=0.72, factor=3.0, centre=(0.0, 0.012, 1.305))
FACE = Magnifier(axis=2, begin=1.42, full=1.50, factor=1.5, centre=(0.0, 0.0, 0.0))


def humanoid(n_vertices: int = 8000) -> Character:
    """Return a human with about ``n_vertices`` vertices, at least 4000.

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
        magnifiers=Magnifiers((HANDS, FACE)),
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
