"""Save the files of 0.1.0 that today's code has to open, and beside them what they showed when they were saved.

They were made by the code of 0.1.0 (commit 87f9d8b) on the oldest Blender, 4.2.23; today's code cannot make them again:

    git worktree add ../of-0.1.0 87f9d8b
    python tests/blender/data/save_with_0_1_0.py ../of-0.1.0

There are three objects: a corrected one with all outputs, names and colours of the user's, and bones; one that is
registered to it; and one with two trees, whose minima are parts too, and whose loose parts are analyzed by themselves.
"""

import json
import sys
from pathlib import Path

import bpy
import numpy as np

FOLDER = Path(__file__).parent
OUTPUTS = {"VERTEX_ATTRIBUTE", "CORNER_COLORS", "FACE_SETS", "VERTEX_GROUPS", "MATERIALS", "FIELD"}
N_VERTICES = 2000


def main(checkout: str) -> None:
    """Save the file and what it shows, with the code of a checkout."""
    sys.path.insert(0, checkout)
    from tools.extension import load_extension

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    load_extension().register()
    bpy.context.preferences.filepaths.save_version = 0
    beast, runner, _ = _beast(), _runner(), _two_blobs()
    _activate(beast, runner)
    bpy.ops.eigenparts.register_selected(order="1")
    _activate(beast)
    bpy.ops.eigenparts.create_armature(weights="NONE", order="1")
    file = FOLDER / "parts_of_0_1_0.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file), compress=True)
    bpy.ops.wm.open_mainfile(filepath=str(file))
    told, arrays = {}, {}
    for name in ("beast", "runner", "blobs"):
        told[name], of_object = _shown_by(bpy.data.objects[name])
        arrays |= {f"{name} {what}": values for what, values in of_object.items()}
    _activate(bpy.data.objects["runner"])
    bpy.ops.eigenparts.create_armature(weights="NONE", order="1")
    told["runner"]["bones"] = sorted(bone.name for bone in bpy.context.object.data.bones)
    for name in ("beast", "runner", "blobs"):
        arrays |= {f"{name} {what}": values for what, values in _after_changes(bpy.data.objects[name]).items()}
    told["runner"]["own titles"] = [row.title for row in bpy.data.objects["runner"].data.eigenparts.rows]
    file.with_suffix(".json").write_text(json.dumps(told, indent=1, sort_keys=True) + "\n")
    np.savez_compressed(file.with_suffix(".npz"), **arrays)


def _beast() -> bpy.types.Object:
    """Add a quadruped with corrections of every kind, names and a colour of the user's, and all outputs."""
    from examples import quadruped
    from examples.blender import add_posed_mesh

    beast = _named(add_posed_mesh(quadruped(N_VERTICES)), "beast")
    beast.data.materials.append(bpy.data.materials.new("Fur"))
    bpy.ops.eigenparts.analyze(order="1")
    first, second, third = _parts_by_size(beast.data)[:3]
    first.color, second.title, third.title = (0.8, 0.1, 0.3), "Schnauze", "Leg"
    bpy.ops.eigenparts.write_outputs(outputs=OUTPUTS, softness=0.05)
    _correct(beast)
    return beast


def _correct(beast: bpy.types.Object) -> None:
    """Make one correction of each kind."""
    n_levels = beast.data["eigenparts_state"]["hierarchy"]["n_levels"]
    first, second, third, *_, last = (row.part for row in _parts_by_size(beast.data))
    bpy.ops.eigenparts.set_branch_level(part=first, level=n_levels - 1)
    bpy.ops.eigenparts.split_part(part=second, position=0.3)
    bpy.ops.eigenparts.move_border(part=third, offset=-0.05)
    bpy.ops.eigenparts.merge_parts(part=last, into=0)
    selected = np.zeros(len(beast.data.polygons), dtype=bool)
    selected[np.flatnonzero(_integers(beast.data, "part") == 0)[:20]] = True
    beast.data.polygons.foreach_set("select", selected)
    bpy.ops.eigenparts.paint_part(new=True)
    assert len(beast.data.eigenparts.correction_rows) == 5
    assert not any(row.rests for row in beast.data.eigenparts.correction_rows)


def _parts_by_size(mesh: bpy.types.Mesh) -> list[bpy.types.PropertyGroup]:
    """Return the rows of the parts without the body, the one of most faces first."""
    return sorted((row for row in mesh.eigenparts.rows if row.part), key=lambda row: (-row.n_faces, row.part))


def _runner() -> bpy.types.Object:
    """Add a quadruped in another pose, with a name of its own for a part."""
    from examples import quadruped
    from examples.blender import add_posed_mesh

    runner = _named(add_posed_mesh(quadruped(N_VERTICES), "walk"), "runner")
    bpy.ops.eigenparts.analyze(order="1")
    runner.data.eigenparts.rows[1].title = "Its own"
    return runner


def _two_blobs() -> bpy.types.Object:
    """Add two stars in one mesh with an eigenfunction as the field, in the mode that is not the usual one."""
    from compute.mesh import TriangleMesh

    from tests.shapes import joined, star

    small = star(n_arms=5, n_subdivisions=2)
    both = joined(small, TriangleMesh(0.7 * small.vertices + [6, 0, 0], small.triangles))
    mesh = bpy.data.meshes.new("blobs")
    mesh.from_pydata(both.vertices.tolist(), [], both.triangles.tolist())
    blobs = bpy.data.objects.new("blobs", mesh)
    bpy.context.collection.objects.link(blobs)
    _activate(blobs)
    bpy.ops.eigenparts.analyze(field="EIGENFUNCTION", eigenfunction=4, order="1", shells="SEPARATE")
    bpy.ops.eigenparts.segment(n_parts=6, mode="FEATURES")
    return blobs


def _named(obj: bpy.types.Object, name: str) -> bpy.types.Object:
    obj.name = obj.data.name = name
    _activate(obj)
    return obj


def _activate(active: bpy.types.Object, *others: bpy.types.Object) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for obj in (active, *others):
        obj.select_set(True)
    bpy.context.view_layer.objects.active = active


def _shown_by(obj: bpy.types.Object) -> tuple[dict[str, object], dict[str, np.ndarray]]:
    """Return what an object shows: what is read in the panels, and the numbers on its faces."""
    shown = obj.data.eigenparts
    group_of = {group.index: group.name for group in obj.vertex_groups}
    told = {
        "level": shown.level,
        "mode": shown.mode,
        "n_parts": shown.n_parts,
        "softness": shown.softness,
        "outputs": [name for name in sorted(OUTPUTS) if getattr(shown, name.lower())],
        "rows": [
            {"part": row.part, "depth": row.depth, "title": row.title, "color": list(row.color), "faces": row.n_faces}
            for row in shown.rows
        ],
        "corrections": [{"title": row.title, "rests": row.rests} for row in shown.correction_rows],
        "groups": sorted(group_of.values()),
        "materials": [material.name for material in obj.data.materials],
    }
    arrays = {
        "slots": np.array([polygon.material_index for polygon in obj.data.polygons]),
        "labels": _integers(obj.data, "part"),
        "grouped": np.array([len(vertex.groups) for vertex in obj.data.vertices]),
    }
    return told, arrays


def _after_changes(obj: bpy.types.Object) -> dict[str, np.ndarray]:
    """Return the parts of the faces at every level, and without the first and without any corrections."""
    _activate(obj)
    shown, arrays = obj.data.eigenparts.level, {}
    for level in range(obj.data["eigenparts_state"]["hierarchy"]["n_levels"]):
        bpy.ops.eigenparts.segment(level=level)
        arrays[f"level {level}"] = _integers(obj.data, "part")
    bpy.ops.eigenparts.segment(level=shown)
    for place in reversed(range(len(obj.data.eigenparts.correction_rows))):
        bpy.ops.eigenparts.remove_correction(index=place)
        arrays[f"without {place}"] = _integers(obj.data, "part")
    return arrays


def _integers(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    values = np.empty(len(mesh.attributes[name].data), dtype=np.int32)
    mesh.attributes[name].data.foreach_get("value", values)
    return values


if __name__ == "__main__":
    main(sys.argv[1])
