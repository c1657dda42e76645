"""Write transferred layers to an object, mixed with what is there; what stands in the way is told before."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import bpy
import numpy as np
from numpy.typing import NDArray

from ... import compute
from ...tasks import layers
from ...tasks.attribute_types import Domain
from ...tasks.layers import Layer
from ...tasks.refusals import Refusal, in_name_of
from ..blender.known_values import mesh_of
from ..mesh_data import mesh_arrays
from ..mesh_data.attribute_values import read_attribute, store_values
from ..mesh_state import state
from ..outputs import corner_colours
from ..outputs.division import PART, Division
from ..outputs.vertex_groups import active_group_kept
from .layer_reading import read_weights
from .shape_keys import ABSOLUTE, write_shape_keys

# Weights below this are left out of a vertex group.
LEAST_WEIGHT = 1e-4
MOST_UV_LAYERS = 8


@dataclass(frozen=True)
class Mix:
    """Share of the new values: a factor, and the name of a vertex group whose weights it is multiplied with."""

    factor: float
    mask: str


WHOLE = Mix(1.0, "")


def refuse_obstacles(obj: bpy.types.Object, given: list[Layer], mix: Mix) -> None:
    """Raise a Refusal that names the object if one of the layers cannot be written to it."""
    with in_name_of(obj.name):
        _refuse_linked(obj)
        if mix.mask and mix.mask not in obj.vertex_groups:
            raise Refusal(f'There is no vertex group "{mix.mask}" to be used as the mask.')
        for layer in given:
            _OBSTACLES.get(layer.kind, _refuse_clash)(obj, layer)
        new_uvs = {layer.name for layer in given if layer.is_uv} - {uv.name for uv in mesh_of(obj).uv_layers}
        if len(mesh_of(obj).uv_layers) + len(new_uvs) > MOST_UV_LAYERS:
            raise Refusal(f"A mesh can have {MOST_UV_LAYERS} UV maps; delete some first.")


def _refuse_linked(obj: bpy.types.Object) -> None:
    if obj.library is not None or mesh_of(obj).library is not None:
        raise Refusal("The object or its mesh is linked from another file; make it local first.")


def _refuse_locked(obj: bpy.types.Object, layer: Layer) -> None:
    if not layer.is_companion and layer.name in obj.vertex_groups and obj.vertex_groups[layer.name].lock_weight:
        raise Refusal(f'The vertex group "{layer.name}" is locked; unlock it first.')


def _refuse_missing_basis(obj: bpy.types.Object, layer: Layer) -> None:
    keys = mesh_of(obj).shape_keys
    if keys is None:
        raise Refusal("The mesh has no Basis that shape keys could start from; add a shape key first.")
    if not keys.use_relative:
        raise Refusal(ABSOLUTE.format(obj.name))
    if keys.key_blocks[0].name == layer.name:
        raise Refusal(f'"{layer.name}" is the Basis here, but a shape key on the source; rename one of them.')
    if layer.name in keys.key_blocks and keys.key_blocks[layer.name].lock_shape:
        raise Refusal(f'The shape key "{layer.name}" is locked; unlock it first.')


def _refuse_foreign_part(obj: bpy.types.Object, layer: Layer) -> None:
    mesh_arrays.refuse_foreign(mesh_of(obj), (PART, corner_colours.PART_COLOR))


def _refuse_clash(obj: bpy.types.Object, layer: Layer) -> None:
    existing = mesh_of(obj).attributes.get(layer.name)
    if existing is not None and layer.name in mesh_arrays.own_names(mesh_of(obj)):
        raise Refusal(f'The attribute "{layer.name}" here is from Eigenparts; take it back, or rename the other one.')
    if existing is not None and (existing.data_type, existing.domain) != (layer.data_type, layer.kind):
        raise Refusal(f'There is an attribute "{layer.name}" of another kind; rename one of them.')


def _refuse_nothing(obj: bpy.types.Object, layer: Layer) -> None:
    """Slots for materials can always be added."""


_OBSTACLES = {
    layers.GROUP: _refuse_locked,
    layers.SHAPE_KEY: _refuse_missing_basis,
    layers.PARTS: _refuse_foreign_part,
    layers.MATERIAL: _refuse_nothing,
}


def write_layers(obj: bpy.types.Object, given: list[Layer], mix: Mix, colours: NDArray[np.float32]) -> list[str]:
    """Write layers to an object that `refuse_obstacles` let pass, and return what is to be told.

    Parameters
    ----------
    colours : (n, 4) float32
        Of the parts, by their labels.
    """
    mesh, share = mesh_of(obj), _shares(obj, mix)
    writers: dict[str, Callable[[Layer], None]] = {
        layers.MATERIAL: lambda layer: _write_materials(mesh, layer, share),
        layers.PARTS: lambda layer: _write_parts(mesh, layer, share, colours),
    }
    _write_companions(obj, [layer for layer in given if layer.is_companion])
    _write_groups(obj, [layer for layer in given if layer.kind == layers.GROUP and not layer.is_companion], share)
    for kind in (
        layers.POINT,
        layers.FACE,
        layers.CORNER,
        layers.MATERIAL,
        layers.PARTS,
    ):
        for layer in [layer for layer in given if layer.kind == kind]:
            if kind in writers:
                writers[kind](layer)
            else:
                _write_attribute(mesh, layer, share)
    told = write_shape_keys(obj, [layer for layer in given if layer.kind == layers.SHAPE_KEY], share)
    mesh.update()
    return told


def _shares(obj: bpy.types.Object, mix: Mix) -> NDArray[np.float64]:
    """Return the (V,) share of the new values that each vertex takes."""
    if not mix.mask:
        return np.full(len(mesh_of(obj).vertices), mix.factor)
    return mix.factor * read_weights(obj, [mix.mask])[:, 0]


def _write_companions(obj: bpy.types.Object, some: list[Layer]) -> None:
    """Write whole vertex groups that shape keys need, where the object has none of their names."""
    missing = [layer for layer in some if layer.name not in obj.vertex_groups]
    _write_groups(obj, missing, np.ones(len(mesh_of(obj).vertices)))


def _write_groups(obj: bpy.types.Object, some: list[Layer], share: NDArray[np.float64]) -> None:
    names = [layer.name for layer in some]
    if not names:
        return
    before = read_weights(obj, names)
    after = compute.mixed(before, np.hstack([layer.values for layer in some]), share)
    with active_group_kept(obj):
        for name in names:
            if name not in obj.vertex_groups:
                obj.vertex_groups.new(name=name)
    for name, column, old in zip(names, np.clip(after, 0, 1).T, before.T, strict=True):
        fill_group(obj.vertex_groups[name], np.where(column < LEAST_WEIGHT, 0, column), old)


def fill_group(group: bpy.types.VertexGroup, weights: NDArray[np.float64], before: NDArray[np.float64]) -> None:
    """Give vertices (V,) their weights in a group; where they have none they are taken out if they were in it."""
    group.remove(np.flatnonzero((weights == 0) & (before > 0)).tolist())
    group.add(np.flatnonzero(weights == 1).tolist(), 1.0, "REPLACE")
    # Blender takes one weight for any number of vertices, so those between 0 and 1 go one by one.
    for vertex in np.flatnonzero((weights > 0) & (weights < 1)).tolist():
        group.add([vertex], weights[vertex], "REPLACE")


def _write_materials(mesh: bpy.types.Mesh, layer: Layer, share: NDArray[np.float64]) -> None:
    slot = np.array([_slot(mesh, name) for name in layer.names], dtype=np.int32)
    if "material_index" not in mesh.attributes:
        mesh.attributes.new("material_index", "INT", "FACE")
    attribute = mesh.attributes["material_index"]
    store_values(attribute, _replaced(read_attribute(attribute), slot[layer.values], _of_faces(mesh, share)))


def _slot(mesh: bpy.types.Mesh, name: str) -> int:
    """Return the slot that has a material, a new one if there is none."""
    material = bpy.data.materials.get(name)
    slots = list(mesh.materials)
    if material not in slots:
        mesh.materials.append(material)
        return len(slots)
    return slots.index(material)


def _write_parts(mesh: bpy.types.Mesh, layer: Layer, share: NDArray[np.float64], colours: NDArray[np.float32]) -> None:
    """Write labels and colours of parts; a mesh with an analysis of its own keeps them, as its levels lead to them."""
    if state.is_analyzed(mesh):
        return
    before = np.zeros_like(layer.values)
    if PART.name in mesh.attributes:
        before = mesh_arrays.read_own_integers(mesh, PART).reshape(-1, 1)
    labels = _replaced(before, layer.values, _of_faces(mesh, share)).ravel().astype(np.int32)
    mesh_arrays.write_attribute(mesh, PART, labels)
    shown = np.minimum(labels, len(colours) - 1)
    corner_colours.write(mesh, Division(shown, {}, colours))


def _write_attribute(mesh: bpy.types.Mesh, layer: Layer, share: NDArray[np.float64]) -> None:
    attribute = mesh.attributes.get(layer.name) or _new_attribute(mesh, layer)
    before = read_attribute(attribute)
    share = _spread(mesh, layer.kind, share)
    if layer.can_blend:
        store_values(attribute, compute.mixed(before.astype(np.float64), layer.values, share))
    else:
        store_values(attribute, _replaced(before, layer.values, share))


def _new_attribute(mesh: bpy.types.Mesh, layer: Layer) -> bpy.types.Attribute:
    if layer.is_uv:
        mesh.uv_layers.new(name=layer.name)
        return mesh.attributes[layer.name]
    assert layer.data_type
    return mesh.attributes.new(layer.name, layer.data_type, cast(Domain, layer.kind))


def _spread(mesh: bpy.types.Mesh, domain: str, share: NDArray[np.float64]) -> NDArray[np.float64]:
    if domain == layers.CORNER:
        return share[mesh_arrays.vertex_of_corner(mesh)]
    return _of_faces(mesh, share) if domain == layers.FACE else share


def _of_faces(mesh: bpy.types.Mesh, share: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (F,) the mean share of the corners of each face."""
    n_corners = mesh_arrays.n_corners_of_polygon(mesh)
    face = np.repeat(np.arange(len(n_corners)), n_corners)
    return np.bincount(face, share[mesh_arrays.vertex_of_corner(mesh)], len(n_corners)) / n_corners


def _replaced(before: NDArray[Any], after: NDArray[Any], share: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.where(compute.taken_over(share, len(before))[:, None], after, before)
