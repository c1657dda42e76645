"""What one process finds on some meshes: ``python -m tests.compute.processor_run IN.npz OUT.npz``."""

import sys

import numpy as np

from compute import TriangleMesh, analyze, mirror_parts, skeleton

MODES = ("nested", "features")


def results_of(name, vertices, triangles):
    """Return arrays by name: parts at all levels up to a few beyond the default one, their twins, joints and bones."""
    analysis = analyze(TriangleMesh(vertices, triangles), order=1)
    n_levels = min(analysis.hierarchy.n_levels, analysis.hierarchy.default_level + 3)
    parts = [analysis.segment(level=level, mode=mode).labels for level in range(n_levels) for mode in MODES]
    partner = mirror_parts(analysis, analysis.segment(mode="nested").labels)
    limbs = [mode for mode in MODES if analysis.segment(mode=mode).n_parts > 1]
    bones = [skeleton(analysis, mode=mode, partner=partner, n_pieces=2) for mode in limbs]
    return {
        f"{name} parts": np.stack(parts),
        f"{name} twins": np.array(partner),
        f"{name} bones": np.stack([found.bone_of_vertex for found in bones]),
        f"{name} joints": np.concatenate([found.joints for found in bones]) / np.ptp(vertices, axis=0).max(),
    }


if __name__ == "__main__":
    meshes = np.load(sys.argv[1])
    names = sorted({key.rsplit(" ", 1)[0] for key in meshes})
    results = [results_of(name, meshes[f"{name} vertices"], meshes[f"{name} triangles"]) for name in names]
    np.savez(sys.argv[2], **{key: array for found in results for key, array in found.items()})
