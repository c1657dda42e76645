"""The hierarchy of a field on a surface: its levels, the bodies of its shells, and the sizes of its arcs."""

import numpy as np

from ...fields.scalar_field import Net, ScalarField
from ...msc.morse_smale import FieldTopology
from ...surface.cleaning import Surface
from ...surface.mesh import Ints
from .arc_measures import ArcMeasures, measure_arcs
from .levels import Hierarchy, build_hierarchy
from .shell_bodies import with_bodies


def measured_hierarchy(
    surface: Surface, field: ScalarField, topology: FieldTopology, *, ends_at_handles: bool
) -> tuple[Hierarchy, tuple[Ints, ...], tuple[ArcMeasures, ...]]:
    """Order the features of a field on a surface, and measure their arcs.

    Parameters
    ----------
    surface : Surface
    field : ScalarField
        On a net of n vertices over the surface.
    topology : FieldTopology
        Of the field on its net.
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
    measures = (measure_arcs(tree, arc, field) for tree, arc in zip(hierarchy.trees, arcs, strict=True))
    return hierarchy, arcs, tuple(measures)


def _shell_of_vertex(surface: Surface, net: Net) -> Ints:
    """Return the shell (n,) of each vertex of a net; -1 for those in no triangle."""
    shell = np.full(len(net.positions), -1)
    shell[net.triangles] = surface.mesh.component_of_triangle[net.triangle_of_surface, None]
    return shell
