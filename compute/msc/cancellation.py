"""Cancelling pairs in the Morse-Smale complex: lines to a cancelled extremum go on through its saddle."""

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .pairing import Pairing
from .separatrices import Separatrices

# A stretch of a line: its number, and whether it is walked from the extremum back to the saddle.
Stretch = tuple[int, bool]


def extended_lines(full: Separatrices, pairing: Pairing, n_cancelled: int) -> Separatrices:
    """Return the lines that are left when pairs are cancelled by rising persistence.

    Parameters
    ----------
    full : Separatrices
        All lines.
    pairing : Pairing
    n_cancelled : int
        How many pairs to cancel.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 3.3.
    """
    growing = _Lines(full)
    rows = zip(pairing.extremum.tolist(), pairing.saddle.tolist(), pairing.is_maximum.tolist(), strict=True)
    for extremum, saddle, is_maximum in itertools.islice(rows, n_cancelled):
        growing.cancel(extremum, saddle, is_maximum)
    kept = np.flatnonzero(np.isin(full.saddle, pairing.surviving_saddles(n_cancelled)) & ~growing.is_hidden)
    routes = [growing.route(line) for line in kept.tolist()]
    lines, paths = (tuple(_in_one(pieces, stretches) for stretches, _ in routes) for pieces in (full.lines, full.paths))
    return Separatrices(
        saddle=full.saddle[kept],
        extremum=np.array([end for _, end in routes], dtype=np.int64),
        rises=full.rises[kept],
        lines=lines,
        paths=paths,
    )


class _Lines:
    """The lines of a complex while pairs are cancelled."""

    def __init__(self, full: Separatrices) -> None:
        self._extremum = full.extremum.tolist()
        self._of_saddle: dict[tuple[int, bool], list[int]] = {}
        for line, key in enumerate(zip(full.saddle.tolist(), full.rises.tolist(), strict=True)):
            self._of_saddle.setdefault(key, []).append(line)
        self._beyond: dict[int, tuple[list[Stretch], int]] = {}
        self.is_hidden = np.zeros(len(full), dtype=bool)

    def cancel(self, extremum: int, saddle: int, is_maximum: bool) -> None:
        """Lead every line that ends at an extremum on, back to the saddle and to the extremum on its other side."""
        lines = self._of_saddle[saddle, is_maximum]
        routes = [self.route(line) for line in lines]
        # The pair is the least persistent one that is left, so one line ends here and one at an older extremum.
        cancelled = next(place for place, (_, end) in enumerate(routes) if end == extremum)
        stretches, end = next(route for route in routes if route[1] != extremum)
        self.is_hidden[lines[cancelled]] = True
        back = [(line, not is_back) for line, is_back in reversed(routes[cancelled][0])]
        self._beyond[extremum] = back + stretches, end

    def route(self, line: int) -> tuple[list[Stretch], int]:
        """Return the stretches of a line with all that was added to it, and the extremum at which it ends now."""
        stretches, end = [(line, False)], self._extremum[line]
        while end in self._beyond:
            further, end = self._beyond[end]
            stretches = stretches + further
        return stretches, end


def _in_one(lines: tuple[NDArray[Any], ...], stretches: list[Stretch]) -> NDArray[Any]:
    pieces = [lines[line][::-1] if is_back else lines[line] for line, is_back in stretches]
    return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
