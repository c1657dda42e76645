"""Separatrices: the integral lines that leave the saddles, up to maxima and down to minima."""

from dataclasses import dataclass

import numpy as np

from ..surface.mesh import Bools, Floats, Ints
from .critical_points import sector_nodes
from .integral_lines import Ascent, Exits, ascent_of, exits_of, steepest_exits, trace
from .merge_tree import ends_of_paths
from .ranked_net import RankedNet


@dataclass(frozen=True, eq=False)
class Separatrices:
    """Integral lines from saddles to extrema; l lines.

    Attributes
    ----------
    saddle, extremum : (l,) int64
        Net vertices.
    rises : (l,) bool
        Whether the line goes up, to a maximum.
    lines : tuple of (p, 3) float64
        Points of each line, from the saddle to the extremum.
    paths : tuple of (q,) int64
        The net vertices next to each line, every two joined by an edge.
    """

    saddle: Ints
    extremum: Ints
    rises: Bools
    lines: tuple[Floats, ...]
    paths: tuple[Ints, ...]

    def __len__(self) -> int:
        return len(self.saddle)


@dataclass(frozen=True, eq=False)
class Flow:
    """The path of every vertex up to a maximum, or down to a minimum where ``ascent`` is of the negative field.

    Attributes
    ----------
    rises : bool
        Whether the paths lead up.
    ascent : Ascent
    exits : Exits
    next_vertex : (n,) int64
        The net vertex that the steepest path from each vertex leads to or past; itself at extrema.
    end : (n,) int64
        The extremum that these lead to.
    """

    rises: bool
    ascent: Ascent
    exits: Exits
    next_vertex: Ints
    end: Ints


def flow_to_maxima(net: RankedNet, positions: Floats, values: Floats) -> Flow:
    """Return the flow along the gradient."""
    return _flow(True, ascent_of(net, positions, values))


def flow_to_minima(net: RankedNet, positions: Floats, values: Floats) -> Flow:
    """Return the flow against the gradient."""
    return _flow(False, ascent_of(net.reversed(), positions, -values))


def _flow(rises: bool, ascent: Ascent) -> Flow:
    exits, n = exits_of(ascent), ascent.net.n_vertices
    best = steepest_exits(exits, exits.vertex, n)
    next_vertex = np.where(best < 0, np.arange(n), exits.neighbour[best])
    return Flow(rises=rises, ascent=ascent, exits=exits, next_vertex=next_vertex, end=ends_of_paths(next_vertex))


def separatrices_of(saddles: Ints, up: Flow, down: Flow) -> Separatrices:
    """Trace a line in every sector above and below the saddles.

    The net says which extremum a line belongs to. The rare line that ends elsewhere, where the flow divides within a
    triangle, is replaced by the path along the net.
    """
    rising, falling = _lines_of(saddles, up), _lines_of(saddles, down)
    return Separatrices(
        saddle=np.append(rising.saddle, falling.saddle),
        extremum=np.append(rising.extremum, falling.extremum),
        rises=np.append(rising.rises, falling.rises),
        lines=rising.lines + falling.lines,
        paths=rising.paths + falling.paths,
    )


def _lines_of(saddles: Ints, flow: Flow) -> Separatrices:
    starts = _steepest_in_sectors(saddles, flow)
    saddle, first = flow.exits.vertex[starts], flow.exits.neighbour[starts]
    paths = _paths_on_net(saddle, first, flow.next_vertex)
    lines, end = trace(flow.ascent, flow.exits, starts)
    for astray in np.flatnonzero(end != flow.end[first]).tolist():
        lines[astray] = flow.ascent.positions[paths[astray]]
    return Separatrices(
        saddle=saddle,
        extremum=flow.end[first],
        rises=np.full(len(lines), flow.rises),
        lines=tuple(lines),
        paths=tuple(paths),
    )


def _steepest_in_sectors(saddles: Ints, flow: Flow) -> Ints:
    """Return the exit that each sector above the saddles is left by."""
    exits, n = flow.exits, flow.ascent.net.n_vertices
    vertex, neighbour, component = sector_nodes(saddles, flow.ascent.net.reversed())
    keys = vertex * n + neighbour
    order = np.argsort(keys)
    is_saddle = np.zeros(n, dtype=bool)
    is_saddle[saddles] = True
    rows = np.flatnonzero(is_saddle[exits.vertex])
    sector = component[order][keys[order].searchsorted(exits.vertex[rows] * n + exits.neighbour[rows])]
    chosen = Exits(exits.vertex[rows], exits.slope[rows], exits.corner[rows], exits.neighbour[rows])
    return rows[steepest_exits(chosen, sector, int(component.max(initial=-1)) + 1)]


def _paths_on_net(saddle: Ints, first: Ints, next_vertex: Ints) -> list[Ints]:
    """Follow the net from all saddles at once."""
    line = np.arange(len(saddle))
    steps = [(line, saddle), (line, first)]
    at = first
    while len(line := line[(further := next_vertex[at]) != at]):
        at = further[further != at]
        steps.append((line, at))
    numbers, vertices = (np.concatenate([step[column] for step in steps]) for column in (0, 1))
    order = np.argsort(numbers, kind="stable")
    return np.split(vertices[order], np.searchsorted(numbers[order], np.arange(1, len(saddle))))
