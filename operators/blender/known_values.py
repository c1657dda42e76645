"""Values that Blender's types leave open and that are known where this extension asks for them."""

from collections.abc import Sequence
from typing import Any, Protocol, TypeVar, cast

import bpy

Value = TypeVar("Value")
Data = TypeVar("Data", bound=bpy.types.ID)


class Elements(Protocol):
    """The values of an attribute, of any type."""

    def __len__(self) -> int: ...

    def foreach_get(self, attr: str, seq: Any, /) -> None:
        """Copy all values into an array."""

    def foreach_set(self, attr: str, seq: Any, /) -> None:
        """Copy all values from an array."""


class _WithElements(Protocol):
    data: Elements


class _WithValue(Protocol):
    default_value: float | Sequence[float]


def present(value: Value | None) -> Value:
    """Return a value that is never missing here, such as the scene while an operator runs."""
    assert value is not None
    return value


def mesh_of(obj: bpy.types.Object | None) -> bpy.types.Mesh:
    """Return the mesh of a mesh object."""
    return data_of(obj, bpy.types.Mesh)


def data_of(obj: bpy.types.Object | None, kind: type[Data]) -> Data:
    """Return the data of an object that is known to be of some kind."""
    assert obj is not None
    assert isinstance(obj.data, kind)
    return obj.data


def mesh_with(settings: bpy.types.PropertyGroup) -> bpy.types.Mesh:
    """Return the mesh that some settings belong to."""
    assert isinstance(settings.id_data, bpy.types.Mesh)
    return settings.id_data


def elements_of(attribute: bpy.types.Attribute) -> Elements:
    """Return the values of an attribute; each of Blender's attribute types declares them anew."""
    return cast(_WithElements, attribute).data


def values_of(array: bpy.types.bpy_prop_array) -> Sequence[float]:
    """Return the components of a colour or size, which the stubs give no way to read."""
    return cast(Sequence[float], array)


def set_input(node: bpy.types.Node, name: str, value: float | Sequence[float]) -> None:
    """Set the value of an input of a shader; each of Blender's socket types declares it anew."""
    cast(_WithValue, node.inputs[name]).default_value = value


def numbers_of(owner: bpy.types.ID, name: str) -> Sequence[float]:
    """Return the numbers that a custom property holds; none if it is not there."""
    return cast(Sequence[float], owner.get(name, ()))
