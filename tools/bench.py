"""Run the benchmarks and keep the Markdown tables that they print, one file each.

usage: python tools/bench.py [--data FOLDER] [--output FOLDER] [NAME...]

Without a folder of meshes those run that need none, at small sizes: some minutes in all. With one all run as the pages
show them, which takes hours. A peer that is not installed is left out of its table.
"""

import argparse
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Benchmark:
    """The arguments that a benchmark is run with.

    Attributes
    ----------
    full : str
        Arguments for the tables on the pages; DATA stands for the folder.
    quick : str, optional
        Arguments without the folder; None if there is nothing to run then.
    """

    full: str = "--data DATA"
    quick: str | None = None


BENCHMARKS = {
    "spectrum": Benchmark(quick="--sizes 5000 10000 --pairs 10 --repeats 1"),
    "elements": Benchmark(quick=""),
    "levels": Benchmark(quick="--sizes 50000"),
    "topology": Benchmark("", "--largest 10000"),
    "segmentation": Benchmark(),
    "robustness": Benchmark(),
    "registration": Benchmark(),
    "calibration": Benchmark(),
    "registered_parts": Benchmark(),
    "transfer": Benchmark(),
    "between_characters": Benchmark(),
    "transfer_by_place": Benchmark(),
    "skeleton": Benchmark(quick=""),
    "slider": Benchmark("", "--vertices 10000"),
    "size": Benchmark("", "--vertices 13000"),
    "memory": Benchmark("", "--vertices 13000 --stages segment"),
    "load": Benchmark("", "--meshes 50 --changes 20"),
    "fuzzing": Benchmark("--cases 1000", "--cases 50"),
    "operators": Benchmark("0 400 --seeds 10", "0 100"),
    "corpus": Benchmark("DATA"),
}


def main(arguments: list[str]) -> int:
    """Run what is asked for, all that can be run if nothing is; return how many failed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(BENCHMARKS))
    parser.add_argument("--data", type=Path, help="folder of meshes")
    parser.add_argument("--output", type=Path, default=Path("demo") / "bench", help="folder for the tables")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    return sum(_run(name, options) for name in options.names or BENCHMARKS)


def _run(name: str, options: argparse.Namespace) -> bool:
    """Run one benchmark, keep what it prints, and return whether it failed."""
    benchmark = BENCHMARKS[name]
    given = benchmark.full if options.data else benchmark.quick
    if given is None:
        sys.stdout.write(f"{name}: left out, as it measures meshes of a folder that is named with DATA.\n")
        return False
    words = [str(options.data.resolve()) if word == "DATA" else word for word in given.split()]
    command = [sys.executable, "-m", f"benchmarks.{name}", *words]
    sys.stdout.write(f"python -m benchmarks.{name} {' '.join(words)}\n")
    sys.stdout.flush()
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, cwd=ROOT, env=os.environ | threads, stdout=subprocess.PIPE, text=True)
    (options.output / f"{name}.md").write_text(done.stdout)
    sys.stdout.write(done.stdout if done.returncode == 0 else f"{name} failed.\n")
    return done.returncode != 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
