"""A four-legged animal in the manner of a fox, 0.6 m tall at the shoulder, looking along -y."""

from .character import Character, Plan, build
from .magnifier import Magnifier, Magnifiers
from .rig import Bone, Pose, both_sides, with_mirrored_bones
from .solids import Body, Solid, with_mirrored_solids

SHOULDER, ELBOW, WRIST = (0.082, -0.215, 0.500), (0.092, -0.150, 0.345), (0.094, -0.185, 0.125)
FORE_FOOT, FORE_TOES = (0.094, -0.200, 0.042), (0.096, -0.275, 0.030)
HIP, KNEE, HOCK = (0.075, 0.290, 0.535), (0.098, 0.205, 0.345), (0.098, 0.375, 0.200)
HIND_FOOT, HIND_TOES = (0.098, 0.345, 0.044), (0.100, 0.265, 0.030)
TAIL = ((0.0, 0.37, 0.595), (0.0, 0.48, 0.585), (0.0, 0.59, 0.535), (0.0, 0.70, 0.500), (0.0, 0.82, 0.505))
TAIL_RADII = (0.036, 0.050, 0.064, 0.058, 0.022)
NECK, SKULL, NOSE = (0.0, -0.270, 0.600), (0.0, -0.400, 0.815), (0.0, -0.650, 0.815)
EAR, EAR_TIP = (0.058, -0.385, 0.935), (0.088, -0.370, 1.060)

BONES = (
    Bone("hips", None, (0.0, 0.30, 0.57), (0.0, 0.37, 0.595)),
    Bone("loin", "hips", (0.0, 0.26, 0.57), (0.0, 0.05, 0.57)),
    Bone("chest", "loin", (0.0, 0.05, 0.57), NECK),
    Bone("neck", "chest", NECK, SKULL),
    Bone("head", "neck", SKULL, NOSE),
    Bone("ear.L", "head", EAR, EAR_TIP),
    *(Bone(f"tail_{i + 1}", f"tail_{i}" if i else "hips", TAIL[i], TAIL[i + 1]) for i in range(4)),
    Bone("fore_arm.L", "chest", SHOULDER, ELBOW),
    Bone("fore_shin.L", "fore_arm.L", ELBOW, WRIST),
    Bone("fore_paw.L", "fore_shin.L", WRIST, FORE_FOOT),
    Bone("fore_toes.L", "fore_paw.L", FORE_FOOT, FORE_TOES),
    Bone("hind_thigh.L", "hips", HIP, KNEE),
    Bone("hind_shin.L", "hind_thigh.L", KNEE, HOCK),
    Bone("hind_paw.L", "hind_shin.L", HOCK, HIND_FOOT),
    Bone("hind_toes.L", "hind_paw.L", HIND_FOOT, HIND_TOES),
)
TRUNK = (
    Solid("chest", (0.0, -0.195, 0.530), (0.0, 0.020, 0.550), (0.128, 0.116), (0.86, 1.0, 1.1)),
    Solid("loin", (0.0, 0.020, 0.555), (0.0, 0.230, 0.575), (0.112, 0.090), (0.86, 1.0, 1.0), blend=0.03),
    Solid("hips", (0.0, 0.240, 0.575), (0.0, 0.300, 0.565), (0.090, 0.100), (0.95, 1.0, 1.0), blend=0.03),
    *(
        Solid(f"tail_{i + 1}", TAIL[i], TAIL[i + 1], (TAIL_RADII[i], TAIL_RADII[i + 1]), blend=0.010 if i else 0.05)
        for i in range(4)
    ),
)
HEAD = (
    Solid("neck", (0.0, -0.240, 0.580), (0.0, -0.385, 0.800), (0.098, 0.070), (0.9, 1.0, 1.0), blend=0.07),
    Solid("head", (0.0, -0.410, 0.860), (0.0, -0.430, 0.855), (0.094, 0.090), (1.0, 1.0, 0.93), blend=0.04),
    Solid("head", (0.050, -0.420, 0.835), (0.050, -0.420, 0.835), (0.055, 0.055), blend=0.05),
    Solid("head", (0.0, -0.480, 0.835), (0.0, -0.630, 0.812), (0.060, 0.030), (1.0, 1.0, 0.9), blend=0.06),
    Solid("head", (0.0, -0.656, 0.822), (0.0, -0.656, 0.822), (0.020, 0.020), (1.1, 0.9, 0.85), blend=0.008),
    Solid("head", (0.050, -0.488, 0.880), (0.050, -0.488, 0.880), (0.021, 0.021), blend=0.005),
    Solid("ear.L", EAR, EAR_TIP, (0.046, 0.012), (1.0, 0.5, 1.0), blend=0.025),
)
LEGS = (
    Solid("fore_arm.L", (0.072, -0.190, 0.520), ELBOW, (0.082, 0.046), (0.78, 1.0, 1.0), blend=0.05),
    Solid("fore_shin.L", ELBOW, WRIST, (0.043, 0.0285), blend=0.010),
    Solid("fore_paw.L", WRIST, FORE_FOOT, (0.0285, 0.033), blend=0.006),
    Solid("fore_toes.L", FORE_FOOT, (0.096, -0.252, 0.030), (0.035, 0.030), (1.2, 1.0, 0.95), blend=0.010),
    Solid("hind_thigh.L", (0.076, 0.275, 0.530), KNEE, (0.100, 0.054), (0.70, 1.0, 1.0), blend=0.05),
    Solid("hind_shin.L", KNEE, HOCK, (0.052, 0.029), (0.9, 1.0, 1.0), blend=0.012),
    Solid("hind_paw.L", HOCK, HIND_FOOT, (0.029, 0.031), blend=0.006),
    Solid("hind_toes.L", HIND_FOOT, (0.100, 0.287, 0.030), (0.034, 0.030), (1.2, 1.0, 0.95), blend=0.010),
)

# Only the head is this high.
HEAD_MAGNIFIER = Magnifier(axis=2, begin=0.66, full=0.76, factor=1.4, centre=(0.0, -0.40, 0.0))

POSES = {
    "rest": Pose(),
    "walk": Pose(
        {
            "fore_arm.L": (-24.0, 0.0, 0.0),
            "fore_shin.L": (12.0, 0.0, 0.0),
            "fore_arm.R": (20.0, 0.0, 0.0),
            "fore_shin.R": (-4.0, 0.0, 0.0),
            "fore_paw.R": (20.0, 0.0, 0.0),
            "hind_thigh.L": (22.0, 0.0, 0.0),
            "hind_shin.L": (-2.0, 0.0, 0.0),
            "hind_paw.L": (12.0, 0.0, 0.0),
            "hind_thigh.R": (-20.0, 0.0, 0.0),
            "hind_shin.R": (14.0, 0.0, 0.0),
            "tail_1": (-10.0, 0.0, 8.0),
            "tail_2": (0.0, 0.0, 8.0),
            "head": (6.0, 0.0, 0.0),
        }
    ),
    "run": Pose(
        both_sides(
            {
                "fore_arm.L": (-42.0, 0.0, 0.0),
                "fore_shin.L": (10.0, 0.0, 0.0),
                "hind_thigh.L": (36.0, 0.0, 0.0),
                "hind_shin.L": (-14.0, 0.0, 0.0),
                "hind_paw.L": (30.0, 0.0, 0.0),
                "ear.L": (-30.0, 0.0, 0.0),
            }
        )
        | {"neck": (22.0, 0.0, 0.0), "head": (-14.0, 0.0, 0.0), "tail_1": (14.0, 0.0, 0.0), "tail_2": (8.0, 0.0, 0.0)},
        shift=(0.0, 0.0, 0.1),
    ),
    "sit": Pose(
        both_sides(
            {
                "hind_thigh.L": (-46.0, 0.0, 0.0),
                "hind_shin.L": (30.0, 0.0, 0.0),
                "hind_paw.L": (-32.0, 0.0, 0.0),
                "hind_toes.L": (10.0, 0.0, 0.0),
                "fore_arm.L": (30.0, 0.0, 0.0),
                "fore_shin.L": (4.0, 0.0, 0.0),
            }
        )
        | {"hips": (-38.0, 0.0, 0.0), "neck": (18.0, 0.0, 0.0), "head": (16.0, 0.0, 0.0), "tail_1": (30.0, 0.0, 15.0)},
        shift=(0.0, 0.0, -0.334),
    ),
    "look": Pose(
        {
            "neck": (0.0, 0.0, 28.0),
            "head": (0.0, 0.0, 34.0),
            "tail_1": (-30.0, 0.0, 0.0),
            "tail_2": (-30.0, 0.0, 0.0),
            "tail_3": (-30.0, 0.0, 0.0),
            "fore_arm.R": (-40.0, 0.0, 0.0),
            "fore_shin.R": (70.0, 0.0, 0.0),
            "fore_paw.R": (25.0, 0.0, 0.0),
        }
    ),
}


def quadruped(n_vertices: int = 8000) -> Character:
    """Return a four-legged animal with about ``n_vertices`` vertices, at least 2000.

    Raises
    ------
    ValueError
        If that is too few for its thin parts.
    """
    return build(_plan(), n_vertices)


def _plan() -> Plan:
    bones = with_mirrored_bones(BONES)
    return Plan(
        name="quadruped",
        bones=bones,
        body=Body(with_mirrored_solids((*TRUNK, *HEAD, *LEGS))),
        poses=POSES,
        part_of_bone={bone.name: _part(bone.name) for bone in bones},
        fine_part_of_bone={bone.name: _fine_part(bone.name) for bone in bones},
        magnifiers=Magnifiers((HEAD_MAGNIFIER,)),
    )


def _part(bone: str) -> str:
    """Return torso, head, tail, fore_leg.L, hind_leg.L, fore_leg.R or hind_leg.R."""
    stem = bone.split("_")[0]
    if stem in ("fore", "hind"):
        return f"{stem}_leg{bone[-2:]}"
    if stem in ("neck", "head", "ear.L", "ear.R"):
        return "head"
    return "tail" if stem == "tail" else "torso"


def _fine_part(bone: str) -> str:
    """Return the bone's own name, but one name for the tail, the toes with their paw and the trunk."""
    if bone in ("hips", "loin", "chest"):
        return "torso"
    return "tail" if bone.startswith("tail") else bone.replace("toes", "paw")
