"""Sentences in the sidebar, the list of parts, and what the menus have."""

from types import SimpleNamespace

import bpy
import pytest

from tests.blender.conftest import add_object
from tests.blender.drawn import Context, Layout, Record, draw_panels
from tests.shapes import star

SENTENCE = "Press Analyze: what protrudes becomes parts, such as limbs and fingers. Then move the level."


@pytest.fixture
def tab(extension):
    from eigenparts.ui import tab

    return tab


@pytest.mark.parametrize("width", [60, 200, 300, 1000])
def test_a_sentence_is_drawn_whole_in_lines_that_fit(tab, width):
    record = Record()
    tab.draw_hint(Layout(record), SENTENCE, width)
    assert " ".join(record.labels) == SENTENCE
    assert max(map(len, record.labels)) <= max(20, width / 7)
    assert len(record.labels) > 1 or width == 1000


def test_a_word_that_is_too_long_has_a_line_of_its_own(tab):
    record = Record()
    tab.draw_hint(Layout(record), f"See {'x' * 50} there.", 60)
    assert [line for line in record.labels if line] == ["See", "x" * 50, "there."]


def small_star(name):
    shape = star(n_arms=5, n_subdivisions=2)
    return add_object(shape.vertices, shape.triangles, name)


def test_the_direction_names_the_source_and_the_others(tab):
    def told():
        record = Record()
        tab.draw_direction(Layout(record), Context())
        return record.labels

    assert told() == ["Select meshes, the source last"]
    objects = [small_star(name) for name in ("first", "second", "last")]
    assert told() == ["last to 2 others"]
    objects[0].select_set(False)
    assert told() == ["last to second"]
    # What shares the mesh of the source has all of it already.
    objects[1].data = objects[2].data
    assert told() == ["Select meshes, the source last"]


class Bars(Layout):
    """A layout that keeps the texts of the progress bars."""

    def _called(self, name, *arguments, **options):
        if name == "progress":
            self.record.labels.append(options["text"])
        super()._called(name, *arguments, **options)
        return Bars(self.record)


@pytest.mark.parametrize("job", ["analyze", "register_selected", "transfer", "create_armature", "cut"])
def test_progress_stands_in_one_panel_in_place_of_its_button(tab, job):
    status = bpy.context.window_manager.eigenparts
    status.is_running, status.job, status.text = True, f"eigenparts.{job}", "Solving"
    panels = {tab.ANALYZE_PANEL, *tab.PANEL_OF_JOB.values()}
    rows = {}
    for panel in panels:
        record = Record()
        row = tab.main_row(SimpleNamespace(layout=Bars(record), bl_idname=panel), Context())
        rows[panel] = record.labels
        assert (row is None) == (record.labels == ["Solving"])
    assert [panel for panel, labels in rows.items() if labels] == [tab.PANEL_OF_JOB.get(status.job, tab.ANALYZE_PANEL)]


@pytest.mark.parametrize(("order", "elements"), [("1", "Linear"), ("2", "Quadratic"), ("AUTO", "Cubic")])
def test_the_panel_says_which_elements_were_taken(order, elements):
    small_star("star")
    bpy.ops.eigenparts.analyze(order=order)
    assert [text for text in draw_panels() if text.startswith(f"Diffusion, {elements}, levels 0 to ")]


def test_the_shares_in_the_list_add_up():
    small_star("star")
    bpy.ops.eigenparts.analyze(order="1")
    shares = [float(text.rstrip("%")) for text in draw_panels() if text.endswith("%")]
    assert len(shares) == bpy.context.object.data.eigenparts.n_parts > 1
    assert sum(shares) == pytest.approx(100, abs=0.5)
