"""Operator: give the selected meshes what the active one has, from weights to materials."""

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, PointerProperty, StringProperty

from ..jobs.background import BackgroundOperator
from ..mesh_data import mesh_arrays
from ..mesh_state import registration_record
from ..mesh_state.state import is_analyzed, read
from ..messages.sentences import tell
from ..messages.user_errors import Refusal, in_name_of, refuse_unwritable
from ..parts.analyze import Ticket, find_mesh
from ..registration.register_selected import can_start_with_others, other_meshes
from .layer_reading import Choice, read_layers
from .layer_rollback import layers_or_nothing
from .layer_transferring import Body, Transferred, transfer_bodies
from .layer_writing import Mix, refuse_obstacles, write_layers
from .layers import PARTS, Layer

NOTHING_ELSE = "Select the meshes to transfer to, and last the one to transfer from."
HAS_PARTS = "{} was analyzed and keeps its own parts; Register Selected gives it those of {}."
FOUND_BY = {
    "number": "Vertices correspond by their numbers.",
    "faces": "The faces are the same under other numbers.",
    "shape": "Matched by shape.",
}


@dataclass(frozen=True, eq=False)
class Destination:
    """Where transferred layers belong."""

    source: str
    colours: np.ndarray
    objects: tuple[int, ...]
    tickets: tuple[Ticket, ...]


class TransferOptions:
    """What is transferred and how; the scene keeps it for the panel, the operator takes it from scripts."""

    layers: EnumProperty(
        name="Layers",
        description="What the other meshes are given",
        options={"ENUM_FLAG"},
        items=[
            ("GROUPS", "Vertex Groups", "Weights, such as those of an armature"),
            ("SHAPE_KEYS", "Shape Keys", "Turned as the surface is turned; the other mesh must have a Basis"),
            ("UVS", "UV Maps", "With their seams on the edges that are next to them"),
            ("COLORS", "Colors", "Color attributes of vertices and face corners"),
            ("ATTRIBUTES", "Vertex Attributes", "All other attributes of vertices"),
            ("FACES", "Face Attributes", "Face sets and other attributes of faces, by majority"),
            ("MATERIALS", "Materials", "Slots and what is assigned to the faces"),
            ("PARTS", "Parts", "Labels and colors of parts, for meshes that are not analyzed themselves"),
        ],
        default={"GROUPS"},
    )
    groups: EnumProperty(
        name="Groups",
        description="Which of the vertex groups the other meshes are given",
        items=[
            ("ALL", "All", "All vertex groups"),
            ("DEFORM", "Deform Bones", "Those of bones that deform the mesh"),
            ("NAMED", "Named", "Those that are named"),
        ],
    )
    group_names: StringProperty(name="Names", description="Names of vertex groups with commas between them")
    factor: FloatProperty(
        name="Mix",
        description="How much of what is there is replaced: 0 for nothing, 1 for all of it",
        subtype="FACTOR",
        min=0,
        max=1,
        default=1,
    )
    mask: StringProperty(
        name="Mask",
        description="Name of a vertex group of the other meshes: something is written only where it has weight",
    )
    unsure: EnumProperty(
        name="Unsure",
        description="What is written to vertices whose place on the active mesh is not sure",
        items=[
            ("TAKE", "Take Over", "What is found at the most likely place"),
            ("FILL", "Fill In", "What fits smoothly to the sure vertices around them"),
        ],
        default="FILL",
    )
    selects_unsure: BoolProperty(
        name="Select Unsure", description="Select the vertices whose place is not sure, and no others"
    )
    mirrored: BoolProperty(
        name="Mirrored",
        description="The other meshes are mirror images, such as a left glove and a right one; left and right are"
        " swapped in names",
    )
    use_modifiers: BoolProperty(
        name="With Modifiers", description="Match the shapes as modifiers leave them; they must not change the faces"
    )


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

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """From the window: what the call leaves open is taken from the panel."""
        for name in TransferOptions.__annotations__:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(context.scene.eigenparts_transfer, name))
        return super().invoke(context, event)

    def begin(self, context: bpy.types.Context) -> tuple[Callable[..., list[Transferred]], Destination]:
        source, targets = context.object, other_meshes(context)
        if not targets:
            raise Refusal(NOTHING_ELSE)
        bodies = [_read(context, obj, source, self.use_modifiers) for obj in (source, *targets)]
        given = read_layers(source, self._choice())
        for obj in targets:
            refuse_obstacles(obj, given, self._mix())
        fills = self.unsure == "FILL"
        work = partial(_transfer, bodies[0], given, bodies[1:], self.mirrored, fills)
        tickets = tuple(Ticket(obj.data.session_uid, mesh_arrays.fingerprint(obj.data)) for obj in targets)
        return work, Destination(
            source.name, _part_colours(source.data, given), tuple(obj.session_uid for obj in targets), tickets
        )

    def finish(self, context: bpy.types.Context, destination: Destination, transferred: list[Transferred]) -> set[str]:
        objects = [_find(uid, ticket) for uid, ticket in zip(destination.objects, destination.tickets, strict=True)]
        for obj, result in zip(objects, transferred, strict=True):
            refuse_obstacles(obj, result.layers, self._mix())
        with ExitStack() as all_of_them:
            for obj, result in zip(objects, transferred, strict=True):
                all_of_them.enter_context(layers_or_nothing(obj, result.layers))
                write_layers(obj, result.layers, self._mix(), destination.colours)
        for obj, result in zip(objects, transferred, strict=True):
            if self.selects_unsure:
                _select(obj.data, ~result.is_sure)
            self._tell(obj, destination.source, result)
        return {"FINISHED"}

    def _choice(self) -> Choice:
        names = tuple(name.strip() for name in self.group_names.split(",") if name.strip())
        if not self.layers:
            raise Refusal("Choose at least one layer to transfer.")
        return Choice(frozenset(self.layers), self.groups, names, self.mirrored)

    def _mix(self) -> Mix:
        return Mix(self.factor, self.mask)

    def _tell(self, obj: bpy.types.Object, source: str, result: Transferred) -> None:
        n_layers = len(result.layers)
        given = f"{obj.name}: {n_layers} layers of {source}." if n_layers > 1 else f"{obj.name}: 1 layer of {source}."
        tell(self, "INFO", given, FOUND_BY[result.found_by], self._unsure(result))
        if result.confidence <= registration_record.SURE:
            tell(self, "WARNING", f"{obj.name} is matched with a confidence of {result.confidence:.0%} only.")
        for name in result.torn_seams:
            tell(self, "WARNING", f'{obj.name}: the seams of "{name}" could not be kept, there are too many pieces.')
        if is_analyzed(obj.data) and any(layer.kind == PARTS for layer in result.layers):
            tell(self, "WARNING", HAS_PARTS.format(obj.name, source))

    def _unsure(self, result: Transferred) -> str:
        """Return how many vertices are unsure; empty if all are sure."""
        n_unsure, n_vertices = int((~result.is_sure).sum()), len(result.is_sure)
        if n_unsure and self.unsure == "FILL":
            return f"{n_unsure} of {n_vertices} vertices are unsure and were filled in."
        return f"{n_unsure} of {n_vertices} vertices are unsure." if n_unsure else ""


def _transfer(
    source: Body,
    given: list[Layer],
    targets: list[Body],
    mirrored: bool,
    fills: bool,
    progress: Callable[[float, str], None],
) -> list[Transferred]:
    return transfer_bodies(source, given, targets, mirrored=mirrored, fills=fills, progress=progress)


def _read(context: bpy.types.Context, obj: bpy.types.Object, source: bpy.types.Object, use_modifiers: bool) -> Body:
    """Return what of an object goes into the job, or say by its name why nothing can."""
    with in_name_of(obj.name):
        refuse_unwritable(obj.data)
        arrays = mesh_arrays.read_object(context, obj, use_modifiers)
    return body_of(obj, arrays, *_wishes(obj.data, source))


def body_of(
    obj: bpy.types.Object, arrays: mesh_arrays.MeshArrays, flips: Mapping[int, int] | None = None, alternative: int = 0
) -> Body:
    """Return an object in the form that layers are transferred in, with what the user chose of its matchings."""
    mesh = obj.data
    corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    n_corners = mesh_arrays.n_corners_of_polygon(mesh)
    polygon = np.repeat(np.arange(len(n_corners)), n_corners)
    vertex = mesh_arrays.vertex_of_corner(mesh).astype(np.int64)
    return Body(obj.name, arrays, corners.reshape(-1, 3).astype(np.int64), vertex, polygon, flips or {}, alternative)


def _wishes(mesh: bpy.types.Mesh, source: bpy.types.Object) -> tuple[dict[int, int], int]:
    """Return the signs and the alternative that the user chose if the mesh is registered to the source."""
    match = read(mesh).match
    if match is None or match.reference != source.name:
        return {}, 0
    return {int(number): sign for number, sign in match.flips.items()}, match.alternative


def _part_colours(mesh: bpy.types.Mesh, given: list[Layer]) -> np.ndarray:
    highest = max((int(layer.values.max(initial=0)) for layer in given if layer.kind == PARTS), default=0)
    return read(mesh).parts.colours_of(highest + 1)


def _find(session_uid: int, ticket: Ticket) -> bpy.types.Object:
    find_mesh(ticket)
    obj = next((obj for obj in bpy.data.objects if obj.session_uid == session_uid), None)
    if obj is None:
        raise Refusal("An object was deleted meanwhile.")
    return obj


def _select(mesh: bpy.types.Mesh, is_selected: np.ndarray) -> None:
    """Select vertices and nothing else."""
    mesh.vertices.foreach_set("select", is_selected)
    # Where these are absent nothing is selected. Blender 5.0 makes edges from Python with one of a wrong type, and
    # ends when it is written to.
    for name in (".select_edge", ".select_poly"):
        found = mesh.attributes.get(name)
        if found is not None:
            mesh.attributes.remove(found)
    mesh.update()


class EigenpartsTransferSettings(TransferOptions, bpy.types.PropertyGroup):
    """The options the panel shows."""


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (EigenpartsTransferSettings, EIGENPARTS_OT_transfer)
)


def register() -> None:
    """Add the operator and the settings of the panel."""
    _register_classes()
    bpy.types.Scene.eigenparts_transfer = PointerProperty(type=EigenpartsTransferSettings)


def unregister() -> None:
    """Take them away again."""
    del bpy.types.Scene.eigenparts_transfer
    _unregister_classes()
