"""Tips: the extrema at which limbs end, and the places up to which bones reach into them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..analysis.analysis import Analysis
from ..msc.reeb import ReebGraph
from ..surface.mesh import Floats
from ..surface.ties import evened, first_largest
from .branching import Chain
from .interior import Interior
from .layout import BoneLayout
from .sliced_shape import SlicedShape
from .slices import Slices

# Shares of the way from the last slice to the extremum that a tip may reach, as long as it stays inside.
REACHES = (0.85, 0.7, 0.5, 0.3)
# A middle line that never gets as far out as this fraction of its limb ends in a cavity.
CAVITY = 0.82


def tips_of_parts(analysis: Analysis, graph: ReebGraph, slices: Slices, layout: BoneLayout | None) -> dict[int, int]:
    """Return the leaves of the graph that are tips, with their parts: of each part the most extreme one."""
    is_upper = np.zeros(len(graph.vertex), dtype=bool)
    is_upper[graph.arcs[:, 1]] = True
    leaves = np.flatnonzero((graph.degree == 1) & (is_upper | analysis.field.minima_are_features))
    arc_of = {node: arc for arc, ends in enumerate(graph.arcs.tolist()) for node in ends}
    values = analysis.field.values
    height = evened(np.abs(values[graph.vertex] - np.median(values[analysis.net.used])))
    ranked = sorted(leaves.tolist(), key=lambda leaf: -height[leaf])
    tips: dict[int, int] = {}
    for leaf in ranked:
        of_arc = slices.of_arc(arc_of[leaf])
        if not len(of_arc):
            continue
        part = int(slices.part[of_arc[-1] if is_upper[leaf] else of_arc[0]])
        if layout is None or part in layout.tips or part not in layout.parts:
            tips.setdefault(part, leaf)
    return {leaf: part for part, leaf in tips.items()}


@dataclass(frozen=True, eq=False)
class Tip:
    """The tip of a limb; P poses.

    Attributes
    ----------
    places : (P, 3) float64
    last : int
        The slice from which the middle line runs straight to the tip.
    """

    places: Floats
    last: int


def tip_of_chain(chain: Chain, shape: SlicedShape) -> Tip:
    """Return the tip at the end of a chain: towards its extremum, or its farthest point if that lies in a cavity."""
    crown = hidden_crown(chain, shape.slices, shape.centres[0], shape.triangle_centres)
    if crown is None:
        place, last = shape.analysis.net.positions[shape.graph.vertex[chain.end]], int(chain.slices[-1])
    else:
        place, last = shape.triangle_centres[crown], widest_slice(chain, shape.slices)
    vertex = shape.nearest_vertex(place)
    return Tip(reaching(shape.centres[:, last], shape.poses[:, vertex], shape.interior), last)


def with_straight_tips(centres: Floats, tips: Mapping[Chain, Tip]) -> Floats:
    """Return the centres (P, S, 3) of slices, on each chain those behind the last before its tip on a straight line."""
    straight = centres.copy()
    for chain, tip in tips.items():
        late = chain.slices[1 + np.flatnonzero(chain.slices == tip.last)[0] :]
        share = np.linspace(0, 1, len(late) + 2)[1:-1, None]
        start = centres[:, tip.last]
        straight[:, late] = start[:, None] + share * (tip.places - start)[:, None]
    return straight


def hidden_crown(chain: Chain, slices: Slices, centres: Floats, places: Floats) -> int | None:
    """Return the net triangle farthest from where a limb begins, if its extremum lies in a cavity such as a mouth.

    A middle line that runs the length of a limb comes near its farthest point, even if it curls back.
    """
    is_of_chain = np.zeros(slices.count, dtype=bool)
    is_of_chain[chain.slices] = True
    triangles = np.flatnonzero(is_of_chain[slices.of_triangle])
    line = centres[chain.slices]
    distance = np.linalg.norm(places[triangles] - line[0], axis=1)
    farthest = int(first_largest(distance))
    reach = np.linalg.norm(line - line[0], axis=1).max()
    return int(triangles[farthest]) if reach < CAVITY * distance[farthest] else None


def widest_slice(chain: Chain, slices: Slices) -> int:
    """Return the widest slice in the outer half of a chain: behind it the level sets close."""
    outer = chain.slices[len(chain.slices) // 2 :]
    return int(outer[first_largest(slices.girth[outer])])


def reaching(last: Floats, extremum: Floats, interior: Interior) -> Floats:
    """Return the places (P, 3) of a tip in all poses: as far towards the extremum as it stays inside at rest."""
    reach = next((reach for reach in REACHES if interior.holds(last[:1] + reach * (extremum - last)[:1])[0]), 0.0)
    return last + reach * (extremum - last)
