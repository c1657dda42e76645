"""Test the zip in the real application, where there is one; pictures are left in demo/window.

usage: python tools/test_window.py
"""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tools.window import what_is_missing


def main() -> int:
    """Build the zip and run the tests with it; say so if nothing can be run here."""
    missing = what_is_missing()
    if missing:
        sys.stdout.write(f"Not run: {missing}\n")
        return 0
    subprocess.run([sys.executable, ROOT / "tools" / "package.py"], check=True)
    archive = next((ROOT / "dist").glob("*linux_x64.zip"))
    command = [sys.executable, "-m", "pytest", "-q", "-rs", "tests/window"]
    return subprocess.run(command, cwd=ROOT, env={**os.environ, "EIGENPARTS_PACKAGE": str(archive)}).returncode


if __name__ == "__main__":
    sys.exit(main())
