"""What the documentation names is there: links, pictures, code, operators, options, files and sentences."""

import ast
import importlib
import re
import shlex

import pytest

from tests.docs.pages import (
    GUIDE,
    PAGES,
    ROOT,
    anchors,
    links,
    name_of,
    operators,
    prose,
    python_blocks,
    texts,
)
from tools.bench import BENCHMARKS

every_page = pytest.mark.parametrize("page", PAGES, ids=name_of)
every_page_of_the_guide = pytest.mark.parametrize("page", GUIDE, ids=name_of)

# Of other programs.
FOREIGN_OPTIONS = {"--background", "--command", "--quiet", "--nthreads", "--nworkers"} | {
    *("--online-mode", "--name", "--url", "--enable"),
}
FOLDERS = "benchmarks|cli|compute|docs|examples|operators|presets|tasks|tests|tools|ui"
EXAMPLE = re.compile(r"blender --background --command eigenparts ((?:segment|register|transfer|batch) [^\n`]+)")


@every_page
def test_links_and_pictures_lead_somewhere(page):
    missing = []
    for target in links(page):
        path, _, anchor = target.partition("#")
        goal = page.parent / path if path else page
        if not goal.exists() or (anchor and anchor not in anchors(goal)):
            missing.append(target)
    assert missing == []


def test_every_page_can_be_reached_from_the_readme():
    reached, waiting = set(), [ROOT / "README.md"]
    while waiting:
        page = waiting.pop().resolve()
        if page not in reached and page.suffix == ".md":
            reached.add(page)
            waiting += [page.parent / target.partition("#")[0] for target in links(page) if target[0] != "#"]
    assert {name_of(page) for page in PAGES} == {name_of(page) for page in reached}


@every_page
def test_python_on_the_page_can_be_read(page):
    for code in python_blocks(page):
        ast.parse(code)


@every_page
def test_operators_on_the_page_exist(page):
    named = re.findall(r"bpy\.ops\.eigenparts\.(\w+)|`eigenparts\.([a-z_]+)`", page.read_text())
    assert {first or second for first, second in named} - set(operators()) - {"cli"} == set()


@every_page
def test_operators_on_the_page_have_the_properties_they_are_given(page):
    for name, arguments in re.findall(r"bpy\.ops\.eigenparts\.(\w+)\(([^)\n]*)\)", page.read_text()):
        call = ast.parse(f"f({arguments})").body[0].value
        assert {keyword.arg for keyword in call.keywords} <= operators()[name]


@every_page
def test_options_on_the_page_exist(page):
    known = {text for text in texts("cli", "benchmarks", "tools") if text.startswith("--")} | FOREIGN_OPTIONS
    assert set(re.findall(r"(?<![\w-])--[a-z]+(?:-[a-z]+)*", prose(page))) - known == set()


@pytest.mark.parametrize("command", sorted({line for page in PAGES for line in EXAMPLE.findall(page.read_text())}))
def test_command_lines_on_the_pages_are_understood(command):
    if "..." in command:
        pytest.skip("a pattern, no example")
    pytest.importorskip("bpy", reason="the command line needs Blender as a Python module")
    from tools.extension import load_extension

    load_extension()
    options = importlib.import_module("eigenparts.cli.arguments").parse(shlex.split(command))
    assert options.command == command.split()[0]


def test_the_layers_of_a_transfer_are_those_of_the_window():
    pytest.importorskip("bpy", reason="operators need Blender as a Python module")
    from tools.extension import load_extension

    load_extension()
    choices = importlib.import_module("eigenparts.operators.transfer.layer_choices")
    page = (ROOT / "docs/command_line.md").read_text()
    (listed,) = re.findall(r"^\| `--layers KINDS` \| some of ([^|]*), with commas", page, re.MULTILINE)
    named = [kind.upper() for kind in re.findall(r"`(\w+)`", listed)]
    assert named == list(choices.LAYERS_OF_FILES)
    assert set(choices.LAYERS) - set(named) == {choices.MATERIALS}


def is_there(path):
    """Whether a file, a module or, after a dot, something in a module is in the project."""
    module, _, name = path.rpartition(".")
    holder = ROOT / f"{module}.py"
    return any((ROOT / f"{path}{end}").exists() for end in ("", ".py")) or (
        holder.is_file() and re.search(rf"^(?:def|class) {name}\b", holder.read_text(), re.MULTILINE) is not None
    )


@every_page
def test_files_and_modules_on_the_page_exist(page):
    text = page.read_text()
    files = re.findall(rf"`((?:{FOLDERS})/[\w/.]*\w)`", text)
    modules = re.findall(r"python -m\s+(benchmarks\.\w+)", text)
    paths = [*files, *(f"{module.replace('.', '/')}.py" for module in modules)]
    assert [path for path in paths if not is_there(path)] == []


@every_page
def test_targets_on_the_page_are_in_the_makefile(page):
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    assert set(re.findall(r"(?:`|^    )make ([a-z-]+)", page.read_text(), re.MULTILINE)) - targets == set()


def test_the_sentences_of_troubleshooting_are_those_of_the_code():
    rows = re.findall(r"^\| ([^|]+) \|.*\|$", (ROOT / "docs/guide/troubleshooting.md").read_text(), re.MULTILINE)
    sentences = [row for row in rows if row not in ("it says", "---")]
    assert len(sentences) > 30
    known = texts("operators", "tasks", "compute", "ui")
    patterns = {sentence: ".*".join(map(re.escape, sentence.split("…"))) for sentence in sentences}
    assert [name for name, pattern in patterns.items() if not any(re.fullmatch(pattern, text) for text in known)] == []


@every_page_of_the_guide
def test_what_the_guide_tells_to_press_is_in_the_window(page):
    bold = set(re.findall(r"\*\*([^*]+)\*\*", prose(page)))
    assert sorted(bold - texts("operators", "ui")) == []


def test_every_benchmark_is_on_its_page_and_run_by_the_tool():
    rows = re.findall(r"^\| `benchmarks/(\w+)\.py` \|", (ROOT / "docs/benchmarks.md").read_text(), re.MULTILINE)
    scripts = {path.stem for path in (ROOT / "benchmarks").glob("*.py") if "parse_args(" in path.read_text()}
    assert sorted(rows) == sorted(scripts)
    # This one wants a zip and a real window.
    assert set(BENCHMARKS) == scripts - {"responsiveness"}
