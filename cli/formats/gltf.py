"""glTF, as one file (.glb) or several (.gltf)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from .gltf_file import Table, parse_gltf, rows_of
from .open_file import OpenFile, open_file
from .own_attributes import claim_own_attributes
from .part_materials import give_parts_materials, has_colours_of_user
from .repairs import other_faces, refuse_no_numbers

# What contents can raise that nobody has looked at; the importer is asked then, and says what is wrong.
DAMAGED = (KeyError, IndexError, TypeError, ValueError, AttributeError)
TRIANGLES, FLOAT32 = 4, 5126


def read_gltf(path: Path) -> OpenFile:
    """Open a file whose tables fit together."""
    n_listed, n_not_finite = _counts(*parse_gltf(path))
    refuse_no_numbers(n_not_finite)
    # The shape of bones would be one mesh more.
    _call(bpy.ops.import_scene.gltf, filepath=str(path), disable_bone_shape=True)
    repairs = {
        mesh.name: [other_faces(n_listed[mesh.name], len(mesh.polygons))]
        for mesh in bpy.data.meshes
        if n_listed.get(mesh.name, len(mesh.polygons)) != len(mesh.polygons)
    }
    return open_file(claim_own_attributes(repairs))


def write_gltf(path: Path, file: OpenFile) -> None:
    """Write all objects of the scene, with the parts in the names of materials."""
    give_parts_materials()
    _call(
        bpy.ops.export_scene.gltf,
        filepath=str(path),
        export_format="GLB",
        check_existing=False,
        export_extras=True,
        export_cameras=True,
        export_lights=True,
        export_all_influences=True,
        export_vertex_color="ACTIVE" if has_colours_of_user() else "MATERIAL",
    )


def _call(operator: Any, **options: object) -> None:
    """Call an operator with those of some options that it has in this version."""
    known = operator.get_rna_type().properties
    operator(**{name: value for name, value in options.items() if name in known})


def _counts(table: Table, buffers: list[memoryview]) -> tuple[dict[str, int], dict[str, int]]:
    """Return how many faces of each mesh are listed, and how many points are no numbers, as far as that is known."""
    try:
        return _n_faces(table), _n_not_finite(table, buffers)
    except DAMAGED:
        return {}, {}


def _n_faces(table: Table) -> dict[str, int]:
    """Return how many triangles each mesh has, where nothing but triangles is listed and the name is its own."""
    counts: dict[str, list[int]] = {}
    for name, primitives in _meshes(table):
        is_plain = all(primitive.get("mode", TRIANGLES) == TRIANGLES for primitive in primitives)
        corners = [primitive.get("indices", primitive["attributes"]["POSITION"]) for primitive in primitives]
        n_triangles = sum(table["accessors"][number]["count"] // 3 for number in corners)
        counts.setdefault(name, []).append(n_triangles if is_plain else -1)
    return {name: found[0] for name, found in counts.items() if len(found) == 1 and found[0] >= 0}


def _n_not_finite(table: Table, buffers: list[memoryview]) -> dict[str, int]:
    """Return how many points of each mesh are no numbers."""
    return {
        name: sum(_n_bad(table, number, buffers) for number in {part["attributes"]["POSITION"] for part in primitives})
        for name, primitives in _meshes(table)
    }


def _n_bad(table: Table, number: int, buffers: list[memoryview]) -> int:
    accessor = table["accessors"][number]
    if "bufferView" not in accessor or accessor["componentType"] != FLOAT32:
        return 0
    view = table["bufferViews"][accessor["bufferView"]]
    start, strides = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), (view.get("byteStride", 12), 4)
    places: NDArray[np.float32] = np.ndarray((accessor["count"], 3), "<f4", buffers[view["buffer"]], start, strides)
    return int((~np.isfinite(places).all(axis=1)).sum())


def _meshes(table: Table) -> Iterator[tuple[str, list[Table]]]:
    """Yield the name of each mesh, and those of its primitives that have points."""
    for number, mesh in enumerate(rows_of(table, "meshes")):
        primitives = [part for part in rows_of(mesh, "primitives") if "POSITION" in part.get("attributes", ())]
        yield mesh.get("name") or f"Mesh_{number}", primitives
