"""glTF, as one file (.glb) or several (.gltf)."""

from __future__ import annotations

import base64
import json
import struct
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import bpy
import numpy as np
from numpy.typing import NDArray

from .part_materials import give_parts_materials, has_colours_of_user
from .repairs import OTHER_FACES, Repairs, refuse_no_numbers

# What a table of contents that is damaged can raise; the importer is asked then, and says what is wrong.
DAMAGED = (KeyError, IndexError, TypeError, ValueError, AttributeError, OSError, RecursionError, struct.error)
TRIANGLES, FLOAT32 = 4, 5126


def read_gltf(path: Path) -> Repairs:
    """Add the objects of a file to the scene, and return what was mended."""
    try:
        contents = _Contents(path)
        n_listed, n_not_finite = contents.n_faces(), contents.n_not_finite()
    except DAMAGED:
        n_listed, n_not_finite = {}, {}
    refuse_no_numbers(n_not_finite)
    # The shape of bones would be one mesh more.
    _call(bpy.ops.import_scene.gltf, filepath=str(path), disable_bone_shape=True)
    return {
        mesh.name: [OTHER_FACES.format(n_listed[mesh.name], len(mesh.polygons))]
        for mesh in bpy.data.meshes
        if n_listed.get(mesh.name, len(mesh.polygons)) != len(mesh.polygons)
    }


def write_gltf(path: Path) -> None:
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


class _Contents:
    """What a file says of its meshes."""

    def __init__(self, path: Path) -> None:
        data = path.read_bytes()
        self._folder, self._chunk = path.parent, b""
        if data[:4] == b"glTF":
            size = struct.unpack_from("<I", data, 12)[0]
            self._chunk, data = data[20 + size + 8 :], data[20 : 20 + size]
        self._table = json.loads(data)

    def n_faces(self) -> dict[str, int]:
        """Return how many triangles each mesh has, where nothing but triangles is listed and the name is its own."""
        counts: dict[str, list[int]] = {}
        for name, primitives in self._meshes():
            is_plain = all(primitive.get("mode", TRIANGLES) == TRIANGLES for primitive in primitives)
            n_corners = (self._table["accessors"][_corners(primitive)]["count"] for primitive in primitives)
            counts.setdefault(name, []).append(sum(count // 3 for count in n_corners) if is_plain else -1)
        return {name: found[0] for name, found in counts.items() if len(found) == 1 and found[0] >= 0}

    def n_not_finite(self) -> dict[str, int]:
        """Return how many points of each mesh are no numbers."""
        return {
            name: sum(map(self._n_bad, {primitive["attributes"]["POSITION"] for primitive in primitives}))
            for name, primitives in self._meshes()
        }

    def _meshes(self) -> list[tuple[str, list[dict[str, Any]]]]:
        named = [
            (mesh.get("name") or f"Mesh_{number}", mesh) for number, mesh in enumerate(self._table.get("meshes", ()))
        ]
        return [
            (name, [part for part in mesh["primitives"] if "POSITION" in part["attributes"]]) for name, mesh in named
        ]

    def _n_bad(self, number: int) -> int:
        accessor = self._table["accessors"][number]
        if "bufferView" not in accessor or accessor["componentType"] != FLOAT32:
            return 0
        view = self._table["bufferViews"][accessor["bufferView"]]
        start, stride = view.get("byteOffset", 0) + accessor.get("byteOffset", 0), view.get("byteStride", 12)
        places: NDArray[np.float32] = np.ndarray(
            (accessor["count"], 3), "<f4", self._buffer(view["buffer"]), start, (stride, 4)
        )
        return int((~np.isfinite(places).all(axis=1)).sum())

    def _buffer(self, number: int) -> bytes:
        uri = self._table["buffers"][number].get("uri")
        if uri is None:
            return self._chunk
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        return (self._folder / unquote(uri)).read_bytes()


def _corners(primitive: dict[str, Any]) -> int:
    """Return the accessor whose count is that of the corners."""
    return primitive.get("indices", primitive["attributes"]["POSITION"])
