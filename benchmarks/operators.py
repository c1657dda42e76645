"""Operators pressed at random in Blender, among what users do: as many steps of as many seeds as wanted.

usage: python -m benchmarks.operators [SEED] [STEPS] [--seeds N] [--log FILE] [--replay FILE [--shrink]]

Step k of a seed is the same wherever it is taken. The log has a line before each step, so that it also tells at which
one a process has ended, and one after it. ``--replay`` takes the steps of the last seed of a log again; ``--shrink``
leaves out all that the last finding does not need, and prints what is left.
"""

import argparse
import contextlib
import io
import json
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, TextIO

import bpy

from tests.blender.random_steps.run import Step, Taken, draw_steps, take_all
from tools.extension import load_extension


def main(arguments: list[str] | None = None) -> int:
    """Take the steps, print what became of them, and return 1 if anything was found."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("seed", nargs="?", type=int, default=0)
    parser.add_argument("steps", nargs="?", type=int, default=400)
    parser.add_argument("--seeds", type=int, default=1, help="how many seeds are run, from the first on")
    parser.add_argument("--log", type=Path, default=Path(tempfile.gettempdir()) / "eigenparts-operators.jsonl")
    parser.add_argument("--replay", type=Path, metavar="FILE", help="take the steps of the last seed in a log again")
    parser.add_argument("--shrink", action="store_true", help="and leave out those that the last finding does not need")
    options = parser.parse_args(arguments)
    load_extension().register()
    if options.replay:
        return _replay(*_read(options.replay), is_shrunk=options.shrink)
    start, taken = time.process_time(), []
    with options.log.open("w") as log:
        for seed in range(options.seed, options.seed + options.seeds):
            taken += [(seed, one) for one in _logged(seed, draw_steps(seed, options.steps), log)]
    sys.stdout.write(table(taken, time.process_time() - start))
    return int(any(one.findings for _, one in taken))


def table(taken: list[tuple[int, Taken]], seconds: float) -> str:
    """Return how often each action was done and refused, and the findings with their seeds, as Markdown."""
    counts = Counter((one.step.action, one.outcome) for _, one in taken)
    lines = ["| step | done | refused |", "|---|---|---|"]
    for action in sorted({action for action, _ in counts}):
        done = counts[action, "done"] + counts[action, "user"]
        lines.append(f"| {action} | {done} | {counts[action, 'refused']} |")
    findings = Counter(finding for _, one in taken for finding in one.findings)
    seeds = {finding: sorted({seed for seed, one in taken if finding in one.findings}) for finding in findings}
    lines += ["", f"bpy {bpy.app.version_string}, {len(taken)} steps, {seconds:.0f} s CPU, {len(findings)} findings."]
    lines += [f"{n} times, seeds {seeds[finding]}: {finding}" for finding, n in findings.most_common()]
    return "\n".join(lines) + "\n"


def _logged(seed: int, steps: list[Step], log: TextIO) -> Iterator[Taken]:
    """Yield steps as they are taken, with a line in the log before and after each."""
    running = _taken(seed, steps)
    for step in steps:
        _write(log, {"seed": seed, "step": step})
        taken = next(running)
        _write(log, {"text": taken.text, "outcome": taken.outcome, "findings": taken.findings})
        yield taken


def _taken(seed: int, steps: Iterable[Step]) -> Iterator[Taken]:
    """Take steps in a new file, with nothing printed."""
    with tempfile.TemporaryDirectory() as folder:
        running = take_all(seed, list(steps), Path(folder))
        while True:
            with contextlib.redirect_stdout(io.StringIO()):
                taken = next(running, None)
            if taken is None:
                return
            yield taken


def _write(log: TextIO, row: dict[str, Any]) -> None:
    log.write(json.dumps(row) + "\n")
    log.flush()


def _read(path: Path) -> tuple[int, list[Step]]:
    """Return the last seed of a log, and its steps."""
    rows = [row for row in map(json.loads, path.read_text().splitlines()) if "step" in row]
    seed = rows[-1]["seed"]
    return seed, [Step(*row["step"]) for row in rows if row["seed"] == seed]


def _replay(seed: int, steps: list[Step], is_shrunk: bool) -> int:
    """Take steps again, print each, and return 1 if anything was found."""
    taken = list(_taken(seed, shrunk(seed, steps) if is_shrunk else steps))
    for one in taken:
        sys.stdout.write(f"{one.step.action} {one.step.seed}: {one.text}\n")
        sys.stdout.writelines(f"    {finding}\n" for finding in one.findings)
    return int(any(one.findings for one in taken))


def shrunk(seed: int, steps: list[Step]) -> list[Step]:
    """Return as few of the steps as still lead to the last finding: halves are left out first, single ones at last."""
    found = [(number, one.findings[-1]) for number, one in enumerate(_taken(seed, steps)) if one.findings]
    if not found:
        return steps
    last, finding = found[-1]
    steps, size = steps[: last + 1], last + 1
    while size > 1:
        size = (size + 1) // 2
        for first in reversed(range(0, len(steps) - 1, size)):
            fewer = steps[:first] + steps[min(first + size, len(steps) - 1) :]
            if any(finding in one.findings for one in _taken(seed, fewer)):
                steps = fewer
    return steps


if __name__ == "__main__":
    sys.exit(main())
