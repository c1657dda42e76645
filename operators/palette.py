"""Colours of parts: distinct for colour-blind people too, on a neutral grey body."""

import numpy as np

BODY = "9e9e9e"
# Chosen one after the other, each as far as possible from the body, from all before it and most of all from the one
# just before: by CIEDE2000 in normal sight, where lightness counts less because shading changes it, and under complete
# protanopia, deuteranopia and tritanopia (Machado et al. 2009).
PARTS = (
    *("ee9900", "4433cc", "bb0000", "3399ff", "772244", "bbeebb", "ffbbff", "008866", "ddee77", "ff2277"),
    *("443377", "66ddcc", "1166ff", "880022", "888833", "bb5599", "88cc66", "995544", "9977bb"),
)


def standard_colours() -> list[tuple[float, ...]]:
    """Return linear RGB of the body and of the parts."""
    return [_linear(colour) for colour in (BODY, *PARTS)]


def use_colours(colours: list[tuple[float, ...]]) -> None:
    """From now on, take these linear RGB for the body and the parts; meshes keep theirs until coloured anew."""
    _in_use[:] = colours


def colours_of_labels(n_labels: int) -> np.ndarray:
    """Return (n_labels, 4) float32 linear RGBA, row 0 the body; the colours repeat after the last."""
    body, *parts = _in_use
    rgb = [body, *(parts[label % len(parts)] for label in range(n_labels - 1))][:n_labels]
    return np.column_stack([np.reshape(rgb, (n_labels, 3)), np.ones(n_labels)]).astype(np.float32)


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
