"""Arrays and records as plain numbers and texts on a mesh: they come back as they were, and nothing else comes back."""

from dataclasses import dataclass, make_dataclass
from types import GenericAlias

import bpy
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

SHAPES = arrays.array_shapes(min_dims=1, max_dims=3, min_side=0, max_side=4)
KINDS = {
    "int64": st.integers(-(2**31), 2**31 - 1),
    "float64": st.floats(allow_nan=False, allow_infinity=False),
    "bool": st.booleans(),
}


@dataclass
class Tree:
    """What is stored: numbers, arrays, and what belongs to each face, which is an attribute."""

    n_roots: int
    value_range: float
    parent: NDArray[np.int64]
    height: NDArray[np.float64]
    is_maximum: NDArray[np.bool_]
    of_face: NDArray[np.int32]


@pytest.fixture(scope="module")
def serialization(extension):
    from eigenparts.operators.mesh_state import serialization

    return serialization


def through_a_mesh(value):
    """Return a value as it is read from a custom property."""
    mesh = bpy.data.meshes.new("kept")
    mesh["state"] = {"value": value}
    return mesh["state"]["value"]


@pytest.mark.parametrize("kind", KINDS)
def test_arrays_come_back_as_they_were(serialization, kind):
    @settings(deadline=None, max_examples=40, derandomize=True)
    @given(arrays.arrays(kind, SHAPES, elements=KINDS[kind]))
    def check(array):
        back = serialization.unpacked_array(through_a_mesh(serialization.packed_array(array)), kind)
        assert (back.dtype, back.shape) == (array.dtype, array.shape)
        np.testing.assert_array_equal(back, array)

    check()


def a_tree():
    return Tree(3, 0.5, np.array([1, -1]), np.array([0.25, 2.0]), np.array([True, False]), np.zeros(9, dtype=np.int32))


def test_a_record_comes_back_without_what_belongs_to_faces(serialization):
    back = serialization.unpacked(through_a_mesh(serialization.packed(a_tree())), Tree)
    assert set(back) == {"n_roots", "value_range", "parent", "height", "is_maximum"}
    for name, value in back.items():
        np.testing.assert_array_equal(value, getattr(a_tree(), name))
        assert type(value) is type(getattr(a_tree(), name))


class AliasOfItsOwn:
    """An NDArray as NumPy 2.5 has it: what it makes remembers the alias and the numbers, not ``numpy.ndarray``."""

    def __getitem__(self, numbers):
        return GenericAlias(self, (numbers,))


def test_arrays_are_known_by_the_annotations_of_every_numpy(serialization, monkeypatch):
    alias = AliasOfItsOwn()
    monkeypatch.setattr(serialization, "NDArray", alias)
    for array in (a_tree().parent, a_tree().height, a_tree().is_maximum):
        record = make_dataclass("Record", [("of_arc", alias[array.dtype.type])])
        back = serialization.unpacked(through_a_mesh(serialization.packed(record(array))), record)
        np.testing.assert_array_equal(back["of_arc"], array)


def test_the_end_of_the_numbers_that_blender_keeps_stays_beyond_every_other(serialization):
    """The root of a tree closes never, which is the highest number of 64 bits."""
    never = np.iinfo(np.int64).max
    array = np.array([7, never])
    back = serialization.unpacked_array(through_a_mesh(serialization.packed_array(array)), "int64")
    np.testing.assert_array_equal(back, [7, 2**31 - 1])


def test_only_some_rows_are_kept_if_wanted(serialization):
    packed = serialization.packed(a_tree(), slice(1, None))
    assert packed["parent"]["values"] == [-1]
    assert packed["n_roots"] == 3


DAMAGES = {
    "another type": lambda group: group["parent"].update(dtype="float64"),
    "another shape": lambda group: group["parent"].update(shape=[3]),
    "a shape of decimals": lambda group: group["parent"].update(shape=[2.0]),
    "text for numbers": lambda group: group["parent"].update(values="12"),
    "decimals for whole numbers": lambda group: group["parent"].update(values=[1.5, 2.5]),
    "not a number": lambda group: group["height"].update(values=[0.0, float("nan")]),
    "an endless number": lambda group: group.update(value_range=float("inf")),
    "a decimal for a whole number": lambda group: group.update(n_roots=3.5),
    "a number that is gone": lambda group: group.pop("n_roots"),
    "an array that is gone": lambda group: group.pop("is_maximum"),
    "a number for an array": lambda group: group.update(parent=7),
    "text for an array": lambda group: group.update(parent="parent"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_what_is_not_as_it_was_written_is_not_read(serialization, damage):
    group = serialization.packed(a_tree())
    DAMAGES[damage](group)
    with pytest.raises(serialization.UNREADABLE):
        serialization.unpacked(through_a_mesh(group), Tree)
