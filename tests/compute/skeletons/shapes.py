"""Slices and chains that are made up, to ask one thing of a skeleton at a time."""

import numpy as np

from compute import TriangleMesh
from compute.skeletons.branching import Chain
from compute.skeletons.slices import Slices


def slices_of(counts, girth=1.0, part=0) -> Slices:
    """Return slices of arcs without triangles, so many for each arc; girth and part of all or of each."""
    n = sum(counts)
    return Slices(
        offset=np.append(0, np.cumsum(counts)),
        of_triangle=np.zeros(0, dtype=np.int64),
        weight=np.zeros(0),
        girth=np.broadcast_to(np.asarray(girth, dtype=float), n),
        length=np.ones(n),
        part=np.broadcast_to(np.asarray(part, dtype=np.int64), n),
    )


def chain(start, end, *slices) -> Chain:
    return Chain(start, end, np.array(slices, dtype=np.int64))


def spindle(n_rings=25, n_around=12, height=3.0) -> TriangleMesh:
    """Return an ellipsoid of half axes 1, 1 and a height; the rings at its poles have no length."""
    z, angle = np.meshgrid(np.linspace(-height, height, n_rings), 2 * np.pi * np.arange(n_around) / n_around)
    z, angle = z.T.ravel(), angle.T.ravel()
    girth = np.sqrt(1 - (z / height) ** 2)
    k = np.arange(len(z) - n_around)
    right = k - k % n_around + (k + 1) % n_around
    triangles = [[k, right, right + n_around], [k, right + n_around, k + n_around]]
    vertices = np.stack([girth * np.cos(angle), girth * np.sin(angle), z], axis=1)
    return TriangleMesh(vertices, np.concatenate(triangles, axis=1).T)
