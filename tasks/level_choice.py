"""The ways to choose a level."""

from typing import TypedDict


class LevelChoice(TypedDict, total=False):
    """A level by its number, by the least persistence of its features, or by the number of its parts; one at most."""

    level: int
    threshold: float
    n_parts: int
