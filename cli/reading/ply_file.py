"""A look at a .ply file before Blender opens it, whose reader ends the process at some that are damaged."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .damage import cut_short, damaged

TYPES = {
    **{name: "i1" for name in ("char", "int8")},
    **{name: "u1" for name in ("uchar", "uint8")},
    **{name: "i2" for name in ("short", "int16")},
    **{name: "u2" for name in ("ushort", "uint16")},
    **{name: "i4" for name in ("int", "int32")},
    **{name: "u4" for name in ("uint", "uint32")},
    **{name: "f4" for name in ("float", "float32")},
    **{name: "f8" for name in ("double", "float64")},
}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
# Blender counts in whole numbers of 32 bits.
MOST = 2**31 - 1
# Bytes of the longest header that is looked for.
HEADER = 1 << 20
KEYWORDS = ("format", "element", "property")
INDICES = ("vertex_indices", "vertex_index")


@dataclass(frozen=True)
class Property:
    """A column; a list has the type of its length, too."""

    name: str
    type: str
    length_type: str = ""


@dataclass
class Element:
    """A table of the file."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    @property
    def has_lists(self) -> bool:
        """Whether its rows may have different sizes."""
        return any(column.length_type for column in self.properties)


@dataclass(frozen=True)
class Header:
    """What the file says of itself.

    Attributes
    ----------
    order : str
        Of the bytes, as numpy writes it; empty if the numbers are text.
    elements : list of Element
    n_lines, size : int
        Of the header.
    """

    order: str
    elements: list[Element]
    n_lines: int
    size: int


def check_ply(path: Path) -> None:
    """Raise a Refusal if a .ply is not what its header says."""
    data = path.read_bytes()
    header = _header(data)
    n_vertices = _n_vertices(header)
    if header.order:
        _check_bytes(data, header, n_vertices)
    else:
        _check_text(data, header, n_vertices)


def _header(data: bytes) -> Header:
    if not data.startswith(b"ply"):
        raise damaged('line 1: it does not begin with "ply"')
    end = re.compile(rb"(?:\r\n|\n|\r)end_header[ \t]*(?:\r\n|\n|\r|\Z)").search(data[:HEADER])
    if end is None:
        raise damaged('the header has no line "end_header"')
    lines = data[: end.end()].decode("latin-1").splitlines()
    order, elements = _order_and_elements(lines)
    if order is None:
        raise damaged("the header does not say in which format the numbers are")
    return Header(order, elements, len(lines), end.end())


def _order_and_elements(lines: list[str]) -> tuple[str | None, list[Element]]:
    order, elements = None, list[Element]()
    for number, line in enumerate(lines, 1):
        words = line.split()
        # Whatever else stands there is a comment to Blender.
        if not words or words[0] not in KEYWORDS:
            continue
        if words[0] == "format" and len(words) == 3 and words[1] in ORDERS:
            order = ORDERS[words[1]]
        elif words[0] == "element" and len(words) == 3 and words[2].isdecimal() and int(words[2]) <= MOST:
            elements.append(Element(words[1], int(words[2])))
        elif (column := _property(words)) and elements:
            elements[-1].properties.append(column)
        else:
            raise damaged(f'line {number}: "{line.strip()[:40]}" is no line of a .ply header')
    return order, elements


def _property(words: list[str]) -> Property | None:
    match words:
        case ["property", "list", length_type, kind, name] if TYPES.get(length_type, "f")[0] != "f" and kind in TYPES:
            return Property(name, TYPES[kind], TYPES[length_type])
        case ["property", kind, name] if kind in TYPES:
            return Property(name, TYPES[kind])
    return None


def _n_vertices(header: Header) -> int:
    vertices = next((element for element in header.elements if element.name == "vertex"), None)
    if vertices is None:
        raise damaged("the header lists no vertices")
    if not {"x", "y", "z"} <= {column.name for column in vertices.properties if not column.length_type}:
        raise damaged("the header lists no x, y and z of the vertices")
    for element in header.elements:
        names = [column.name for column in element.properties]
        if len(set(names)) < len(names) or not names:
            raise damaged(f'the header lists the columns of "{element.name}" twice or not at all')
    return vertices.count


def _check_bytes(data: bytes, header: Header, n_vertices: int) -> None:
    at = header.size
    for element in header.elements:
        if not element.has_lists:
            at += element.count * sum(np.dtype(column.type).itemsize for column in element.properties)
            if at > len(data):
                raise cut_short(f'byte {len(data)}, within "{element.name}"')
        elif element.count:
            at = _end_of_rows(data, at, element, header.order, n_vertices)


def _end_of_rows(data: bytes, at: int, element: Element, order: str, n_vertices: int) -> int:
    """Return where the rows of an element with lists end, which has to be within the file."""
    row = _row_type(data, at, element, order)
    if at + row.itemsize * element.count <= len(data):
        rows = np.frombuffer(data, row, element.count, at)
        # Mostly all faces have as many corners.
        if all((rows[name] == rows[name][0]).all() for name in row.names or () if name.startswith("length")):
            for k, column in enumerate(element.properties):
                _check_indices(column, rows[f"values{k}"], n_vertices, f"byte {at}")
            return at + rows.nbytes
    for number in range(element.count):
        row = _row_type(data, at, element, order)
        values = np.frombuffer(data, row, 1, at)
        for k, column in enumerate(element.properties):
            _check_indices(column, values[f"values{k}"], n_vertices, f"byte {at}, row {number} of {element.name}")
        at += row.itemsize
    return at


def _row_type(data: bytes, at: int, element: Element, order: str) -> np.dtype[np.void]:
    """Return the type of a row, whose lists have the lengths that are found there."""
    columns: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    end = at
    for k, column in enumerate(element.properties):
        length = 1
        if column.length_type:
            length_type = np.dtype(order + column.length_type)
            if end + length_type.itemsize > len(data):
                raise cut_short(f'byte {len(data)}, within "{element.name}"')
            length = int(np.frombuffer(data, length_type, 1, end)[0])
            columns.append((f"length{k}", order + column.length_type))
            end += length_type.itemsize
        size = np.dtype(column.type).itemsize * length
        if length < 0 or end + size > len(data):
            raise damaged(f'byte {end}: a row of "{element.name}" with {length} entries does not fit into the file')
        columns.append((f"values{k}", order + column.type, (length,)))
        end += size
    return np.dtype(columns)


def _check_indices(column: Property, values: NDArray[np.generic], n_vertices: int, where: str) -> None:
    if column.name in INDICES and values.size and not (values.min() >= 0 and values.max() < n_vertices):
        raise damaged(f"{where}: a face has a corner that is none of the {n_vertices} vertices")


def _check_text(data: bytes, header: Header, n_vertices: int) -> None:
    lines = data[header.size :].splitlines()
    at = 0
    for element in header.elements:
        rows = lines[at : at + element.count]
        first = header.n_lines + at + 1
        if len(rows) < element.count:
            raise cut_short(f'line {first + len(rows)}, after {len(rows)} of {element.count} rows of "{element.name}"')
        if not element.has_lists:
            _check_table(rows, len(element.properties), first)
        else:
            for number, row in enumerate(rows, first):
                _check_row(_numbers(row, number), element, n_vertices, number)
        at += element.count


def _check_table(rows: list[bytes], n_columns: int, first: int) -> None:
    """Raise a Refusal if a row has another number of columns, or anything but numbers."""
    try:
        whole = np.array(b" ".join(rows).split(), dtype=np.float64)
    except ValueError:
        whole = np.empty(0)
    if len(whole) == n_columns * len(rows) and all(row.count(b" ") >= n_columns - 1 for row in rows):
        return
    for number, row in enumerate(rows, first):
        n_numbers = len(_numbers(row, number))
        if n_numbers != n_columns:
            raise damaged(f"line {number}: there are {n_numbers} numbers where {n_columns} belong")


def _numbers(row: bytes, number: int) -> list[float]:
    try:
        return [float(word) for word in row.split()]
    except ValueError:
        raise damaged(f"line {number}: there is something else than numbers") from None


def _check_row(numbers: list[float], element: Element, n_vertices: int, line: int) -> None:
    at = 0
    for column, values in _columns(numbers, element, line):
        at += len(values) + bool(column.length_type)
        if column.name in INDICES and not all(0 <= value < n_vertices and value.is_integer() for value in values):
            raise damaged(f"line {line}: a face has a corner that is none of the {n_vertices} vertices")
    if at != len(numbers):
        raise damaged(f"line {line}: there are {len(numbers)} numbers where {at} belong")


def _columns(numbers: list[float], element: Element, line: int) -> Iterator[tuple[Property, list[float]]]:
    """Yield each column of a row with its values."""
    at = 0
    for column in element.properties:
        length = 1.0
        if column.length_type:
            length = numbers[at] if at < len(numbers) else -1.0
            at += 1
        if not (0 <= length <= len(numbers) - at and length.is_integer()):
            raise damaged(f"line {line}: the row has fewer numbers than it should")
        yield column, numbers[at : at + int(length)]
        at += int(length)
