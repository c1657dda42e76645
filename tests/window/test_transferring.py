"""Transfer in the window: weights and parts of a character on another pose of it, which has other faces."""

import numpy as np
import pytest

from tests.window.conftest import choose, labels, nearest_quads, select, unfold

# Seconds; on a busy machine, where the surface is bent, this takes a while.
BENDING = 400.0
TARGET = "bpy.data.objects['humanoid walk']"
OPTIONS = "bpy.context.scene.eigenparts_transfer"
WEIGHTS = "[[(element.group, element.weight) for element in vertex.groups] for vertex in {obj}.data.vertices]"


@pytest.fixture
def transferred(pair):
    """The pair, after weights and parts went from the one to the other."""
    select(pair, "humanoid walk", "humanoid rest")
    pair.run(f"{OPTIONS}.layers = {{'GROUPS', 'PARTS'}}")
    choose(pair, "eigenparts transfer")
    pair.wait_for(f"len({TARGET}.vertex_groups) > 0", BENDING)
    pair.settle()
    return pair


def weights(window, obj):
    """Return (V, B) the weights of an object, in the order of its groups."""
    given = window.value(WEIGHTS.format(obj=obj))
    table = np.zeros((len(given), window.value(f"len({obj}.vertex_groups)")))
    for vertex, elements in enumerate(given):
        for group, weight in elements:
            table[vertex, group] = weight
    return table


def test_weights_are_those_the_character_was_made_with(transferred, walker, show):
    names = transferred.value(f"[group.name for group in {TARGET}.vertex_groups]")
    true = walker.weights[:, [[bone.name for bone in walker.bones].index(name) for name in names]]
    assert 0.5 * np.abs(weights(transferred, TARGET) - true).sum(axis=1).mean() < 0.05
    show_upper_arm(transferred)
    unfold(transferred, "Transfer")
    show("transferred")


def show_upper_arm(window):
    select(window, "humanoid walk")
    window.run(
        f"{TARGET}.vertex_groups.active = {TARGET}.vertex_groups['upper_arm.L']\n"
        "with over_view(): bpy.ops.object.mode_set(mode='WEIGHT_PAINT')"
    )


def test_parts_lie_where_they_lie_on_the_first_until_an_undo_takes_all_back(transferred, humanoid, walker):
    expected = np.array(labels(transferred))[nearest_quads(humanoid, walker)]
    assert (np.array(labels(transferred, f"{TARGET}.data")) == expected).mean() > 0.95
    transferred.press("Z", ctrl=True)
    transferred.wait_for(f"len({TARGET}.vertex_groups) == 0")
    assert not transferred.value(f"'part' in {TARGET}.data.attributes")
