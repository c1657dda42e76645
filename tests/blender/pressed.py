"""Operators as scripts call them: done, or refused in a sentence, and never broken."""

import re
from typing import NamedTuple

import bpy

# Operators of Blender's own making, which refuse with a warning.
WARNING_ONLY = {"add_analysis_preset", "add_transfer_preset"}


class Pressed(NamedTuple):
    """Whether an operator did what it was asked, and what it said if not."""

    is_done: bool
    sentence: str


def press(operator, **options):
    """Call an operator; it may refuse in a sentence, but not break."""
    rna = getattr(bpy.ops.eigenparts, operator).get_rna_type()
    flags = {name for name in options if getattr(rna.properties[name], "is_enum_flag", False)}
    given = {name: set(value) if name in flags else value for name, value in options.items()}
    try:
        is_done, sentence = getattr(bpy.ops.eigenparts, operator)(**given) == {"FINISHED"}, ""
    except RuntimeError as error:
        is_done, sentence = False, str(error)
    assert "Traceback" not in sentence, sentence
    if not is_done and operator not in WARNING_ONLY:
        assert is_sentence(sentence), sentence or f"{operator} says nothing"
    return Pressed(is_done, sentence.strip())


def is_sentence(text):
    """Return whether a text is what Blender says of a refusal of ours."""
    return ".poll()" in text or re.match(r"Error: .*[.!]\s*$", text, re.DOTALL) is not None
