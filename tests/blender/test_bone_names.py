"""Names of bones."""

import numpy as np

NAMES = {0: "Body", 1: "Part 1", 2: "Part 2", 3: "tail"}
# Root, a bone of the body that carries each limb, and two bones in each.
PARENT = np.array([-1, 0, 1, 2, 0, 4, 5, 0, 7])
PART = np.array([0, 0, 1, 1, 0, 2, 2, 0, 3])


def named(extension, names=None, pairing=None, taken=()):
    from eigenparts.operators.armature.bone_names import name_bones

    return name_bones(PARENT, PART, names or NAMES, pairing or {}, set(taken))


def test_bones_are_numbered_outward_and_carriers_named_after_what_they_carry(extension):
    carriers = ["Part 1 root", "Part 1_1", "Part 1_2", "Part 2 root", "Part 2_1", "Part 2_2", "tail root", "tail"]
    assert named(extension) == ["Root", *carriers]


def test_mirrored_parts_share_a_name_and_differ_in_the_side(extension):
    names = named(extension, pairing={1: (1, 1), 2: (1, -1)})
    assert names[1:7] == ["Part 1 root.L", "Part 1_1.L", "Part 1_2.L", "Part 1 root.R", "Part 1_1.R", "Part 1_2.R"]


def test_names_of_the_user_are_kept(extension):
    given = {**NAMES, 1: "arm.L", 2: "right arm"}
    names = named(extension, given, {1: (1, 1), 2: (1, -1)})
    assert names[2] == "arm_1.L"
    assert names[5] == "right arm_1.R"


def test_no_name_is_given_twice_or_taken_from_a_group(extension):
    names = named(extension, {**NAMES, 2: "Part 1"}, taken={"tail", "Root"})
    assert len(set(names)) == len(names)
    assert not {"tail", "Root"} & set(names)


def test_long_names_keep_their_side_and_number(extension):
    """Blender cuts names after 63 bytes, here within a letter."""
    long = "右手" * 30
    names = named(extension, {**NAMES, 1: long + ".L", 2: long + "x.R"})
    assert len(set(names)) == len(names)
    assert max(len(name.encode()) for name in names) <= 63
    assert names[2].startswith("右手右手")
    assert [name[-4:] for name in names[2:4]] == ["_1.L", "_2.L"]
