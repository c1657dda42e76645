"""Names of bones: after their parts, numbered outward, with the suffix that Blender mirrors poses by."""

from collections import Counter

import numpy as np
from numpy.typing import NDArray

ROOT = "Root"
SUFFIXES = {1: ".L", -1: ".R", 0: ""}
# Names that already tell a side, and names that nobody gave.
SIDED = (".L", ".R", "_L", "_R", ".l", ".r", "_l", "_r")
UNNAMED = "Part "
# Bytes in the names of bones; Blender would cut longer ones, and with them the side and the number.
LONGEST_NAME = 63
# What of them is left for the name of a part, so that what its bone is or its number stays.
LONGEST_BASE = 50


def name_bones(
    parent: NDArray[np.int64],
    part: NDArray[np.int64],
    names: dict[int, str],
    pairing: dict[int, tuple[int, int]],
    taken: set[str],
) -> list[str]:
    """Return (J,) the name of the bone that ends in each joint; the first is that of the root.

    Parameters
    ----------
    parent, part : (J,) int
        Of the joints of a skeleton.
    names : dict
        Of the parts.
    pairing : dict
        For each part that has a side, the part both are called after and the side.
    taken : set of str
        Names that must not be used.
    """
    sided = {number: _sided(number, names, pairing) for number in names}
    goals = _goals(parent, part)
    count = Counter(int(number) for number, goal in zip(part[1:], goals[1:], strict=True) if goal < 0)
    seen: Counter[int] = Counter()
    given = [_free(ROOT, "", taken)]
    for joint in range(1, len(parent)):
        limb, goal = int(part[joint]), goals[joint]
        base, suffix = sided[goal if goal >= 0 else limb]
        if goal >= 0:
            base = _shortened(base, LONGEST_BASE) + " root"
        elif count[limb] > 1:
            seen[limb] += 1
            base = f"{_shortened(base, LONGEST_BASE)}_{seen[limb]}"
        given.append(_free(base, suffix, taken.union(given)))
    return given


def _goals(parent: NDArray[np.int64], part: NDArray[np.int64]) -> list[int]:
    """Return for each bone that only carries another part the number of that part, -1 for all others."""
    goals = []
    for joint in range(len(parent)):
        carried = set(part[parent == joint].tolist())
        is_carrier = joint > 0 and len(carried) == 1 and int(part[joint]) not in carried
        goals.append(carried.pop() if is_carrier else -1)
    return goals


def _sided(number: int, names: dict[int, str], pairing: dict[int, tuple[int, int]]) -> tuple[str, str]:
    name = names[number]
    if name.endswith(SIDED):
        return name[:-2], name[-2:]
    first, side = pairing.get(number, (number, 0))
    # Both sides share a name, unless the user has named them.
    shared = names.get(first, name) if name.startswith(UNNAMED) else name
    return shared, SUFFIXES[side]


def _free(base: str, suffix: str, taken: set[str]) -> str:
    endings = [suffix, *(f"_{number:03}{suffix}" for number in range(1, len(taken) + 2))]
    candidates = (_shortened(base, LONGEST_NAME - len(ending)) + ending for ending in endings)
    return next(candidate for candidate in candidates if candidate not in taken)


def _shortened(name: str, n_bytes: int) -> str:
    """Return the beginning of a name that takes so many bytes at most, in whole letters."""
    return name.encode()[:n_bytes].decode(errors="ignore")
