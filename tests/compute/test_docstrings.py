"""The docstrings of the scripting API: their sections are complete, and their examples give what they say.

In examples, numpy is ``np``, all public names are imported, ``vertices`` and ``triangles`` are the arrays of a star of
five arms, ``mesh`` is the ``TriangleMesh`` of them and ``analysis`` what ``analyze(mesh)`` returns.
"""

import doctest
import inspect

import numpy as np
import pytest

import compute
from tests.shapes import star

# Public names whose docstrings are not complete yet.
UNFINISHED = {
    *("Correspondence", "Eigenbasis", "Matching", "Skeleton", "TriangleMesh"),
    *("binding_weights", "correspond", "match", "mirror_parts", "register", "skeleton", "solve_eigenbasis"),
    *("Cancelled", "EngineError", "FieldError", "LevelError", "MeshError", "RegistrationError", "SpectrumError"),
}
FINISHED = sorted(set(compute.__all__) - UNFINISHED)


def calls_of(name):
    """Return a public function, or the public methods of a class, by their names."""
    subject = getattr(compute, name)
    if not inspect.isclass(subject):
        return {name: subject}
    return {
        f"{name}.{method}": value
        for method, value in vars(subject).items()
        if inspect.isfunction(value) and not method.startswith("_")
    }


CALLS = {path: call for name in FINISHED for path, call in calls_of(name).items()}


def missing_sections(call):
    """Return the sections that the docstring of a call lacks."""
    signature = inspect.signature(call, eval_str=True)
    text = inspect.getdoc(call) or ""
    wanted = {"Examples"}
    wanted |= {"Parameters"} if set(signature.parameters) - {"self", "cls"} else set()
    wanted |= {"Returns"} if signature.return_annotation is not None else set()
    return {section for section in wanted if f"\n{section}\n{'-' * len(section)}\n" not in text}


@pytest.fixture(scope="module")
def namespace():
    mesh = star(n_arms=5, n_subdivisions=3)
    public = {name: getattr(compute, name) for name in compute.__all__}
    arrays = {"vertices": mesh.vertices, "triangles": mesh.triangles}
    return {"np": np, "mesh": mesh, "analysis": compute.analyze(mesh), **arrays, **public}


def failures(subject, namespace):
    """Return what goes wrong in the examples of a function, or of a class and all in it."""
    told = []
    runner = doctest.DocTestRunner(verbose=False, optionflags=doctest.NORMALIZE_WHITESPACE)
    for test in doctest.DocTestFinder().find(subject, subject.__name__, globs=dict(namespace)):
        runner.run(test, out=told.append)
    return "".join(told)


@pytest.mark.parametrize("path", CALLS)
def test_every_call_tells_what_it_takes_and_returns_and_gives_an_example(path):
    assert missing_sections(CALLS[path]) == set()


@pytest.mark.parametrize("path", CALLS)
def test_every_parameter_is_described(path):
    section = (inspect.getdoc(CALLS[path]) or "").partition("\nParameters\n")[2].partition("\n\n")[0]
    described = {name.strip() for line in section.splitlines() for name in line.partition(" : ")[0].split(",")}
    assert set(inspect.signature(CALLS[path]).parameters) - {"self", "cls"} <= described


@pytest.mark.parametrize("name", FINISHED)
def test_every_public_name_has_an_example(name):
    assert ">>> " in (inspect.getdoc(getattr(compute, name)) or "")


@pytest.mark.parametrize("name", compute.__all__)
def test_examples_give_what_they_say(name, namespace):
    assert failures(getattr(compute, name), namespace) == ""


def test_a_call_without_sections_is_noticed():
    def bare(level: int) -> int:
        """Return a level."""
        return level

    assert missing_sections(bare) == {"Parameters", "Returns", "Examples"}


def test_an_example_that_gives_something_else_is_noticed(namespace):
    def wrong():
        """Return one.

        >>> 1
        2
        """

    assert "Expected" in failures(wrong, namespace)
