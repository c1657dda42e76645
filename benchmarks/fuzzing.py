"""Broken meshes by the thousand: each gives a division or a sentence, the same one twice.

usage: python -m benchmarks.fuzzing [--cases N] [--seed S] [--jobs N] [--log FILE] [--calls [NAME ...]]

With --calls it is calls of the scripting API, all or those named, each with random arguments of every kind.

Case k of a seed is the same mesh wherever it runs. A log that exists is continued; the table is printed at the end.
"""

import argparse
import json
import sys
import tempfile
import time
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
from tests.fuzzing.calls import CALLS, tried

CHUNK = 50
MOST_STEPS = 4


def main(arguments: list[str] | None = None) -> int:
    """Run the cases that the log lacks, print what became of all, and return 1 if there was a fault."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--log", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-fuzzing.jsonl")
    parser.add_argument("--calls", nargs="*", choices=sorted(CALLS), help="calls of the scripting API instead")
    options = parser.parse_args(arguments)
    if options.calls is not None:
        return try_calls(options.calls or sorted(CALLS), options.seed, options.cases, options.jobs)
    rows = _read(options.log, options.seed)
    chunks = [first for first in range(0, options.cases, CHUNK) if first not in rows]
    with ProcessPoolExecutor(options.jobs, mp_context=get_context("spawn")) as pool, options.log.open("a") as log:
        for row in pool.map(partial(run_chunk, options.seed), chunks):
            rows[row["first"]] = row
            log.write(json.dumps(row) + "\n")
            log.flush()
    sys.stdout.write(table(list(rows.values())))
    return int(any(row["faults"] for row in rows.values()))


def try_calls(paths: list[str], seed: int, n_cases: int, n_jobs: int) -> int:
    """Print for each call how many cases gave a result and how many a sentence, and the faults; 1 if there were any."""
    sys.stdout.write("| call | cases | results | sentences | faults | CPU s |\n|---|---|---|---|---|---|\n")
    faults: list[str] = []
    with ProcessPoolExecutor(n_jobs, mp_context=get_context("spawn")) as pool:
        for path, row in zip(paths, pool.map(partial(_try_call, seed, n_cases), paths), strict=True):
            *counts, seconds, found = row
            sys.stdout.write(
                f"| {path} | {n_cases} | {' | '.join(map(str, counts))} | {len(found)} | {seconds:.1f} |\n"
            )
            sys.stdout.flush()
            faults += found
    sys.stdout.write("\n".join(["", *faults, f"{n_cases * len(paths)} cases, {len(faults)} faults.", ""]))
    return int(bool(faults))


def _try_call(seed: int, n_cases: int, path: str) -> tuple[int, int, float, list[str]]:
    """Return numbers of results and sentences, CPU seconds, and the faults with the numbers that repeat them."""
    start = time.process_time()
    outcomes = [tried(path, seed, number) for number in range(n_cases)]
    found = [f"{path} {number}: {fault}" for number, outcome in enumerate(outcomes) for fault in outcome.faults]
    n_sentences = sum(outcome.sentence is not None for outcome in outcomes)
    n_results = sum(outcome.sentence is None and not outcome.faults for outcome in outcomes)
    return n_results, n_sentences, time.process_time() - start, found


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
