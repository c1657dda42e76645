"""Which of the libraries that we are compared with are installed."""

from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec


def is_installed(module: str) -> bool:
    """Whether a module can be imported."""
    return find_spec(module) is not None


def versions_of(*packages: str) -> str:
    """Return a line with the versions of some packages."""
    return ", ".join(_version(name) for name in packages)


def _version(name: str) -> str:
    try:
        return f"{name} {version(name)}"
    except PackageNotFoundError:
        return f"no {name}"
