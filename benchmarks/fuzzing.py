"""Broken meshes by the thousand: each gives a division or a sentence, the same one twice.

usage: python -m benchmarks.fuzzing [--cases N] [--seed S] [--jobs N] [--log FILE]

Case k of a seed is the same mesh wherever it runs. A log that exists is continued; the table is printed at the end.
"""

import argparse
import json
import sys
import tempfile
import warnings
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from compute import EngineError, TriangleMesh, analyze
from tests.damage import DAMAGES, SHAPES, damaged

CHUNK = 50
MOST_STEPS = 4


def main(arguments: list[str] | None = None) -> int:
    """Run the cases that the log lacks, print what became of all, and return 1 if there was a fault."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--log", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-fuzzing.jsonl")
    options = parser.parse_args(arguments)
    rows = _read(options.log, options.seed)
    chunks = [first for first in range(0, options.cases, CHUNK) if first not in rows]
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool, options.log.open("a") as log:
        for row in pool.map(partial(run_chunk, options.seed), chunks):
            rows[row["first"]] = row
            log.write(json.dumps(row) + "\n")
            log.flush()
    sys.stdout.write(table(list(rows.values())))
    return int(any(row["faults"] for row in rows.values()))


def table(rows: list[dict[str, Any]]) -> str:
    """Return how many cases ended how, the sentences and the faults, as Markdown."""
    outcomes: Counter[str] = sum((Counter(row["outcomes"]) for row in rows), Counter())
    total = sum(outcomes.values())
    lines = ["| outcome | cases | share |", "|---|---|---|"]
    lines += [f"| {outcome} | {n} | {n / total:.2%} |" for outcome, n in outcomes.most_common()]
    faults = [fault for row in rows for fault in row["faults"]]
    return "\n".join([*lines, "", f"{total} cases, {len(faults)} faults.", *map(str, faults)]) + "\n"


def run_chunk(seed: int, first: int) -> dict[str, Any]:
    """Return the outcomes of the cases from ``first`` on, and those that ended as they must not."""
    outcomes: Counter[str] = Counter()
    faults = []
    for number in range(first, first + CHUNK):
        case, order = draw(seed, number)
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("error")
            try:
                outcomes[outcome(case, order)] += 1
            except Exception as error:
                faults.append({"number": number, "case": case, "error": f"{type(error).__name__}: {error}"})
                outcomes["FAULT"] += 1
    return {"seed": seed, "first": first, "outcomes": outcomes, "faults": faults}


def draw(seed: int, number: int) -> tuple[dict[str, Any], int]:
    """Return the arguments of `tests.damage.damaged` for a case, and the order of its elements."""
    rng = np.random.default_rng([seed, number])
    names = rng.choice(sorted(DAMAGES), rng.integers(0, MOST_STEPS + 1)).tolist()
    steps = [(name, float(rng.random() ** rng.integers(1, 4))) for name in names]
    shape, exponent = str(rng.choice(sorted(SHAPES))), int(rng.integers(-5, 6))
    return {"shape": shape, "steps": steps, "seed": int(rng.integers(2**32)), "exponent": exponent}, int(
        rng.choice([1, 1, 2, 3])
    )


def outcome(case: dict[str, Any], order: int) -> str:
    """Return "divided" or the sentence of the refusal."""
    vertices, triangles = damaged(**case)
    first, second = (_labels(vertices, triangles, order) for _ in range(2))
    if isinstance(first, str):
        assert first == second
        return first
    assert np.array_equal(first, second)
    assert first.shape == (len(triangles),)
    return "divided"


def _labels(vertices: np.ndarray, triangles: np.ndarray, order: int) -> np.ndarray | str:
    try:
        analysis = analyze(TriangleMesh(vertices, triangles), order=order)
    except EngineError as refusal:
        return str(refusal)
    last = analysis.hierarchy.n_levels - 1
    for mode in ("features", "nested"):
        finest = analysis.segment(level=last, mode=mode)
        assert set(finest.labels) <= {0, *finest.parts.id}
    return analysis.segment(mode="features").labels


def _read(log: Path, seed: int) -> dict[int, dict[str, Any]]:
    rows = [json.loads(line) for line in log.read_text().splitlines()] if log.is_file() else []
    return {row["first"]: row for row in rows if row["seed"] == seed}


if __name__ == "__main__":
    sys.exit(main())
