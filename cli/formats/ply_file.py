"""What a .ply file says of itself, looked at before Blender opens it: its reader ends the process at damaged ones."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .damage import cut_short, damaged

TYPES = {
    **dict(char="i1", uchar="u1", short="i2", ushort="u2", int="i4", uint="u4", float="f4", double="f8"),
    **dict(int8="i1", uint8="u1", int16="i2", uint16="u2", int32="i4", uint32="u4", float32="f4", float64="f8"),
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

    def row_type(self, order: str) -> np.dtype[np.void]:
        """Return the type of a row without lists."""
        return np.dtype([(column.name, order + column.type) for column in self.properties])


@dataclass(frozen=True)
class Header:
    """What the file says of itself.

    Attributes
    ----------
    text : str
    order : str
        Of the bytes, as numpy writes it; empty if the numbers are text.
    elements : list of Element
    """

    text: str
    order: str
    elements: list[Element]

    @property
    def size(self) -> int:
        """Where the rows begin."""
        return len(self.text)

    def count_of(self, name: str) -> int:
        """Return how many rows an element has."""
        return next((element.count for element in self.elements if element.name == name), 0)


def parse_ply(data: bytes) -> tuple[Header, NDArray[np.bool_] | None]:
    """Return what a file says of itself, and which of its points are no numbers; None if points have lists.

    Raises
    ------
    Refusal
        If it is not what its header says.
    """
    header = header_of(data)
    tables = _tables_of_bytes(data, header) if header.order else _tables_of_text(data, header)
    if "vertex" not in tables:
        return header, None
    places = np.stack([tables["vertex"][axis] for axis in "xyz"], axis=1)
    return header, ~np.isfinite(places).all(axis=1)


def header_of(data: bytes) -> Header:
    """Return what a file says of itself; raises a Refusal if this makes no sense."""
    if not data.startswith(b"ply"):
        raise damaged('line 1: it does not begin with "ply"')
    end = re.compile(rb"(?:\r\n|\n|\r)end_header[ \t]*(?:\r\n|\n|\r|\Z)").search(data[:HEADER])
    if end is None:
        raise damaged('the header has no line "end_header"')
    text = data[: end.end()].decode("latin-1")
    order, elements = _order_and_elements(text.splitlines())
    if order is None:
        raise damaged("the header does not say in which format the numbers are")
    _check_elements(elements)
    return Header(text, order, elements)


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


def _check_elements(elements: list[Element]) -> None:
    vertices = next((element for element in elements if element.name == "vertex"), None)
    if vertices is None:
        raise damaged("the header lists no vertices")
    if not {"x", "y", "z"} <= {column.name for column in vertices.properties if not column.length_type}:
        raise damaged("the header lists no x, y and z of the vertices")
    for element in elements:
        names = [column.name for column in element.properties]
        if len(set(names)) < len(names) or not names:
            raise damaged(f'the header lists the columns of "{element.name}" twice or not at all')


def _tables_of_bytes(data: bytes, header: Header) -> dict[str, Any]:
    """Return the rows of the elements without lists, by name."""
    at, n_vertices, tables = header.size, header.count_of("vertex"), dict[str, Any]()
    for element in header.elements:
        if not element.has_lists:
            row = element.row_type(header.order)
            if at + element.count * row.itemsize > len(data):
                raise cut_short(f'byte {len(data)}, within "{element.name}"')
            tables[element.name] = np.frombuffer(data, row, element.count, at)
            at += tables[element.name].nbytes
        elif element.count:
            at = _end_of_rows(data, at, element, header.order, n_vertices)
    return tables


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


def _tables_of_text(data: bytes, header: Header) -> dict[str, Any]:
    """Return the columns of the elements without lists, by name."""
    lines, first = data[header.size :].splitlines(), len(header.text.splitlines()) + 1
    at, n_vertices, tables = 0, header.count_of("vertex"), dict[str, Any]()
    for element in header.elements:
        rows, line = lines[at : at + element.count], first + at
        if len(rows) < element.count:
            raise cut_short(f'line {line + len(rows)}, after {len(rows)} of {element.count} rows of "{element.name}"')
        if not element.has_lists:
            columns = _table(rows, len(element.properties), line).T
            tables[element.name] = {
                column.name: values for column, values in zip(element.properties, columns, strict=True)
            }
        else:
            for number, row in enumerate(rows, line):
                _check_row(_numbers(row, number), element, n_vertices, number)
        at += element.count
    return tables


def _table(rows: list[bytes], n_columns: int, first: int) -> NDArray[np.float64]:
    """Return the numbers in rows; raises a Refusal if a row has not as many, or anything but numbers."""
    try:
        whole = np.array(b" ".join(rows).split(), dtype=np.float64)
    except ValueError:
        whole = np.empty(0)
    if len(whole) == n_columns * len(rows) and all(row.count(b" ") >= n_columns - 1 for row in rows):
        return whole.reshape(len(rows), n_columns)
    table = [_numbers(row, number) for number, row in enumerate(rows, first)]
    for number, numbers in enumerate(table, first):
        if len(numbers) != n_columns:
            raise damaged(f"line {number}: there are {len(numbers)} numbers where {n_columns} belong")
    return np.array(table)


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
