"""A maker for each kind of parameter of the scripting API, so that calls that are added later are tried, too."""

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

import compute
from tests.fuzzing.meshes import random_mesh


class Case:
    """Random arguments that belong together: two shapes, and all that is made of them, each when it is asked for."""

    def __init__(self, *seeds: int) -> None:
        self.rng = np.random.default_rng(seeds)
        self.boundary = self._choice(*("neumann",) * 7, "dirichlet")
        self.shells = self._choice("bridged", "bridged", "largest", "separate")
        self.order = self._choice(1, 1, 2, 3, "auto")

    def _choice(self, *values: Any) -> Any:
        return values[self.rng.integers(len(values))]

    def usual(self, *values: Any, wrong: tuple[Any, ...]) -> Any:
        """Return one of some values, or seldom one that is to be refused."""
        return self._choice(*(wrong if self.rng.random() < 0.06 else values))

    @cached_property
    def mesh(self) -> compute.TriangleMesh:
        return compute.TriangleMesh(*random_mesh(self.rng))

    @property
    def last_mesh(self) -> compute.TriangleMesh:
        """The target's mesh where there is one, else the only one."""
        return self.other_mesh if "other_mesh" in vars(self) else self.mesh

    @cached_property
    def other_mesh(self) -> compute.TriangleMesh:
        """The same shape moved and under other numbers, or with faces missing, or as it is; or another one."""
        vertices, triangles = self.mesh.vertices, self.mesh.triangles
        kind = self._choice("numbers", "faces", "pose", "same", "other")
        if kind == "numbers":
            order = self.rng.permutation(len(vertices))
            return compute.TriangleMesh(vertices[order], np.argsort(order)[triangles])
        if kind == "faces":
            return compute.TriangleMesh(vertices, triangles[self.rng.random(len(triangles)) > 0.1])
        if kind == "pose":
            return compute.TriangleMesh(self.pose, triangles)
        return self.mesh if kind == "same" else compute.TriangleMesh(*random_mesh(self.rng))

    @property
    def pose(self) -> np.ndarray:
        with np.errstate(all="ignore"):
            return self.mesh.vertices * (1 + 0.05 * self.rng.standard_normal(self.mesh.vertices.shape))

    @cached_property
    def analysis(self) -> compute.Analysis:
        return self._analyzed(self.mesh, self.field)

    @cached_property
    def target(self) -> compute.Analysis:
        field = self.field
        return self._analyzed(self.other_mesh, "diffusion" if isinstance(field, np.ndarray) else field)

    def _analyzed(self, mesh: compute.TriangleMesh, field: Any) -> compute.Analysis:
        return compute.analyze(mesh, field=field, order=self.order, boundary=self.boundary, shells=self.shells)

    @cached_property
    def field(self) -> Any:
        values = self.rng.standard_normal(len(self.mesh.vertices))
        some = self.rng.random(len(values)) < 0.02
        with np.errstate(all="ignore"):
            own = self.usual(
                *(values, 0 * values, np.round(values), 1e30 * values, 1e-30 * values, 1e30 + values),
                *(values.astype(np.float32), self.mesh.vertices[:, 0]),
                wrong=(1e300 * values, 1e-310 * values, np.where(some, np.nan, values), values[1:]),
            )
        return self.usual(*("diffusion",) * 5, int(self.rng.integers(1, 6)), own, own, wrong=("heat", 0, -1, 99))

    @cached_property
    def segmentation(self) -> compute.Segmentation:
        return self.analysis.segment(level=self.level, mode=self.mode)

    @property
    def level(self) -> int | None:
        n_levels = self.analysis.hierarchy.n_levels
        return self.usual(None, None, 0, n_levels - 1, int(self.rng.integers(n_levels)), wrong=(n_levels, -1, 10**9))

    @property
    def mode(self) -> str:
        return self.usual(*compute.MODES, wrong=("other",))

    @property
    def labels(self) -> np.ndarray:
        """Those of a division, random ones, or those of another mesh."""
        labels = self.segmentation.labels
        random = self.rng.integers(0, 5, len(labels)).astype(np.int32)
        return self.usual(labels, labels, random, wrong=(labels[1:], -1 - labels, labels.astype(np.float64)))

    @cached_property
    def skeleton(self) -> compute.Skeleton:
        return compute.skeleton(self.analysis)

    @cached_property
    def correspondence(self) -> compute.Correspondence:
        return compute.correspond(self.analysis, self.target)

    @property
    def points(self) -> Any:
        """Some pairs of vertices, seldom of others than there are."""
        n_pairs = int(self.rng.integers(0, 4))
        shapes = len(self.mesh.vertices), len(self.other_mesh.vertices)
        pairs = np.stack([self.rng.choice(n, n_pairs, replace=n < n_pairs) for n in shapes], axis=1)
        return self.usual(None, pairs, pairs, wrong=(pairs + 10**6, -1 - pairs, pairs + 0.5, [(0, 0)] * 2, "ab"))

    @property
    def number(self) -> float:
        return float(self._choice(*self.rng.standard_normal(4), 0, -1, 0.01, 1, 1e300, np.nan, np.inf))

    def values(self, n: int, *shape: int) -> np.ndarray:
        return self.rng.standard_normal((n, *shape)) * self._choice(1.0, 1e-30, 1e30, 0.0)


Maker = Callable[[Case], Any]

# By "call.parameter", or by the name of the parameter where it means the same everywhere.
MAKERS: dict[str, Maker] = {
    "mesh": lambda case: case.mesh,
    "analysis": lambda case: case.analysis,
    "source": lambda case: case.analysis,
    "target": lambda case: case.target,
    "analyses": lambda case: [case.analysis, case.target][: case.usual(1, 2, 2, wrong=(0,))],
    "skeleton": lambda case: case.skeleton,
    "correspondence": lambda case: case.correspondence,
    "segmentation": lambda case: case.segmentation,
    "basis": lambda case: case.analysis.eigenbasis,
    "field": lambda case: case.field,
    "n_functions": lambda case: case.usual(None, 1, 2, 3, 7, wrong=(0, -3, 40, 200, 10**6)),
    "solve_eigenbasis.n_functions": lambda case: case.usual(7, 1, 2, wrong=(0, -3, 40, 200, 10**6)),
    "judge_eigenfunctions.n_functions": lambda case: case.usual(8, 3, 100, wrong=(0, -1)),
    "order": lambda case: case.usual(case.order, wrong=(0, 4, "cubic")),
    "solve_eigenbasis.order": lambda case: case.usual(1, 2, 3, wrong=(0, 4)),
    "boundary": lambda case: case.usual(case.boundary, wrong=("open",)),
    "shells": lambda case: case.usual(case.shells, wrong=("all",)),
    "borders": lambda case: case.usual("edges", "exact", wrong=("smooth",)),
    "component": lambda case: case.usual(None, 0, wrong=(1, -1, 99)),
    "progress": lambda case: lambda fraction, text: None,
    "level": lambda case: case.level,
    "mode": lambda case: case.mode,
    "threshold": lambda case: case._choice(None, case.number),
    "n_parts": lambda case: case._choice(None, int(case.rng.integers(-1, 9))),
    "essential": lambda case: case._choice(False, True),
    "joints": lambda case: case._choice(False, True),
    "within": lambda case: case._choice(None, int(case.rng.choice(case.analysis.segment().parts.id)), 99),
    "labels": lambda case: case.labels,
    "poses": lambda case: case.usual([], [case.pose] * 2, wrong=([case.pose[1:]], [case.pose * np.nan])),
    "n_pieces": lambda case: case.usual(1, 2, 5, wrong=(0, -1)),
    "partner": lambda case: case._choice(None, compute.mirror_parts(case.analysis, case.segmentation.labels)),
    "layout": lambda case: case._choice(None, case.skeleton.layout),
    "softness": lambda case: case.usual(0.6, 0.0, 1e3, wrong=(np.nan, np.inf, -1.0)),
    "function": lambda case: case.usual(1, 2, 3, wrong=(0, -1, 99)),
    "method": lambda case: case.usual("auto", "auto", "place", "shape", wrong=("number", "faces")),
    "correspond_by_place.source": lambda case: case.mesh,
    "correspond_by_place.target": lambda case: case.target.mesh,
    "matching": lambda case: case._choice(None, None, compute.match(case.analysis, case.target)),
    "mirrored": lambda case: case._choice(False, True),
    "flips": lambda case: case.usual(None, {1: -1}, {1: 1, 2: -1}, wrong=({0: 1}, {3: 0})),
    "points": lambda case: case.points,
    "register.points": lambda case: case.usual(None, [case.points], wrong=([], [case.points] * 3)),
    "executor": lambda case: None,
    "reference": lambda case: case.usual(0, 0, 1, wrong=(-1, 5)),
    "first": lambda case: case.analysis.diagram,
    "second": lambda case: case.target.diagram,
    "diagram": lambda case: case.analysis.diagram,
    "metric": lambda case: case.usual("hausdorff", "bottleneck", wrong=("other",)),
    "x": lambda case: case.number,
    "y": lambda case: case.number,
    "fill_unsure.target": lambda case: case.target.mesh,
    "fill_unsure.values": lambda case: case.values(len(case.target.mesh.vertices), 2),
    "transfer_displacements.source": lambda case: case.mesh,
    "transfer_displacements.target": lambda case: case.target.mesh,
    "displacements": lambda case: case.values(len(case.mesh.vertices), 3),
    "transfer_corners.source": lambda case: case.mesh,
    "transfer_corners.values": lambda case: case.values(len(case.mesh.triangles), 3, 2),
    "corner_vertex": lambda case: case.target.mesh.triangles.ravel(),
    "corner_triangle": lambda case: np.repeat(np.arange(len(case.target.mesh.triangles)), 3),
    "softened_labels.labels": lambda case: case.rng.integers(0, 4, len(case.mesh.vertices)).astype(np.int32),
    "width": lambda case: case._choice(0.0, case.number, float(np.sqrt(case.mesh.areas.sum()))),
    # Methods of results.
    "Analysis.self": lambda case: case.analysis,
    "Correspondence.self": lambda case: case.correspondence,
    "MorseSmaleComplex.self": lambda case: case.analysis.complex,
    "PersistenceDiagram.self": lambda case: case.analysis.diagram,
    "face_of_triangle": lambda case: case._choice(None, np.arange(len(case.mesh.triangles)) // 2),
    "edges": lambda case: case._choice(None, case.mesh.edges.vertices[:3]),
    "Correspondence.transfer.values": lambda case: case.values(len(case.mesh.vertices), 2),
    "Correspondence.transfer_labels.labels": lambda case: np.arange(len(case.mesh.vertices)),
    "Correspondence.transfer_faces.labels": lambda case: np.arange(len(case.mesh.triangles)),
    "height": lambda case: case.number,
    "n_pairs": lambda case: int(case.rng.integers(-1, 9)),
    "persistence": lambda case: case.number,
    "dimension": lambda case: case._choice(0, 1, 2, 3),
}
