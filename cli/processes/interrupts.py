"""Ctrl C ends the command, with all that the command has started."""

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TypeAlias

Handler: TypeAlias = "Callable[[int, FrameType | None], object] | int | None"


@contextmanager
def interruptible() -> Iterator[None]:
    """Let Ctrl C raise KeyboardInterrupt meanwhile, also in the application, which only takes note of it."""
    before = _set(signal.default_int_handler)
    try:
        yield
    finally:
        _set(before)


@contextmanager
def interrupt_held() -> Iterator[None]:
    """Let Ctrl C wait until the end of the block, so that what is begun in it is known when it is to be ended."""
    held: list[int] = []
    before = _set(lambda number, _: held.append(number))
    try:
        yield
    finally:
        _set(before)
    if held:
        raise KeyboardInterrupt


def _set(handler: Handler) -> Handler:
    """Set what Ctrl C does and return what it did; None where Python does not know or may not."""
    if handler is None:
        return None
    try:
        return signal.signal(signal.SIGINT, handler)
    except ValueError:
        # Only the main thread may.
        return None
