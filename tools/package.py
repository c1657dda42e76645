"""Build the zips that users install, one for each platform, with Blender's own builder.

usage: python tools/package.py
"""

import hashlib
import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tools.builder import run_builder, run_or_exit, validate

WHEELS = ROOT / "wheels"
DIST = ROOT / "dist"
# What the package registry gives, as `sha256sum` writes and checks it.
CHECKSUMS = ROOT / "tools" / "wheels.sha256"
# Bytes; the extension site takes no more.
LARGEST = 100_000_000


def main() -> int:
    """Build all zips and print the size of each."""
    for archive in build():
        sys.stdout.write(f"{archive.relative_to(ROOT)}  {archive.stat().st_size / 1e6:.1f} MB\n")
    return 0


def build() -> list[Path]:
    """Fetch the wheels, build and validate the zips, and return them."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    for wheel in manifest["wheels"]:
        _fetch(ROOT / wheel)
        check_wheel(ROOT / wheel)
    DIST.mkdir(exist_ok=True)
    for old in DIST.glob("*.zip"):
        old.unlink()
    run_builder("build", "--source-dir", ROOT, "--output-dir", DIST, "--split-platforms")
    archives = sorted(DIST.glob("*.zip"))
    for archive in archives:
        validate(archive)
        if archive.stat().st_size > LARGEST:
            sys.exit(f"{archive.name} is larger than the {LARGEST // 10**6} MB that the extension site takes.")
    return archives


def checksums() -> dict[str, str]:
    """Return the SHA-256 of each wheel by its name."""
    return {name: checksum for checksum, name in map(str.split, CHECKSUMS.read_text().splitlines())}


def check_wheel(wheel: Path) -> None:
    """End if a wheel is not, byte for byte, the one of the package registry."""
    if hashlib.sha256(wheel.read_bytes()).hexdigest() != checksums().get(wheel.name):
        sys.exit(f"{wheel} is not the file that {CHECKSUMS.name} names; remove it, and it is fetched again.")


def _fetch(wheel: Path) -> None:
    """Download one wheel if it is not there yet; its name says for which Python and platform."""
    if wheel.exists():
        return
    package, version, python, _, platform = wheel.stem.split("-")
    options = ["--no-deps", "--only-binary=:all:", "--python-version", re.sub(r"cp3", "3.", python)]
    source = ["--platform", platform.split(".")[0], f"{package}=={version}", "--dest", WHEELS]
    run_or_exit(sys.executable, "-m", "pip", "download", "-qq", "--disable-pip-version-check", *options, *source)
    if not wheel.exists():
        sys.exit(f"The wheel {wheel.name} that blender_manifest.toml names is not what the package registry gives.")


if __name__ == "__main__":
    sys.exit(main())
