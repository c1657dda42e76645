"""Targets: what lies at the place of a result, whose it is, and how a new result takes it.

A result is its file, the files that belong to it, and a report that keeps the digests of them all and the name of the
input. A file is replaced if the report beside it has its digest and the same input; all else is the user's, or was
changed by the user, and stays. This is looked at before the work, and again when the result takes its place. What lies
beside may also be no report at all, damaged or the user's. The result then shows: if it is there already, byte for
byte, all is well, and nothing is touched.

That takes several steps, since no system exchanges several files at once, and a process may be killed, or a disk be
full, between any two of them:

1. All files are written in a stage, and so is the report, twice: with the digests of the files that will be replaced
   (``before``) and without. An error up to here leaves all as it was.
2. The report with ``before`` takes its place. From now on it has the digests of the old files and of the new ones.
3. The files take theirs, the result last.
4. Where files were replaced, the report without ``before`` takes the place of the other.

After step 2, and between any two files of step 3, old files and new ones lie there together. Each is one that the
report knows, so the next run may replace it; and not all are new, so nothing counts as finished. Before step 4 the
result is whole and counts as finished. Without that step, a user's file that was replaced with ``--overwrite`` and
brought back would count as ours. Looking and moving happen under a lock of the folder, so of two runs one comes first.
"""

import os
import stat
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ...tasks.refusals import Refusal
from ..jobs import Job
from ..reports.report import Report, Written, as_line, path_beside
from ..reports.stored_report import StoredReport, read_report
from .digests import NO_FILE, digest_there
from .locks import folder_lock
from .stages import files_in

# Bytes of a name, on all file systems in use.
LONGEST_NAME = 255
# Endings of what belongs to a result, as far as it is known before anything is written.
BELONGING = {".obj": ".mtl"}
# The report without digests of what is replaced, in the stage.
FINAL_REPORT = ".eigenparts-report"
UNKNOWN = "not known as a result of Eigenparts"
ADVICE = "so it is not replaced; choose another folder with --output, or allow it with --overwrite."


@dataclass(frozen=True)
class Place:
    """What lies at the place of a result.

    Attributes
    ----------
    job : Job
    stored : StoredReport
    digests : dict
        Of what has one of the names of the result, or one that the report has, by name.
    """

    job: Job
    stored: StoredReport
    digests: dict[str, str]

    @property
    def is_doubtful(self) -> bool:
        """Whether what lies beside a file is no report at all: a damaged one of ours, or the user's."""
        is_report = self.stored.written is not None or self.stored.report is not None
        return self.stored.is_there and not is_report and self.job.target.name in self.digests

    def objection(self) -> str | None:
        """Return a sentence if a result may not take this place."""
        beside = path_beside(self.job.target)
        if folders := [name for name in (*self.digests, beside.name) if _is_folder(self._path(name))]:
            return f"{self._path(folders[0])} is a folder where the result belongs; choose another with --output."
        if self.job.overwrite:
            return None
        if self.stored.written is not None:
            return self._objection_of(self.stored.written)
        if self.stored.report is not None:
            return f"{beside} is the report of a version that did not keep what it wrote, {ADVICE}"
        unknown = [*self.digests, *([beside.name] if self.stored.is_there else [])]
        return f"{self._path(unknown[0])} is {UNKNOWN}, {ADVICE}" if unknown and not self.is_doubtful else None

    def _objection_of(self, written: Written) -> str | None:
        if not _is_same(self.job.target.parent / written["source"], self.job.path):
            return f"{self.job.target} is the result of another file, {written['source']}, {ADVICE}"
        known = (written["files"], written.get("before", {}))
        for name, digest in self.digests.items():
            if digest not in [digests.get(name) for digests in known]:
                problem = "changed since it was written" if name in written["files"] else UNKNOWN
                return f"{self._path(name)} is {problem}, {ADVICE}"
        return None

    def _path(self, name: str) -> Path:
        return self.job.target.with_name(name)


def refuse_before_work(job: Job) -> None:
    """Raise a Refusal if the result of a file could not take its place."""
    excess = len(os.fsencode(path_beside(job.target).name)) - LONGEST_NAME
    if excess > 0:
        raise Refusal(f"the name of the report would be too long; shorten the name of the file by {excess} bytes.")
    belonging = BELONGING.get(job.target.suffix.lower())
    names = [job.target.name, *([job.target.with_suffix(belonging).name] if belonging else [])]
    with folder_lock(job.target.parent):
        _refuse(_look(job, names))


def publish(job: Job, stage: Path, report: Report) -> None:
    """Let what was written into a stage take its place, with its report.

    Raises
    ------
    Refusal
        If something lies there that is not ours.
    """
    files = {path.name: digest_there(path) or NO_FILE for path in files_in(stage)}
    if job.target.name not in files:
        raise Refusal("Blender wrote no result.")
    with folder_lock(job.target.parent):
        place = _look(job, files)
        _refuse(place)
        if not place.is_doubtful or job.overwrite:
            _move(job, stage, report, files, place.digests)
        elif files.items() <= place.digests.items():
            report["warnings"] = [f"{path_beside(job.target)} is no report, and stays as it is"]
        else:
            raise Refusal(f"{job.target} may be yours, as what lies beside it is no report of it, {ADVICE}")


def is_finished(job: Job, written: Written) -> bool:
    """Whether a result and all that belongs to it are there as they were written."""
    files = written["files"]
    return job.target.name in files and all(digest_there(job.target.with_name(name)) == files[name] for name in files)


def _move(job: Job, stage: Path, report: Report, files: dict[str, str], there: dict[str, str]) -> None:
    beside = path_beside(job.target).name
    written: Written = {"source": _path_from(job.target.parent, job.path), "files": files}
    before = {name: digest for name, digest in there.items() if files.get(name) != digest}
    _write_report(stage / beside, {**report, "written": {**written, "before": before} if before else written})
    if before:
        _write_report(stage / FINAL_REPORT, {**report, "written": written})
    # The result itself is the last of the files: whoever sees it finds what belongs to it.
    for name in (beside, *sorted(files.keys() - {job.target.name}), job.target.name):
        os.replace(stage / name, job.target.with_name(name))
    if before:
        os.replace(stage / FINAL_REPORT, path_beside(job.target))


def _write_report(path: Path, report: Report) -> None:
    path.write_text(as_line(report) + "\n", encoding="utf-8")


def _look(job: Job, names: Iterable[str]) -> Place:
    stored = read_report(path_beside(job.target))
    known = {} if stored.written is None else stored.written["files"] | stored.written.get("before", {})
    digests = {name: digest_there(job.target.with_name(name)) for name in dict.fromkeys([*names, *known])}
    return Place(job, stored, {name: digest for name, digest in digests.items() if digest is not None})


def _refuse(place: Place) -> None:
    if (objection := place.objection()) is not None:
        raise Refusal(objection)


def _path_from(folder: Path, path: Path) -> str:
    """Return the way from a folder to a file, so that both can be moved together."""
    real = os.path.realpath(path)
    try:
        return Path(os.path.relpath(real, os.path.realpath(folder))).as_posix()
    except ValueError:
        # Windows: on another drive.
        return Path(real).as_posix()


def _is_same(path: Path, other: Path) -> bool:
    try:
        return path.samefile(other)
    except (OSError, ValueError):
        return False


def _is_folder(path: Path) -> bool:
    try:
        return stat.S_ISDIR(path.lstat().st_mode)
    except OSError:
        return False
