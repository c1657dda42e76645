"""The texts of the extension in other languages than English: one table a language."""

import bpy

from ...operators.messages import sentences
from .german import GERMAN
from .german_sentences import GERMAN_SENTENCES

# By Blender's name of the language.
LANGUAGES = {"de_DE": GERMAN | GERMAN_SENTENCES}
# Blender looks for the labels of operators in a context of their own.
CONTEXTS = (
    # The stubs declare neither of them.
    bpy.app.translations.contexts.default,  # type: ignore[attr-defined]
    bpy.app.translations.contexts.operator_default,  # type: ignore[attr-defined]
)


def register() -> None:
    """Give Blender the tables."""
    tables = {
        language: {(context, text): translation for text, translation in table.items() for context in CONTEXTS}
        for language, table in LANGUAGES.items()
    }
    bpy.app.translations.register(__package__, tables)
    sentences.use_tables(LANGUAGES.values())


def unregister() -> None:
    """Take them back."""
    sentences.use_tables(())
    bpy.app.translations.unregister(__package__)
