"""The scripting API can be used with a type checker."""

import inspect
import typing

import pytest

import compute

CALLS = [getattr(compute, name) for name in compute.__all__ if callable(getattr(compute, name))]


def calls_of(subject):
    """Return a function, or the public methods of a class."""
    if not inspect.isclass(subject):
        return [subject]
    named = [value for name, value in vars(subject).items() if not name.startswith("_")]
    return [value.fget if isinstance(value, property) else value for value in named if is_code(value)]


def is_code(value):
    return inspect.isfunction(value) or isinstance(value, property)


@pytest.mark.parametrize("subject", CALLS, ids=lambda subject: subject.__name__)
def test_every_argument_and_result_has_a_type(subject):
    for call in calls_of(subject):
        hints = typing.get_type_hints(call)
        names = set(inspect.signature(call).parameters) - {"self", "cls"}
        assert names | {"return"} == set(hints), call


def test_a_call_without_a_type_is_noticed():
    def bare(mesh, n_functions: int = 1):
        return mesh, n_functions

    with pytest.raises(AssertionError):
        test_every_argument_and_result_has_a_type(bare)
