"""Operator: put the Morse-Smale complex of the field on the mesh, as curves and dots."""

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks.mesh_analysis import AnalyzedShape
from ...tasks.mesh_shape import Stretch
from ..blender.known_values import mesh_of, present
from ..blender.typed_properties import FloatProperty, IntProperty, TypedProperties
from ..mesh_data.world_shape import as_transform
from ..mesh_state.palette import COMPLEX_COLOURS
from ..mesh_state.palette import COMPLEX_ROLE as ROLE
from ..mesh_state.state import is_analyzed, read
from ..outputs.rollback import nothing_left_behind
from ..parts.fresh_analysis import FreshAnalysis

# The object whose complex a collection holds.
OF_OBJECT = "eigenparts_complex"
# Radius of lines and of dots, as fractions of the largest extent of the mesh.
LINE_RADIUS, DOT_RADIUS = 0.0015, 0.006
# Quads of a ball, around and from pole to pole.
DOT_SEGMENTS, DOT_RINGS = 16, 8


@dataclass(frozen=True, eq=False)
class TracedComplex:
    """Polylines and dots by role, in the coordinates of the shape.

    Attributes
    ----------
    lines : dict of list of (p, 3)
    dots : dict of (n, 3)
    """

    lines: dict[str, list[NDArray[np.float64]]]
    dots: dict[str, NDArray[np.float64]]


class EIGENPARTS_OT_trace_complex(FreshAnalysis, TypedProperties, bpy.types.Operator):
    """Put the critical points of the field on the active mesh, with the lines of steepest ascent between them"""

    bl_idname = "eigenparts.trace_complex"
    bl_label = "Trace Complex"
    bl_options = {"UNDO"}

    level: int = IntProperty(
        name="Level", description="How many features to keep; -1 for the level that the mesh shows", default=-1, min=-1
    )
    thickness: float = FloatProperty(
        name="Thickness", description="How thick lines and dots are, as a multiple of the usual", default=1.0, min=0.01
    )

    def show(self, context: bpy.types.Context, owner: bpy.types.Object, shape: AnalyzedShape) -> str:
        analysis = shape.analysis
        traced = traced_complex(analysis, self.level if self.level >= 0 else shown_level(mesh_of(owner), analysis))
        size = self.thickness * float(np.ptp(analysis.mesh.vertices, axis=0).max())
        with nothing_left_behind(context):
            lines = {role: curve_of(role, lines, LINE_RADIUS * size) for role, lines in traced.lines.items()}
            dots = {role: dots_of(role, places, DOT_RADIUS * size) for role, places in traced.dots.items()}
            # What is there from before goes only when there is something to take its place.
            collection = empty_collection(context, owner.name)
            for role, data in {**lines, **dots}.items():
                obj = add_object(collection, owner, role, data, shape.stretch)
                if role in dots:
                    obj["places"] = traced.dots[role].ravel().tolist()
        n_dots = sum(len(places) for places in traced.dots.values())
        return f'{n_dots} critical points are in the collection "{collection.name}".'


def shown_level(mesh: bpy.types.Mesh, analysis: "compute.Analysis") -> int | None:
    """Return the level that a mesh shows, as far as the analysis has so many; None if it shows none."""
    return min(read(mesh).level, analysis.hierarchy.n_levels - 1) if is_analyzed(mesh) else None


def traced_complex(analysis: "compute.Analysis", level: int | None) -> TracedComplex:
    """Return the lines and dots of a level."""
    found = analysis.complex_at_level(level)
    points, separatrices = found.critical_points, found.separatrices
    places = analysis.net.positions[points.vertex]
    lines: dict[str, list[NDArray[np.float64]]] = {"rising": [], "falling": []}
    for rises, line in zip(separatrices.rises, separatrices.lines, strict=True):
        lines["rising" if rises else "falling"].append(line)
    lines["level"] = [line for saddle in points.value[points.kind == 1] for line in found.level_lines(saddle)]
    dots = {role: places[points.kind == kind] for kind, role in enumerate(("minimum", "saddle", "maximum"))}
    return TracedComplex(lines, dots)


def empty_collection(context: bpy.types.Context, name: str) -> bpy.types.Collection:
    """Return the collection for the complex of an object, with nothing in it."""
    collection = next((c for c in bpy.data.collections if c.get(OF_OBJECT) == name), None)
    if collection is None:
        collection = bpy.data.collections.new(f"Complex of {name}")
        collection[OF_OBJECT] = name
    if name_of_scene_collection(context, collection) is None:
        present(context.scene).collection.children.link(collection)
    for old in [obj for obj in collection.objects if obj.get(ROLE) is not None]:
        data = present(old.data)
        bpy.data.objects.remove(old)
        if data.users == 0:
            bpy.data.batch_remove([data])
    return collection


def name_of_scene_collection(context: bpy.types.Context, collection: bpy.types.Collection) -> str | None:
    """Return the name of a collection if it is in the scene."""
    return next((c.name for c in present(context.scene).collection.children_recursive if c == collection), None)


def add_object(
    collection: bpy.types.Collection, owner: bpy.types.Object, role: str, data: bpy.types.ID, stretch: Stretch
) -> bpy.types.Object:
    """Put data that lies in the shape of the mesh in its place, following it."""
    obj = bpy.data.objects.new(data.name, data)
    obj[ROLE] = role
    obj.parent = owner
    # Scaled as the owner, dots would be flattened with it.
    obj.matrix_parent_inverse = as_transform(stretch.inverse)
    obj.color.foreach_set((*COMPLEX_COLOURS[role], 1.0))
    collection.objects.link(obj)
    return obj


def curve_of(role: str, lines: list[NDArray[np.float64]], radius: float) -> bpy.types.Curve:
    """Return a round curve with a spline for each line."""
    curve = bpy.data.curves.new(f"{role.capitalize()} lines", "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = radius
    curve.bevel_resolution = 1
    for line in lines:
        spline = curve.splines.new("POLY")
        spline.points.add(len(line) - 1)
        spline.points.foreach_set("co", np.column_stack([line, np.ones(len(line))]).ravel().astype(np.float32))
    curve.materials.append(material_of(role))
    return curve


def dots_of(role: str, places: NDArray[np.float64], radius: float) -> bpy.types.Mesh:
    """Return a mesh of small balls."""
    ball, faces = _ball()
    vertices = (places[:, None] + radius * ball).reshape(-1, 3)
    mesh = bpy.data.meshes.new(f"{role.capitalize()} dots")
    offsets = len(ball) * np.arange(len(places))[:, None, None]
    mesh.from_pydata(vertices.tolist(), [], (faces + offsets).reshape(-1, 4).tolist())
    mesh.shade_smooth()
    mesh.materials.append(material_of(role))
    return mesh


def material_of(role: str) -> bpy.types.Material:
    """Return the material of a role, which shows its colour in every shading."""
    material = next((m for m in bpy.data.materials if m.get(ROLE) == role), None)
    if material is None:
        material = bpy.data.materials.new(f"Complex {role}")
        material[ROLE] = role
        material.diffuse_color.foreach_set((*COMPLEX_COLOURS[role], 1.0))
    return material


def _ball() -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return a ball of radius 1 made of quads; those at the poles are flat."""
    turn, fall = np.meshgrid(np.arange(DOT_SEGMENTS), np.arange(DOT_RINGS + 1), indexing="ij")
    longitude, latitude = 2 * np.pi * turn / DOT_SEGMENTS, np.pi * fall / DOT_RINGS
    ring = np.sin(latitude)
    places = np.stack([ring * np.cos(longitude), ring * np.sin(longitude), np.cos(latitude)], axis=-1)
    number = turn * (DOT_RINGS + 1) + fall
    following = np.roll(number, -1, axis=0)
    quads = np.stack([number[:, :-1], number[:, 1:], following[:, 1:], following[:, :-1]], axis=-1)
    return places.reshape(-1, 3), quads.reshape(-1, 4)


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_trace_complex,))
