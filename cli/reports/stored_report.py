"""What lies at the place of a report, read as if it could be anything: ours, the user's, damaged or hostile."""

from __future__ import annotations

import json
import math
import stat
from dataclasses import dataclass
from pathlib import Path
from types import UnionType
from typing import Any, TypeGuard, get_args, get_origin, get_type_hints, is_typeddict

from .report import Report, Written

# Bytes; a report of some 100,000 parts. What is larger is none of ours.
LARGEST = 1 << 24
# What reports of results have, all the others being of files that failed.
OF_RESULTS = {"version", "seconds", "digest", "settings", "objects", "output"}


@dataclass(frozen=True)
class StoredReport:
    """A report that was read, as far as it has the shape of one.

    Attributes
    ----------
    is_there : bool
        Whether anything lies there.
    written : Written, optional
        What was written together with it.
    report : Report, optional
        All of it, if all of it has the shape of a report of a result.
    """

    is_there: bool
    written: Written | None = None
    report: Report | None = None


def read_report(path: Path) -> StoredReport:
    """Read what lies at the place of a report."""
    try:
        mode = path.lstat().st_mode
    except OSError:
        return StoredReport(is_there=False)
    value = _json_in(path) if stat.S_ISREG(mode) else None
    if not isinstance(value, dict):
        return StoredReport(is_there=True)
    return StoredReport(True, _written_in(value.get("written")), value if _is_report(value) else None)


def has_shape(value: object, kind: Any) -> bool:
    """Whether a value that JSON can hold is one of a type: a TypedDict, list, dictionary, union or plain type."""
    if is_typeddict(kind):
        kinds = get_type_hints(kind)
        return (
            isinstance(value, dict)
            and kind.__required_keys__ <= value.keys() <= kinds.keys()
            and all(has_shape(part, kinds[name]) for name, part in value.items())
        )
    if get_origin(kind) in (list, dict):
        # Names are texts in JSON.
        parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
        return isinstance(value, get_origin(kind)) and all(has_shape(part, get_args(kind)[-1]) for part in parts)
    if get_origin(kind) is UnionType:
        return any(has_shape(value, one) for one in get_args(kind))
    if kind is float:
        return type(value) is int or (type(value) is float and math.isfinite(value))
    return kind is object or type(value) is kind


def _json_in(path: Path) -> object:
    try:
        with open(path, "rb") as stream:
            text = stream.read(LARGEST + 1)
        return json.loads(text) if len(text) <= LARGEST else None
    except (OSError, ValueError, RecursionError):
        return None


def _written_in(value: Any) -> Written | None:
    """Return what was written, if all names are those of files beside the report."""
    if not has_shape(value, Written):
        return None
    written: Written = value
    return written if all(map(_is_name, [*written["files"], *written.get("before", {})])) else None


def _is_name(name: str) -> bool:
    return Path(name).name == name and "\0" not in name


def _is_report(value: dict[str, object]) -> TypeGuard[Report]:
    return value.keys() >= OF_RESULTS and has_shape(value, Report)
