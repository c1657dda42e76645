"""Levels: which pairs of extremum and saddle survive, from the whole body down to the smallest feature."""

from dataclasses import dataclass

import numpy as np

from ...errors import LevelError
from ...msc.merge_tree import MergeTree
from ...msc.morse_smale import FieldTopology
from ...surface.mesh import Bools, Floats, Ints
from ...surface.ties import ROUNDING, evened
from .arc_tree import ALWAYS, NEVER, ArcTree
from .tree_building import Features, arc_of_vertex, build_arc_tree

# Pairs below this fraction of the field's range are noise of the triangulation (Reuter 2009, section 4.3).
NOISE_THRESHOLD = 1e-4
# Pairs above this fraction are what people call parts: the middle of the plateau 0.04 to 0.08 on the Princeton
# segmentation benchmark with the diffusion field.
DEFAULT_THRESHOLD = 0.05


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """All pairs of a field by persistence, and the noise-free trees that any level is read from.

    Level L keeps the L most persistent pairs. Every extremum that survives is a part, the most extreme one too; parts
    are numbered by falling persistence, so that a part keeps its number at every level.

    Attributes
    ----------
    pairs : (n, 2) int64
        Net vertices (extremum, saddle), by rising persistence.
    persistence : (n,) float64
        Difference of the field between the two.
    is_maximum : (n,) bool
        Whether the extremum is a maximum.
    value_range : float
        Highest minus lowest value of the field.
    n_levels : int
        Pairs above the noise threshold, and one for level 0, at which all is body.
    trees : tuple of ArcTree
        One for each kind of extremum that is a feature.
    """

    pairs: Ints
    persistence: Floats
    is_maximum: Bools
    value_range: float
    n_levels: int
    trees: tuple[ArcTree, ...]

    @property
    def default_level(self) -> int:
        """The level that a person would most likely pick."""
        return self.level_of_threshold(DEFAULT_THRESHOLD)

    def level_of_threshold(self, threshold: float) -> int:
        """Return the level that keeps the pairs of at least this fraction of the range."""
        if not threshold >= 0:
            raise LevelError(f"The threshold is a fraction of the field's range, from 0 to 1, not {threshold}.")
        n_above = int((self.persistence >= (threshold - ROUNDING) * self.value_range).sum())
        return min(n_above, self.n_levels - 1)

    def checked_level(self, level: int) -> int:
        """Return the level, or say which levels there are."""
        if not 0 <= level < self.n_levels or level != int(level):
            raise LevelError(f"Level {level} does not exist; this shape has levels 0 to {self.n_levels - 1}.")
        return int(level)


@dataclass(frozen=True, eq=False)
class _Sweep:
    """A merge tree with the direction it was swept in."""

    tree: MergeTree
    is_of_maxima: bool


def build_hierarchy(
    topology: FieldTopology, *, minima_are_features: bool, least_range: float = 0.0, ends_at_handles: bool = False
) -> tuple[Hierarchy, tuple[Ints, ...]]:
    """Order the features of a field, and place the net on the trees of its levels.

    Parameters
    ----------
    topology : FieldTopology
        The field on its net of n vertices.
    minima_are_features : bool
        Whether minima are parts as well as maxima.
    least_range : float
        A field with a smaller range than this has no features.
    ends_at_handles : bool
        Whether parts end at essential saddles, too, where a handle closes; they survive at every level.

    Returns
    -------
    hierarchy : Hierarchy
    arcs : tuple of (n,) int64
        For each tree, the arc that each vertex of the net lies on.
    """
    sweeps = [_Sweep(topology.maxima, True)] + ([_Sweep(topology.minima, False)] if minima_are_features else [])
    value_range = float(np.ptp(topology.values[topology.links.vertex]))
    pairs, persistence, is_maximum = _pairs_by_persistence(topology.values, sweeps)
    noise = max(NOISE_THRESHOLD * value_range, np.inf if value_range < least_range else 0.0)
    n_features = int((persistence > noise).sum())
    always = np.unique(topology.essential.loops) if ends_at_handles else np.zeros(0, dtype=np.int64)
    trees, arcs = _grow_trees(sweeps, pairs[::-1][:n_features], always)
    hierarchy = Hierarchy(
        pairs=pairs,
        persistence=persistence,
        is_maximum=is_maximum,
        value_range=value_range,
        n_levels=n_features + 1,
        trees=trees,
    )
    return hierarchy, arcs


def _pairs_by_persistence(values: Floats, sweeps: list[_Sweep]) -> tuple[Ints, Floats, Bools]:
    pairs = np.concatenate([np.stack([sweep.tree.extremum, sweep.tree.saddle], axis=1) for sweep in sweeps])
    is_maximum = np.concatenate([np.full(len(sweep.tree.saddle), sweep.is_of_maxima) for sweep in sweeps])
    persistence = evened(np.abs(values[pairs[:, 0]] - values[pairs[:, 1]]))
    order = np.lexsort((-pairs[:, 0], persistence))
    return pairs[order], persistence[order], is_maximum[order]


def _grow_trees(sweeps: list[_Sweep], features: Ints, always: Ints) -> tuple[tuple[ArcTree, ...], tuple[Ints, ...]]:
    """Build the arc tree of each sweep.

    ``features`` are the pairs above the noise by falling persistence, ``always`` the saddles that survive at any level.
    """
    n_vertices = len(sweeps[0].tree.rank)
    extrema = np.concatenate([*(sweep.tree.roots for sweep in sweeps), features[:, 0]])
    part = np.zeros(n_vertices, dtype=np.int64)
    part[extrema] = np.arange(1, len(extrema) + 1)
    closing = np.full(n_vertices, NEVER)
    # Where pairs share a saddle, the most persistent one keeps it alive: the last one that is written stays.
    closing[features[::-1, 1]] = np.arange(len(features))[::-1]
    closing[always] = ALWAYS
    known = Features(part, closing, n_roots=len(extrema) - len(features), n_features=len(features))
    trees, arcs = [], []
    for sweep in sweeps:
        tree, places = build_arc_tree(sweep.tree, sweep.is_of_maxima, known)
        trees.append(tree)
        arcs.append(arc_of_vertex(sweep.tree, tree, places))
    return tuple(trees), tuple(arcs)
