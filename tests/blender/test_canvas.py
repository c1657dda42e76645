"""Shapes on a canvas cover the area that they have, and letters that of a line of text."""

import numpy as np
import pytest

SIZE = 60


@pytest.fixture(scope="module")
def canvases(extension):
    from eigenparts.operators.topology.canvas import Canvas

    return lambda: Canvas(SIZE, SIZE, (0, 0, 0))


def covered(canvas):
    """Return how many pixels are covered, by a shape of colour (1, 0.5, 0.25)."""
    np.testing.assert_allclose(canvas.pixels[..., 1:], canvas.pixels[..., :1] * [0.5, 0.25], atol=1e-6)
    return float(canvas.pixels[..., 0].sum())


COLOUR = (1, 0.5, 0.25)
CORNERS = np.array([[10.3, 12.1], [45.7, 20.2], [22.9, 50.4]])
AREA = 0.5 * abs(np.linalg.det(CORNERS[1:] - CORNERS[0]))
SHAPES = {
    "disk": (lambda canvas: canvas.disk((30.2, 29.7), 11.5, COLOUR), np.pi * 11.5**2),
    "ring and back": (lambda canvas: canvas.disk((30, 30), 11.5, COLOUR, opacity=0.5), 0.5 * np.pi * 11.5**2),
    "rectangle": (lambda canvas: canvas.rectangle((10.25, 20.5), (30.75, 45.25), COLOUR), 20.5 * 24.75),
    "diamond": (lambda canvas: canvas.diamond((30.4, 30.1), 12, COLOUR), 2 * 12**2),
    "polygon": (lambda canvas: canvas.polygon(CORNERS, COLOUR), AREA),
    "polygon the other way round": (lambda canvas: canvas.polygon(CORNERS[::-1], COLOUR), AREA),
    "triangle": (lambda canvas: canvas.triangles(CORNERS[None], COLOUR), AREA),
    "triangle twice": (lambda canvas: canvas.triangles(np.stack([CORNERS, CORNERS]), COLOUR), AREA),
    "line": (lambda canvas: canvas.line([[10, 12], [50, 42]], COLOUR, width=4), 50 * 4 + np.pi * 2**2),
    "bent line": (
        lambda canvas: canvas.line([[10, 10], [40, 10], [40, 40]], COLOUR, width=4),
        60 * 4 + np.pi * 2**2 - 4 + (4 - np.pi) * 1,
    ),
    "dashes": (lambda canvas: canvas.dashes((5, 30), (53, 30), COLOUR, 2), 4 * (6 * 2 + np.pi)),
    "outside": (lambda canvas: canvas.disk((-20, 30), 11.5, COLOUR), 0),
    "half outside": (lambda canvas: canvas.disk((0, 30), 11.5, COLOUR), 0.5 * np.pi * 11.5**2),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_shape_covers_its_area(canvases, shape):
    draw, area = SHAPES[shape]
    canvas = canvases()
    draw(canvas)
    assert covered(canvas) == pytest.approx(area, rel=0.02, abs=0.01)


def test_x_runs_to_the_right_and_y_up(canvases):
    canvas = canvases()
    canvas.disk((45, 15), 3, COLOUR)
    rows, columns = np.nonzero(canvas.pixels[..., 0])
    assert (rows.mean(), columns.mean()) == pytest.approx((14.5, 44.5))


def test_letters_stand_on_the_line_and_leave_nothing_behind(extension):
    import bpy

    from eigenparts.operators.topology.lettering import Lettering

    with Lettering() as letters:
        narrow, wide, none = (letters.triangles(text) for text in ("x", "xxxx", " "))
    assert narrow.shape[1:] == (3, 2)
    assert len(wide) == 4 * len(narrow)
    assert np.ptp(wide[..., 0]) > 3 * np.ptp(narrow[..., 0])
    # A small x is between one third and two thirds of a line high.
    assert narrow[..., 1].min() == pytest.approx(0, abs=0.02)
    assert 0.3 < narrow[..., 1].max() < 0.7
    assert len(none) == 0
    assert [len(blocks) for blocks in (bpy.data.objects, bpy.data.curves, bpy.data.fonts)] == [0, 0, 0]
