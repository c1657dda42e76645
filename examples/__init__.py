"""Characters made by code, with rigs, weights, poses and true parts: numpy and scipy only, apart from ``blender``."""

from .character import Character
from .humanoid import humanoid
from .rig import Bone, Pose

__all__ = ["Bone", "Character", "Pose", "humanoid"]
