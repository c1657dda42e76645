"""What a fresh machine is told."""

import subprocess
import sys
from pathlib import Path

import pytest

from tools import environment
from tools.pythons import find_python
from tools.system_libraries import PACKAGE_OF_LIBRARY, explain_failed_import


def import_error(library):
    return f"Traceback ...\nImportError: {library}: cannot open shared object file: No such file or directory\n"


@pytest.mark.parametrize("library", list(PACKAGE_OF_LIBRARY))
def test_a_missing_library_is_named_with_its_package(library):
    sentence = explain_failed_import(import_error(library))
    assert library in sentence
    assert PACKAGE_OF_LIBRARY[library] in sentence.partition("apt install ")[2].rstrip(").").split()
    assert "\n" not in sentence


def test_all_missing_libraries_are_named_at_once(monkeypatch):
    monkeypatch.setattr("tools.system_libraries._can_load", lambda library: library != "libSM.so.6")
    sentence = explain_failed_import(import_error("libXi.so.6"))
    assert "libraries are missing: libXi.so.6, libSM.so.6 (Debian, Ubuntu: apt install libsm6 libxi6)." in sentence


def test_an_unknown_library_is_named_without_advice(monkeypatch):
    monkeypatch.setattr("tools.system_libraries._can_load", lambda library: True)
    sentence = explain_failed_import(import_error("libodd.so.3"))
    assert sentence == "Blender cannot be loaded because the system library is missing: libodd.so.3."


def test_another_reason_is_passed_on():
    assert explain_failed_import("ImportError: numpy is too old\n").endswith("ImportError: numpy is too old")


def test_the_running_python_is_found_first():
    assert find_python("{}.{}".format(*sys.version_info)) == sys.executable


def test_a_python_that_does_not_exist_is_not_found():
    assert find_python("3.99") is None


def test_a_launcher_without_its_python_is_passed_over(tmp_path, monkeypatch):
    launcher = tmp_path / "python3.99"
    launcher.write_text("#!/bin/sh\nexit 127\n")
    launcher.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert find_python("3.99") is None


def test_a_folder_that_is_not_ours_is_not_cleared(tmp_path):
    (tmp_path / "thesis.txt").write_text("precious")
    script = Path(__file__).parents[2] / "tools" / "environment.py"
    made = subprocess.run([sys.executable, script, tmp_path], capture_output=True, text=True)
    assert made.returncode != 0
    assert "was not made for this" in made.stdout + made.stderr
    assert (tmp_path / "thesis.txt").read_text() == "precious"


def test_an_environment_has_what_the_application_ships():
    packages = environment._packages("5.2.3")
    assert {"bpy==5.2.3", "numpy==2.3.4"} < set(packages)
    assert sum(package.startswith("scipy==") for package in packages) == 1


def test_a_newest_environment_leaves_numpy_and_scipy_to_pip():
    packages = environment._packages("5.2.3-newest")
    assert {"bpy==5.2.3", "numpy", "scipy"} < set(packages)
    assert not [package for package in packages if package.startswith(("numpy==", "scipy=="))]


def test_a_newest_environment_is_made_again_on_another_day(monkeypatch):
    class Tomorrow(environment.datetime.date):
        @classmethod
        def today(cls):
            return cls(2999, 1, 1)

    made_today = environment._fingerprint("5.2.3-newest"), environment._fingerprint("5.2.3")
    monkeypatch.setattr(environment.datetime, "date", Tomorrow)
    assert environment._fingerprint("5.2.3-newest") != made_today[0]
    assert environment._fingerprint("5.2.3") == made_today[1]
