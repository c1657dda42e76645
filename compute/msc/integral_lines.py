"""Integral lines of a piecewise linear field: the paths of steepest ascent, through triangles and along edges."""

from dataclasses import dataclass

import numpy as np

from ..surface.mesh import Bools, Floats, Ints
from .ranked_net import RankedNet

# A line that meets an edge this close to one of its ends, as a fraction of the edge, goes through the vertex.
AT_VERTEX = 1e-9
# In the place of a corner: the exit is an edge.
ALONG_EDGE = -1
# Lines longer than this many steps, in units of the square root of the number of triangles, are given up.
LONGEST_LINE = 30


@dataclass(frozen=True, eq=False)
class Ascent:
    """The gradient of a field, which lines ascend along.

    Attributes
    ----------
    net : RankedNet
        Ordered by value.
    positions : (n, 3) float64
    values : (n,) float64
        The field; its negative for lines that descend.
    rates : (m, 3) float64
        How the barycentric coordinates change along the gradient of each triangle.
    """

    net: RankedNet
    positions: Floats
    values: Floats
    rates: Floats


@dataclass(frozen=True, eq=False)
class Exits:
    """Exits of vertices, across a triangle or along an edge; r rows.

    Attributes
    ----------
    vertex : (r,) int64
    slope : (r,) float64
        Rise of the field per length.
    corner : (r,) int64
        3 t + k for an exit across triangle t from its corner k; ``ALONG_EDGE`` for one along an edge.
    neighbour : (r,) int64
        The vertex at the other end of the edge; for a triangle, the higher one of the opposite edge.
    """

    vertex: Ints
    slope: Floats
    corner: Ints
    neighbour: Ints


def ascent_of(net: RankedNet, positions: Floats, values: Floats) -> Ascent:
    """Return the gradient of a field, in the form that lines are traced on."""
    triangles = net.links.triangles
    a, b, c = positions[triangles].swapaxes(0, 1)
    # Each side is opposite to the corner of its number; the gradient of a barycentric coordinate is perpendicular
    # to that side, and products of perpendiculars are products of the sides.
    sides = np.stack([c - b, a - c, b - a], axis=1)
    double_area_squared = (np.cross(sides[:, 0], sides[:, 1]) ** 2).sum(axis=1)
    # Rates relative to the first corner do not lose the differences of a field far from zero.
    rise = values[triangles] - values[triangles[:, :1]]
    drift = np.einsum("tkx,tk->tx", sides, rise)
    with np.errstate(divide="ignore", invalid="ignore"):
        rates = np.einsum("tkx,tx->tk", sides, drift) / double_area_squared[:, None]
    return Ascent(net, positions, values, np.where(np.isfinite(rates), rates, 0.0))


def exits_of(ascent: Ascent) -> Exits:
    """Return every exit that leads up from a vertex."""
    corners, rank = ascent.net.links.triangles, ascent.net.rank
    rates, values = ascent.rates, ascent.values
    slope = np.sqrt(np.maximum(np.einsum("tk,tk->t", rates, values[corners] - values[corners[:, :1]]), 0))
    ahead, behind = (np.roll(rates, -shift, axis=1) for shift in (1, 2))
    triangle, place = np.nonzero((ahead > 0) & (behind > 0))
    ends = np.stack([corners[triangle, (place + shift) % 3] for shift in (1, 2)])
    higher = np.where(rank[ends[0]] > rank[ends[1]], ends[0], ends[1])
    sides = ascent.net.links.edges.vertices
    low, high = np.where((rank[sides[:, 0]] < rank[sides[:, 1]])[:, None], sides, sides[:, ::-1]).T
    length = np.linalg.norm(ascent.positions[high] - ascent.positions[low], axis=1)
    along = (values[high] - values[low]) / np.maximum(length, np.finfo(float).tiny)
    return Exits(
        np.append(corners[triangle, place], low),
        np.append(slope[triangle], along),
        np.append(3 * triangle + place, np.full(len(low), ALONG_EDGE)),
        np.append(higher, high),
    )


def steepest_exits(exits: Exits, group: Ints, n_groups: int) -> Ints:
    """Return the row of the steepest exit of each group, -1 where a group has none."""
    order = np.lexsort((exits.slope, group))
    best = np.full(n_groups, -1)
    # Of several assignments to one place the last one stays.
    best[group[order]] = order
    return best


def trace(ascent: Ascent, exits: Exits, starts: Ints) -> tuple[list[Floats], Ints]:
    """Follow the steepest ascent from given exits until nothing is higher.

    Parameters
    ----------
    ascent : Ascent
    exits : Exits
        All of them.
    starts : (l,) int64
        The exit each line begins with.

    Returns
    -------
    lines : list of (p, 3)
        From the vertex of the exit to the end.
    end : (l,) int64
        The vertex each line ends at; -1 where it was given up.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.2.
    """
    best = steepest_exits(exits, exits.vertex, ascent.net.links.n_vertices)
    end = np.full(len(starts), -1)
    steps = [(np.arange(len(starts)), ascent.positions[exits.vertex[starts]])]
    heads = _leave(ascent, exits, starts, np.arange(len(starts)))
    for _ in range(LONGEST_LINE * int(len(ascent.net.links.triangles) ** 0.5 + 10)):
        steps.append((heads.line, _places(ascent, heads)))
        going_on = best[heads.vertex]
        stops = (heads.vertex >= 0) & (going_on < 0)
        end[heads.line[stops]] = heads.vertex[stops]
        at_vertex = (heads.vertex >= 0) & ~stops
        if not len(heads.line) or stops.all():
            break
        leaving = _leave(ascent, exits, going_on[at_vertex], heads.line[at_vertex])
        heads = _joined(leaving, _cross(ascent, _chosen(heads, heads.vertex < 0)))
    return _polylines(steps, len(starts)), end


@dataclass(frozen=True, eq=False)
class _Heads:
    """The heads of growing lines: at a vertex, or on the side opposite to a corner (3 t + k) of a triangle.

    The point divides that side, from corner k + 1 to corner k + 2, at ``fraction``.
    """

    line: Ints
    vertex: Ints
    corner: Ints
    fraction: Floats


def _chosen(heads: _Heads, rows: Bools | Ints) -> _Heads:
    return _Heads(heads.line[rows], heads.vertex[rows], heads.corner[rows], heads.fraction[rows])


def _joined(first: _Heads, second: _Heads) -> _Heads:
    columns = ("line", "vertex", "corner", "fraction")
    return _Heads(*(np.concatenate([getattr(first, name), getattr(second, name)]) for name in columns))


def _leave(ascent: Ascent, exits: Exits, taken: Ints, line: Ints) -> _Heads:
    """Go from vertices by the given exits, along an edge or across a triangle."""
    corner = exits.corner[taken]
    ahead, behind = (ascent.rates.ravel()[_next_corner(corner, shift)] for shift in (1, 2))
    # Rows that go along an edge have no corner; their fraction is not used.
    fraction = np.where(corner < 0, 0.0, behind / np.where(corner < 0, 1.0, ahead + behind))
    heads = _Heads(line, np.where(corner < 0, exits.neighbour[taken], -1), corner, fraction)
    return _snapped(ascent, heads)


def _cross(ascent: Ascent, heads: _Heads) -> _Heads:
    """Go on from points inside edges, across the next triangle or, where its gradient points back, along the edge."""
    corners = ascent.net.links.triangles.ravel()
    side = _next_corner(heads.corner, 1)
    across = ascent.net.links.opposite[side]
    start, stop = corners[side], corners[_next_corner(side, 1)]
    entry = _next_corner(across, 2)
    goes_in = (across >= 0) & (ascent.rates.ravel()[entry] > 0)
    higher = np.where(ascent.net.rank[start] > ascent.net.rank[stop], start, stop)
    along = _Heads(heads.line, higher, heads.corner, heads.fraction)
    # The neighbour's side runs the other way, unless the winding changes here.
    fraction = np.where(corners[across] == start, heads.fraction, 1 - heads.fraction)
    inside = _pass_through(ascent, heads.line[goes_in], entry[goes_in], fraction[goes_in])
    return _joined(_chosen(along, ~goes_in), _snapped(ascent, inside))


def _pass_through(ascent: Ascent, line: Ints, entry: Ints, fraction: Floats) -> _Heads:
    """Cross triangles from the side opposite to the corner ``entry`` to one of the other two."""
    ahead, behind = _next_corner(entry, 1), _next_corner(entry, 2)
    rates = ascent.rates.ravel()
    with np.errstate(divide="ignore", invalid="ignore"):
        time_ahead = np.where(rates[ahead] < 0, (1 - fraction) / -rates[ahead], np.inf)
        time_behind = np.where(rates[behind] < 0, fraction / -rates[behind], np.inf)
    leaves_ahead = time_ahead <= time_behind
    # Leaving opposite to the corner ahead, the side runs from the corner behind to the entry's; and so on around.
    weight_of_entry = rates[entry] * np.minimum(time_ahead, time_behind)
    corner = np.where(leaves_ahead, ahead, behind)
    return _Heads(line, np.full(len(line), -1), corner, np.where(leaves_ahead, weight_of_entry, 1 - weight_of_entry))


def _snapped(ascent: Ascent, heads: _Heads) -> _Heads:
    """Put points that are next to the end of their side onto that vertex."""
    corners = ascent.net.links.triangles.ravel()
    on_side = heads.vertex < 0
    at_start, at_stop = on_side & (heads.fraction < AT_VERTEX), on_side & (heads.fraction > 1 - AT_VERTEX)
    vertex = np.where(at_start, corners[_next_corner(heads.corner, 1)], heads.vertex)
    vertex = np.where(at_stop, corners[_next_corner(heads.corner, 2)], vertex)
    return _Heads(heads.line, vertex, heads.corner, heads.fraction)


def _next_corner(corner: Ints, shift: int) -> Ints:
    """Return the corner of the same triangle that is one or two further."""
    return corner - corner % 3 + (corner + shift) % 3


def _places(ascent: Ascent, heads: _Heads) -> Floats:
    corners = ascent.net.links.triangles.ravel()
    start, stop = (ascent.positions[corners[_next_corner(heads.corner, shift)]] for shift in (1, 2))
    on_side = start + heads.fraction[:, None] * (stop - start)
    return np.where((heads.vertex >= 0)[:, None], ascent.positions[heads.vertex], on_side)


def _polylines(steps: list[tuple[Ints, Floats]], n_lines: int) -> list[Floats]:
    line = np.concatenate([step[0] for step in steps])
    places = np.concatenate([step[1] for step in steps])
    order = np.argsort(line, kind="stable")
    return np.split(places[order], np.searchsorted(line[order], np.arange(1, n_lines)))
