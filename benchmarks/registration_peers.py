"""The same pairs by pyFM: wave kernel signatures, a functional map, ZoomOut; with and without its orientation term."""

import warnings

import numpy as np

from benchmarks.registration_truth import Copy
from compute.surface.mesh import Floats, Ints, TriangleMesh

# As in pyFM's own example.
N_FUNCTIONS = 35
N_REFINED = 10
FIT = {"w_descr": 1.0, "w_lap": 1e-2, "w_dcomm": 1e-1}
# Name of the method and weight of the term for orientation.
ORIENTATION_WEIGHTS = {"pyFM": 0.0, "pyFM, orientation": 1.0}


def prepare_peer(mesh: TriangleMesh):
    """Return pyFM's mesh with its eigenfunctions."""
    from pyFM.mesh import TriMesh

    prepared = TriMesh(mesh.vertices, mesh.triangles, area_normalize=True, center=True)
    return prepared.process(k=2 * N_FUNCTIONS)


def match_by_peer(source, target, orientation_weight: float) -> Ints:
    """Return for each vertex of the target the vertex of the source."""
    from pyFM.functional import FunctionalMapping

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = FunctionalMapping(source, target)
        model.preprocess(n_descr=100, descr_type="WKS", subsample_step=5, k_process=2 * N_FUNCTIONS)
        model.fit(K=(N_FUNCTIONS, N_FUNCTIONS), w_orient=orientation_weight, **FIT)
        return model.get_p2p(FM=model.zoomout_refine(nit=N_REFINED, step=1))


def map_of_vertices(landed: Ints, source: Copy, target: Copy, n_functions: int) -> Floats:
    """Return (k, k) the functional map of a map of vertices, in the functions that truth is given in."""
    here, there = (copy.shape.functions[point_of_vertex(copy)][:, : n_functions + 1] for copy in (source, target))
    return np.linalg.lstsq(there, here[landed], rcond=None)[0][1:, 1:]


def point_of_vertex(copy: Copy) -> Ints:
    """(V,) the shape's point that each vertex is; every vertex of these meshes is analyzed."""
    points = np.zeros(copy.shape.node.max() + 1, dtype=np.int64)
    points[copy.shape.node] = np.arange(len(copy.shape.node))
    return points[: len(copy.analysis.mesh.vertices)]
