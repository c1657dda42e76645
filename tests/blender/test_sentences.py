"""What operators and engine tell is told in the language of the user, with the values it carries."""

import ast
import re
from pathlib import Path

import bpy
import pytest

ROOT = Path(__file__).parents[2]
# Functions that return what is shown.
SHOWN = {"described"}
# Calls that show what is no sentence, and the place of their argument that does.
PLACES = {"progress": 1, "_report": 1, "in_language": 0}


def sentences_of_source():
    """Return all sentences in the code of operators, tasks and engine, with {} where a value is filled in."""
    paths = [path for folder in ("operators", "tasks", "compute") for path in (ROOT / folder).rglob("*.py")]
    found = set().union(*(texts_of(ast.parse(path.read_text())) for path in paths))
    begun = {text for text in found if text[:1] in ("{", '"') or text[:1].isupper()}
    return {text for text in begun if re.search("[a-z]{3}", text)}


def texts_of(tree):
    nodes = list(ast.walk(tree))
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef)
    docstrings = {id(node.body[0].value) for node in nodes if isinstance(node, documented) and is_told(node.body[0])}
    pieces = {id(piece) for node in nodes if isinstance(node, ast.JoinedStr) for piece in node.values}
    texts = {filled(node) for node in nodes if id(node) not in docstrings | pieces}
    constants = {line.targets[0].id: line.value for line in tree.body if is_constant(line)}
    arguments = [node.args[PLACES[called(node)]] for node in nodes if called(node) in PLACES]
    shown = {filled(constants.get(getattr(node, "id", ""), node)) for node in arguments}
    inside = [node for whole in nodes if getattr(whole, "name", "") in SHOWN for node in ast.walk(whole)]
    shown |= {filled(node) for node in inside if isinstance(node, ast.JoinedStr)}
    return {text for text in texts if " " in text and text.endswith(".")} | shown


def is_told(statement):
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


def is_constant(line):
    return isinstance(line, ast.Assign) and isinstance(line.targets[0], ast.Name)


def called(node):
    """Return the name of what a call calls."""
    function = getattr(node, "func", None)
    return getattr(function, "attr", getattr(function, "id", ""))


def filled(node):
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
    text = node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""
    return re.sub(r"\{[^}]*\}", "{}", text)


@pytest.fixture
def german(extension):
    return extension.ui.translations.LANGUAGES["de_DE"]


@pytest.fixture
def told(extension, german):
    """What is told in German; Blender as a module knows no language but English."""
    from eigenparts.operators.messages.sentences import in_language

    return lambda text: in_language(text, lambda known: german.get(known, known))


def test_the_sentences_are_found():
    assert {
        "The mesh has no faces; there is nothing to analyze.",  # of the engine
        "Leave edit mode first; results are written to the mesh as a whole.",  # a constant
        "Level {} does not exist; this shape has levels 0 to {}.",  # with values
        "{} was analyzed and keeps its own parts; Register Selected gives it those of {}.",  # filled in later
        "Computing eigenfunctions",  # what a job is doing
        "Searching order and signs",  # a constant
    } <= sentences_of_source()


def test_every_sentence_is_in_the_table(german):
    assert sorted(sentences_of_source() - set(german)) == []


@pytest.mark.parametrize("sentence", sorted(sentences_of_source()))
def test_every_sentence_is_told_with_its_values(told, german, sentence):
    values = [f"{number}.5 %" for number in range(sentence.count("{}"))]
    assert told(sentence.format(*values)) == german[sentence].format(*values)
    assert all(value in told(sentence.format(*values)) for value in values)


@pytest.mark.parametrize(
    ("text", "beginning"),
    [
        ("Cube.001: The mesh has no faces; there is nothing to analyze.", "Cube.001: Das Netz hat keine Flächen;"),
        ("My: cube: There is no part 3 at this level.", "My: cube: Auf dieser Stufe gibt es kein Teil 3."),
        ("6 parts (1.5 s). Eigenfunction 2 suits best: its parts hold 3 of 4 protrusions.", "6 Teile (1.5 s). Eigen"),
        ("Arm: 2 layers of Body. Matched by shape. 3 of 40 vertices are unsure.", "Arm: 2 Ebenen von Body. Nach der"),
        ("The shape has 3 handles; bones are a tree, so they are open at one end there.", "Die Gestalt hat 3 Henkel;"),
        ("{0} {x and %s do not touch, so they cannot be one part.", "{0} {x und %s berühren sich nicht"),
        ("Arm: Computing eigenfunctions", "Arm: Eigenfunktionen berechnen"),
    ],
)
def test_names_and_several_sentences_are_told(told, text, beginning):
    assert told(text).startswith(beginning)


@pytest.mark.parametrize("text", ["", "Nobody knows this. Nor: that.", "A value {} with braces", "Part 1.2", ": . "])
def test_what_is_in_no_table_is_told_as_it_is(told, text):
    assert told(text) == text


def test_english_is_told_as_it_is(extension):
    from eigenparts.operators.messages.sentences import in_language

    for sentence in sentences_of_source():
        text = sentence.format(*range(sentence.count("{}")))
        assert in_language(text) == text


def test_refusals_are_told_in_the_language(extension, analyzed, german, monkeypatch):
    from eigenparts.operators.messages import sentences

    in_language = sentences.in_language
    monkeypatch.setattr(
        sentences, "in_language", lambda text: in_language(text, lambda known: german.get(known, known))
    )
    with pytest.raises(RuntimeError, match="Stufe 99 gibt es nicht; diese Gestalt hat die Stufen 0 bis 4"):
        bpy.ops.eigenparts.segment(level=99)
