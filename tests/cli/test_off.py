"""The Object File Format as it is found in the wild."""

import pytest

from tools.extension import load_extension

TRIANGLE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]


@pytest.fixture
def parse_off():
    load_extension()
    from eigenparts.cli.off import parse_off

    return parse_off


@pytest.mark.parametrize(
    "text",
    [
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "# made by hand\nOFF\n\n3 1 3 # counts\n0 0 0\n1 0 0\n\n0 1 0\n3 0 1 2 255 0 0\n",
        "COFF\n3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n",
        "OFF\r\n3 2 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n2 0 1\r\n3 0 1 2\r\n",
    ],
)
def test_all_ways_to_write_a_triangle(parse_off, text):
    assert parse_off(text) == (TRIANGLE, [[0, 1, 2]])


@pytest.mark.parametrize(
    "text",
    [
        "",
        "PLY\n",
        "OFF\n",
        "OFF\n3 1 0\n0 0 0\n",
        "OFF\n1 1 0\n0 0 0\n3 0 1 2\n",
        "OFF\n1 0 0\n0 zero 0\n",
        "OFF\n1 0 0\n0 0\n",
    ],
)
def test_what_is_no_mesh_is_refused(parse_off, text):
    with pytest.raises((ValueError, IndexError)):
        parse_off(text)
