"""Every text of the window is in the table of every language."""

import ast
import re
import string
from pathlib import Path

import bpy
import pytest

from tests.blender.test_sentences import sentences_of_source

ROOT = Path(__file__).parents[2]
# What Blender itself writes into every class, and translates.
OF_BLENDER = ("rna_type", "name", "remove_name", "remove_active")
# Names that are the same in every language.
NAMES = {"Eigenparts"}
# Calls that draw a text.
CALLS = {"label", "operator", "prop", "progress", "column", "translated", "menu"}


def texts_of_window(extension):
    """Return every text that the extension shows in panels, menus and tooltips."""
    found = set().union(
        *(texts_of_operator(getattr(bpy.ops.eigenparts, name).get_rna_type()) for name in dir(bpy.ops.eigenparts)),
        *({kind.bl_label} for base in (bpy.types.Panel, bpy.types.Menu) for kind in own_classes(base)),
        *(texts_of_properties(kind) for kind in own_classes(bpy.types.PropertyGroup)),
        *(texts_of_properties(kind) for kind in own_classes(bpy.types.AddonPreferences)),
        *(texts_of_property(switch) for switch in own_switches()),
        *map(texts_of_source, (ROOT / "ui").glob("*.py")),
        {extension.ui.tab.NO_MESH, extension.ui.panel.FIRST_STEP},
        {extension.operators.mesh_state.schema.ABSENT, extension.operators.mesh_state.schema.DAMAGED},
    )
    return {text for text in found if any(letter.isalpha() for letter in text)} - NAMES


def own_classes(base):
    # Modules are loaded anew for each test; those of earlier ones are no longer registered.
    return [kind for kind in base.__subclasses__() if kind.__module__.startswith("eigenparts") and kind.is_registered]


def own_switches():
    properties = bpy.types.WindowManager.bl_rna.properties
    return [entry for entry in properties if entry.identifier.startswith("eigenparts_")]


def texts_of_operator(rna):
    own = [entry for entry in rna.properties if entry.identifier not in OF_BLENDER]
    return {rna.name, rna.description}.union(*map(texts_of_property, own))


def texts_of_properties(kind):
    return set().union(*map(texts_of_property, own_properties(kind)))


def own_properties(kind):
    names = {name for base in kind.__mro__ for name in getattr(base, "__annotations__", ())}
    return [kind.bl_rna.properties[name] for name in names]


def texts_of_property(entry):
    items = entry.enum_items if entry.type == "ENUM" else ()
    # What has no name is shown nowhere, and Blender calls it by its identifier.
    return ({entry.name, entry.description} - {entry.identifier}).union(
        *({item.name, item.description} for item in items)
    )


def texts_of_source(path):
    """Return the constant texts in calls that draw."""
    calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
    drawing = [call for call in calls if getattr(call.func, "attr", getattr(call.func, "id", "")) in CALLS]
    given = [word.value for call in drawing for word in call.keywords if word.arg in ("text", "heading")]
    given += [call.args[0] for call in drawing if getattr(call.func, "id", "") == "translated"]
    return {node.value for node in given if isinstance(node, ast.Constant)}


def test_the_texts_are_found(extension):
    assert {
        "Analyze",  # operator
        "Find what protrudes on the active mesh, such as limbs, heads and fingers, and divide it into parts",
        "Default Level",  # drawn
        "Linear where that gives the same parts, otherwise cubic while memory allows",  # item of a list
        "Draw the borders between parts",  # switch
        "Parts of {name}",  # translated before it is filled
    } <= texts_of_window(extension)


# What Blender fills in or never shows, and collections, which are shown row by row.
WITHOUT_TOOLTIP = {"rows", "correction_rows", "is_running", "is_picking", "job", "fraction", "text", "shown", "problem"}


def test_every_property_says_more_than_what_it_is_called(extension):
    operators = [getattr(bpy.ops.eigenparts, name).get_rna_type() for name in dir(bpy.ops.eigenparts)]
    entries = [
        *(entry for rna in operators for entry in rna.properties if entry.identifier not in OF_BLENDER),
        *(entry for kind in own_classes(bpy.types.PropertyGroup) for entry in own_properties(kind)),
        *(entry for kind in own_classes(bpy.types.AddonPreferences) for entry in own_properties(kind)),
        *own_switches(),
    ]
    assert [rna.identifier for rna in operators if len(rna.description.split()) < 4] == []
    items = [item for entry in entries if entry.type == "ENUM" for item in entry.enum_items]
    silent = {entry.identifier for entry in (*entries, *items) if len(entry.description) <= len(entry.name)}
    assert silent <= WITHOUT_TOOLTIP


@pytest.mark.parametrize("language", ["de_DE"])
def test_every_text_is_translated(extension, language):
    table = extension.ui.translations.LANGUAGES[language]
    assert sorted(texts_of_window(extension) - set(table)) == []
    assert [text for text, translation in table.items() if not translation.strip()] == []


@pytest.mark.parametrize("language", ["de_DE"])
def test_no_translation_is_left_over(extension, language):
    left = set(extension.ui.translations.LANGUAGES[language]) - texts_of_window(extension)
    # A sentence may stand there for some of its values too, where these are words.
    patterns = [re.escape(sentence).replace(r"\{\}", ".*") for sentence in sentences_of_source()]
    assert sorted(text for text in left if not any(re.fullmatch(pattern, text) for pattern in patterns)) == []


@pytest.mark.parametrize("language", ["de_DE"])
def test_a_translation_keeps_the_places_to_fill(extension, language):
    def places(text):
        fields = [field for _, field, _, _ in string.Formatter().parse(text) if field is not None]
        # Values without names may stand in another order.
        return sorted("" if field.isdecimal() else field for field in fields)

    table = extension.ui.translations.LANGUAGES[language]
    assert [text for text, translation in table.items() if places(text) != places(translation)] == []
