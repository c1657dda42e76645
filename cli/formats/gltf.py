"""glTF, as one file (.glb) or several (.gltf)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from .gltf_file import GltfFile, parse_gltf
from .open_file import OpenFile, open_file
from .own_attributes import claim_own_attributes
from .part_materials import give_parts_materials, has_colours_of_user
from .repairs import OTHER_FACES, refuse_no_numbers

# What contents can raise that nobody has looked at; the importer is asked then, and says what is wrong.
DAMAGED = (KeyError, IndexError, TypeError, ValueError, AttributeError, OSError)


def read_gltf(path: Path) -> OpenFile:
    """Open a file whose tables fit together."""
    n_listed, n_not_finite = _counts(parse_gltf(path))
    refuse_no_numbers(n_not_finite)
    # The shape of bones would be one mesh more.
    _call(bpy.ops.import_scene.gltf, filepath=str(path), disable_bone_shape=True)
    repairs = {
        mesh.name: [OTHER_FACES.format(n_listed[mesh.name], len(mesh.polygons))]
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


def _counts(file: GltfFile) -> tuple[dict[str, int], dict[str, int]]:
    """Return how many faces of each mesh are listed, and how many points are no numbers, as far as that is known."""
    try:
        return file.n_faces(), file.n_not_finite()
    except DAMAGED:
        return {}, {}
