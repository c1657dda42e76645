"""Run the Blender tests on several Blender versions, each in an environment of its own, and install the zip in each.

usage: python tools/test_matrix.py [VERSION...]
"""

import os
import platform
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tools.environment import BLENDERS, SetUpError, make_environment

ROOT = Path(__file__).parents[1]
TESTS = ["tests/blender", "tests/cli"]
SYSTEMS = {
    "Linux": "linux_x64",
    "Windows": "windows_x64",
    "Darwin": f"macos_{platform.machine()}".replace("x86_64", "x64"),
}


def main(versions: list[str]) -> int:
    """Test each version and print one line for it; return 1 if anything failed."""
    outcomes = [_try(version) for version in versions or BLENDERS]
    sys.stdout.write("\n" + "\n".join(line for line, _ in outcomes) + "\n")
    return int(not all(passed for _, passed in outcomes))


def _try(version: str) -> tuple[str, bool]:
    """Return one line about a version, and whether all went well."""
    if version not in BLENDERS:
        return f"Blender {version}: unknown; tools/environment.py has {', '.join(BLENDERS)}", False
    start = time.monotonic()
    try:
        python = make_environment(ROOT / ".environments" / version, version)
    except SetUpError as error:
        return f"Blender {version}: {error}", False
    tests, tests_passed = _run(python, "-m", "pytest", "-q", "--numprocesses", "auto", "-m", "not long", *TESTS)
    package, package_works = _run(python, "tools/try_package.py", _archive())
    told = f"Blender {version} (Python {BLENDERS[version][0]}): {tests}; from the zip: {package}"
    return f"{told} [{time.monotonic() - start:.0f} s in all]", tests_passed and package_works


def _run(python: Path, *arguments: str) -> tuple[str, bool]:
    """Run something, show what it prints, and return its last line and whether it went well."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    run = subprocess.run([python, *arguments], cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True)
    sys.stdout.write(run.stdout)
    lines = run.stdout.strip().splitlines()
    return lines[-1].strip("= ") if lines else "nothing", run.returncode == 0


def _archive() -> str:
    return str(next((ROOT / "dist").glob(f"*{SYSTEMS[platform.system()]}.zip"), ""))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
