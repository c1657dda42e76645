"""Characters made by code, with rigs, weights, poses and true parts: numpy and scipy only, apart from ``blender``."""

from .character import Character
from .hand import hand
from .handles import handles
from .humanoid import humanoid
from .octopus import octopus
from .quadruped import quadruped
from .rig import Bone, Pose

__all__ = ["Bone", "Character", "Pose", "hand", "handles", "humanoid", "octopus", "quadruped"]
