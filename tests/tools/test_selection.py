"""Shares of the long tests, and what fits into a time."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.selection import draws, is_drawn

ROOT = Path(__file__).parents[2]
NAMES = [f"tests/test_something.py::test_it[{number}]" for number in range(1000)]


def drawn(share, draw):
    return {name for name in NAMES if is_drawn(name, share, draw)}


@pytest.mark.parametrize("share", [0.0, 0.05, 0.2, 1.0])
def test_a_share_has_its_size(share):
    assert len(drawn(share, "6e8849b")) / len(NAMES) == pytest.approx(share, abs=0.05)


def test_a_share_is_the_same_each_time_and_another_for_another_commit():
    first, second = drawn(0.2, "6e8849b"), drawn(0.2, "12953b4")
    assert first == drawn(0.2, "6e8849b")
    # Two draws of a fifth have a fifth of a fifth in common.
    assert len(first & second) / len(NAMES) == pytest.approx(0.04, abs=0.02)


def test_a_larger_share_holds_the_smaller_one():
    assert drawn(0.1, "6e8849b") < drawn(0.3, "6e8849b")


def test_twenty_draws_of_a_fifth_meet_nearly_everything():
    met = set().union(*(drawn(0.2, f"commit {number}") for number in range(20)))
    assert len(met) / len(NAMES) > 0.97


def test_of_all_draws_one_is_usual():
    usual, *long = draws(3)
    assert usual == 0
    assert [(case.values, [mark.name for mark in case.marks]) for case in long] == [
        ((number,), ["long"]) for number in (1, 2, 3)
    ]


def run(folder, *arguments):
    """Run 40 tests, every fourth of them long; the sixth takes an hour by the clock. Return what pytest says."""
    folder.joinpath("test_made.py").write_text(
        "import pytest, time\n"
        "@pytest.mark.parametrize('n', [n if n % 4 else pytest.param(n, marks=pytest.mark.long) for n in range(40)])\n"
        "def test_it(n, now=time.monotonic):\n    if n == 5: time.monotonic = lambda: now() + 3600\n"
    )
    folder.joinpath("pytest.ini").write_text("[pytest]\nmarkers = long\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "tests.selection", "-p", "no:cacheprovider", *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True).stdout


def test_long_tests_are_left_out_or_run_alone(tmp_path):
    assert "30 passed, 10 deselected" in run(tmp_path, "-m", "not long")
    assert "10 passed, 30 deselected" in run(tmp_path, "-m", "long")


def test_what_a_share_was_drawn_by_is_told(tmp_path):
    told = run(tmp_path, "--share=0.5", "--draw=again")
    assert "Drawn: --share=0.5 --draw=again" in told
    assert 10 < int(told.split(" passed")[0].split()[-1]) < 30


def test_after_a_time_no_other_test_is_begun(tmp_path):
    assert "6 passed, 34 skipped" in run(tmp_path, "--within=1800")
