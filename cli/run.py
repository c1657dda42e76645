"""Run a command: find its files, do them here or in processes, and report each."""

import argparse
from collections.abc import Container, Iterable, Iterator
from itertools import chain
from typing import TextIO

from ..tasks.refusals import Refusal
from . import batch
from .formats import name_of_divided, name_of_transferred
from .formats.file_errors import problem_of
from .jobs import Job, failed_report, jobs_of_files, refused_jobs
from .processes.cluster import cluster_pool
from .processes.interrupts import interruptible
from .processes.limits import memory_limited
from .processes.pool import local_pool, units_of
from .processes.supervision import end_with_parent, is_supervised
from .registering import Register
from .reports.report import Report
from .reports.reporters import ProgressLine, reporter_for
from .run_serial import Command, run_in_this_process
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
    except OSError as error:
        # What is told goes into a file on a full disk, or to a program that has ended.
        err.write(f"{problem_of(error)}\n")
    except KeyboardInterrupt:
        err.write("Interrupted; what is finished stays.\n")
    return 1


def _run_files(options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    """Do the files that were named, tell about each, and return 1 if any failed."""
    name_of_result = name_of_transferred if options.command == "transfer" else name_of_divided
    jobs = jobs_of_files(options.files, options.output, name_of_result, overwrite=options.overwrite)
    return _report_all(_reports(jobs, options), options, out, err)


def _run_batch(options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    """Do what is not finished below the folders that were named, tell about each file, and return 1 if any failed."""
    jobs = batch.find_jobs(options)
    finished = {} if options.again else batch.finished_reports(jobs, _command(options).settings)
    line = ProgressLine(err, len(jobs) - len(finished), len(finished))
    return _report_all(chain(finished.values(), line.counting(_reports(jobs, options, finished))), options, out, err)


def _report_all(reports: Iterable[Report], options: argparse.Namespace, out: TextIO, err: TextIO) -> int:
    reporter, any_failed = reporter_for(options, out, err), False
    for report in reports:
        if "error" in report:
            any_failed = True
            err.write(f"{report['file']}: {report['error']}\n")
        reporter.add(report)
    reporter.close()
    return int(any_failed)


def _reports(jobs: list[Job], options: argparse.Namespace, finished: Container[Job] = ()) -> Iterator[Report]:
    """Yield the report of each file that is not finished when it is done."""
    refused = refused_jobs(jobs, [job.path for job in jobs] + ([options.source] if options.source else []))
    unfinished = [job for job in jobs if job not in finished]
    for job in unfinished:
        if job in refused:
            yield failed_report(job, refused[job])
    free = [job for job in unfinished if job not in refused]
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
