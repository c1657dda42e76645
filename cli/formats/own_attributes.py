"""Attributes of a file that are called like ours: results of ours are taken back, others get out of the way."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
import numpy as np

from ...operators.mesh_data.attribute_values import read_attribute
from ...operators.mesh_data.mesh_arrays import OwnAttribute, mark_own, own_names, write_attribute
from ...operators.outputs import output_registry
from ...operators.outputs.corner_colours import PART_COLOR
from ...tasks.attribute_types import STORAGES
from .repairs import Repairs

RENAMED = 'the attribute "{}" of the file is "{}" in the result, as its name belongs to what is written there.'


def claim_own_attributes(repairs: Repairs) -> Repairs:
    """Mark what an earlier result brought along as ours, rename what cannot be of one, and add what is to be told.

    Formats other than .blend keep the names of attributes, but not the marks that tell ours from the user's.
    """
    told = {mesh.name: list(_claim(mesh)) for mesh in bpy.data.meshes}
    return repairs | {name: [*repairs.get(name, ()), *sentences] for name, sentences in told.items() if sentences}


def _claim(mesh: bpy.types.Mesh) -> Iterator[str]:
    for own in output_registry.result_attributes(None):
        attribute = mesh.attributes.get(own.name)
        if attribute is None or own.name in own_names(mesh):
            continue
        if own.name == PART_COLOR.name and attribute.domain == own.domain and "COLOR" in attribute.data_type:
            mesh.attributes.remove(attribute)
        elif _is_result(attribute, own):
            _take_back(mesh, attribute, own)
        else:
            attribute.name = f"{own.name}_of_file"
            yield RENAMED.format(own.name, attribute.name)


def _is_result(attribute: bpy.types.Attribute, own: OwnAttribute) -> bool:
    """Whether an attribute holds what one of ours does; formats keep whole numbers as decimal ones."""
    if own.data_type != "INT" or attribute.domain != own.domain or attribute.data_type not in ("FLOAT", "INT", "INT8"):
        return False
    values = read_attribute(attribute)
    return bool(np.isfinite(values).all() and (values == np.rint(values)).all() and (values >= 0).all())


def _take_back(mesh: bpy.types.Mesh, attribute: bpy.types.Attribute, own: OwnAttribute) -> None:
    values = read_attribute(attribute).astype(np.int32)
    assert attribute.data_type in STORAGES
    mesh.attributes.remove(attribute)
    mark_own(mesh, [own.name])
    write_attribute(mesh, own, values)
