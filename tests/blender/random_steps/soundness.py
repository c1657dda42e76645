"""What has to hold between what is stored on a mesh, its layers and the lists of the panel."""

import bpy
import numpy as np

from tests.blender.conftest import values_of


def unsound(mesh: bpy.types.Mesh) -> set[str]:
    """Return all that does not fit together on an analyzed mesh that is not being edited."""
    from eigenparts.operators.mesh_state.state import read

    state = read(mesh)
    if state.stored is None or mesh.is_editmode:
        return set()
    if not state.is_readable:
        return {"the state cannot be read"}
    settings, rows = mesh.eigenparts, list(mesh.eigenparts.rows)
    complaints = {
        "the rows are not those of the stored parts": {row.part for row in rows} != set(state.summary.shares),
        "the level is none that there is": not 0 <= settings.level <= state.highest_level,
        "the number of parts is another": settings.n_parts != len(rows),
        "the active row is none": not -1 <= settings.active_row < len(rows),
        "the areas do not add up": abs(sum(row.share for row in rows) - 1) > 1e-3,
        "the corrections are not those listed": len(settings.correction_rows) != len(state.corrections),
        "parts have no names or the same": len({row.title for row in rows} - {""}) < len(rows),
        **_of_labels(mesh, {row.part: row.n_faces for row in rows}),
    }
    return {sentence for sentence, is_so in complaints.items() if is_so}


def invalid(mesh: bpy.types.Mesh) -> bool:
    """Return whether Blender would have to mend the faces of a mesh."""
    if not len(mesh.vertices) or not np.isfinite(values_of(mesh, "position", 3, np.float32, "vector")).all():
        # Blender mends coordinates that are no numbers on the mesh that the copy was made of, too.
        return False
    copy = mesh.copy()
    try:
        return copy.validate()
    finally:
        bpy.data.meshes.remove(copy)


def left_on(mesh: bpy.types.Mesh) -> list[str]:
    """Return what is still there of ours."""
    names = [*mesh.attributes.keys(), *mesh.keys()]
    rows = ["rows"] * (len(mesh.eigenparts.rows) + len(mesh.eigenparts.correction_rows))
    return [name for name in names if name.lstrip(".").startswith("eigenparts_")] + rows


def _of_labels(mesh: bpy.types.Mesh, listed: dict[int, int]) -> dict[str, bool]:
    attribute = mesh.attributes.get("part")
    if attribute is None or (attribute.data_type, attribute.domain) != ("INT", "FACE"):
        return {"the labels are gone": True}
    labels, counts = np.unique(values_of(mesh, "part"), return_counts=True)
    shown = dict(zip(labels.tolist(), counts.tolist(), strict=True))
    return {
        "labels are not listed": not set(shown) <= set(listed),
        "faces are miscounted": {part: n for part, n in listed.items() if n} != shown,
    }
