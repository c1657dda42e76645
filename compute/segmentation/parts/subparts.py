"""A part that was divided further, put back into its segmentation."""

from dataclasses import replace
from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from ...fields.scalar_field import Net
from ...surface.mesh import Ints
from ..borders.level_set_borders import Polyline
from .part_labels import BODY, Parts, Segmentation, listed_parents


def inserted(
    whole: Segmentation, part: int, inside: Ints, finer: Segmentation, finer_net: Net, net: Net
) -> Segmentation:
    """Replace a part by its own parts; what is left of it keeps its number, the others follow the last one.

    Parameters
    ----------
    whole : Segmentation
    part : int
        Label of the part in ``whole``.
    inside : (t,) int64
        The triangles of that part.
    finer : Segmentation
        Of those t triangles alone.
    finer_net, net : Net
        The nets that the vertices in the tables of ``finer`` and ``whole`` belong to.
    """
    first = int(whole.parts.id.max())
    labels = whole.labels.copy()
    labels[inside] = _renumbered(finer.labels.astype(np.int64), part, first)
    added = finer.parts.id != BODY
    columns = {
        "id": _renumbered(finer.parts.id[added], part, first),
        "parent": _renumbered(finer.parts.parent[added], part, first),
        "extremum": _nearest(finer_net, net, finer.parts.extremum[added]),
        "saddle": _nearest(finer_net, net, finer.parts.saddle[added]),
        "area": finer.parts.area[added],
        "n_triangles": finer.parts.n_triangles[added],
        "mirror": np.where(finer.parts.mirror[added] < 0, -1, _renumbered(finer.parts.mirror[added], part, first)),
    }
    joined = {name: np.concatenate([getattr(whole.parts, name), column]) for name, column in columns.items()}
    is_divided = joined["id"] == part
    joined["area"][is_divided] -= finer.parts.area[added].sum()
    joined["n_triangles"][is_divided] -= finer.parts.n_triangles[added].sum()
    left = joined["n_triangles"] > 0
    parent = np.zeros(1 + int(joined["id"].max()), dtype=np.int64)
    parent[joined["id"]] = joined["parent"]
    joined["parent"] = listed_parents(parent, joined["id"][left])[joined["id"]]
    parts = Parts(**{name: column[left] for name, column in joined.items()})
    return Segmentation(
        labels=labels,
        parts=parts,
        level=whole.level,
        warnings=(*whole.warnings, *finer.warnings),
        _trace=partial(_all_borders, whole, part, finer, first),
    )


def _all_borders(whole: Segmentation, part: int, finer: Segmentation, first: int) -> tuple[Polyline, ...]:
    """Return the borders of all parts, and those inside the one that was divided."""
    inner = (replace(line, part=int(_renumbered(np.array(line.part), part, first))) for line in finer.borders)
    return (*whole.borders, *inner)


def _renumbered(labels: Ints, part: int, first: int) -> Ints:
    return np.where(labels == BODY, part, first + labels)


def _nearest(finer_net: Net, net: Net, vertices: Ints) -> Ints:
    return net.used[cKDTree(net.positions[net.used]).query(finer_net.positions[vertices])[1]]
