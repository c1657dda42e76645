"""Build an extension repository that any web server or shared folder can host, for updates within Blender.

usage: python tools/repository.py [FOLDER]

The folder, dist/repository if none is named, gets the zips of all platforms, the list of them that Blender reads and a
page to install them from. Zips of other extensions that lie there are listed, too.
"""

import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from tools.builder import run_builder
from tools.package import DIST, build

FOLDER = DIST / "repository"


def main(arguments: list[str]) -> int:
    """Build zips and repository; print where it is."""
    folder = Path(arguments[0]).resolve() if arguments else FOLDER
    index = publish(build(), folder)
    sys.stdout.write(f"The repository is in {folder}; here its address is {index.as_uri()}\n")
    return 0


def publish(archives: list[Path], folder: Path) -> Path:
    """Put zips into a folder in place of those of earlier versions, and return the list of all zips there."""
    folder.mkdir(parents=True, exist_ok=True)
    for extension in {archive.name.split("-")[0] for archive in archives}:
        for old in folder.glob(f"{extension}-*.zip"):
            old.unlink()
    for archive in archives:
        shutil.copy(archive, folder)
    run_builder("server-generate", "--repo-dir", folder, "--html")
    return folder / "index.json"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
