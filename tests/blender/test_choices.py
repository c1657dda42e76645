"""Modes, loose parts, orders, boundaries and fields are declared once; lists, arguments and pages follow."""

import inspect
import subprocess
import sys
from pathlib import Path

import bpy
import pytest

import compute

ROOT = Path(__file__).parents[2]


def items_of(owner, name):
    return [item.identifier for item in owner.bl_rna.properties[name].enum_items]


def identifiers(words):
    return [str(word).upper() for word in words]


def test_the_words_load_nothing():
    """Panels and the help of the command line ask for them where scipy is missing."""
    script = "import compute, sys; compute.MODES, compute.SHELLS; print('numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("order", compute.ORDERS),
        ("boundary", compute.BOUNDARIES),
        ("shells", compute.SHELLS),
        ("borders", compute.BORDERS),
    ],
)
def test_the_lists_of_an_analysis_are_the_words_of_the_engine(extension, name, words):
    settings = bpy.context.scene.eigenparts
    assert items_of(settings, name) == identifiers(words)
    assert getattr(settings, name) == identifiers(words)[0]
    assert inspect.signature(compute.analyze).parameters[name].default == words[0]


def test_the_modes_are_those_of_the_engine(star_object):
    for owner in (star_object.data.eigenparts, bpy.ops.eigenparts.segment.get_rna_type()):
        items = owner.bl_rna.properties["mode"] if hasattr(owner, "bl_rna") else owner.properties["mode"]
        assert [item.identifier for item in items.enum_items] == identifiers(compute.MODES)
    assert star_object.data.eigenparts.mode == identifiers(compute.MODES)[0]


def test_the_fields_of_the_engine_come_first(extension):
    names = items_of(bpy.context.scene.eigenparts, "field")
    assert names == [*identifiers(compute.FIELDS), "EIGENFUNCTION", "ATTRIBUTE"]


@pytest.mark.parametrize("option", ["mode", "shells", "borders"])
def test_the_command_line_takes_the_words_of_the_engine(extension, option, capsys):
    from eigenparts.cli import arguments

    for word in {"mode": compute.READINGS, "shells": compute.SHELLS, "borders": compute.BORDERS}[option]:
        assert getattr(arguments.parse(["segment", "a.obj", f"--{option}", word]), option) == word
    with pytest.raises(SystemExit):
        arguments.parse(["segment", "a.obj", f"--{option}", "other"])


@pytest.mark.parametrize("words", [compute.READINGS, compute.SHELLS])
def test_the_page_of_the_command_line_names_every_word(words):
    page = (ROOT / "docs" / "command_line.md").read_text()
    assert [word for word in words if f"`{word}`" not in page and f" {word}`" not in page] == []
