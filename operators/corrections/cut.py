"""Operator: cut the mesh along the borders of its parts."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.typed_properties import EnumProperty, TypedProperties
from ..mesh_data.custom_normals import normals_kept
from ..mesh_data.mesh_cut import cut_mesh
from ..mesh_state import analysis_writer, corrected_analysis, registration_record
from ..mesh_state.analyzed_faces import AnalyzedFaces
from ..mesh_state.state import MeshState, is_analyzed_for, read
from ..messages.sentences import tell
from ..messages.user_errors import can_use_active_mesh, refusals_told
from ..outputs import output_registry, part_writer
from ..outputs.rollback import all_or_nothing, faces_or_nothing
from . import paint

# A part that a cut changes by more than this fraction of the whole area is told of.
NOTABLE_CHANGE = 0.05


class EIGENPARTS_OT_cut(TypedProperties, bpy.types.Operator):
    """Make the borders of the parts run along edges"""

    bl_idname = "eigenparts.cut"
    bl_label = "Cut Borders"
    bl_options = {"REGISTER", "UNDO"}

    method: str = EnumProperty(
        name="Method",
        description="How edges come to lie on the borders",
        items=[
            ("INSERT", "Insert Edges", "Cut the faces that borders cross; all that the mesh carries is interpolated"),
            ("EXISTING", "Existing Edges", "Leave the mesh as it is, and move borders to short lines of its edges"),
        ],
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return can_use_active_mesh(cls, context) and is_analyzed_for(cls, context)

    def execute(self, context: bpy.types.Context) -> Outcome:
        with refusals_told(self):
            mesh = mesh_of(context.object)
            state, n_before = read(mesh), len(mesh.polygons)
            registration_record.refuse_registered(state.registration)
            shares = state.summary.shares
            with all_or_nothing(mesh):
                if self.method == "INSERT":
                    insert_borders(present(context.object), state)
                else:
                    move_borders(state)
            if self.method == "INSERT":
                _tell_change(self, read(mesh), shares)
            n_new = len(mesh.polygons) - n_before
            tell(self, "INFO", f"{n_new} faces were added." if n_new else "The borders run along edges.")
            return {"FINISHED"}
        return {"CANCELLED"}


def insert_borders(obj: bpy.types.Object, state: MeshState) -> None:
    """Cut the mesh of an object along the borders of the parts that it shows.

    Raises
    ------
    Refusal
        If others use the mesh too, or it cannot be cut; nothing is changed then.
    """
    mesh = mesh_of(obj)
    _refuse_shared(obj)
    output_registry.refuse_foreign_results(state)
    level, mode = state.level, state.mode
    profile, crossings = corrected_analysis.crossings(state, state.border_source)
    part_tree = state.analysis.part_tree
    cuts = part_tree.cut_arcs(level, mode, compute.Corrections(state.corrections).branch_levels)
    arcs, shown = part_tree.arcs_of_faces, _exact_at(part_tree, cuts)
    # From here on the faces are not what they were; a refusal before has not touched them.
    with faces_or_nothing(mesh):
        with normals_kept(mesh):
            faces = cut_mesh(mesh, crossings, np.stack(profile.arcs, axis=1).astype(np.int64), state.stretch)
        for of_faces in (arcs, shown):
            for number, arc in enumerate(of_faces):
                of_faces[number] = np.concatenate([arc, arc[faces.origin]])
                of_faces[number][faces.face] = faces.arcs[:, number]
        _show(state, arcs, shown, level, mode)


def _exact_at(part_tree: compute.PartTree, cuts: list[NDArray[np.int64]]) -> list[NDArray[np.int64]]:
    """Return the arcs that faces are shown in, their own where the parts of a level end elsewhere than they are cut."""
    shown = []
    for tree, cut, own, arc in zip(
        part_tree.trees, cuts, part_tree.arcs_of_faces, part_tree.shown_arcs_of_faces, strict=True
    ):
        part = tree.spread(cut)
        shown.append(np.where(part[arc] == part[own], arc, own))
    return shown


def move_borders(state: MeshState) -> None:
    """Move the borders of the parts that a mesh shows to short lines of its edges."""
    output_registry.refuse_foreign_results(state)
    analysis, level, mode = state.analysis, state.level, state.mode
    labels = part_writer.read_labels(state.mesh)
    moved = compute.shortened_borders(labels, state.faces.graph)
    if state.corrections:
        # Faces that were given to a part by hand do not follow arcs, so these are given to theirs in the same way.
        paint.repaint(state, np.where(moved != labels, moved, state.painted))
        return
    cuts = analysis.part_tree.cut_arcs(level, mode)
    arcs, shown = analysis.part_tree.arcs_of_faces, analysis.part_tree.shown_arcs_of_faces
    for arc, cut in zip(shown, cuts, strict=True):
        # The last arc of a tree is a root, which is body at every level.
        arc_of_part = np.full(int(moved.max(initial=0)) + 1, len(cut) - 1)
        ends = np.flatnonzero((cut > 0) & (cut < len(arc_of_part)))
        arc_of_part[cut[ends]] = ends
        arc[moved != labels] = arc_of_part[moved[moved != labels]]
    _show(state, arcs, shown, level, mode)


def _show(
    state: MeshState, arcs: list[NDArray[np.int64]], shown: list[NDArray[np.int64]], level: int, mode: str
) -> None:
    """Store new arcs of the faces, their own and those they are shown in, and divide the mesh as before."""
    faces = AnalyzedFaces(state.mesh, state.shells, state.stretch)
    own, of_parts = ([arc[faces.graph.stands_for] for arc in each] for each in (arcs, shown))
    branches = compute.connected_branches(own, faces.graph, of_parts)
    analysis_writer.store_branches(state.mesh, branches, faces.place_of_vertex)
    part_writer.segment_mesh(state.mesh, level=level, mode=mode)


def _tell_change(operator: bpy.types.Operator, state: MeshState, before: dict[int, float]) -> None:
    """Warn of the part that a cut has changed most if it is notable: what hangs together within faces falls apart."""
    after = state.summary.shares
    change = {part: abs(after.get(part, 0.0) - before.get(part, 0.0)) for part in {**before, **after} if part}
    part = max(change, key=change.__getitem__, default=0)
    if part and change[part] > NOTABLE_CHANGE:
        name, old, new = state.parts.name_of(part), before.get(part, 0.0), after.get(part, 0.0)
        tell(
            operator,
            "WARNING",
            f"{name} had {old:.0%} of the area and has {new:.0%} now, as parts meet within single faces there; "
            "undo and choose another level if it should not.",
        )


def _refuse_shared(obj: bpy.types.Object) -> None:
    n_users = mesh_of(obj).users - mesh_of(obj).use_fake_user
    if n_users > 1:
        raise Refusal(f"The mesh is used {n_users} times; make it single-user first, so that only this object is cut.")
    if any(modifier.type == "MULTIRES" for modifier in obj.modifiers):
        raise Refusal("Cutting would lose the details of the Multiresolution modifier; apply it first.")


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_cut,))
