"""Operator: give the selected meshes what the active one has, from weights to materials."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
from numpy.typing import NDArray

from ...tasks.layer_mapping import MappedLayers, map_to_all
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.registered_settings import transfer_settings
from ..jobs.background import BackgroundOperator
from ..jobs.mesh_handle import MeshHandle
from ..mesh_data.selected_meshes import other_meshes
from ..mesh_state.point_pairs import points_between
from ..registration.register_selected import can_start_with_others
from . import mesh_transfer
from .layer_reading import LayerChoice
from .layer_writing import Mix
from .mesh_transfer import TransferSettings, TransferSource
from .transfer_options import TransferOptions

NOTHING_ELSE = "Select the meshes to transfer to, and last the one to transfer from."


@dataclass(frozen=True, eq=False)
class TransferHandles:
    """The layers that were read, and the objects that get them."""

    source: TransferSource
    targets: tuple[MeshHandle, ...]
    settings: TransferSettings


class EIGENPARTS_OT_transfer(TransferOptions, BackgroundOperator, bpy.types.Operator):
    """Gives all selected meshes what the active one has."""

    bl_idname = "eigenparts.transfer"
    bl_description = (
        "Give all selected meshes what the active one has: weights, shape keys, UV maps, colors, materials; "
        "pose, resolution and order of the vertices may differ"
    )
    bl_label = "Transfer"
    bl_options = {"UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_start_with_others(cls, context, NOTHING_ELSE)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> Outcome:
        """From the window: what the call leaves open is taken from the panel."""
        for name in TransferOptions.__annotations__:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(transfer_settings(context), name))
        return super().invoke(context, event)

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., list[MappedLayers]], TransferHandles]:
        targets, settings = other_meshes(context), self.transfer_settings()
        if not targets:
            raise Refusal(NOTHING_ELSE)
        source = mesh_transfer.read_source(context, present(context.object), settings)
        shapes = [
            mesh_transfer.read_target(context, obj, source, settings, points_between(context, context.object, obj))
            for obj in targets
        ]
        handles = TransferHandles(source, tuple(MeshHandle.of(obj) for obj in targets), settings)
        work = partial(map_to_all, fills=settings.fills_unsure, method=settings.method)
        return partial(work, source.shape, source.layers, shapes), handles

    def finish(self, context: bpy.types.Context, handles: TransferHandles, mapped: list[MappedLayers]) -> Outcome:
        objects = [handle.find_object() for handle in handles.targets]
        for messages in mesh_transfer.write_all(objects, mapped, handles.source, handles.settings):
            messages.report(self)
        if self.selects_unsure:
            for obj, layers in zip(objects, mapped, strict=True):
                _select(mesh_of(obj), ~layers.is_sure)
        return {"FINISHED"}

    def transfer_settings(self) -> TransferSettings:
        """Return the properties of the operator as values."""
        names = tuple(name.strip() for name in self.group_names.split(",") if name.strip())
        choice = LayerChoice(frozenset(self.layers), self.groups, names, self.mirrored)
        fills, method = self.unsure == "FILL", self.method.lower()
        return TransferSettings(choice, Mix(self.factor, self.mask), fills, self.use_modifiers, method)


def _select(mesh: bpy.types.Mesh, is_selected: NDArray[np.bool_]) -> None:
    """Select vertices and nothing else."""
    mesh.vertices.foreach_set("select", is_selected)
    # Where these are absent nothing is selected. Blender 5.0 makes edges from Python with one of a wrong type, and
    # ends when it is written to.
    for name in (".select_edge", ".select_poly"):
        attribute = mesh.attributes.get(name)
        if attribute is not None:
            mesh.attributes.remove(attribute)
    mesh.update()


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_transfer,))
