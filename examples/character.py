"""Characters: a quad mesh with bones, skinning weights, poses and true parts."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .magnifier import Magnifiers
from .parts import heaviest_part, majority
from .rig import Bone, Pose, bone_motions, mirrored_name
from .skinning import blend_skinning, diffused_weights
from .solids import Body
from .surface_net import QuadMesh, mesh_body, mirror_of_vertex

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
    genus : int
        How many handles the body has.
    """

    name: str
    bones: tuple[Bone, ...]
    body: Body
    poses: Mapping[str, Pose]
    part_of_bone: Mapping[str, str]
    fine_part_of_bone: Mapping[str, str]
    magnifiers: Magnifiers = field(default_factory=Magnifiers)
    genus: int = 0


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
    """

    plan: Plan
    vertices: Floats
    quads: Ints
    weights: Floats

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
        return _names(self.bones, self.plan.part_of_bone)

    @cached_property
    def fine_part_names(self) -> tuple[str, ...]:
        """The fine parts: head, neck, upper_arm.L, index.L ..."""
        return _names(self.bones, self.plan.fine_part_of_bone)

    @cached_property
    def part_of_vertex(self) -> Ints:
        """(V,) index into ``part_names``: the part whose bones have the most weight; each part is one piece."""
        return self._heaviest(self.part_names, self.plan.part_of_bone)

    @cached_property
    def fine_part_of_vertex(self) -> Ints:
        """(V,) index into ``fine_part_names``."""
        return self._heaviest(self.fine_part_names, self.plan.fine_part_of_bone)

    @property
    def part_of_quad(self) -> Ints:
        """(Q,) index into ``part_names``."""
        return majority(self.part_of_vertex, self.quads)

    @property
    def fine_part_of_quad(self) -> Ints:
        """(Q,) index into ``fine_part_names``."""
        return majority(self.fine_part_of_vertex, self.quads)

    @cached_property
    def mirror_of_vertex(self) -> Ints:
        """(V,) the vertex at the mirror image in x = 0, for symmetric characters."""
        return mirror_of_vertex(self.vertices)

    def mesh_in_pose(self, pose: str) -> Floats:
        """Return the (V, 3) vertices in a named pose."""
        return blend_skinning(self.vertices, self.weights, bone_motions(self.bones, self.poses[pose]))

    def _heaviest(self, names: tuple[str, ...], part_of_bone: Mapping[str, str]) -> Ints:
        column = [names.index(part_of_bone[bone.name]) for bone in self.bones]
        return heaviest_part(self.weights @ np.eye(len(names))[column], self.quads)


def build(plan: Plan, n_vertices: int) -> Character:
    """Return the character of a plan with about ``n_vertices`` vertices.

    Raises
    ------
    ValueError
        If the plan has parts too thin for that few vertices.
    """
    mesh = mesh_body(plan.body, n_vertices, plan.magnifiers)
    if not (_has_handles(mesh, plan.genus) and _has_tips(mesh, plan.bones)):
        raise ValueError(f"{n_vertices} vertices are too few to keep the parts of the {plan.name} whole and apart.")
    weights = _weights(plan, mesh)
    if plan.body.symmetric:
        mirrored_bone = [_number(plan.bones)[mirrored_name(bone.name)] for bone in plan.bones]
        weights = 0.5 * (weights + weights[mirror_of_vertex(mesh.vertices)][:, mirrored_bone])
    return Character(plan, mesh.vertices, mesh.quads, weights)


def _weights(plan: Plan, mesh: QuadMesh) -> Floats:
    """Return the weights that pass smoothly between the flesh of one bone and that of the next."""
    nearest, radius = plan.body.nearest_solid(mesh.vertices)
    bone_of_solid = np.array([_number(plan.bones)[solid.bone] for solid in plan.body.solids])
    triangles = mesh.quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    return diffused_weights(mesh.vertices, triangles, bone_of_solid[nearest], len(plan.bones), radius)


def _has_handles(mesh: QuadMesh, genus: int) -> bool:
    """Whether the mesh has so many handles; each quad of a closed mesh has two edges to itself."""
    return len(mesh.vertices) - len(mesh.quads) == 2 - 2 * genus


def _has_tips(mesh: QuadMesh, bones: tuple[Bone, ...]) -> bool:
    """Whether the mesh reaches over most of each bone that is the last of its chain."""
    parents = {bone.parent for bone in bones}
    last = [bone for bone in bones if bone.name not in parents]
    heads, tails = np.array([bone.head for bone in last]), np.array([bone.tail for bone in last])
    missing, _ = cKDTree(mesh.vertices).query(tails)
    return bool((missing < np.linalg.norm(tails - heads, axis=1)).all())


def _names(bones: tuple[Bone, ...], part_of_bone: Mapping[str, str]) -> tuple[str, ...]:
    """Return each part once, in the order of the bones."""
    return tuple(dict.fromkeys(part_of_bone[bone.name] for bone in bones))


def _number(bones: tuple[Bone, ...]) -> dict[str, int]:
    return {bone.name: i for i, bone in enumerate(bones)}
