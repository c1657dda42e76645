"""Sentences for the user, in the language of the user, with the values that they carry.

Operators and engine write English with the values filled in. A table of another language has the same sentences with {}
where values stand; here, where they are told, they are found again. What is in no table is told as it is.
"""

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

import bpy
from bpy.app.translations import pgettext_rpt

# Of a report: its colour, and whether a script gets an exception.
Kind = Literal["INFO", "WARNING", "ERROR"]

PLACE = "{}"
# A value goes on to the end of its sentence at most.
_VALUE = r"((?:(?!\. ).)*?)"

_patterns: list[tuple[re.Pattern[str], str]] = []


@dataclass(frozen=True)
class Messages:
    """Sentences about what was done, in English with the values filled in.

    Attributes
    ----------
    infos : tuple of str
        Told in one line.
    warnings : tuple of str
        Each told in a line of its own.
    """

    infos: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def report(self, operator: bpy.types.Operator) -> None:
        """Let an operator tell the sentences in the language of the user, warnings last and each of them once."""
        if any(self.infos):
            tell(operator, "INFO", *self.infos)
        for warning in dict.fromkeys(self.warnings):
            tell(operator, "WARNING", warning)


def use_tables(tables: Iterable[Iterable[str]]) -> None:
    """From now on, know the sentences of some tables that have places for values."""
    sentences = {sentence for table in tables for sentence in table if PLACE in sentence}
    # Of two that fit, the one with more words of its own says more.
    _patterns[:] = [(_pattern(sentence), sentence) for sentence in sorted(sentences, key=len, reverse=True)]


def tell(operator: bpy.types.Operator, kind: Kind, *sentences: str) -> None:
    """Report sentences, of the kind "INFO", "WARNING" or "ERROR", in the language of the user."""
    operator.report({kind}, " ".join(in_language(sentence) for sentence in sentences if sentence))


def in_language(text: str, translate: Callable[[str], str] = pgettext_rpt) -> str:
    """Return some sentences in the language of the user, those that are not known as they are.

    Parameters
    ----------
    text : str
        What is told, or "name: what is told", in English.
    translate : callable, optional
        Returns what stands in a table of texts, and any other text as it is; Blender's if not given.
    """
    told = translate(text)
    if told == text:
        told = _filled(text, translate) or _piecewise(text, translate)
    return told


def _filled(text: str, translate: Callable[[str], str]) -> str | None:
    """Return the translation of a sentence with places, with the values of a text; None if the text is none such."""
    for pattern, sentence in _patterns:
        found = pattern.fullmatch(text)
        if found is not None:
            return translate(sentence).format(*found.groups())
    return None


def _piecewise(text: str, translate: Callable[[str], str]) -> str:
    """Return one sentence after the other, or what follows a name."""
    first, stop, rest = text.partition(". ")
    if stop:
        return f"{in_language(f'{first}.', translate)} {in_language(rest, translate)}"
    name, colon, rest = text.partition(": ")
    return f"{name}: {in_language(rest, translate)}" if colon else text


def _pattern(sentence: str) -> re.Pattern[str]:
    return re.compile(_VALUE.join(map(re.escape, sentence.split(PLACE))), re.DOTALL)
