"""Operator: cut the mesh along the borders of its parts."""

import bpy
import numpy as np
from bpy.props import EnumProperty

from ... import compute
from ..mesh_data.custom_normals import normals_kept
from ..mesh_data.mesh_arrays import read_mesh
from ..mesh_data.mesh_cut import cut_mesh
from ..mesh_state import corrected_analysis, corrections, part_table, registration_record, state
from ..messages.sentences import tell
from ..messages.user_errors import Refusal, can_use_active_mesh, refusals_told
from ..outputs import part_writer
from ..outputs.rollback import all_or_nothing, faces_or_nothing
from . import paint

# A part that a cut changes by more than this fraction of the whole area is told of.
NOTABLE_CHANGE = 0.05


class EIGENPARTS_OT_cut(bpy.types.Operator):
    """Make the borders of the parts run along edges"""

    bl_idname = "eigenparts.cut"
    bl_label = "Cut Borders"
    bl_options = {"REGISTER", "UNDO"}

    method: EnumProperty(
        name="Method",
        description="How edges come to lie on the borders",
        items=[
            ("INSERT", "Insert Edges", "Cut the faces that borders cross; all that the mesh carries is interpolated"),
            ("EXISTING", "Existing Edges", "Leave the mesh as it is, and move borders to short lines of its edges"),
        ],
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context) and state.is_analyzed_for(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        with refusals_told(self):
            registration_record.refuse_registered(context.object.data)
            n_before, shares = len(context.object.data.polygons), _shares(context.object.data)
            with all_or_nothing(context.object.data), faces_or_nothing(context.object.data):
                if self.method == "INSERT":
                    insert_borders(context.object)
                else:
                    move_borders(context.object.data)
            if self.method == "INSERT":
                _tell_change(self, context.object.data, shares)
            n_new = len(context.object.data.polygons) - n_before
            tell(self, "INFO", f"{n_new} faces were added." if n_new else "The borders run along edges.")
            return {"FINISHED"}
        return {"CANCELLED"}


def insert_borders(obj: bpy.types.Object) -> None:
    """Cut the mesh of an object along the borders of the parts that it shows.

    Raises
    ------
    Refusal
        If others use the mesh too, or it cannot be cut; nothing is changed then.
    """
    mesh = obj.data
    _refuse_shared(obj)
    part_writer.refuse_foreign_results(mesh)
    analysis, source = state.load(mesh), state.load_source(mesh)
    level, mode = state.summarize(mesh).level, state.mode_of(mesh)
    profile, crossings = corrected_analysis.crossings(mesh, source)
    arcs = analysis.part_tree.arcs_of_faces
    with normals_kept(mesh):
        faces = cut_mesh(mesh, crossings, np.stack(profile.arcs, axis=1).astype(np.int64))
    for number, arc in enumerate(arcs):
        arcs[number] = np.concatenate([arc, arc[faces.origin]])
        arcs[number][faces.face] = faces.arcs[:, number]
    _show(mesh, arcs, level, mode)


def move_borders(mesh: bpy.types.Mesh) -> None:
    """Move the borders of the parts that a mesh shows to short lines of its edges."""
    part_writer.refuse_foreign_results(mesh)
    analysis = state.load(mesh)
    level, mode = state.summarize(mesh).level, state.mode_of(mesh)
    labels = part_writer.read_labels(mesh)
    moved = compute.shortened_borders(labels, _face_graph(mesh))
    if corrected_analysis.items_of(mesh):
        # Faces that were given to a part by hand do not follow arcs, so these are given to theirs in the same way.
        paint.repaint(mesh, np.where(moved != labels, moved, corrections.read_painted(mesh)))
        return
    cuts = analysis.part_tree.cut_arcs(level, mode)
    arcs = analysis.part_tree.arcs_of_faces
    for arc, cut in zip(arcs, cuts, strict=True):
        # The last arc of a tree is a root, which is body at every level.
        arc_of_part = np.full(int(moved.max(initial=0)) + 1, len(cut) - 1)
        ends = np.flatnonzero((cut > 0) & (cut < len(arc_of_part)))
        arc_of_part[cut[ends]] = ends
        arc[moved != labels] = arc_of_part[moved[moved != labels]]
    _show(mesh, arcs, level, mode)


def _show(mesh: bpy.types.Mesh, arcs: list[np.ndarray], level: int, mode: str) -> None:
    """Store new arcs of the faces, and divide the mesh as before."""
    graph = _face_graph(mesh)
    state.store_branches(mesh, compute.connected_branches([arc[graph.stands_for] for arc in arcs], graph))
    part_writer.segment_mesh(mesh, level=level, mode=mode)


def _face_graph(mesh: bpy.types.Mesh) -> "compute.FaceGraph":
    arrays = read_mesh(mesh)
    triangles = compute.TriangleMesh(arrays.vertices, arrays.triangles)
    surface = compute.analyzed_surface(triangles, state.shells_of(mesh))
    return compute.face_graph(triangles, surface, arrays.polygon_of_triangle)


def _shares(mesh: bpy.types.Mesh) -> dict[int, float]:
    return {part: share for part, share, _ in state.summarize(mesh).parts}


def _tell_change(operator: bpy.types.Operator, mesh: bpy.types.Mesh, before: dict[int, float]) -> None:
    """Tell which part a cut has changed most if that is notable: what hangs together within faces only falls apart."""
    after = _shares(mesh)
    change = {part: abs(after.get(part, 0.0) - before.get(part, 0.0)) for part in {**before, **after} if part}
    part = max(change, key=change.__getitem__, default=0)
    if part and change[part] > NOTABLE_CHANGE:
        name, old, new = part_table.name_of(mesh, part), before.get(part, 0.0), after.get(part, 0.0)
        tell(
            operator,
            "WARNING",
            f"{name} had {old:.0%} of the area and has {new:.0%} now, as parts meet within single faces there; "
            "undo and choose another level if it should not.",
        )


def _refuse_shared(obj: bpy.types.Object) -> None:
    n_users = obj.data.users - obj.data.use_fake_user
    if n_users > 1:
        raise Refusal(f"The mesh is used {n_users} times; make it single-user first, so that only this object is cut.")
    if any(modifier.type == "MULTIRES" for modifier in obj.modifiers):
        raise Refusal("Cutting would lose the details of the Multiresolution modifier; apply it first.")


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_cut,))
