"""A part that was divided further, put back into its segmentation."""

from dataclasses import replace
from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from ...fields.scalar_field import Net
from ...surface.mesh import Ints
from ..borders.level_set_borders import Polyline
from .part_labels import BODY, Parts, Segmentation


def inserted(whole: Segmentation, part: int, inside: Ints, own: Segmentation, own_net: Net, net: Net) -> Segmentation:
    """Replace a part by its own parts; what is left of it keeps its number, the others follow the last one.

    Parameters
    ----------
    whole : Segmentation
    part : int
        Label of the part in ``whole``.
    inside : (t,) int64
        The triangles of that part.
    own : Segmentation
        Of those t triangles alone.
    own_net, net : Net
        The nets that the vertices in the tables of ``own`` and ``whole`` belong to.
    """
    first = int(whole.parts.id.max())
    labels = whole.labels.copy()
    labels[inside] = _renumbered(own.labels.astype(np.int64), part, first)
    added = own.parts.id != BODY
    columns = {
        "id": _renumbered(own.parts.id[added], part, first),
        "parent": _renumbered(own.parts.parent[added], part, first),
        "extremum": _nearest(own_net, net, own.parts.extremum[added]),
        "saddle": _nearest(own_net, net, own.parts.saddle[added]),
        "area": own.parts.area[added],
        "n_triangles": own.parts.n_triangles[added],
    }
    joined = {name: np.concatenate([getattr(whole.parts, name), column]) for name, column in columns.items()}
    is_divided = joined["id"] == part
    joined["area"][is_divided] -= own.parts.area[added].sum()
    joined["n_triangles"][is_divided] -= own.parts.n_triangles[added].sum()
    left = joined["n_triangles"] > 0
    parts = Parts(**{name: column[left] for name, column in joined.items()})
    trace = partial(_all_borders, whole, part, own, first)
    return Segmentation(labels, parts, whole.level, (*whole.warnings, *own.warnings), trace)


def _all_borders(whole: Segmentation, part: int, own: Segmentation, first: int) -> tuple[Polyline, ...]:
    """Return the borders of all parts, and those inside the one that was divided."""
    inner = (replace(line, part=int(_renumbered(np.array(line.part), part, first))) for line in own.borders)
    return (*whole.borders, *inner)


def _renumbered(labels: Ints, part: int, first: int) -> Ints:
    return np.where(labels == BODY, part, first + labels)


def _nearest(own_net: Net, net: Net, vertices: Ints) -> Ints:
    used = np.unique(net.triangles)
    return used[cKDTree(net.positions[used]).query(own_net.positions[vertices])[1]]
