"""The Object File Format as it is found in the wild: numbers on any lines, every keyword, comments of any encoding."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ...tasks.refusals import Refusal

# Some writers leave out the keyword, the space behind it or the number of edges.
HEAD = re.compile(
    r"\s*(?P<keyword>(?P<st>ST)?(?P<c>C)?(?P<n>N)?(?P<w>4)?(?P<dim>n)?OFF)?(?(dim)\s*(?P<dimensions>\d{1,9})\s)"
    r"\s*(?P<vertices>\d{1,12})\s+(?P<faces>\d{1,12})(?:[ \t]+\d+(?=\s|\Z)|[ \t]*\n\s*\d+[ \t]*(?=\n|\Z))?"
)
BINARY = re.compile(rb"\s*(ST)?(C)?(N)?(4)?OFF[ \t]+BINARY[^\n]*\n")
# Numbers that are none, as some systems write them; their sign # would begin a comment.
NO_NUMBERS = re.compile(r"\d\.#\w+|nan\([^)\s]*\)", re.IGNORECASE)
# Letters of a line that a sentence quotes.
LONGEST_QUOTE = 40


@dataclass(frozen=True, eq=False)
class OffFile:
    """Points and faces as they are written in a file.

    Attributes
    ----------
    vertices : (V, 3) float64
    n_corners : (F,) int64
        Of each face.
    corners : (C,) int64
        The points of one face after the other, whether they exist or not.
    unread : list of int
        Numbers of the lines behind the last face.
    """

    vertices: NDArray[np.float64]
    n_corners: NDArray[np.int64]
    corners: NDArray[np.int64]
    unread: list[int] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class FaceLines:
    """The lines of the faces of a file, also of those that Blender cannot hold.

    Attributes
    ----------
    n_corners : (F,) int64
        On each line.
    corners : (C,) int64
        Of one line after the other.
    kept : (F',) int64
        The line of each face that the mesh has.
    """

    n_corners: NDArray[np.int64]
    corners: NDArray[np.int64]
    kept: NDArray[np.int64]

    @property
    def first_corner(self) -> NDArray[np.int64]:
        """(F,) the first corner on each line, -1 where there is none."""
        has_corners = self.n_corners > 0
        first = np.full(len(has_corners), -1)
        first[has_corners] = self.corners[(np.cumsum(self.n_corners) - self.n_corners)[has_corners]]
        return first


@dataclass(frozen=True)
class _Text:
    """What a file says behind its head, line by line, without comments and empty lines.

    Attributes
    ----------
    n_vertices, n_faces : int
    n_coordinates : int
        3, or 4 if the fourth is what the others are divided by.
    widths : tuple of int
        How many numbers a point may have.
    lines : list of str
    line_numbers : list of int
    """

    n_vertices: int
    n_faces: int
    n_coordinates: int
    widths: tuple[int, ...]
    lines: list[str]
    line_numbers: list[int]


def parse_off(data: bytes) -> OffFile:
    """Return the points and faces of a file; what else it says of them, such as colours, is left out.

    Raises
    ------
    Refusal
        Names the line that is wrong.
    """
    binary = BINARY.match(data)
    if binary is not None:
        return _parse_binary(data[binary.end() :], *(part is not None for part in binary.groups()))
    text = _text_of(data)
    for layout, width in product((_one_on_each_line, _each_face_on_a_line, _on_any_lines), text.widths):
        try:
            return layout(text, width)
        except (ValueError, IndexError, OverflowError):
            continue
    raise Refusal(_objection(text))


def _text_of(data: bytes) -> _Text:
    # Not splitlines, which takes letters of some encodings for ends of lines.
    plain = _decoded(data).replace("\r\n", "\n").replace("\r", "\n")
    plain = re.sub(r"#[^\n]*", "", NO_NUMBERS.sub("nan", plain))
    head = HEAD.match(plain)
    if head is None:
        raise Refusal("line 1: an .off file begins with the word OFF and the numbers of its points and faces.")
    if head["dim"] and head["dimensions"] != "3":
        raise Refusal(f"its points have {head['dimensions']} coordinates; only those with 3 can be divided.")
    n_coordinates = 4 if head["w"] else 3
    others = (3 if head["n"] else 0) + (2 if head["st"] else 0)
    widths = tuple(n_coordinates + others + n_colours for n_colours in ((4, 3) if head["c"] else (0,)))
    lines = plain[head.end() :].split("\n")
    filled = [number for number, line in enumerate(lines) if line and not line.isspace()]
    first = plain.count("\n", 0, head.end()) + 1
    counts = int(head["vertices"]), int(head["faces"])
    return _Text(*counts, n_coordinates, widths, [lines[i] for i in filled], [first + i for i in filled])


def _decoded(data: bytes) -> str:
    """Return the text; where it is more than ASCII it is a comment, so any encoding of single bytes will do."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", errors="replace")
    return data.removeprefix(b"\xef\xbb\xbf").decode("latin-1")


def _one_on_each_line(text: _Text, width: int) -> OffFile:
    """Read each point and each face from a line of its own, with anything behind it, whatever the width."""
    end = text.n_vertices + text.n_faces
    if len(text.lines) < end:
        raise ValueError(end)
    rows = _numbers(text.lines[: text.n_vertices], range(text.n_coordinates))
    return OffFile(_places(rows), *_faces_of_lines(text.lines[text.n_vertices : end]), text.line_numbers[end:])


def _each_face_on_a_line(text: _Text, width: int) -> OffFile:
    """Read points from any lines, and then each face from a line of its own, with its colour behind it."""
    end = len(text.lines) - text.n_faces
    values = np.array(" ".join(text.lines[: max(end, 0)]).split(), dtype=np.float64)
    return OffFile(_places(_rows_of(values, text, width)), *_faces_of_lines(text.lines[end:] if text.n_faces else []))


def _on_any_lines(text: _Text, width: int) -> OffFile:
    """Read all numbers one after the other; the faces have no colours then."""
    values = np.array(" ".join(text.lines).split(), dtype=np.float64)
    end = width * text.n_vertices
    faces = _whole(values[end:])
    n_corners, starts = _walk(faces, text.n_faces)
    if starts[-1] != len(faces):
        raise ValueError(len(faces))
    return OffFile(_places(_rows_of(values[:end], text, width)), n_corners, np.delete(faces, starts[:-1]))


def _walk(faces: NDArray[np.int64], n_faces: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return how many corners each face has, and where each of them begins, with the end behind the last."""
    numbers, starts = faces.tolist(), [0]
    for _ in range(n_faces):
        starts.append(starts[-1] + 1 + max(numbers[starts[-1]], 0))
    found = np.array(starts, dtype=np.int64)
    return np.diff(found) - 1, found


def _rows_of(values: NDArray[np.float64], text: _Text, width: int) -> NDArray[np.float64]:
    return values.reshape(text.n_vertices, width)[:, : text.n_coordinates]


def _faces_of_lines(lines: list[str]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return how many corners the face of each line has, and the corners of all."""
    n_corners = np.array([line.split(None, 1)[0] for line in lines], dtype=np.int64)
    if (n_corners < 0).any() or (n_corners > max(map(len, lines), default=0)).any():
        raise ValueError("no count")
    starts = np.cumsum(n_corners) - n_corners
    corners = np.empty(int(n_corners.sum()), dtype=np.int64)
    for size in np.unique(n_corners).tolist():
        chosen = np.flatnonzero(n_corners == size)
        rows = _whole(_numbers([lines[i] for i in chosen.tolist()], range(1, 1 + size)))
        corners[(starts[chosen][:, None] + np.arange(size)).ravel()] = rows.ravel()
    return n_corners, corners


def _numbers(lines: list[str], columns: range) -> NDArray[np.float64]:
    """Return some columns of the numbers on lines; raises a ValueError if one is missing."""
    if not lines or not columns:
        return np.empty((len(lines), len(columns)))
    return np.loadtxt(lines, usecols=tuple(columns), comments=None, ndmin=2)


def _whole(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return numbers of points as such; raises a ValueError if one is not whole."""
    if not (values == np.rint(values)).all():
        raise ValueError("not whole")
    return values.astype(np.int64)


def _places(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return (V, 3) the places of points; where there is a fourth coordinate, the others are divided by it."""
    with np.errstate(all="ignore"):
        return rows[:, :3] / rows[:, 3:4] if rows.shape[1] == 4 else rows


def _parse_binary(data: bytes, has_texture: bool, has_colour: bool, has_normal: bool, has_weight: bool) -> OffFile:
    words = np.frombuffer(data, dtype=">i4", count=len(data) // 4)
    width = 3 + has_weight + 3 * has_normal + 4 * has_colour + 2 * has_texture
    try:
        n_vertices, n_faces, _ = words[:3].tolist()
        end = 3 + width * n_vertices
        rows = words[3:end].view(">f4").reshape(n_vertices, width)[:, : 3 + has_weight].astype(np.float64)
        return OffFile(_places(rows), *_binary_faces(words[end:].tolist(), n_faces))
    except (ValueError, IndexError) as error:
        raise Refusal("the binary file ends before all of its points and faces.") from error


def _binary_faces(words: list[int], n_faces: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    place, n_corners, corners = 0, [], list[int]()
    for _ in range(n_faces):
        size = words[place]
        end = place + 1 + size
        if size < 0 or words[end] < 0:
            raise ValueError(size)
        n_corners.append(size)
        corners += words[place + 1 : end]
        # Behind the corners stand the number of its colours and the colours.
        place = end + 1 + words[end]
    return np.array(n_corners, dtype=np.int64), np.array(corners, dtype=np.int64)


def _objection(text: _Text) -> str:
    """Return what is wrong with a file that none of the layouts fits, and on which line."""
    for number, line in zip(text.line_numbers, text.lines, strict=True):
        for word in line.split():
            if not _is_number(word):
                return f"line {number}: {word[:LONGEST_QUOTE]!r} is no number."
    n_lines = text.n_vertices + text.n_faces
    rows = list(zip(text.line_numbers, text.lines, strict=True))[:n_lines]
    for place, (number, line) in enumerate(rows if len(text.lines) >= n_lines else ()):
        kind = "point" if place < text.n_vertices else "face"
        if not (_is_point(line, text) if kind == "point" else _is_face(line)):
            return f"line {number}: {line.strip()[:LONGEST_QUOTE]!r} is no {kind}."
    return f"the file ends before the {text.n_vertices} points and {text.n_faces} faces that its head tells of."


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _is_point(line: str, text: _Text) -> bool:
    return len(line.split()) >= text.n_coordinates


def _is_face(line: str) -> bool:
    words = line.split()
    return (
        all(word.isdecimal() for word in words[:1])
        and all(word.lstrip("-").isdecimal() for word in words[1 : 1 + int(words[0])])
        and len(words) > int(words[0])
    )
