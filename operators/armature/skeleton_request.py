"""Base class of the operators that lay bones into the active mesh: the analysis, its skeleton, left and right."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.refusals import in_name_of
from ...tasks.skeleton_laying import NamedSkeleton, SkeletonInput, lay_bones
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.registered_settings import skeleton_settings
from ..jobs.mesh_handle import MeshHandle
from ..mesh_data import mesh_arrays
from ..mesh_data.world_shape import size_of
from ..mesh_state import bone_layout, part_sides
from ..mesh_state.corrected_analysis import exact_labels
from ..mesh_state.references import reference_of, state_of_reference
from ..mesh_state.state import is_analyzed_for, read, remember
from ..messages.sentences import Messages
from ..outputs.part_writer import read_labels
from ..outputs.rollback import all_or_nothing, bound_or_not, nothing_left_behind
from ..parts.analysis_request import AnalysisRequest
from ..parts.analysis_settings import read_input
from .skeleton_options import ArmatureOptions, SkeletonOptions


class SkeletonRequest(SkeletonOptions, AnalysisRequest):
    """Lays a skeleton into the parts that the active mesh shows."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and is_analyzed_for(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        """From the window: what the call leaves open is taken from the panel."""
        for name in self._options():
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(skeleton_settings(context), name))
        return super().invoke(context, event)

    def draw(self, context: bpy.types.Context) -> None:
        """Show what can be changed afterwards: with other options of the analysis all would have to be done again."""
        layout = present(self.layout)
        layout.use_property_split = True
        for name in self._options():
            layout.prop(self, name)

    def _options(self) -> list[str]:
        names = (*ArmatureOptions.__annotations__, *SkeletonOptions.__annotations__)
        return [name for name in names if name in self.properties.bl_rna.properties]

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., NamedSkeleton], MeshHandle]:
        obj = present(context.object)
        state = read(mesh_of(obj))
        reference = state_of_reference(state)
        wanted = SkeletonInput(
            labels=exact_labels(state, read_labels(mesh_of(obj))),
            level=state.level,
            n_pieces=self.bones_in_limbs,
            poses=_other_poses(context),
            pairing={} if reference is None else reference.part_sides,
            needs_weights=self.needs_weights(),
            layout=None if reference is None else reference.bone_layout,
        )
        return partial(lay_bones, read_input(context, obj, self.analysis_settings()), wanted), MeshHandle.of(obj)

    def needs_weights(self) -> bool:
        """Whether the mesh is to be bound to the bones with weights of ours."""
        return False

    def finish(self, context: bpy.types.Context, handle: MeshHandle, laid: NamedSkeleton) -> Outcome:
        obj = handle.find_object_in_view(context)
        mesh = mesh_of(obj)
        with all_or_nothing(mesh), nothing_left_behind(context), bound_or_not(obj):
            sides, layout = part_sides.packed_sides(laid.pairing), bone_layout.packed_layout(laid.skeleton.layout)
            remember(mesh, {**sides, **layout})
            built = self.build(context, obj, laid)
        warnings = (*built.warnings, *laid.warnings, *_warnings_of_reference(mesh))
        Messages(built.infos, warnings).report(self)
        return {"FINISHED"}

    def build(self, context: bpy.types.Context, obj: bpy.types.Object, laid: NamedSkeleton) -> Messages:
        """Build objects for the bones, and return what is to be told of them."""
        raise NotImplementedError


def _warnings_of_reference(mesh: bpy.types.Mesh) -> list[str]:
    """Return the warning about a registered mesh whose reference has no bones that it could be given."""
    reference = reference_of(read(mesh))
    # An object that was deleted lives on where others refer to it, but nothing can be created for it.
    if reference is None or not reference.users_scene or read(mesh_of(reference)).bone_layout is not None:
        return []
    return [bone_layout.NO_BONES.format(reference.name)]


def part_names(mesh: bpy.types.Mesh, skeleton: compute.Skeleton) -> dict[int, str]:
    """Return the names of the parts that bones lie in."""
    parts = read(mesh).parts
    return {part: parts.name_of(part) for part in np.unique(skeleton.part).tolist()}


def _other_poses(context: bpy.types.Context) -> tuple[NDArray[np.float64], ...]:
    """Return the vertices of the other selected meshes that have the same faces: the same body in other poses."""
    active = present(context.object)
    others = [obj for obj in context.selected_objects if obj is not active and obj.type == "MESH"]
    poses = [obj for obj in others if not mesh_of(obj).is_editmode and _share_faces(mesh_of(obj), mesh_of(active))]
    return tuple(_pose(context, obj) * (size_of(obj) / size_of(active)) for obj in poses)


def _pose(context: bpy.types.Context, obj: bpy.types.Object) -> NDArray[np.float64]:
    with in_name_of(obj.name):
        return mesh_arrays.read_object(context, obj, use_modifiers=False).vertices


def _share_faces(first: bpy.types.Mesh, second: bpy.types.Mesh) -> bool:
    # Which diagonal cuts a quad depends on the pose, so triangles are not compared.
    return len(first.vertices) == len(second.vertices) and all(
        np.array_equal(read(first), read(second))
        for read in (mesh_arrays.vertex_of_corner, mesh_arrays.polygon_of_triangle)
    )
