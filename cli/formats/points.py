"""Files of points: pairs of vertices of the source and of the files that are done, as JSON."""

import json
from pathlib import Path

from ...tasks.match_options import NO_POINTS, GivenPoints
from ...tasks.refusals import Refusal
from ..reports.report import Settings

LOOK = '{"points": [[source, target], ...]} with the numbers of vertices, from 0'


def settings_of_points(path: Path | None) -> Settings:
    """Return what is remembered with a result of the points that it was made with; nothing if there are none."""
    return {} if path is None else {"points": [list(pair) for pair in points_of(path).vertices]}


def points_of(path: Path | None) -> GivenPoints:
    """Return the pairs of vertices in a file; none if there is none.

    Raises
    ------
    Refusal
        If there is no such file, or something else is in it.
    """
    if path is None:
        return NO_POINTS
    if not path.is_file():
        told = "this is a folder; name the file in it" if path.is_dir() else "there is no such file"
        raise Refusal(f"the points {path}: {told}.")
    try:
        pairs = json.loads(path.read_text(encoding="utf-8"))["points"]
        vertices = tuple((source, target) for source, target in pairs)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise Refusal(f"the points {path}: this is no file of points, which is {LOOK}.") from error
    if not vertices or not all(type(vertex) is int for pair in vertices for vertex in pair):
        raise Refusal(f"the points {path}: there are no pairs of whole numbers in it; it is to be {LOOK}.")
    return GivenPoints(vertices, tuple(range(1, 1 + len(vertices))))
