"""Install a zip the way a user does, in a Blender that has no scipy of its own, and run the main job with it.

usage: python tools/try_package.py ZIP
"""

import os
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

# What a user would do, in a Blender that finds nothing but the zip; run in a process of its own.
SESSION = """
import sys
import bpy
import addon_utils
bpy.ops.wm.read_factory_settings()
addon_utils.enable("bl_pkg")
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", enable_on_install=True)
bpy.ops.mesh.primitive_monkey_add()
assert bpy.ops.eigenparts.analyze() == {"FINISHED"}
import scipy
assert "user_resources" in scipy.__file__, scipy.__file__
print("parts:", bpy.context.object.data.eigenparts.n_parts, "of a monkey, with scipy", scipy.__version__)
addon_utils.disable("bl_ext.user_default.eigenparts")
"""


def main(archive: Path) -> int:
    """Try one zip with the running Python's Blender; return 1 and show what happened if it fails."""
    with tempfile.TemporaryDirectory() as folder:
        libraries = _without_scipy(Path(folder) / "libraries")
        # Without site packages (-S), only what is linked into the folder can be imported.
        environment = os.environ | {
            "PYTHONPATH": str(libraries),
            "BLENDER_USER_RESOURCES": str(Path(folder) / "user_resources"),
        }
        command = [sys.executable, "-S", "-c", SESSION, str(archive.resolve())]
        tried = subprocess.run(command, env=environment, capture_output=True, text=True)
    told = [line for line in tried.stdout.splitlines() if line.startswith("parts:")]
    sys.stdout.write("\n".join(told or [tried.stdout, tried.stderr]) + "\n")
    return int(not told)


def _without_scipy(folder: Path) -> Path:
    """Return a folder with links to all installed packages but scipy."""
    folder.mkdir()
    for package in Path(sysconfig.get_path("platlib")).iterdir():
        if not package.name.startswith(("scipy", "__pycache__")) and package.suffix != ".pth":
            (folder / package.name).symlink_to(package)
    return folder


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
