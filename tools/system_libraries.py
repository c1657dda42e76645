"""The system libraries that Blender misses, and the Debian packages that bring them."""

import ctypes
import re

# The libraries that Blender as a Python module leaves to the system, and where Debian and Ubuntu have them.
PACKAGE_OF_LIBRARY = {
    "libX11.so.6": "libx11-6",
    "libXi.so.6": "libxi6",
    "libXfixes.so.3": "libxfixes3",
    "libXrender.so.1": "libxrender1",
    "libXext.so.6": "libxext6",
    "libSM.so.6": "libsm6",
    "libICE.so.6": "libice6",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libgomp.so.1": "libgomp1",
}


def explain_failed_import(message: str) -> str:
    """Return one sentence for the text that a failed ``import bpy`` left."""
    named = re.search(r"(lib\S+?\.so[.\d]*): cannot open shared object file", message)
    if named is None:
        return f"Blender cannot be loaded: {message.strip().splitlines()[-1] if message.strip() else 'no reason given'}"
    missing = [named[1], *(library for library in PACKAGE_OF_LIBRARY if library != named[1] and not _can_load(library))]
    packages = sorted({PACKAGE_OF_LIBRARY[library] for library in missing if library in PACKAGE_OF_LIBRARY})
    advice = f" (Debian, Ubuntu: apt install {' '.join(packages)})" if packages else ""
    noun = "library is" if len(missing) == 1 else "libraries are"
    return f"Blender cannot be loaded because the system {noun} missing: {', '.join(missing)}{advice}."


def _can_load(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
