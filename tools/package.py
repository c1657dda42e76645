"""Build the zips that users install, one for each platform, with Blender's own builder.

usage: python tools/package.py
"""

import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).parents[1]
WHEELS = ROOT / "wheels"
DIST = ROOT / "dist"


def main() -> int:
    """Fetch the wheels, build, validate, and print the size of each zip."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    for wheel in manifest["wheels"]:
        _fetch(ROOT / wheel)
    DIST.mkdir(exist_ok=True)
    for old in DIST.glob("*.zip"):
        old.unlink()
    _run_builder("build", "--source-dir", ROOT, "--output-dir", DIST, "--split-platforms")
    for archive in sorted(DIST.glob("*.zip")):
        _run_builder("validate", archive)
        sys.stdout.write(f"{archive.relative_to(ROOT)}  {archive.stat().st_size / 1e6:.1f} MB\n")
    return 0


def _fetch(wheel: Path) -> None:
    """Download one wheel if it is not there yet; its name says for which Python and platform."""
    if wheel.exists():
        return
    package, version, python, _, platform = wheel.stem.split("-")
    options = ["--no-deps", "--only-binary=:all:", "--python-version", re.sub(r"cp3", "3.", python)]
    source = ["--platform", platform.split(".")[0], f"{package}=={version}", "--dest", WHEELS]
    _run(sys.executable, "-m", "pip", "download", "-qq", "--disable-pip-version-check", *options, *source)
    if not wheel.exists():
        sys.exit(f"The wheel {wheel.name} that blender_manifest.toml names is not what the package registry gives.")


def _run_builder(*arguments: object) -> None:
    _run(sys.executable, next(_builders()), *arguments)


def _builders() -> Iterator[Path]:
    """Blender's builder comes with the bpy module and runs without it being loaded."""
    module = find_spec("bpy")
    homes = module.submodule_search_locations if module else None
    if not homes:
        sys.exit("Blender as a Python module is not installed.")
    return Path(homes[0]).glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py")


def _run(*command: object) -> None:
    finished = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if finished.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{finished.stdout}{finished.stderr}")


if __name__ == "__main__":
    sys.exit(main())
