"""Run a command: find its files, do them here or in processes, and report each."""

import argparse
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import TextIO

from ..operators.messages.user_errors import Refusal
from . import batch
from .cluster import cluster_pool
from .formats import name_of_divided, name_of_transferred
from .interrupts import interruptible
from .jobs import Job, conflicting_jobs, jobs_of_files
from .process_limits import end_with_parent, is_supervised, memory_limited
from .process_pool import local_pool, units_of
from .registering import Register
from .report import Report
from .reporters import ProgressLine, reporter_for
from .run_serial import Command, failed_report, run_in_this_process
from .segmenting import Segment
from .transferring import Transfer


def run_command(options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    """Do what was asked for, tell about each file, and return 1 if any failed."""
    if is_supervised():
        end_with_parent()
    do = _run_batch if options.command == "batch" else _run_files
    try:
        with interruptible():
            return do(options, out, err)
    except Refusal as refusal:
        err.write(f"{refusal}\n")
    except KeyboardInterrupt:
        err.write("Interrupted; what is finished stays.\n")
    return 1


def _run_files(options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    """Do the files that were named, tell about each, and return 1 if any failed."""
    name_of_result = name_of_transferred if options.command == "transfer" else name_of_divided
    jobs = jobs_of_files(options.files, options.output, name_of_result)
    return _report_all(_reports(jobs, options), options, out, err)


def _run_batch(options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    """Do what is not finished below the folders that were named, tell about each file, and return 1 if any failed."""
    jobs = batch.find_jobs(options)
    finished = {} if options.again else batch.finished_reports(jobs, _command(options).settings)
    unfinished = [job for job in jobs if job not in finished]
    line = ProgressLine(err, len(unfinished), len(finished))
    return _report_all(chain(finished.values(), line.counting(_reports(unfinished, options))), options, out, err)


def _report_all(reports: Iterable[Report], options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    reporter, any_failed = reporter_for(options, out), False
    for report in reports:
        if "error" in report:
            any_failed = True
            err.write(f"{report['file']}: {report['error']}\n")
        reporter.add(report)
    reporter.close()
    return int(any_failed)


def _reports(jobs: list[Job], options: argparse.Namespace) -> Iterator[Report]:
    """Yield the report of each file when it is done."""
    blocked = conflicting_jobs(jobs)
    for job, earlier in blocked.items():
        yield failed_report(job, f"its result would replace that of {earlier}; give them different folders.")
    free = [job for job in jobs if job not in blocked]
    if options.scheduler:
        with cluster_pool(options) as pool:
            yield from pool.run(free)
    elif _needs_processes(free, options):
        with local_pool(options) as pool:
            yield from pool.run(units_of(free, options))
    else:
        with memory_limited(options.memory_limit):
            yield from run_in_this_process(free, _command(options))


def _needs_processes(jobs: list[Job], options: argparse.Namespace) -> bool:
    """Whether files are done in other processes: one that ends its process would otherwise take more with it."""
    if options.in_process:
        return False
    is_asked_for = options.jobs or options.timeout or options.memory_limit
    return bool(jobs) and (options.command == "batch" or len(jobs) > 1 or is_asked_for is not None)


def _command(options: argparse.Namespace) -> Command:
    if options.command == "transfer":
        return Transfer(options)
    return Register(options) if options.source else Segment(options)
