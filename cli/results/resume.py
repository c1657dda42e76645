"""Finished files, which need not be done again: the report kept with a result says what it was made of."""

import os
from pathlib import Path

from ..jobs import Job
from ..reports.report import VERSION, Report, Settings, path_beside, without_version
from ..reports.stored_report import read_report
from .digests import digest_of
from .targets import is_finished


def finished_report(job: Job, settings: Settings) -> Report | None:
    """Return the report of a result that would come out the same again; None if there is no such result."""
    stored = read_report(path_beside(job.target))
    report = stored.report
    if report is None or stored.written is None or "error" in report:
        return None
    try:
        same = {"version": VERSION, "settings": settings, "digest": digest_of(job.path)}
        if any(report.get(name) != value for name, value in same.items()) or not is_finished(job, stored.written):
            return None
    except OSError:
        return None
    report = without_version(report)
    del report["written"]
    report["file"], report["output"], report["skipped"] = str(job.path), str(job.target), True
    return report


def is_result(path: Path) -> bool:
    """Whether the report beside a file says that it was written together with it."""
    written = read_report(path_beside(path)).written
    return written is not None and path.name in written["files"]


def may_be_result(path: Path) -> bool:
    """Whether something lies at the place of its report, be it damaged, or of a version that did not keep its name."""
    return os.path.lexists(path_beside(path))
