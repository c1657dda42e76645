"""What the command line understands, and what it says to what it does not."""

from importlib import import_module
from pathlib import Path

import pytest

from tools.extension import load_extension


@pytest.fixture(scope="module")
def parse():
    load_extension()
    return import_module("eigenparts.cli.arguments").parse


@pytest.mark.parametrize("command", ["register", "transfer"])
def test_the_first_file_is_the_source_if_none_is_named(parse, command):
    assert parse([command, "a.off", "b.off"]).source == Path("a.off")
    named = parse([command, "a.off", "b.off", "--source", "c.off"])
    assert (named.source, named.files) == (Path("c.off"), [Path("a.off"), Path("b.off")])


def test_a_time_limit_goes_with_all_that_has_processes(parse):
    for where in ([], ["--jobs", "2"], ["--scheduler", "tcp://host:8786"]):
        assert parse(["segment", "a.off", "--timeout", "5", *where]).timeout == 5


def test_layers_are_a_set_of_known_kinds(parse):
    assert parse(["transfer", "a.off", "--layers", "UVs, groups,groups"]).layers == ["groups", "uvs"]
    assert parse(["transfer", "a.off"]).layers == ["groups"]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["segment", "a.off", "--timeout", "5", "--in-process"], "so it does not go with --in-process"),
        (["segment", "a.off", "--jobs", "0"], "must be at least 1"),
        (["segment", "a.off", "--jobs", "2", "--timeout", "0"], "must be more than 0"),
        (["segment", "a.off", "--jobs", "2", "--timeout", "1e9"], "at most 604800"),
        (["segment", "a.off", "--level", "1", "--parts", "2"], "not allowed with"),
        (["segment", "a.off", "--json", "--json-lines"], "not allowed with"),
        (["segment", "a.off", "--jobs", "2", "--scheduler", "tcp://host:8786"], "not allowed with"),
        (["transfer", "a.off", "--layers", "groups,bones"], "must be some of groups"),
        (["batch", "files", "--points", "points.json"], "--points needs a --source"),
        (["segment", "a.off", "--output", ""], "must be a folder"),
        (["segment", "a.off", "--output", __file__], "must be a folder"),
        (["segment"], "required: FILE"),
        (["divide", "a.off"], "invalid choice"),
    ],
)
def test_what_makes_no_sense_is_said_in_a_sentence(parse, capsys, arguments, sentence):
    with pytest.raises(SystemExit) as exit_request:
        parse(arguments)
    assert exit_request.value.code == 2
    assert sentence in capsys.readouterr().err


def test_the_command_of_workers_is_split_as_a_shell_does(parse):
    command = "ssh host 'my blender' --background"
    assert parse(["segment", "a.off", "--worker-command", command]).worker_command == [
        *("ssh", "host", "my blender", "--background")
    ]
