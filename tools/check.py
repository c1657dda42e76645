"""Check a change in under a minute: ruff, mypy, and the tests that it touches.

usage: python tools/check.py [FILE...]

Without files it takes those that differ from where the branch left ``main``. The tests that are nearest to the change
come first, and after ``SECONDS`` no other one is begun; ``make test`` runs all.
"""

import os
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tools.touched import changed_files, touched_tests

ROOT = Path(__file__).parents[1]
# What tests may take, so that all is done within a minute.
SECONDS = 35
# A new process for each core costs more than it saves where there are few tests.
MANY_TESTS = 3
LINTERS = (("ruff", "check", "."), ("ruff", "format", "--check", "."), ("mypy",))


def main(files: list[str]) -> int:
    """Check the files and tell how it went; return 1 if anything failed."""
    start = time.monotonic()
    tests = touched_tests(ROOT, files or changed_files(ROOT))
    _say(f"Tests: {' '.join(tests)}")
    processes = ["--numprocesses", "2"] if len(tests) > MANY_TESTS else []
    commands = (*LINTERS, ("pytest", "-q", "-m", "not long", f"--within={SECONDS}", *processes, *tests))
    failed = [" ".join(command[:2]) for command in commands if _run(*command)]
    told = f"Failed: {', '.join(failed)}." if failed else "All well."
    _say(f"{told} [{time.monotonic() - start:.0f} s]")
    return int(bool(failed))


def _run(*command: str) -> int:
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run([sys.executable, "-m", *command], cwd=ROOT, env=environment).returncode


def _say(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
