"""Every picture is made by code of the project and shown on a page, and every page shows pictures that can be made."""

import ast
import re

from tests.docs.pages import PAGES, ROOT, links

FOLDER = ROOT / "docs" / "pictures"


def made_by_script():
    """Return the names in the tables of the script that makes pictures."""
    tree = ast.parse((ROOT / "tools/pictures/__main__.py").read_text())
    tables = [node.value for node in tree.body if isinstance(node, ast.AnnAssign)]
    return {key.value for table in tables if isinstance(table, ast.Dict) for key in table.keys}


def taken_in_window():
    """Return the names that the tests of the window give to pictures for the guide."""
    tests = "".join(path.read_text() for path in (ROOT / "tests/window").glob("test_*.py"))
    return {f"window_{name}.png" for name in re.findall(r'\bshow\("(\w+)"', tests)}


def shown():
    return {target.rsplit("/", 1)[-1] for page in PAGES for target in links(page) if "pictures/" in target}


def test_every_picture_is_made_by_code_of_the_project():
    there = {path.name for path in FOLDER.iterdir()}
    assert there - made_by_script() - taken_in_window() == set()


def test_every_picture_that_the_script_makes_is_there():
    assert made_by_script()
    assert made_by_script() - {path.name for path in FOLDER.iterdir()} == set()


def test_every_picture_is_shown_on_a_page():
    assert {path.name for path in FOLDER.iterdir()} - shown() == set()


def test_no_picture_is_heavier_than_a_page_should_be():
    heavy = {path.name: path.stat().st_size for path in FOLDER.iterdir() if path.stat().st_size > 1_000_000}
    assert heavy == {}
