"""What the extension site asks of a package; docs/releasing.md has its rules."""

import ast
import re
import tomllib
from pathlib import Path

import pytest

from tools.builder import validate
from tools.package import check_wheel, checksums

ROOT = Path(__file__).parents[2]
MANIFEST_TEXT = (ROOT / "blender_manifest.toml").read_text()
MANIFEST = tomllib.loads(MANIFEST_TEXT)
PACKAGED = ("compute", "tasks", "operators", "ui", "cli", "presets", "__init__.py")
SOURCES = [path for part in PACKAGED for path in [ROOT / part, *(ROOT / part).rglob("*.py")] if path.is_file()]
# What permissions are about: modules of the network, names of files and of the clipboard.
ONLINE = {"socket", "ssl", "ftplib", "smtplib", "requests", "urllib.request", "http.client", "http.server"}
USES = {"clipboard": {"clipboard"}, "files": {"write_text", "write_bytes", "open"}, "network": ONLINE}


def test_blender_accepts_the_manifest_and_its_tags(tmp_path):
    validate(extension_with(MANIFEST_TEXT, tmp_path))


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [(r"^tagline = .*$", 'tagline = "Segments meshes."', "punctuation"), (r"^tags = .*$", 'tags = ["Parts"]', "Parts")],
    ids=["tagline with a full stop", "unknown tag"],
)
def test_blender_refuses_what_the_site_would_refuse(right, wrong, told, tmp_path):
    with pytest.raises(SystemExit, match=told):
        validate(extension_with(re.sub(right, wrong, MANIFEST_TEXT, flags=re.MULTILINE), tmp_path))


@pytest.mark.parametrize("permission", USES)
def test_a_permission_is_declared_if_and_only_if_it_is_used(permission):
    used = any(not names_in(path).isdisjoint(USES[permission]) for path in SOURCES)
    assert used == (permission in MANIFEST["permissions"])


def test_no_text_is_run_as_code():
    """No ``eval`` and no ``exec``, which reviewers of the site look for."""
    assert [path for path in SOURCES if not names_in(path).isdisjoint({"eval", "exec"})] == []


def test_the_name_is_not_that_of_blender():
    assert "blender" not in MANIFEST["name"].lower() + MANIFEST["id"]


def test_every_wheel_has_its_checksum_of_the_registry():
    assert set(checksums()) == {Path(wheel).name for wheel in MANIFEST["wheels"]}


def test_a_wheel_that_was_changed_is_refused(tmp_path):
    changed = tmp_path / Path(MANIFEST["wheels"][0]).name
    changed.write_bytes(b"PK")
    with pytest.raises(SystemExit, match="remove it"):
        check_wheel(changed)


def extension_with(manifest, folder):
    """Put an extension into a folder, without the wheels, which a checkout may not have yet, and return the folder."""
    (folder / "__init__.py").touch()
    without = re.sub(r"^wheels = \[.*?\]\n", "", manifest, flags=re.DOTALL | re.MULTILINE)
    (folder / "blender_manifest.toml").write_text(without)
    return folder


def names_in(path):
    """Return names, attributes and modules that a file speaks of."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Name):
            found.add(node.id)
        elif isinstance(node, ast.Attribute):
            found.add(node.attr)
        elif isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.update([node.module, *(f"{node.module}.{alias.name}" for alias in node.names)])
    return found
