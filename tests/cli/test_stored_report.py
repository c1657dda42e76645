"""What lies at the place of a report may be anything."""

import json
import os

import pytest

from tests.cli.writing import cli

WRITTEN = {"source": "star.off", "files": {"star_parts.off": "0" * 32}}
ROW = {"name": "star", "level": 1, "n_levels": 2, "parts": [], "seconds": 0.5, "warnings": []}
GOOD = {
    **{"version": 1, "file": "star.off", "seconds": 1, "digest": "0" * 32, "settings": {"level": None}},
    **{"objects": [ROW], "output": "star_parts.off", "written": WRITTEN},
}


@pytest.fixture
def read(tmp_path):
    def read_back(value):
        (tmp_path / "report.json").write_bytes(value if isinstance(value, bytes) else json.dumps(value).encode())
        return cli("reports.stored_report").read_report(tmp_path / "report.json")

    return read_back


def test_a_report_is_read_as_it_was_written(read):
    assert read(GOOD).report == GOOD
    assert read(GOOD).written == WRITTEN
    assert read({name: value for name, value in GOOD.items() if name != "written"}).written is None


@pytest.mark.parametrize(
    ("twin", "is_read"), [({}, True), ({"mirror": None}, True), ({"mirror": 2}, True), ({"mirror": "2"}, False)]
)
def test_twins_are_numbers_or_none_or_not_told(read, twin, is_read):
    part = {"id": 1, "name": "part_1", "parent": 0, "area": 1.5, "faces": 3, **twin}
    report = {**GOOD, "objects": [{**ROW, "parts": [part]}]}
    assert read(report).report == (report if is_read else None)


@pytest.mark.parametrize(
    "value",
    [
        b"[" * 200_000,
        b'{"written":' * 200_000,
        b"5",
        b"",
        b"\xff\xfe\x00",
        b'{"x":' + b"9" * 5000 + b"}",
        b'{"version": 1}' + b" " * (1 << 24),
        [GOOD],
        {"written": [WRITTEN]},
        {"written": {"source": 5, "files": {}}},
        {"written": {"source": "star.off", "files": ["star_parts.off"]}},
        {"written": {"source": "star.off", "files": {"star_parts.off": 5}}},
        {"written": {"source": "star.off", "files": {"../star_parts.off": "0" * 32}}},
        {"written": {"source": "star.off", "files": {"/etc/passwd": "0" * 32}}},
        {"written": {"source": "star.off", "files": {"star\0.off": "0" * 32}}},
    ],
    ids=range(15),
)
def test_what_is_no_report_is_none(read, value):
    stored = read(value)
    assert (stored.is_there, stored.written, stored.report) == (True, None, None)


@pytest.mark.parametrize("value", [None, True, -1.5, "x", 5, [], {}, [5], [[]], {"x": 1}, float("nan"), float("inf")])
@pytest.mark.parametrize("name", sorted(GOOD.keys() - {"written"}))
def test_a_report_with_a_value_of_another_type_is_none(read, name, value):
    stored = read(GOOD | {name: value})
    fits = {type(GOOD[name])} | ({float} if name == "seconds" and value == -1.5 else set())
    is_plain = type(value) in fits and value not in ([5], [[]])
    assert (stored.report is not None) == is_plain
    assert stored.written == WRITTEN


@pytest.mark.parametrize("row", [5, {}, {"name": 5}, ROW | {"parts": 5}, ROW | {"warnings": [5]}, ROW | {"other": 1}])
def test_a_report_with_a_row_of_another_shape_is_none(read, row):
    assert read(GOOD | {"objects": [row]}).report is None


def test_what_is_no_file_is_not_opened(tmp_path):
    read_report = cli("reports.stored_report").read_report
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to(tmp_path / "loop")
    (tmp_path / "loop").symlink_to(tmp_path / "link")
    assert all(read_report(tmp_path / name).is_there for name in ("folder", "pipe", "link"))
    assert not read_report(tmp_path / "nothing").is_there
