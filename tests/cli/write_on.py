"""Write results of two sizes in turns until the process is killed: ``python -m tests.cli.write_on SOURCE TARGET``."""

import itertools
import sys
from pathlib import Path

from tests.cli.writing import cli, run_job

if __name__ == "__main__":
    job = cli("jobs").Job(*map(Path, sys.argv[1:]))
    run_job(job, 1)
    print("begins", flush=True)
    for level in itertools.cycle((2, 1)):
        assert "error" not in run_job(job, level)
