"""Shells that were analyzed each by itself: every one but the first gets a body of its own beside the common one."""

from dataclasses import replace

import numpy as np

from ...surface.mesh import Ints
from .arc_tree import ALWAYS, NEVER, NO_ARC, NO_SADDLE, ArcTree, without_necks
from .levels import Hierarchy


def with_bodies(hierarchy: Hierarchy, shell_of_vertex: Ints) -> Hierarchy:
    """Return the hierarchy of a field on several shells with one root, and an arc for the whole of each shell.

    The trees of the shells stand side by side under the new root. That of the first shell is the common body as far as
    it is no part; around each other one lies an arc that is cut off at every level, with a number of its own. All
    arcs keep their places, and parts the order of their numbers.

    Parameters
    ----------
    hierarchy : Hierarchy
        Each of its trees has one root for each shell.
    shell_of_vertex : (n,) int64
        The shell that each vertex of the net lies on.
    """
    trees = tuple(_with_bodies(tree, shell_of_vertex[tree.extremum]) for tree in hierarchy.trees)
    return replace(hierarchy, trees=trees)


def _with_bodies(tree: ArcTree, shell: Ints) -> ArcTree:
    """Return one tree, given the shell (A,) of each arc."""
    roots = np.flatnonzero(tree.is_root)
    roots = roots[np.argsort(shell[roots])]
    n_arcs, n_more = len(tree.parent), len(roots) - 1
    whole, root = n_arcs + np.arange(n_more), n_arcs + n_more
    parent = np.concatenate([tree.parent, np.full(n_more, root), [NO_ARC]])
    parent[roots] = [root, *whole]
    part = np.where(tree.part > tree.n_roots, tree.part + n_more, tree.part)
    bodies = tree.n_roots + 1 + np.arange(n_more)
    part = np.concatenate([part, bodies, part[roots[:1]]])
    closing = np.concatenate([tree.closing, np.full(n_more, ALWAYS), [NEVER]])
    return replace(
        tree,
        n_roots=tree.n_roots + n_more,
        parent=parent,
        part=part,
        extremum=np.concatenate([tree.extremum, tree.extremum[roots[1:]], tree.extremum[roots[:1]]]),
        saddle=np.concatenate([tree.saddle, np.full(n_more + 1, NO_SADDLE)]),
        closing=closing,
        joint_part=part,
        joint_closing=closing,
        **without_necks(len(part)),
    )
