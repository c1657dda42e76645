"""Make a virtual environment in which Eigenparts runs with Blender as a Python module.

usage: python tools/environment.py FOLDER [BLENDER_VERSION[-newest]]

Does nothing where the environment is already as it should be. Without a version it takes the Blender that fits the
Python it is started with, or another Python that it finds. "5.2.3-newest" has the newest numpy and scipy that pip finds
for this Blender, as ``pip install bpy scipy`` brings them; it is looked for again every day.
"""

import datetime
import hashlib
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tools.pythons import find_python
from tools.system_libraries import explain_failed_import

REQUIREMENTS = Path(__file__).with_name("requirements.txt")

# Blender version: the Python it is built for and the numpy it ships.
BLENDERS = {
    "4.2.23": ("3.11", "1.24.3"),
    "4.5.15": ("3.11", "1.26.4"),
    "5.0.1": ("3.11", "1.26.4"),
    "5.2.3": ("3.13", "2.3.4"),
    # The numpy of 5.2: the module asks for any from 2.2 on.
    "5.3.0": ("3.13", "2.3.4"),
}
NEWEST = "-newest"
# The Blender that development uses on each Python, in the order of preference where neither is given.
USUAL_BLENDERS = {"3.11": "4.5.15", "3.13": "5.2.3"}


class SetUpError(Exception):
    """The environment cannot be made; the text says what the user can do."""


def make_environment(folder: Path, blender: str) -> Path:
    """Return the Python of an environment with this Blender, made or completed if need be."""
    python = folder / "bin" / "python"
    stamp = folder / "eigenparts-environment.txt"
    wanted = _fingerprint(blender)
    if not (stamp.is_file() and stamp.read_text() == wanted and python.exists()):
        _refuse_foreign(folder, stamp)
        _create(folder, python_of(blender))
        stamp.write_text("not finished\n")
        _install(python, blender)
        _check_import(python)
        stamp.write_text(wanted)
    return python


def is_known(blender: str) -> bool:
    """Whether there is an environment for a version, "5.2.3" or "5.2.3-newest"."""
    return blender.removesuffix(NEWEST) in BLENDERS


def python_of(blender: str) -> str:
    """Return the version of Python that a Blender is built for."""
    return BLENDERS[blender.removesuffix(NEWEST)][0]


def usual_blender() -> str:
    """Return the Blender version for the running Python, or for the first suitable Python on this machine."""
    running = f"{sys.version_info.major}.{sys.version_info.minor}"
    for version in (running, *USUAL_BLENDERS):
        if version in USUAL_BLENDERS and find_python(version):
            return USUAL_BLENDERS[version]
    raise SetUpError(
        f"Eigenparts needs Python {' or '.join(USUAL_BLENDERS)}, which Blender is built for; this is Python {running}. "
        "Install one of them or name it: make PYTHON=/path/to/python3.11"
    )


def _fingerprint(blender: str) -> str:
    recipe = " ".join(_packages(blender))
    found_on = f", of {datetime.date.today()}" if blender.endswith(NEWEST) else ""
    return f"Blender {blender}, recipe {hashlib.sha256(recipe.encode()).hexdigest()}{found_on}\n"


def _packages(blender: str) -> list[str]:
    """Return what pip is asked for; a newest environment leaves the versions of numpy and scipy to it."""
    lines = [line.partition("#")[0].strip() for line in REQUIREMENTS.read_text().splitlines()]
    companions = [line for line in lines if line]
    version = blender.removesuffix(NEWEST)
    if version == blender:
        return [f"bpy=={version}", f"numpy=={BLENDERS[version][1]}", *companions]
    return [f"bpy=={version}", "numpy", "scipy", *(line for line in companions if not line.startswith("scipy=="))]


def _refuse_foreign(folder: Path, stamp: Path) -> None:
    """Raise if a folder is not from here: creating the environment would clear it."""
    if folder.exists() and any(folder.iterdir()) and not stamp.is_file():
        raise SetUpError(f"{folder} is there already and was not made for this; remove it or name another folder.")


def _create(folder: Path, version: str) -> None:
    python = find_python(version)
    if python is None:
        raise SetUpError(f"Python {version} was not found; install it or name it in the variable PYTHON.")
    _say(f"Setting up {folder} with {python} (once; it downloads about 400 MB).")
    made = subprocess.run([python, "-m", "venv", "--clear", folder], capture_output=True, text=True)
    if made.returncode:
        raise SetUpError(
            f"Python {version} cannot make virtual environments; install its venv module "
            f"(Debian, Ubuntu: apt install python{version}-venv)."
        )


def _install(python: Path, blender: str) -> None:
    command = [str(python), "-m", "pip", "install", "-qq", "--disable-pip-version-check", *_packages(blender)]
    if subprocess.run(command).returncode:
        raise SetUpError(f"pip could not install Blender {blender} and its companions; see its message above.")


def _check_import(python: Path) -> None:
    loaded = subprocess.run([python, "-c", "import bpy"], capture_output=True, text=True)
    if loaded.returncode:
        raise SetUpError(explain_failed_import(loaded.stderr))


def _say(text: str) -> None:
    sys.stderr.write(text + "\n")


def main(arguments: list[str]) -> int:
    """Make the environment that the command line asks for; return the exit code."""
    try:
        make_environment(Path(arguments[0]), arguments[1] if arguments[1:] else usual_blender())
    except SetUpError as error:
        _say(str(error))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
