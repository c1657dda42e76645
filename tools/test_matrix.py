"""Run the Blender tests on several Blender versions, each in an environment of its own, and install the zip in each.

usage: python tools/test_matrix.py [VERSION...]

"5.2.3" is tested with the numpy that this Blender ships, and its zip with the scipy in it; "5.2.3-newest" with the
newest numpy and scipy that pip finds for it, the tests of the engine too. Without a version, all of both.
"""

import os
import platform
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tools.environment import BLENDERS, NEWEST, SetUpError, is_known, make_environment, python_of

ROOT = Path(__file__).parents[1]
TESTS = ["tests/blender", "tests/cli"]
VERSIONS = "import numpy, scipy; print('numpy', numpy.__version__ + ', scipy', scipy.__version__)"
SYSTEMS = {
    "Linux": "linux_x64",
    "Windows": "windows_x64",
    "Darwin": f"macos_{platform.machine()}".replace("x86_64", "x64"),
}


def main(versions: list[str]) -> int:
    """Test each version and print one line for it; return 1 if anything failed."""
    outcomes = [_try(version) for version in versions or [*BLENDERS, *(f"{version}{NEWEST}" for version in BLENDERS)]]
    sys.stdout.write("\n" + "\n".join(line for line, _ in outcomes) + "\n")
    return int(not all(passed for _, passed in outcomes))


def _try(version: str) -> tuple[str, bool]:
    """Return one line about a version, and whether all went well."""
    if not is_known(version):
        return f"Blender {version}: unknown; tools/environment.py has {', '.join(BLENDERS)}", False
    start = time.monotonic()
    try:
        python = make_environment(ROOT / ".environments" / version, version)
    except SetUpError as error:
        return f"Blender {version}: {error}", False
    told, passed = _try_newest(python) if version.endswith(NEWEST) else _try_shipped(python)
    return f"Blender {version} (Python {python_of(version)}{told} [{time.monotonic() - start:.0f} s in all]", passed


def _try_shipped(python: Path) -> tuple[str, bool]:
    """Test what users of the application have: its numpy, and the scipy of the zip."""
    tests, tests_passed = _test(python, TESTS)
    package, package_works = _run(python, "tools/try_package.py", _archive())
    return f"): {tests}; from the zip: {package}", tests_passed and package_works


def _try_newest(python: Path) -> tuple[str, bool]:
    """Test what ``pip install bpy scipy`` brings, which has no zip; the engine meets these versions nowhere else."""
    libraries, _ = _run(python, "-c", VERSIONS)
    tests, passed = _test(python, [*TESTS, "tests/compute"])
    return f", {libraries}): {tests}", passed


def _test(python: Path, tests: list[str]) -> tuple[str, bool]:
    return _run(python, "-m", "pytest", "-q", "--numprocesses", "auto", "-m", "not long", *tests)


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
