"""Colours of parts: distinct for colour-blind people too, on a neutral grey body."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

BODY = "a6a6a6"
# Found by annealing among clear colours, without the dark and dull ones that shading makes muddy: the first 3, 6, 10,
# 14 and 19 with the body, and each and the one after it, as far apart as can be by CIEDE2000 in normal sight and under
# complete protanopia, deuteranopia and tritanopia (Machado et al. 2009).
PARTS = (
    *("e69f00", "3b82f6", "aa3377", "d9f99d", "15803d", "f5d0fe", "009e73", "4f46e5", "6ee7b7", "cc3311"),
    *("3bc18b", "c882c2", "9cd06e", "c7aff5", "f15e6c", "f9b9d1", "926cb9", "fedd4d", "bc822e"),
)


def standard_colours() -> list[tuple[float, ...]]:
    """Return linear RGB of the body and of the parts."""
    return [_linear(colour) for colour in (BODY, *PARTS)]


def use_colours(colours: list[tuple[float, ...]]) -> None:
    """From now on, take these linear RGB for the body and the parts; meshes keep theirs until coloured anew."""
    _in_use[:] = colours


def colours_of_labels(n_labels: int, places: Mapping[int, int] | None = None) -> NDArray[np.float32]:
    """Return (n_labels, 4) float32 linear RGBA, row 0 the body.

    Parameters
    ----------
    n_labels : int
    places : dict, optional
        The place of each part's colour among those of the parts, from 0; a part that is not among them has the one of
        its number. The colours repeat after the last.
    """
    body, *parts = _in_use
    place = np.arange(-1, n_labels - 1)
    known = {part: place for part, place in (places or {}).items() if 0 < part < n_labels}
    place[list(known.keys())] = list(known.values())
    rgb = np.array(parts)[place % len(parts)]
    rgb[:1] = body
    return np.column_stack([rgb, np.ones(n_labels)]).astype(np.float32)


def srgb_of(linear: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return colours as screens and files have them."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def _components(hexadecimal: str) -> tuple[float, ...]:
    return tuple(component / 255 for component in bytes.fromhex(hexadecimal))


def _linear(hexadecimal: str) -> tuple[float, ...]:
    srgb = np.array(_components(hexadecimal))
    return tuple(np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4).tolist())


# Linear RGB of what a Morse-Smale complex is made of: cold at the minima, warm at the maxima.
COMPLEX_COLOURS = {
    "minimum": _linear("0077bb"),
    "saddle": _linear("f0e442"),
    "maximum": _linear("cc3311"),
    "rising": _linear("e69f00"),
    "falling": _linear("66ccee"),
    "level": _linear("ffffff"),
}
# Linear RGB of the borders between parts: dark, which no part is.
BORDER_COLOUR = _linear("141414")
# The property that says which of these an object of a traced complex is.
COMPLEX_ROLE = "eigenparts_role"

_in_use = standard_colours()
