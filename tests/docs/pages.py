"""The pages of the documentation, and what the code has that they may name."""

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
GUIDE = sorted((ROOT / "docs" / "guide").glob("*.md"))

BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)


def name_of(page):
    return str(page.relative_to(ROOT))


def python_blocks(page):
    return [code for language, code in BLOCK.findall(page.read_text()) if language == "python"]


def prose(page):
    """Return the text without fenced blocks."""
    return BLOCK.sub("", page.read_text())


def links(page):
    """Return the targets of links and pictures that lie in the project."""
    return [target for target in LINK.findall(prose(page)) if not target.startswith(("http:", "https:"))]


def anchors(page):
    """Return what links can name on a page, as hosts of repositories make it of headings."""
    plain = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in HEADING.findall(prose(page)))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in plain}


@cache
def syntax_trees(*folders):
    return [ast.parse(path.read_text()) for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


@cache
def texts(*folders):
    """Return every text of the code below some folders, with an ellipsis where a value is filled in."""
    nodes = [node for tree in syntax_trees(*folders) for node in ast.walk(tree)]
    found = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    found |= {_filled(node) for node in nodes if isinstance(node, ast.JoinedStr)}
    return {re.sub(r"\{[^}]*\}", "…", text) for text in found}


def _filled(node):
    return "".join(part.value if isinstance(part, ast.Constant) else "…" for part in node.values)


@cache
def operators():
    """Return the names of the properties of each operator by what follows "eigenparts." in its name."""
    classes = {
        node.name: node for tree in syntax_trees("operators") for node in tree.body if isinstance(node, ast.ClassDef)
    }
    named = {name: _idname(node) for name, node in classes.items()}
    return {idname.removeprefix("eigenparts."): _properties(name, classes) for name, idname in named.items() if idname}


def _idname(node):
    assigned = [line for line in node.body if isinstance(line, ast.Assign) and line.targets[0].id == "bl_idname"]
    return next((line.value.value for line in assigned if isinstance(line.value, ast.Constant)), "")


def _properties(name, classes):
    if name not in classes:
        return set()
    own = {line.target.id for line in classes[name].body if isinstance(line, ast.AnnAssign)}
    bases = [getattr(base, "id", "") for base in classes[name].bases]
    return own.union(*(_properties(base, classes) for base in bases))
