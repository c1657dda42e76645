"""What every result must be: finite, of labels that are listed, and the same twice."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import fields, is_dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import issparse

import compute

# Numbers that may be infinite or none: heights of edges that were not analyzed, what never dies.
MAY_BE_INFINITE = {"EdgeProfile", "PartTree", "PersistenceDiagram.intervals"}


def faults(path: str, result: Any, mesh: compute.TriangleMesh, last: compute.TriangleMesh) -> list[str]:
    """Return what is wrong with the result of a call on a mesh, or on two, the last of which is a target."""
    found = [] if _may_be_infinite(path, result) else _not_finite(result)
    for number, value in enumerate(result if isinstance(result, list) else [result]):
        check = CHECKS.get(type(value).__name__)
        found += check(value, (mesh, last)[number], last) if check else []
        found += _of_properties(value)
    return found + (_wrong_weights(result, len(mesh.vertices)) if path == "binding_weights" else [])


def same(first: Any, second: Any) -> bool:
    """Whether two results have the same numbers, texts and sizes in the same places."""
    rows = list(zip(_leaves(first), _leaves(second), strict=False))
    n_leaves = len(list(_leaves(first)))
    return len(rows) == n_leaves == len(list(_leaves(second))) and all(
        np.array_equal(one, other, equal_nan=np.asarray(one).dtype.kind == "f") for one, other in rows
    )


def _leaves(result: Any) -> Iterator[Any]:
    """Yield the arrays, numbers and texts in a result, in their order."""
    for value in _inside(result):
        yield from _leaves(value)
    if isinstance(result, np.ndarray | np.generic | int | float | str):
        yield result


def _inside(result: Any) -> list[Any]:
    """Return what a table, a list, a sparse matrix or a result of the engine consists of."""
    if is_dataclass(result):
        names = [field.name for field in fields(result) if not field.name.startswith("_")]
        return [getattr(result, name) for name in names if name not in ("shape", "field_choice")]
    if isinstance(result, dict):
        return [result[key] for key in sorted(result, key=str)]
    if issparse(result):
        return [result.data, result.indices]
    return list(result) if isinstance(result, list | tuple) else []


def _of_properties(result: Any) -> list[str]:
    """Return what is wrong with the properties of a result; a refusal is not."""
    found = []
    public = type(result) if type(result).__name__ in compute.__all__ else object
    for name, value in vars(public).items():
        if isinstance(value, property | cached_property) and not name.startswith("_"):
            with suppress(compute.EngineError):
                found += [f"{name}: {fault}" for fault in _not_finite(getattr(result, name))]
    return found


def _may_be_infinite(path: str, result: Any) -> bool:
    return path in MAY_BE_INFINITE or type(result).__name__ in MAY_BE_INFINITE


def _not_finite(result: Any) -> list[str]:
    numbers = [np.asarray(leaf) for leaf in _leaves(result)]
    bad = [values for values in numbers if values.dtype.kind == "f" and not np.isfinite(values).all()]
    return [f"{len(bad)} arrays have numbers that are not finite"] if bad else []


def _segmentation(result: compute.Segmentation, mesh: compute.TriangleMesh, _: compute.TriangleMesh) -> list[str]:
    ids, counts = np.unique(result.labels, return_counts=True)
    parts = result.parts
    found = []
    if result.labels.shape != (len(mesh.triangles),):
        found.append(f"labels of the shape {result.labels.shape}")
    if not (np.array_equal(ids, np.sort(parts.id)) and np.array_equal(counts, parts.n_triangles[np.argsort(parts.id)])):
        found.append("faces that are not counted in the table of parts")
    if not set(parts.parent.tolist()) <= {0, *parts.id.tolist()}:
        found.append("parents that are not listed")
    if (parts.parent == parts.id)[parts.id > 0].any():
        found.append("parts that grow out of themselves")
    return found


def _skeleton(result: compute.Skeleton, mesh: compute.TriangleMesh, _: compute.TriangleMesh) -> list[str]:
    n_joints = len(result.joints)
    found = []
    if (
        result.parent[0] != -1
        or not (result.parent[1:] < np.arange(1, n_joints)).all()
        or (result.parent[1:] < 0).any()
    ):
        found.append("bones that are no tree")
    if (
        result.bone_of_vertex.shape != (len(mesh.vertices),)
        or not np.isin(result.bone_of_vertex, range(n_joints)).all()
    ):
        found.append("vertices without a bone")
    if not (result.radius > 0).all() or (result.loops < 0).any() or (result.loops >= n_joints).any():
        found.append("radii or loops that cannot be")
    return found


def _correspondence(
    result: compute.Correspondence, source: compute.TriangleMesh, target: compute.TriangleMesh
) -> list[str]:
    found = []
    if (
        result.triangles.shape != (len(target.vertices),)
        or not np.isin(result.triangles, range(len(source.triangles))).all()
    ):
        found.append("vertices without a triangle of the source")
    if result.barycentric.min() < -1e-9 or np.abs(result.barycentric.sum(axis=1) - 1).max() > 1e-9:
        found.append("places outside their triangles")
    if result.confidence.min() < 0 or result.confidence.max() > 1:
        found.append("confidence outside 0 to 1")
    if len(result.triangle_of_triangle) != len(target.triangles):
        found.append("triangles without an image")
    return found


def _matching(result: compute.Matching, *_: compute.TriangleMesh) -> list[str]:
    is_one_to_one = len(np.unique(result.order)) == len(result.order)
    return [] if 0 <= result.confidence <= 1 and is_one_to_one else ["a matching that is none"]


def _eigenbasis(result: compute.Eigenbasis, *_: compute.TriangleMesh) -> list[str]:
    return [] if (np.diff(result.values) >= 0).all() and result.values[0] > 0 else ["eigenvalues that do not rise"]


def _wrong_weights(weights: np.ndarray, n_vertices: int) -> list[str]:
    is_right = len(weights) == n_vertices and np.abs(weights.sum(axis=1) - 1).max() < 1e-6 and weights.min() >= 0
    return [] if is_right else ["weights that do not sum to one"]


CHECKS = {
    "Segmentation": _segmentation,
    "Skeleton": _skeleton,
    "Correspondence": _correspondence,
    "Matching": _matching,
    "Eigenbasis": _eigenbasis,
}
