"""Reporters of files: lines for people, or JSON, and the progress of a batch."""

import argparse
import time
from collections.abc import Iterable, Iterator
from typing import Protocol, TextIO

from .report import Report, as_document, as_line, sentence, warnings_in

# Seconds between lines about progress where they cannot replace each other.
PAUSE = 10.0


class Reporter(Protocol):
    """Writer of reports to stdout."""

    def add(self, report: Report) -> None:
        """Take the report of a file that is done."""

    def close(self) -> None:
        """All files are done."""


class Sentences:
    """A line for each file that was divided, and one on stderr for each of its warnings."""

    def __init__(self, out: TextIO, err: TextIO) -> None:
        self._out, self._err = out, err

    def add(self, report: Report) -> None:
        """Write the lines."""
        if "skipped" in report:
            return
        self._err.writelines(f"{report['file']}: {warning}\n" for warning in warnings_in(report))
        if "error" not in report:
            self._out.write(sentence(report) + "\n")
            self._out.flush()

    def close(self) -> None:
        """Nothing is left to say."""


class JsonLines:
    """A line of JSON for each file, as soon as it is done."""

    def __init__(self, out: TextIO) -> None:
        self._out = out

    def add(self, report: Report) -> None:
        """Write the line."""
        self._out.write(as_line(report) + "\n")
        self._out.flush()

    def close(self) -> None:
        """Nothing is left to say."""


class JsonDocument:
    """One document at the end."""

    def __init__(self, out: TextIO) -> None:
        self._out = out
        self._reports: list[Report] = []

    def add(self, report: Report) -> None:
        """Keep the report."""
        self._reports.append(report)

    def close(self) -> None:
        """Write the document."""
        self._out.write(as_document(self._reports) + "\n")
        self._out.flush()


class ProgressLine:
    """Progress of a batch: one line that is written over and over on a terminal, and now and then elsewhere."""

    def __init__(self, err: TextIO, n_files: int, n_finished_before: int) -> None:
        self._err, self._n_files, self._n_finished_before = err, n_files, n_finished_before
        self._n_done = self._n_failed = 0
        self._overwrites = err.isatty()
        self._start = self._last = time.monotonic()

    def counting(self, reports: Iterable[Report]) -> Iterator[Report]:
        """Pass reports on, and write the progress after each."""
        self._show()
        for report in reports:
            self._clear()
            yield report
            self._n_done += 1
            self._n_failed += "error" in report
            if self._overwrites or time.monotonic() - self._last >= PAUSE or self._n_done == self._n_files:
                self._show()
        if self._overwrites:
            self._err.write("\n")

    def _show(self) -> None:
        self._last = time.monotonic()
        self._err.write(self._text() + ("" if self._overwrites else "\n"))
        self._err.flush()

    def _clear(self) -> None:
        if self._overwrites:
            self._err.write("\r\x1b[K")

    def _text(self) -> str:
        text = f"{self._n_done} of {self._n_files} files"
        if self._n_finished_before:
            text += f" ({self._n_finished_before} finished before)"
        if self._n_failed:
            text += f", {self._n_failed} failed"
        seconds = self._last - self._start
        if 0 < self._n_done < self._n_files:
            return f"{text}, about {_duration(seconds / self._n_done * (self._n_files - self._n_done))} left"
        return f"{text}, {_duration(seconds)}" if self._n_done else text


def reporter_for(options: argparse.Namespace, out: TextIO, err: TextIO) -> Reporter:
    """Return what the options ask for."""
    if options.json:
        return JsonDocument(out)
    return JsonLines(out) if options.json_lines else Sentences(out, err)


def _duration(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    return f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"
