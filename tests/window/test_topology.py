"""The complex of a character, traced in the window and drawn over it."""

from tests.window.conftest import choose, unfold

COUNTS = "{obj['eigenparts_role']: len(obj['places']) // 3 for obj in bpy.data.objects if 'places' in obj}"


def test_a_traced_complex_is_drawn_and_its_points_sum_to_those_of_a_sphere(pair, show):
    before = pair.pixels()
    choose(pair, "trace complex")
    pair.wait_for("any('places' in obj for obj in bpy.data.objects)")
    pair.run("bpy.context.window_manager.eigenparts_complex_through = True")
    unfold(pair, "Topology")
    show("complex")
    counts = pair.value(COUNTS)
    assert counts["minimum"] - counts["saddle"] + counts["maximum"] == 2
    assert (pair.pixels() != before).any(axis=2).mean() > 0.01
