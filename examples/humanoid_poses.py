"""Poses of the humanoid, in degrees from the T-pose.

About x: a leg goes forwards for negative angles, a knee bends for positive ones, the spine bends forwards for positive
ones. About y: the left arm goes down for positive angles. About z: the left arm goes forwards for negative angles.
"""

from .hand import curled
from .rig import Pose, both_sides

ARMS_DOWN = both_sides(
    {
        "clavicle.L": (0.0, 12.0, 0.0),
        "upper_arm.L": (0.0, 56.0, 0.0),
        "forearm.L": (0.0, 0.0, -18.0),
        **curled(12.0),
    }
)

POSES = {
    "rest": Pose(),
    "stand": Pose(ARMS_DOWN | {"head": (0.0, 0.0, 8.0)}),
    "walk": Pose(
        ARMS_DOWN
        | {
            "thigh.L": (-30.0, 0.0, 0.0),
            "shin.L": (12.0, 0.0, 0.0),
            "foot.L": (-4.0, 0.0, 0.0),
            "thigh.R": (20.0, 0.0, 0.0),
            "shin.R": (30.0, 0.0, 0.0),
            "foot.R": (-6.0, 0.0, 0.0),
            "toes.R": (-25.0, 0.0, 0.0),
            "upper_arm.L": (28.0, 60.0, 0.0),
            "forearm.L": (0.0, 0.0, -20.0),
            "upper_arm.R": (-28.0, -60.0, 0.0),
            "forearm.R": (0.0, 0.0, 40.0),
            "spine": (4.0, 0.0, 5.0),
            "chest": (2.0, 0.0, 6.0),
            "head": (-4.0, 0.0, -9.0),
        },
        shift=(0.0, 0.0, -0.071),
    ),
    "sit": Pose(
        both_sides(
            {
                "clavicle.L": (0.0, 10.0, 0.0),
                "upper_arm.L": (-32.0, 56.0, 0.0),
                "forearm.L": (0.0, 0.0, -48.0),
                "thigh.L": (-84.0, -5.0, 0.0),
                "shin.L": (82.0, 0.0, 0.0),
                **curled(10.0),
            }
        )
        | {"spine": (6.0, 0.0, 0.0), "head": (6.0, 0.0, 0.0)},
        shift=(0.0, 0.0, -0.37),
    ),
    "wave": Pose(
        ARMS_DOWN
        | curled(4.0)
        | {
            "clavicle.L": (0.0, -12.0, 0.0),
            "upper_arm.L": (0.0, -18.0, -15.0),
            "forearm.L": (0.0, -70.0, 0.0),
            "hand.L": (0.0, -10.0, 0.0),
            "chest": (0.0, -4.0, 0.0),
            "head": (0.0, 8.0, 12.0),
        }
    ),
    "arms_up": Pose(
        both_sides(
            {
                "clavicle.L": (0.0, -18.0, 0.0),
                "upper_arm.L": (0.0, -48.0, 0.0),
                "forearm.L": (0.0, -8.0, 0.0),
                **curled(5.0),
            }
        )
        | {"head": (-12.0, 0.0, 0.0), "chest": (-5.0, 0.0, 0.0)}
    ),
    "reach": Pose(
        both_sides({"thigh.L": (-52.0, -7.0, 0.0), "shin.L": (68.0, 0.0, 0.0), "foot.L": (-16.0, 0.0, 0.0)})
        | {
            "spine": (22.0, 0.0, 0.0),
            "chest": (16.0, 0.0, -12.0),
            "head": (-28.0, 0.0, 8.0),
            "clavicle.L": (0.0, 5.0, -12.0),
            "upper_arm.L": (0.0, 30.0, -62.0),
            "forearm.L": (0.0, 0.0, -14.0),
            "clavicle.R": (0.0, -8.0, 0.0),
            "upper_arm.R": (30.0, -50.0, 0.0),
            "forearm.R": (0.0, 0.0, 55.0),
        },
        shift=(0.0, 0.0, -0.185),
    ),
}
