"""Characters: a quad mesh with bones, skinning weights, poses and true parts."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .magnifier import Magnifiers
from .rig import Bone, Pose, bone_motions, mirrored_name
from .skinning import blend_skinning, diffused_weights
from .solids import Body
from .surface_net import mesh_body, mirror_of_vertex

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Plan:
    """What a character is built from.

    Attributes
    ----------
    name : str
    bones : tuple of Bone
        Parents before their children.
    body : Body
    poses : mapping of name to Pose
        The first is "rest".
    part_of_bone, fine_part_of_bone : mapping of bone name to part name
        The true parts, coarse and fine.
    magnifiers : Magnifiers
        Where the mesh is finer.
    """

    name: str
    bones: tuple[Bone, ...]
    body: Body
    poses: Mapping[str, Pose]
    part_of_bone: Mapping[str, str]
    fine_part_of_bone: Mapping[str, str]
    magnifiers: Magnifiers = Magnifiers()


@dataclass(frozen=True, eq=False)
class Character:
    """A character at rest, with what is needed to pose it and to know its parts.

    Attributes
    ----------
    plan : Plan
    vertices : (V, 3) float64
        At rest, in metres.
    quads : (Q, 4) int64
        Counter-clockwise seen from outside; the first diagonal is the shorter one.
    weights : (V, B) float64
        Share of each bone in each vertex; rows sum to one.
    bone_of_vertex : (V,) int64
        The bone that each vertex belongs to.
    """

    plan: Plan
    vertices: Floats
    quads: Ints
    weights: Floats
    bone_of_vertex: Ints

    @property
    def name(self) -> str:
        """The name of the character."""
        return self.plan.name

    @property
    def bones(self) -> tuple[Bone, ...]:
        """The B bones, parents before their children."""
        return self.plan.bones

    @property
    def poses(self) -> Mapping[str, Pose]:
        """The named poses, "rest" first."""
        return self.plan.poses

    @cached_property
    def triangles(self) -> Ints:
        """(2 Q, 3) the quads, each cut along its first diagonal; triangles 2 i and 2 i + 1 are quad i."""
        return self.quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)

    @cached_property
    def part_names(self) -> tuple[str, ...]:
        """The coarse parts: head, torso, arm.L ..."""
        return tuple(dict.fromkeys(self.plan.part_of_bone[bone.name] for bone in self.bones))

    @cached_property
    def fine_part_names(self) -> tuple[str, ...]:
        """The fine parts: head, neck, upper_arm.L, index.L ..."""
        return tuple(dict.fromkeys(self.plan.fine_part_of_bone[bone.name] for bone in self.bones))

    @cached_property
    def part_of_vertex(self) -> Ints:
        """(V,) index into ``part_names``."""
        return self._merged(self.part_names, self.plan.part_of_bone)

    @cached_property
    def fine_part_of_vertex(self) -> Ints:
        """(V,) index into ``fine_part_names``."""
        return self._merged(self.fine_part_names, self.plan.fine_part_of_bone)

    @cached_property
    def mirror_of_vertex(self) -> Ints:
        """(V,) the vertex at the mirror image in x = 0, for symmetric characters."""
        return mirror_of_vertex(self.vertices)

    def mesh_in_pose(self, pose: str) -> Floats:
        """Return the (V, 3) vertices in a named pose."""
        return blend_skinning(self.vertices, self.weights, bone_motions(self.bones, self.poses[pose]))

    def _merged(self, names: tuple[str, ...], part_of_bone: Mapping[str, str]) -> Ints:
        part = np.array([names.index(part_of_bone[bone.name]) for bone in self.bones])
        return part[self.bone_of_vertex]


def build(plan: Plan, n_vertices: int) -> Character:
    """Return the character of a plan with about ``n_vertices`` vertices.

    Raises
    ------
    ValueError
        If the plan has parts too thin for that few vertices.
    """
    mesh = mesh_body(plan.body, n_vertices, plan.magnifiers)
    number = {bone.name: i for i, bone in enumerate(plan.bones)}
    nearest, radius = plan.body.nearest_solid(mesh.vertices)
    bone_of_vertex = np.array([number[solid.bone] for solid in plan.body.solids])[nearest]
    triangles = mesh.quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    weights = diffused_weights(mesh.vertices, triangles, bone_of_vertex, len(plan.bones), radius)
    if plan.body.symmetric:
        mirrored_bone = [number[mirrored_name(bone.name)] for bone in plan.bones]
        weights = 0.5 * (weights + weights[mirror_of_vertex(mesh.vertices)][:, mirrored_bone])
    return Character(plan, mesh.vertices, mesh.quads, weights, bone_of_vertex)
