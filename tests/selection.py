"""Which tests are run: a share of the long ones, and as many as fit into a time.

``--share=0.2`` keeps a fifth of what was selected, drawn anew for each commit; ``--draw=NAME`` draws it again. After
``--within=SECONDS`` no other test is begun.
"""

import subprocess
import time
from hashlib import blake2b
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
_start = pytest.StashKey[float]()


def pytest_addoption(parser):
    parser.addoption("--share", type=float, default=1.0, help="fraction of the selected tests that is run")
    parser.addoption("--draw", help="what the share is drawn by; the last commit if not given")
    parser.addoption("--within", type=float, help="seconds after which no other test is begun")


def pytest_configure(config):
    config.stash[_start] = time.monotonic()
    if config.option.share < 1 and config.option.draw is None:
        config.option.draw = _last_commit()


def pytest_collection_modifyitems(config, items):
    share, draw = config.option.share, config.option.draw
    if share < 1:
        left_out = [item for item in items if not is_drawn(item.nodeid, share, draw)]
        items[:] = [item for item in items if is_drawn(item.nodeid, share, draw)]
        config.hook.pytest_deselected(items=left_out)


def pytest_runtest_setup(item):
    seconds = item.config.option.within
    if seconds is not None and time.monotonic() - item.config.stash[_start] > seconds:
        pytest.skip(f"not begun within {seconds:g} s")


def pytest_terminal_summary(terminalreporter, config):
    if config.option.share < 1:
        terminalreporter.write_line(f"Drawn: --share={config.option.share:g} --draw={config.option.draw}")


def is_drawn(name: str, share: float, draw: str) -> bool:
    """Return whether a test is one of a share; the draws of two names have nothing to do with each other."""
    number = int.from_bytes(blake2b(f"{draw} {name}".encode(), digest_size=8).digest())
    return number < share * 2**64


def draws(n_long: int) -> list:
    """Return numbers for a random test to begin with: one for a usual test, and others for long ones."""
    return [0, *(pytest.param(number, marks=pytest.mark.long) for number in range(1, n_long + 1))]


def _last_commit() -> str:
    answer = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    return answer.stdout.strip() or "no commit"
