"""What a worker process is told, and what it tells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

from ..compute.progress import Progress

# Least seconds between two reports of progress.
INTERVAL = 0.1


@dataclass(frozen=True, eq=False)
class Task:
    """Work for a worker.

    Attributes
    ----------
    work : callable
        Takes a callback for progress.
    n_threads : int
        How many cores its matrix libraries use; 0 leaves that to them.
    n_processes : int
        How many processes may share it.
    """

    work: Callable[[Progress], Any]
    n_threads: int = 0
    n_processes: int = 1


@dataclass(frozen=True)
class Ready:
    """A worker has started, and takes tasks."""


@dataclass(frozen=True)
class Report:
    """How far a task is, 0 to 1, and what is being done."""

    fraction: float
    text: str


@dataclass(frozen=True, eq=False)
class Answer:
    """What a task returned."""

    result: Any


@dataclass(frozen=True, eq=False)
class Failure:
    """What a task raised, and where, without folders of the user's."""

    error: Exception
    traceback: str


Told: TypeAlias = Ready | Report | Answer | Failure
