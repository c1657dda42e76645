"""Files of every format, and the command line."""

import importlib
import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

from tests.shapes import star
from tools.extension import load_extension

bpy = pytest.importorskip("bpy", reason="needs Blender as a Python module")

from tests.cli.files import write_off  # noqa: E402

COMMANDS = ("segment", "register", "transfer", "batch")
OF_PROCESSES = ("--jobs", "--scheduler", "--timeout", "--memory-limit", "--in-process")
SCHEMA = Draft202012Validator(json.loads(Path(__file__).parents[2].joinpath("cli/report.schema.json").read_text()))


@pytest.fixture(autouse=True)
def fresh_scene():
    """An empty file."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


@pytest.fixture
def run(capfd):
    """Run the command line in this process, unless the options are about processes, as starting one takes a second.

    It returns the exit code, the lines on stdout (or the report) and those on stderr.
    """

    def call(*arguments):
        extension = load_extension()
        importlib.import_module("eigenparts.cli.processes.suppress_output").flush_streams()
        capfd.readouterr()
        command, *rest = map(str, arguments)
        is_here = command in COMMANDS and not any(option in OF_PROCESSES for option in rest)
        code = extension.cli.main([command, *["--in-process"][:is_here], *rest])
        out, err = capfd.readouterr()
        if "--json" in arguments and out:
            assert list(SCHEMA.iter_errors(json.loads(out))) == []
        return code, json.loads(out) if "--json" in arguments and out else out.splitlines(), err.splitlines()

    return call


@pytest.fixture(scope="session")
def star_off(tmp_path_factory):
    """A star with five arms as an .off file."""
    return write_off(star(n_arms=5, n_subdivisions=3), tmp_path_factory.mktemp("files") / "star.off")
