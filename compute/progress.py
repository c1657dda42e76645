"""Progress of long work, and its end where the user wants none of it any more.

A progress callback is any ``progress(fraction, text)``. Stages call it often, the fraction never falls, and the
callback may raise :class:`~compute.errors.Cancelled`, which stages let through untouched.
"""

from collections.abc import Callable

Progress = Callable[[float, str], None]


def silent(fraction: float, text: str) -> None:
    """Report to nobody."""


def section(progress: Progress, start: float, stop: float) -> Progress:
    """Return a callback whose 0..1 is ``start``..``stop`` of the given one."""

    def report(fraction: float, text: str) -> None:
        progress(start + (stop - start) * min(max(fraction, 0.0), 1.0), text)

    return report


def naming(progress: Progress, name: str) -> Progress:
    """Return a callback whose texts begin with the name of an object."""
    return lambda fraction, text: progress(fraction, f"{name}: {text}")


def rising(progress: Progress) -> Progress:
    """Return a callback that reports the highest fraction so far: an iteration's own estimate may fall back."""
    highest = 0.0

    def report(fraction: float, text: str) -> None:
        nonlocal highest
        highest = max(highest, fraction)
        progress(highest, text)

    return report
