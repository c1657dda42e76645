"""Refusals of ours: sentences for the user, as those of the engine are."""

from collections.abc import Iterator
from contextlib import contextmanager

from ..compute.errors import EngineError


class Refusal(Exception):  # noqa: N818 - nothing is broken: the user can mend it
    """Something cannot be done as things are; the text says what the user can do."""


@contextmanager
def in_name_of(name: str) -> Iterator[None]:
    """Let refusals of ours and of the engine begin with the name of the object they are about."""
    try:
        yield
    except (Refusal, EngineError) as error:
        raise Refusal(f"{name}: {error}") from error
