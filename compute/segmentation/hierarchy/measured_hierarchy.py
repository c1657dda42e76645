"""The hierarchy of a field on a surface: its levels, the bodies of its shells, and the sizes of its arcs."""

from dataclasses import replace

import numpy as np

from ...fem.eigenbasis import Eigenbasis
from ...fields.scalar_field import Net, ScalarField
from ...msc.morse_smale import FieldTopology
from ...surface.cleaning import Surface
from ...surface.mesh import Ints
from .arc_measures import ArcMeasures, measure_arcs
from .arc_tree import NO_SADDLE, ArcTree
from .divided_arcs import with_necks
from .levels import Hierarchy, build_hierarchy
from .shell_bodies import with_bodies
from .twins import find_twins


def measured_hierarchy(
    surface: Surface, field: ScalarField, topology: FieldTopology, basis: Eigenbasis | None, *, ends_at_handles: bool
) -> tuple[Hierarchy, tuple[Ints, ...], tuple[ArcMeasures, ...]]:
    """Order the features of a field on a surface, and measure their arcs.

    Parameters
    ----------
    surface : Surface
    field : ScalarField
        On a net of n vertices over the surface.
    topology : FieldTopology
        Of the field on its net.
    basis : Eigenbasis, optional
        Of the surface, on the vertices of the net: what is symmetric is found by it.
    ends_at_handles : bool
        Whether parts end at essential saddles, too.

    Returns
    -------
    hierarchy : Hierarchy
        With a body of its own for every shell beside the first if each was analyzed by itself.
    arcs : tuple of (n,) int64
        For each tree, the arc that each vertex of the net lies on.
    measures : tuple of ArcMeasures
        For each tree.
    """
    hierarchy, arcs = build_hierarchy(
        topology,
        minima_are_features=field.minima_are_features,
        least_range=field.least_range,
        ends_at_handles=ends_at_handles,
    )
    if surface.is_apart:
        hierarchy = with_bodies(hierarchy, _shell_of_vertex(surface, field.net))
    elif basis is not None and len(basis.functions) == len(field.values):
        hierarchy = _with_twins(hierarchy, field, basis)
    measures = (measure_arcs(tree, arc, field) for tree, arc in zip(hierarchy.trees, arcs, strict=True))
    return with_necks(hierarchy, arcs, tuple(measures), field)


def _with_twins(hierarchy: Hierarchy, field: ScalarField, basis: Eigenbasis) -> Hierarchy:
    """Return a hierarchy whose twins appear and are cut off together."""
    return replace(hierarchy, trees=tuple(_joined(tree, hierarchy, field, basis) for tree in hierarchy.trees))


def _joined(tree: ArcTree, hierarchy: Hierarchy, field: ScalarField, basis: Eigenbasis) -> ArcTree:
    ends = np.flatnonzero(tree.has_saddle)
    extrema, leaf = np.unique(tree.extremum, return_inverse=True)
    saddles, end = np.unique(tree.saddle[ends], return_inverse=True)
    falling = np.append(hierarchy.persistence[::-1][: tree.n_features], field.value_range)
    persistence = np.zeros(len(saddles))
    persistence[end.reshape(-1)] = falling[tree.closing[ends]]
    twin, twin_saddle = find_twins(field.net, basis, extrema, saddles, field.values, persistence)
    part, closing = np.zeros(len(extrema), dtype=np.int64), np.zeros(len(saddles), dtype=np.int64)
    part[leaf.reshape(-1)], closing[end.reshape(-1)] = tree.part, tree.closing[ends]
    joint_closing = tree.closing.copy()
    joint_closing[ends] = np.minimum(closing, closing[twin_saddle])[end.reshape(-1)]
    saddle = np.full(len(tree.parent), NO_SADDLE)
    saddle[ends] = end.reshape(-1)
    images = np.append(twin[leaf.reshape(-1)][:, None], np.append(twin_saddle, NO_SADDLE)[saddle][:, None], axis=1)
    return replace(
        tree,
        joint_part=np.minimum(part, part[twin])[leaf.reshape(-1)],
        joint_closing=joint_closing,
        twin=_places_of(images, np.column_stack([leaf.reshape(-1), saddle])),
    )


def _places_of(images: Ints, rows: Ints) -> Ints:
    """Return the place of each image among some rows (A, 2), its own place where it is not there."""
    place = {(leaf, saddle): number for number, (leaf, saddle) in enumerate(rows.tolist())}
    return np.array([place.get((leaf, saddle), own) for own, (leaf, saddle) in enumerate(images.tolist())])


def _shell_of_vertex(surface: Surface, net: Net) -> Ints:
    """Return the shell (n,) of each vertex of a net; -1 for those in no triangle."""
    shell = np.full(len(net.positions), -1)
    shell[net.triangles] = surface.mesh.component_of_triangle[net.triangle_of_surface, None]
    return shell
