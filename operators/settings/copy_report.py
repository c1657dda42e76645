"""Operator: put what a bug report needs on the clipboard."""

import platform
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path

import bpy
import numpy as np

from ...tasks.refusals import Refusal
from ..blender.known_values import mesh_of, present
from ..blender.outcome import Outcome
from ..blender.registered_settings import analysis_settings, job_status
from ..mesh_state.state import read
from ..messages import unexpected_errors
from ..messages.sentences import tell

MANIFEST = Path(__file__).parents[2] / "blender_manifest.toml"


class EIGENPARTS_OT_copy_report(bpy.types.Operator):
    """Copy what a bug report needs: versions, numbers about the active mesh, messages and the last error; no paths"""

    bl_idname = "eigenparts.copy_report"
    bl_label = "Copy Bug Report"
    bl_options = set()

    def execute(self, context: bpy.types.Context) -> Outcome:
        present(context.window_manager).clipboard = report(context)
        tell(self, "INFO", "The bug report is on the clipboard; paste it where you report the problem.")
        return {"FINISHED"}


def report(context: bpy.types.Context) -> str:
    """Return lines that tell a developer what was used on what."""
    lines = [*_versions(), *_facts_of_scene(context), *_facts_of_object(context.object)]
    if job_status(context).problem:
        lines.append(f"Last message: {job_status(context).problem}")
    fault = unexpected_errors.last()
    if fault is not None:
        lines += ["Last error:", fault.report]
    return "\n".join(lines) + "\n"


def _versions() -> list[str]:
    return [
        f"Eigenparts {tomllib.loads(MANIFEST.read_text())['version']}",
        f"Blender {bpy.app.version_string} ({bpy.app.build_hash.decode()})",
        f"System: {platform.system()} {platform.release()}, {platform.machine()}",
        f"Python {sys.version.split()[0]}, numpy {np.__version__}, scipy {_version_of_scipy()}",
    ]


def _version_of_scipy() -> str:
    """Return it without loading scipy, which may be what is broken."""
    if "scipy" in sys.modules:
        return sys.modules["scipy"].__version__
    return "not loaded yet" if find_spec("scipy") else "missing"


def _facts_of_scene(context: bpy.types.Context) -> list[str]:
    settings = analysis_settings(context)
    names = ("field", "eigenfunction", "order", "boundary", "shells", "borders")
    chosen = [f"{name}={getattr(settings, name)}" for name in names]
    return [f"Settings: {', '.join(chosen)}, use_modifiers={settings.use_modifiers}"]


def _facts_of_object(obj: bpy.types.Object | None) -> list[str]:
    if obj is None or obj.type != "MESH":
        return ["No mesh is active."]
    mesh = mesh_of(obj)
    n_keys = len(mesh.shape_keys.key_blocks) if mesh.shape_keys else 0
    return [
        f"Mesh: {len(mesh.vertices)} vertices, {len(mesh.edges)} edges, {len(mesh.polygons)} faces, "
        f"{len(mesh.loops)} corners, mode {obj.mode}, {mesh.users} users",
        f"Modifiers: {', '.join(modifier.type for modifier in obj.modifiers) or 'none'}; {n_keys} shape keys; "
        f"scale {obj.scale.x:g} {obj.scale.y:g} {obj.scale.z:g}; "
        f"size {obj.dimensions.x:g} {obj.dimensions.y:g} {obj.dimensions.z:g}",
        _facts_of_analysis(mesh),
    ]


def _facts_of_analysis(mesh: bpy.types.Mesh) -> str:
    try:
        summary = read(mesh).summary
    except Refusal as refusal:
        return f"Analysis: {refusal}"
    return (
        f"Analysis: {summary.description}, level {summary.level} of {summary.n_levels - 1}, {len(summary.parts)} parts"
    )


register, unregister = bpy.utils.register_classes_factory((EIGENPARTS_OT_copy_report,))
