"""The paper's matching: order and sign from persistence diagrams, parts from the spectral embedding of their tips.

A negated eigenfunction has the mirrored diagram, so flipped signs are found; but where a shape is symmetric a function
and its negation have the same diagram, and the sign stays open. This is shown, and does not decide alone.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...analysis.analysis import Analysis
from ...errors import RegistrationError
from ...fem.eigenbasis import Eigenbasis
from ...fields.scalar_field import refined_net
from ...msc.diagram_distance import bottleneck_distance, hausdorff_distance
from ...msc.links import links_of
from ...msc.merge_tree import merge_tree
from ...msc.ranked_net import ranked_net
from ...segmentation.parts.part_labels import BODY, Segmentation
from ...surface.assignment import cheapest_assignment
from ...surface.mesh import Bools, Floats, Ints
from ...surface.ties import ROUNDING, evened
from ..eigenfunctions.spectral_shape import SpectralShape
from ..eigenfunctions.zoomout import assigned

# Functions that are compared, and how far a function may move (Reuter 2009, sections 4.6 and 4.7).
DIAGRAM_FUNCTIONS = 6
NEIGHBOURING = 1
# Points nearer to the diagonal than this fraction of the range are noise (Reuter 2009, section 4.3).
NOISE = 1e-4
# Two distances that differ by less than this fraction of the function's range do not decide its sign.
SAME_DISTANCE = 0.005
METRICS = {"hausdorff": hausdorff_distance, "bottleneck": bottleneck_distance}


@dataclass(frozen=True, eq=False)
class DiagramMatching:
    """A matching of the functions of two shapes by their persistence diagrams.

    Attributes
    ----------
    distances : (k, k, 2) float64
        Distance of the diagram of each of the source's functions to that of each of the target's, as it is and
        negated, for surfaces of area 1; infinite where the two stand too far apart to be compared.
    ranges : (k,) float64
        Highest minus lowest value of each of the source's functions.
    """

    distances: Floats
    ranges: Floats

    @cached_property
    def order(self) -> Ints:
        """(k,) the target's function (from 0) that each of the source's is."""
        return assigned(self.distances.min(axis=2))

    @property
    def _chosen(self) -> Floats:
        return self.distances[np.arange(len(self.order)), self.order]

    @property
    def signs(self) -> Ints:
        """(k,) +1, or -1 where the negated diagram is nearer."""
        return np.where(self._chosen[:, 1] < self._chosen[:, 0] - ROUNDING * self.ranges, -1, 1)

    @property
    def is_open(self) -> Bools:
        """(k,) whether the diagrams leave the sign of a function open: those of the shape's symmetry."""
        return np.abs(self._chosen[:, 1] - self._chosen[:, 0]) <= SAME_DISTANCE * self.ranges


def match_diagrams(
    source: Analysis, target: Analysis, *, n_functions: int = DIAGRAM_FUNCTIONS, metric: str = "hausdorff"
) -> DiagramMatching:
    """Compare the separated diagrams of the first eigenfunctions of two shapes, each also with the negated ones.

    Parameters
    ----------
    source, target : Analysis
    n_functions : int
        Number of functions; fewer where a shape has not as many.
    metric : "hausdorff" or "bottleneck"
        Distance of two diagrams.

    Raises
    ------
    RegistrationError
        If there is no such metric.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.6.
    """
    if metric not in METRICS:
        raise RegistrationError(f'The metric is "hausdorff" or "bottleneck", not "{metric}".')
    n_functions = min(n_functions, len(source.eigenbasis.values), len(target.eigenbasis.values))
    source_points, target_points = (separated_points(analysis.eigenbasis, n_functions) for analysis in (source, target))
    return _compared(source_points, target_points, metric)


def match_shape_diagrams(source: SpectralShape, target: SpectralShape) -> DiagramMatching:
    """Compare the diagrams of the functions that matching uses, as `match_diagrams` does."""
    n_functions = min(DIAGRAM_FUNCTIONS, source.n_functions - 1, target.n_functions - 1)
    functions = slice(1, 1 + n_functions)
    source_points, target_points = (
        diagram_points(shape.triangles, shape.functions[:, functions]) for shape in (source, target)
    )
    return _compared(source_points, target_points, "hausdorff")


def _compared(source: list[Floats], target: list[Floats], metric: str) -> DiagramMatching:
    n_functions = len(source)
    distances = np.full((n_functions, n_functions, 2), np.inf)
    for i, points in enumerate(source):
        for j in range(max(0, i - NEIGHBOURING), min(n_functions, i + NEIGHBOURING + 1)):
            distances[i, j] = [METRICS[metric](points, sign * target[j]) for sign in (1, -1)]
    return DiagramMatching(distances, np.array([np.ptp(points) for points in source]))


def separated_points(basis: Eigenbasis, n_functions: int) -> list[Floats]:
    """Return the (n, 2) points (extremum, saddle) of the first functions' diagrams, for a surface of area 1."""
    net = refined_net(basis)
    return diagram_points(net.triangles, basis.functions[:, :n_functions] * np.sqrt(net.areas.sum()))


def diagram_points(triangles: Ints, functions: Floats) -> list[Floats]:
    """Return the (n, 2) points (extremum, saddle) of the diagram of each function (n, k).

    The lowest minimum and the highest maximum are in it as one more pair each, so that no diagram is empty.
    """
    links = links_of(triangles, len(functions))
    diagrams = []
    for function in functions.T:
        values = evened(function, float(np.ptp(function)))
        net = ranked_net(links, values)
        trees = merge_tree(net), merge_tree(net.reversed())
        points = values[np.concatenate([np.stack([tree.extremum, tree.saddle], axis=1) for tree in trees])]
        low, high = values[links.vertex].min(), values[links.vertex].max()
        is_feature = np.abs(points[:, 1] - points[:, 0]) > NOISE * (high - low)
        diagrams.append(np.concatenate([points[is_feature], [[low, high], [high, low]]]))
    return diagrams


@dataclass(frozen=True, eq=False)
class PartPairs:
    """Parts of two shapes that correspond by their tips.

    Attributes
    ----------
    source, target : (p,) int64
        Labels of the parts.
    distance : (p,) float64
        Of their tips in the spectral embedding.
    """

    source: Ints
    target: Ints
    distance: Floats


def match_tips(
    source: Analysis, target: Analysis, parts: tuple[Segmentation, Segmentation], matching: DiagramMatching
) -> PartPairs:
    """Pair the parts of two shapes by the distance of their extrema in the embedding ``f_i / value_i``.

    Parameters
    ----------
    source, target : Analysis
    parts : pair of Segmentation
        Of the source and of the target, with as many features as are to be registered.
    matching : DiagramMatching
        Puts the target's functions in the source's order, with the source's signs.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.7, equation 28.
    """
    source_ids, source_tips = _tips(parts[0])
    target_ids, target_tips = _tips(parts[1])
    source_places = _embedded(source.eigenbasis, source_tips)[:, : len(matching.order)]
    target_places = _embedded(target.eigenbasis, target_tips)[:, matching.order] * matching.signs
    distance = np.linalg.norm(source_places[:, None] - target_places, axis=2)
    rows, columns = cheapest_assignment(distance)
    return PartPairs(source_ids[rows], target_ids[columns], distance[rows, columns])


def _tips(segmentation: Segmentation) -> tuple[Ints, Ints]:
    """Return the labels of all parts but the body, and their extrema."""
    parts = segmentation.parts
    is_limb = parts.id != BODY
    return parts.id[is_limb], parts.extremum[is_limb]


def _embedded(basis: Eigenbasis, nodes: Ints) -> Floats:
    """Return (n, k) places of nodes in the spectral embedding of the surface with area 1."""
    area = basis.surface.mesh.areas.sum()
    return basis.functions[nodes] * np.sqrt(area) / _unit_values(basis)


def _unit_values(basis: Eigenbasis) -> Floats:
    return basis.values * basis.surface.mesh.areas.sum()
