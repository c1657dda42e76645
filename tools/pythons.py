"""Find a Python of a given version on this machine."""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

# Where the usual version managers keep interpreters that are not on the search path.
MANAGED = (
    ".pyenv/versions/{version}.*",
    ".local/share/uv/python/cpython-{version}.*",
    ".asdf/installs/python/{version}.*",
)


def find_python(version: str) -> str | None:
    """Return the path of a working Python of this version ("3.11"), the running one first."""
    return next((path for path in _candidates(version) if _is_version(path, version)), None)


def _candidates(version: str) -> Iterator[str]:
    yield sys.executable
    # A name of its own, so that both versions can be named at once: PYTHON_3_13=/path/to/python3.13
    yield from filter(None, [os.environ.get(f"PYTHON_{version.replace('.', '_')}"), shutil.which(f"python{version}")])
    for pattern in MANAGED:
        yield from map(str, sorted(Path.home().glob(f"{pattern}/bin/python{version}".format(version=version))))


def _is_version(path: str, version: str) -> bool:
    """Ask the Python itself: a launcher of a version manager may stand there without the version behind it."""
    question = "import sys; print('%d.%d' % sys.version_info[:2])"
    try:
        answer = subprocess.run([path, "-c", question], capture_output=True, text=True, check=False)
    except OSError:
        return False
    return answer.stdout.strip() == version
