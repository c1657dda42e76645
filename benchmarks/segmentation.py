"""Parts against people: Rand dissimilarity on meshes that people divided (Princeton segmentation benchmark).

usage: python -m benchmarks.segmentation --data DIR

DIR holds psb-dev/off/N.off and psb-dev/seg/N/N_K.seg, one label a face. The Rand dissimilarity is the share of pairs of
faces on which two divisions disagree, averaged over the people who divided a mesh; "people" is the mean between them.
Beside it, in the same run, spectral clustering told the number of parts that people gave (median).
"""

import argparse
import itertools
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.cluster.vq import kmeans2

from benchmarks.posed_families import read_mesh
from compute import Analysis, TriangleMesh, analyze
from compute.surface.mesh import Ints

# Thresholds between which the default would be chosen if one kind of shape were left out.
THRESHOLDS = (0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.1)
# Meshes 1 to 20 are one kind, 21 to 40 the next, and so on.
MESHES_OF_A_KIND = 20


@dataclass(frozen=True, eq=False)
class Row:
    """One mesh: dissimilarities to the people's divisions."""

    number: int
    n_vertices: int
    n_parts: int
    features: float
    nested: float
    unjointed: float
    clustering: float
    people: float
    nested_by_threshold: dict[float, float]


def main() -> int:
    """Print the table as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    folder = parser.parse_args().data / "psb-dev"
    if not folder.is_dir():
        sys.stdout.write(f"Skipped: there is no {folder}.\n")
        return 0
    rows = [_measure(path) for path in sorted((folder / "off").glob("*.off"), key=lambda path: int(path.stem))]
    sys.stdout.write(_table(rows))
    return 0


def rand_dissimilarity(first: Ints, second: Ints) -> float:
    """Return the share of pairs of faces that one division joins and the other parts."""
    _, first = np.unique(first, return_inverse=True)
    _, second = np.unique(second, return_inverse=True)
    both = np.bincount(first * (second.max() + 1) + second)
    agreeing = [_pairs(both), _pairs(np.bincount(first)), _pairs(np.bincount(second))]
    return float((agreeing[1] + agreeing[2] - 2 * agreeing[0]) / _pairs(np.array([len(first)])))


def _pairs(counts: Ints) -> float:
    return float((counts * (counts - 1.0) / 2).sum())


def _measure(path: Path) -> Row:
    people = [np.loadtxt(file, dtype=int) for file in sorted((path.parents[1] / "seg" / path.stem).glob("*.seg"))]
    analysis = analyze(read_mesh(path))
    nested = analysis.segment()
    true_number = int(np.median([len(np.unique(labels)) for labels in people]))
    between = [rand_dissimilarity(a, b) for a, b in itertools.combinations(people, 2)]
    by_threshold = {x: _mean(analysis.segment(threshold=x).labels, people) for x in THRESHOLDS}
    return Row(
        int(path.stem),
        len(analysis.mesh.vertices),
        nested.n_parts,
        _mean(analysis.segment(mode="features").labels, people),
        _mean(nested.labels, people),
        _mean(analysis.segment(joints=False).labels, people),
        _mean(_clustered(analysis, true_number), people),
        float(np.mean(between)),
        by_threshold,
    )


def _mean(labels: Ints, people: list[Ints]) -> float:
    return float(np.mean([rand_dissimilarity(labels, person) for person in people]))


def _clustered(analysis: Analysis, n_parts: int) -> Ints:
    """Divide by k-means in the first n_parts - 1 eigenfunctions, each row scaled to length 1."""
    mesh: TriangleMesh = analysis.mesh
    rows = analysis.eigenbasis.functions[: len(mesh.vertices), : max(n_parts - 1, 1)][mesh.triangles].mean(axis=1)
    rows /= np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-12)
    return kmeans2(rows, n_parts, minit="++", seed=0)[1]


def _table(rows: list[Row]) -> str:
    lines = [
        "| mesh | vertices | parts | nested | without joints | features | spectral clustering, number given | people |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        figures = (row.nested, row.unjointed, row.features, row.clustering, row.people)
        lines.append(
            f"| {row.number} | {row.n_vertices} | {row.n_parts} | " + " | ".join(f"{x:.3f}" for x in figures) + " |"
        )
    means = [
        np.mean([getattr(row, name) for row in rows])
        for name in ("nested", "unjointed", "features", "clustering", "people")
    ]
    lines.append("| **mean** | | | " + " | ".join(f"**{mean:.4f}**" for mean in means) + " |")
    lines.append(f"\nThreshold chosen without the kind it is judged on: {_without_own_kind(rows):.4f}.\n")
    return "\n".join(lines)


def _without_own_kind(rows: list[Row]) -> float:
    """Return the mean when each kind is judged with the threshold that is best on all other kinds."""
    judged = []
    for row in rows:
        others = [other for other in rows if _kind(other) != _kind(row)]
        best = min(THRESHOLDS, key=lambda x: np.mean([other.nested_by_threshold[x] for other in others]))
        judged.append(row.nested_by_threshold[best])
    return float(np.mean(judged))


def _kind(row: Row) -> int:
    return (row.number - 1) // MESHES_OF_A_KIND


if __name__ == "__main__":
    raise SystemExit(main())
