"""The pages about scripting and the command line say what is true."""

import json
import re
import subprocess
import sys
from pathlib import Path

import bpy
import pytest

from tests.cli.conftest import SCHEMA

DOCS = Path(__file__).parents[2] / "docs"


def blocks_of(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", (DOCS / page).read_text(), re.MULTILINE | re.DOTALL)


def test_the_code_of_the_scripting_page_runs(tmp_path):
    """As a script, in a Python that finds the checkout as a package called eigenparts, and the engine as compute."""
    root = DOCS.parent
    (tmp_path / "eigenparts").symlink_to(root)
    script = tmp_path / "page.py"
    # The page says so: the older module crashes at its end, once any properties with callbacks were registered.
    end = "import os; os._exit(0)" if bpy.app.version < (4, 5) else ""
    script.write_text("\n".join([*blocks_of("scripting.md", "python"), end]))
    command = [sys.executable, "-W", "error::DeprecationWarning:__main__", script]
    paths = {"PYTHONPATH": f"{tmp_path}:{root}", "PATH": ""}
    process = subprocess.run(command, cwd=tmp_path, env=paths, capture_output=True, text=True, timeout=300)
    assert process.returncode == 0, process.stdout + process.stderr
    assert (tmp_path / "monkeys_parts.blend").is_file()


def test_the_report_on_the_page_keeps_the_schema():
    (example,) = blocks_of("command_line.md", "json")
    assert list(SCHEMA.iter_errors(json.loads(example))) == []


@pytest.mark.parametrize("command", ["segment", "register", "transfer", "batch"])
def test_every_option_is_on_the_page(run, command):
    _, lines, _ = run(command, "--help")
    options = set(re.findall(r"--[a-z-]+", "\n".join(lines))) - {"--help"}
    page = (DOCS / "command_line.md").read_text()
    assert {option for option in options if option not in page} == set()
