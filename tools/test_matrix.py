"""Run the Blender tests on several Blender versions, each in an environment of its own.

usage: python tools/test_matrix.py [VERSION...]
"""

import subprocess
import sys
import time
from pathlib import Path

from environment import BLENDERS, SetUpError, make_environment

ROOT = Path(__file__).parents[1]
TESTS = ["tests/blender", "tests/cli"]


def main(versions: list[str]) -> int:
    """Test each version and print one line for it; return 1 if any failed."""
    outcomes = [_test(version) for version in versions or BLENDERS]
    sys.stdout.write("\n" + "\n".join(outcomes) + "\n")
    return int(any("passed" not in outcome or "failed" in outcome for outcome in outcomes))


def _test(version: str) -> str:
    if version not in BLENDERS:
        return f"Blender {version}: unknown; the table in tools/environment.py has {', '.join(BLENDERS)}"
    start = time.monotonic()
    try:
        python = make_environment(ROOT / ".environments" / version, version)
    except SetUpError as error:
        return f"Blender {version}: {error}"
    run = subprocess.run([python, "-m", "pytest", "-q", *TESTS], cwd=ROOT, stdout=subprocess.PIPE, text=True)
    sys.stdout.write(run.stdout)
    last_line = run.stdout.strip().splitlines()[-1].strip("= ")
    return f"Blender {version} (Python {BLENDERS[version][0]}): {last_line} [{time.monotonic() - start:.0f} s in all]"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
