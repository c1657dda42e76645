"""Colours, threads and presets that the user prefers, and the menu that has all actions."""

import ctypes
from pathlib import Path

import bpy
import numpy as np
import pytest

from tests.blender.conftest import values_of

PRESETS = sorted((Path(__file__).parents[2] / "presets" / "eigenparts" / "analysis").glob("*.py"))


@pytest.fixture
def palette(extension):
    from eigenparts.operators import palette

    yield palette
    palette.use_colours(palette.standard_colours())


def test_preferred_colours_are_used_from_the_next_division_on(palette, analyzed):
    palette.use_colours([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    bpy.ops.eigenparts.segment()
    labels = values_of(analyzed.data, "part")
    corners = np.repeat(labels, [polygon.loop_total for polygon in analyzed.data.polygons])
    colours = values_of(analyzed.data, "part_color", 4, np.float32, "color")[:, :3]
    np.testing.assert_array_equal(colours[corners == 0], 0)
    np.testing.assert_array_equal(np.unique(colours[corners == 1], axis=0), [[1, 0, 0]])
    # After the last, the colours repeat.
    np.testing.assert_array_equal(colours[corners == 3][0], colours[corners == 1][0])


def test_threads_reach_the_library_of_scipy(extension):
    from eigenparts.operators import threads

    asked = [
        getattr(library, name)
        for library in threads._libraries()
        for name in (
            "scipy_openblas_get_num_threads",
            "scipy_openblas_get_num_threads64_",
            "openblas_get_num_threads64_",
        )
        if hasattr(library, name)
    ]
    if not asked:
        pytest.skip("numpy and scipy have no OpenBLAS of their own here.")
    before = asked[-1]()
    assert threads.use_threads(1) >= 1
    assert [ctypes.c_int(ask()).value for ask in asked] == [1] * len(asked)
    threads.use_threads(before)


@pytest.mark.parametrize("path", PRESETS, ids=lambda path: path.stem)
def test_a_preset_sets_every_option_but_the_name_of_an_attribute(extension, path):
    settings = bpy.context.scene.eigenparts
    given = {line.split(" = ")[0].removeprefix("settings.") for line in path.read_text().splitlines()[3:]}
    assert given == set(extension.operators.properties.AnalysisOptions.__annotations__) - {"attribute"}
    settings.order = "2"
    exec(compile(path.read_text(), path.name, "exec"), {})
    assert settings.order != "2"


def test_every_entry_of_the_menu_is_an_action(extension):
    names = [entry[0].removeprefix("eigenparts.") for entry in extension.ui.menus.ENTRIES if entry is not None]
    assert len(names) == len(set(names)) > 10
    assert set(names) <= set(dir(bpy.ops.eigenparts))


class Listener:
    """Stands for an operator that reports."""

    def __init__(self):
        self.heard = []

    def report(self, kind, text):
        self.heard.append((kind, text))


def test_an_error_that_nobody_foresaw_becomes_a_sentence(extension):
    from eigenparts.operators import faults

    listener = Listener()
    with faults.errors_told(listener):
        raise MemoryError
    assert listener.heard == [({"ERROR"}, faults.OUT_OF_MEMORY)]
    with faults.errors_told(listener):
        raise ZeroDivisionError("in /home/somebody")
    assert "ZeroDivisionError" in faults.last().sentence
    assert "somebody" not in faults.last().report
    faults.forget()


def test_a_refusal_is_no_fault(extension):
    from eigenparts.operators import faults
    from eigenparts.operators.refusals import Refusal

    listener = Listener()
    with faults.errors_told(listener):
        raise Refusal("Select a mesh object first.")
    assert listener.heard == [({"ERROR"}, "Select a mesh object first.")]
    assert faults.last() is None
