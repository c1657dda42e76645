"""Reports of files: values that programs read, and a line for people."""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import NotRequired, TypedDict, cast

import bpy

from ...compute.registration.parts.transferred_labels import FaceLabels
from ...compute.segmentation.parts.part_labels import BranchLabels
from .part_names import name_of_part, names_of_parts

# Raised when the layout of the report changes; report.schema.json describes it.
VERSION = 1

# What is matched with less counts as failed: it is hardly ever right.
LEAST_CONFIDENCE = 0.05

# All that the results of a command depend on besides the files.
Settings = dict[str, object]


class PartRow(TypedDict):
    """A part of a divided object."""

    id: int
    name: str
    parent: int
    area: float
    faces: int
    # The part that a symmetry of the shape maps it onto; in 0.1.0 it was not told.
    mirror: NotRequired[int | None]
    # Of registered objects: whether the reference has it too.
    matched: NotRequired[bool]


class ObjectRow(TypedDict):
    """An object of a file; what it has depends on the command, and ``error`` on how it went."""

    name: str
    error: NotRequired[str]
    seconds: NotRequired[float]
    warnings: NotRequired[list[str]]
    elements: NotRequired[str]
    level: NotRequired[int]
    n_levels: NotRequired[int]
    parts: NotRequired[list[PartRow]]
    confidence: NotRequired[float]
    source: NotRequired[str]
    found_by: NotRequired[str]
    layers: NotRequired[list[str]]
    unsure_vertices: NotRequired[int]
    unsure_parts: NotRequired[dict[str, float]]
    reference: NotRequired[str]


class Written(TypedDict):
    """The files that were written together, by which it is known later whether they are still as they were written."""

    # Of the input, from the folder of the result.
    source: str
    # Digests by name: of the result and of what belongs to it.
    files: dict[str, str]
    # While files are exchanged: of those that are replaced.
    before: NotRequired[dict[str, str]]


class Report(TypedDict):
    """A file; ``output`` if a result was written."""

    version: NotRequired[int]
    file: str
    error: NotRequired[str]
    seconds: NotRequired[float]
    digest: NotRequired[str]
    settings: NotRequired[Settings]
    objects: NotRequired[list[ObjectRow]]
    output: NotRequired[str]
    warnings: NotRequired[list[str]]
    # Kept with the result only.
    written: NotRequired[Written]
    # Of a batch: whether the result was there before.
    skipped: NotRequired[bool]


def part_rows(mesh: bpy.types.Mesh, labels: BranchLabels | FaceLabels) -> list[PartRow]:
    """Return the table of parts of a divided mesh."""
    parts, given = labels.parts, names_of_parts(mesh)
    numbers = (parts.id.tolist(), parts.parent.tolist(), parts.mirror.tolist())
    return [
        {
            "id": part,
            "name": name_of_part(part, given),
            "parent": parent,
            "area": area,
            "faces": n_faces,
            "mirror": None if mirror < 0 else mirror,
        }
        for part, parent, mirror, area, n_faces in zip(
            *numbers, parts.area.tolist(), parts.n_triangles.tolist(), strict=True
        )
    ]


def problems_of(rows: Iterable[ObjectRow]) -> str:
    """Return one line about the objects of a file that failed or are very likely wrong, empty if there are none."""
    problems = ((row["name"], row.get("error") or _doubt(row)) for row in rows)
    return " ".join(f"{name}: {problem}" for name, problem in problems if problem)


def _doubt(row: ObjectRow) -> str:
    if row.get("confidence", 1.0) >= LEAST_CONFIDENCE:
        return ""
    what = "layers" if "layers" in row else "parts"
    return (
        f"it is matched with a confidence of {row['confidence']:.0%} only, so its {what} are very likely wrong; "
        "the result was written all the same, look at it before you use it."
    )


def without_version(report: Report) -> Report:
    """Return a report that was read without the version that it was written with."""
    return cast(Report, {name: value for name, value in report.items() if name != "version"})


def path_beside(target: Path) -> Path:
    """Return where the report of a result is kept."""
    return target.with_name(target.name + ".json")


def as_line(report: Report) -> str:
    """Return the report of one file as JSON on one line."""
    return json.dumps({"version": VERSION, **report})


def as_document(reports: list[Report]) -> str:
    """Return the report of all files as JSON."""
    return json.dumps({"version": VERSION, "files": reports}, indent=2)


def sentence(report: Report) -> str:
    """Return a line for people about a file that went well."""
    counts = ", ".join(_counts(row) for row in report["objects"] if "error" not in row)
    return f"{report['file']}: {counts}, {report['seconds']:.1f} s, written to {report['output']}"


def warnings_in(report: Report) -> list[str]:
    """Return a line for each warning about a file and its objects."""
    of_objects = [f"{row['name']}: {text}" for row in report.get("objects", []) for text in row.get("warnings", [])]
    return [*report.get("warnings", []), *of_objects]


def _counts(row: ObjectRow) -> str:
    if "layers" in row:
        return f"{row['name']}: {len(row['layers'])} layers ({row['confidence']:.0%} sure)"
    sureness = f" ({row['confidence']:.0%} sure)" if "confidence" in row else ""
    return f"{row['name']}: {len(row['parts'])} parts{sureness}"
