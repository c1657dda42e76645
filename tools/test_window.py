"""Test the zip in the real application, where there is one; pictures are left in demo/window.

usage: python tools/test_window.py [--pictures FOLDER]

With a folder, such as docs/pictures, the pictures that the guide shows are put there if all tests pass.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tools.window import what_is_missing


def main() -> int:
    """Build the zip and run the tests with it; say so if nothing can be run here."""
    parser = argparse.ArgumentParser(description="Test the zip in the real application.")
    parser.add_argument("--pictures", type=Path, metavar="FOLDER", help="put the pictures of the guide there")
    folder = parser.parse_args().pictures
    missing = what_is_missing()
    if missing:
        sys.stdout.write(f"Not run: {missing}\n")
        return 0
    subprocess.run([sys.executable, ROOT / "tools" / "package.py"], check=True)
    archive = next((ROOT / "dist").glob("*linux_x64.zip"))
    command = [sys.executable, "-m", "pytest", "-q", "-rs", "tests/window"]
    code = subprocess.run(command, cwd=ROOT, env={**os.environ, "EIGENPARTS_PACKAGE": str(archive)}).returncode
    if folder is not None and code == 0:
        folder.mkdir(parents=True, exist_ok=True)
        for picture in (ROOT / "demo" / "window").glob("window_*.png"):
            shutil.copy(picture, folder)
    return code


if __name__ == "__main__":
    sys.exit(main())
