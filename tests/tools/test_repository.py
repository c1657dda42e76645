"""A repository that a studio hosts: Blender lists it, installs from it and finds the next version there."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.tools.test_package import PACKAGED
from tools.builder import run_builder
from tools.repository import publish

ROOT = Path(__file__).parents[2]
# What a user would do, in a process of its own: add the repository, install from it, update when there is a newer one.
SESSION = """
import sys
import bpy
import addon_utils
bpy.ops.wm.read_userpref()
# Blender asks for this even where all repositories are folders, as they are here.
bpy.context.preferences.system.use_online_access = True
addon_utils.enable("bl_pkg")
from bl_pkg.bl_extension_cli import cli_extension_handler
for line in sys.argv[1:]:
    assert cli_extension_handler(line.split()) == 0, line
bpy.ops.mesh.primitive_monkey_add()
assert bpy.ops.eigenparts.analyze() == {"FINISHED"}
module = sys.modules["bl_ext.studio.eigenparts"]
with open(module.__path__[0] + "/blender_manifest.toml") as manifest:
    version = next(line for line in manifest if line.startswith("version"))
print("parts:", bpy.context.object.data.eigenparts.n_parts, version)
addon_utils.disable("bl_ext.studio.eigenparts")
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """Builds the zip of a version, for this system and without wheels, which only the real zips have."""

    def built(version):
        source = tmp_path_factory.mktemp("source")
        for part in (*PACKAGED, "LICENSE"):
            copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
            copy(ROOT / part, source / part)
        manifest = re.sub(r"^(wheels|platforms) = \[.*?\]\n", "", _manifest(), flags=re.DOTALL | re.MULTILINE)
        manifest = re.sub(r'^version = ".*"', f'version = "{version}"', manifest, flags=re.MULTILINE)
        (source / "blender_manifest.toml").write_text(manifest)
        archive = tmp_path_factory.mktemp("zips") / f"eigenparts-{version}.zip"
        run_builder("build", "--source-dir", source, "--output-filepath", archive)
        return archive

    return built


def test_blender_installs_and_updates_from_a_repository(package, tmp_path):
    index = publish([package("7.0.0")], tmp_path / "served")
    address = f"repo-add --name Studio --url {index.as_uri()} --clear-all studio"
    assert 'version = "7.0.0"' in blender(tmp_path, address, "sync", "install --enable eigenparts")
    publish([package("7.1.0")], tmp_path / "served")
    assert 'version = "7.1.0"' in blender(tmp_path, "sync", "update")


def test_a_new_version_replaces_the_old_one_and_leaves_other_extensions(package, tmp_path):
    other = tmp_path / "other-1.0.0.zip"
    source = tmp_path / "other"
    source.mkdir()
    (source / "__init__.py").write_text("def register(): pass\ndef unregister(): pass\n")
    manifest = _manifest().partition("# One wheel")[0].replace('"eigenparts"', '"other"')
    (source / "blender_manifest.toml").write_text(manifest)
    run_builder("build", "--source-dir", source, "--output-filepath", other)
    publish([other], tmp_path / "served")
    for version in ("7.0.0", "7.1.0"):
        index = publish([package(version)], tmp_path / "served")
    listed = {(entry["id"], entry["version"]) for entry in json.loads(index.read_text())["data"]}
    assert {pair for pair in listed if pair[0] == "eigenparts"} == {("eigenparts", "7.1.0")}
    assert "other" in dict(listed)
    assert (tmp_path / "served" / "index.html").exists()


def blender(folder, *commands):
    """Return what Blender, with settings of its own in a folder, says after some commands about extensions."""
    user = folder / "user"
    user.mkdir(exist_ok=True)
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(user)}
    command = [sys.executable, "-c", SESSION, *commands]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert "parts:" in done.stdout, done.stdout + done.stderr
    return done.stdout


def _manifest():
    return (ROOT / "blender_manifest.toml").read_text()
