"""The state of a mesh, read once for each action; the only place that opens it.

The trees and tables are plain numbers and texts in the mesh's custom properties; the branch of each face is an
attribute. So any level is one look-up: also after a load, an undo or on a copy. Nothing is trusted when it is read
back: a file may come from anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_analysis import BorderSource, StoredAnalysis
from ...tasks.mesh_shape import Stretch
from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of
from ..mesh_data.mesh_arrays import fingerprint
from ..mesh_data.world_shape import stands_as, users_of
from . import (
    bone_layout,
    corrections,
    function_hints,
    part_sides,
    part_table,
    registration_record,
    schema,
    stored_analysis,
)
from .analyzed_faces import AnalyzedFaces
from .part_table import PartTable
from .registration_record import Match, Registration
from .serialization import UNREADABLE
from .summary import Summary, unpacked_summary

STATE = "eigenparts_state"


@dataclass(frozen=True, eq=False)
class MeshState:
    """The state of a mesh: all that it remembers, as typed values.

    Each value is decoded and checked when it is first asked for, so that whoever needs a name pays for names only.
    What an action needs has to be asked for before it writes to the mesh.

    Attributes
    ----------
    mesh : Mesh
    stored : IDPropertyGroup or None
        As it is in the file: of any version, damaged, or none at all.
    """

    mesh: bpy.types.Mesh
    stored: Any

    def get(self, name: str) -> Any:
        """Return a stored value as it is, None where there is none."""
        return self.stored.get(name) if hasattr(self.stored, "to_dict") else None

    @cached_property
    def readable(self) -> Any:
        """The stored group; raises a Refusal if there is none, or it is of a version that is not known here."""
        if self.stored is None:
            raise Refusal(schema.ABSENT)
        if not isinstance(self.get(schema.VERSION), int):
            raise Refusal(schema.DAMAGED)
        self.refuse_newer()
        return self.stored

    def refuse_newer(self) -> None:
        """Raise a Refusal if a newer version has stored what would be replaced."""
        version = self.get(schema.VERSION)
        if isinstance(version, int) and version > schema.SCHEMA:
            raise Refusal(schema.NEWER)

    @cached_property
    def summary(self) -> Summary:
        """Field, level and parts; raises a Refusal if they cannot be read."""
        group = self.readable
        try:
            return unpacked_summary(group)
        except UNREADABLE as error:
            raise Refusal(schema.DAMAGED) from error

    def refuse_unreadable(self) -> None:
        """Raise a Refusal if level and parts cannot be read."""
        _ = self.summary, self.stretch

    @property
    def level(self) -> int:
        """The level that the mesh shows; raises a Refusal if it cannot be read."""
        return self.summary.level

    @property
    def shown_level(self) -> int:
        """The level that the mesh shows, 0 where it cannot be read."""
        return self.summary.level if self.is_readable else 0

    @property
    def n_parts(self) -> int:
        """The number of parts that the mesh shows, 0 where they cannot be read."""
        return len(self.summary.parts) if self.is_readable else 0

    @property
    def highest_level(self) -> int:
        """The highest level that the mesh can show, 0 where it cannot be read."""
        return self.summary.n_levels - 1 if self.is_readable else 0

    @cached_property
    def is_readable(self) -> bool:
        """Whether level and parts can be read."""
        try:
            self.refuse_unreadable()
        except Refusal:
            return False
        return True

    @cached_property
    def mode(self) -> str:
        """How levels were last read, with or without joints; in the default mode if they never were."""
        mode = self.get(schema.MODE)
        return mode if mode in compute.READINGS else compute.READINGS[0]

    @property
    def is_nested(self) -> bool:
        """Whether parts lie inside parts, so that there may be joints."""
        return compute.mode_of(self.mode) == compute.NESTED

    @cached_property
    def shells(self) -> str:
        """The choice for loose parts that the mesh was analyzed with."""
        shells = self.get(schema.SHELLS)
        return shells if shells in compute.SHELLS else compute.SHELLS[0]

    @cached_property
    def outputs(self) -> tuple[str, ...] | None:
        """The names of the outputs that were chosen, None if none ever were."""
        names = self.get(schema.OUTPUTS)
        return tuple(names.splitlines()) if isinstance(names, str) else None

    @cached_property
    def softness(self) -> float:
        """The width over which vertex groups are softened, in the unit of the world."""
        width = self.get(schema.SOFTNESS)
        return max(0.0, float(width)) if isinstance(width, int | float) else 0.0

    @cached_property
    def analysis(self) -> StoredAnalysis:
        """The analysis without corrections.

        Raises
        ------
        Refusal
            If there is none, or it is from a newer version, of another shape, or damaged.
        """
        if self.readable.get(schema.FINGERPRINT) != fingerprint(self.mesh):
            raise Refusal(schema.CHANGED)
        if not self.stands_as_analyzed:
            raise Refusal(schema.SCALED)
        return self.analysis_of_any_shape

    @cached_property
    def analysis_of_any_shape(self) -> StoredAnalysis:
        """The analysis, also where the mesh was moved since."""
        return stored_analysis.unpacked_analysis(self.mesh, self.readable, self.shells, self.stretch)

    @cached_property
    def stretch(self) -> Stretch:
        """The stretch that the mesh was analyzed with; raises a Refusal if it is damaged."""
        return stored_analysis.unpacked_stretch(self.get(schema.STRETCH))

    @property
    def stands_as_analyzed(self) -> bool:
        """Whether an object that uses the mesh has the scale that it was analyzed with."""
        users = users_of(self.mesh)
        return not users or any(stands_as(obj, self.stretch) for obj in users)

    def scale_problem(self, obj: bpy.types.Object) -> str:
        """Return what is wrong with the scale of an object that uses the mesh; empty if it is as it was analyzed."""
        if stands_as(obj, self.stretch):
            return ""
        others = [other for other in users_of(self.mesh) if stands_as(other, self.stretch)]
        return schema.OTHERWISE_SCALED.format(others[0].name) if others else schema.SCALED

    @cached_property
    def border_source(self) -> BorderSource:
        """The heights and arcs that borders are cut from; raises a Refusal if it is not there."""
        return stored_analysis.unpacked_source(self.mesh, self.readable, self.analysis.part_tree)

    @cached_property
    def faces(self) -> AnalyzedFaces:
        """The faces as they were analyzed; the longest to make."""
        return AnalyzedFaces(self.mesh, self.shells, self.stretch)

    @cached_property
    def corrections(self) -> tuple[compute.Correction, ...]:
        """The corrections by hand, as far as they make sense; cheap enough for every redraw."""
        return corrections.unpacked_items(self.stored)

    @cached_property
    def painted(self) -> NDArray[np.int64]:
        """The (F,) int64 part each face was painted with, -1 elsewhere."""
        return corrections.read_painted(self.mesh)

    @cached_property
    def redrawn(self) -> tuple[compute.PartTree, compute.Corrections] | None:
        """The part tree with its branches as corrections divide them; None if they have to be redrawn."""
        return corrections.read_redrawn(self.mesh, self.readable, self.analysis.part_tree, self.corrections)

    @cached_property
    def parts(self) -> PartTable:
        """Numbers, names and colours of the parts that are shown."""
        return part_table.unpacked_table(self.get)

    def pieces_of_parts(self, part_tree: compute.PartTree) -> dict[int, int]:
        """Return what piece of the surface each of the mesh's own parts is: as it is shown, or else by default."""
        by_default = part_tree.pieces_of_parts(part_tree.hierarchy.default_level)
        if self.registration is not None:
            return by_default | part_tree.pieces_of_parts(min(self.level, self.highest_level), self.mode)
        branch_levels = compute.Corrections(self.corrections).branch_levels
        return by_default | part_tree.pieces_of_parts(self.shown_level, self.mode, branch_levels)

    @cached_property
    def part_colours(self) -> PartTable:
        """The colours of the parts alone, which the list asks for at every redraw."""
        return part_table.unpacked_colours(self.get)

    @cached_property
    def registration(self) -> Registration | None:
        """The registration of the mesh; None if it shows parts of its own."""
        group = self.get(schema.REGISTRATION)
        return registration_record.unpacked_registration(group) if hasattr(group, "to_dict") else None

    @property
    def match(self) -> Match | None:
        """The match with another mesh; None if there is none, or what is stored makes no sense."""
        return None if self.registration is None else self.registration.match

    @property
    def own_parts(self) -> PartTable:
        """Numbers, names and colours of the mesh's own parts, also while it shows those of another."""
        return self.parts if self.registration is None else self.registration.own_parts

    @cached_property
    def function_hints(self) -> list[tuple[int, int, int]]:
        """(number, protrusions held, protrusions of the shape) of each judged function, the best first."""
        return function_hints.unpacked_hints(self.get(schema.FUNCTION_HINTS))

    @cached_property
    def part_sides(self) -> dict[int, tuple[int, int]]:
        """The sides of the parts, as far as they can be understood."""
        return part_sides.unpacked_sides(self.get(schema.PART_SIDES))

    @cached_property
    def bone_layout(self) -> compute.BoneLayout | None:
        """The layout of the bones; None if there is none, or it makes no sense."""
        return bone_layout.unpacked_layout(self.get(schema.BONE_LAYOUT))


def read(mesh: bpy.types.Mesh) -> MeshState:
    """Return what a mesh remembers."""
    return MeshState(mesh, mesh.get(STATE))


def remember(mesh: bpy.types.Mesh, values: dict[str, Any]) -> None:
    """Store values on an analyzed mesh in place of earlier ones; None removes one."""
    stored = mesh[STATE]
    for name, value in values.items():
        if value is not None:
            stored[name] = value
        elif name in stored:
            del stored[name]


def replace(mesh: bpy.types.Mesh, values: dict[str, Any]) -> None:
    """Store values in place of all that the mesh remembers."""
    mesh[STATE] = values


def forget(mesh: bpy.types.Mesh) -> None:
    """Remove the analysis; the attributes stay."""
    if is_analyzed(mesh):
        del mesh[STATE]


def is_analyzed(mesh: bpy.types.Mesh) -> bool:
    """Whether the mesh carries an analysis of any version."""
    return mesh.get(STATE) is not None


def is_analyzed_for(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """Whether the active mesh carries an analysis; if not, the tooltip says what to do."""
    if not is_analyzed(mesh_of(context.object)):
        operator.poll_message_set(schema.ABSENT)
    return is_analyzed(mesh_of(context.object))
