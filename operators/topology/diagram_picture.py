"""The picture of a persistence diagram and of its persistence curve."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ... import compute
from .canvas import Canvas, Floats, Numbers

# A function that turns a text into triangles of letters of height 1.
Letters = Callable[[str], Floats]

WIDTH, HEIGHT = 1600, 920
# Where the line of the legend stands.
LEGEND = 28
PAPER, INK, QUIET, GRID, BAND = ((v, v, v) for v in (1.0, 0.13, 0.42, 0.9, 0.945))
BLUE, RED, PURPLE, GREEN = (0.0, 0.467, 0.733), (0.8, 0.2, 0.067), (0.533, 0.18, 0.447), (0.067, 0.467, 0.2)
# More points than this cannot be told apart; the most persistent ones are drawn.
MOST_POINTS = 3000
# From this many points on they are drawn smaller.
CROWD = 150


@dataclass(frozen=True, eq=False)
class Plotted:
    """A diagram to be drawn, and the marks in it.

    Attributes
    ----------
    title : str
    diagram : PersistenceDiagram
    noise, threshold : float
        Persistence up to which pairs are noise, and from which on they are features by default; as fractions of the
        range.
    """

    title: str
    diagram: compute.PersistenceDiagram
    noise: float
    threshold: float


@dataclass(frozen=True, eq=False)
class _Frame:
    """An upright box on the canvas, and the values at its corners."""

    canvas: Canvas
    letters: Letters
    low: Floats
    high: Floats
    first: Floats
    last: Floats

    def place(self, values: Floats) -> Floats:
        """Return the pixels of values."""
        return self.low + (np.asarray(values) - self.first) / (self.last - self.first) * (self.high - self.low)

    def write(
        self,
        text: str,
        at: Numbers,
        *,
        size: float = 19,
        colour: Numbers = QUIET,
        align: Numbers = (0.5, 0.5),
        angle: float = 0,
    ) -> None:
        """Write a text; ``align`` says which point of its box stands at the place, (0, 0) being the lower left."""
        triangles = self.letters(text) * size
        extent = triangles.max(axis=(0, 1)) if len(triangles) else np.zeros(2)
        # All texts of a size stand on one line, whatever letters they have.
        triangles = triangles - np.array([extent[0], 0.62 * size]) * align
        cosine, sine = np.cos(angle), np.sin(angle)
        self.canvas.triangles(triangles @ [[cosine, sine], [-sine, cosine]] + np.asarray(at), colour)


def draw_diagram(plotted: Plotted, letters: Letters) -> NDArray[np.float32]:
    """Return the (height, width, 3) picture in sRGB, the lowest row first."""
    canvas = Canvas(WIDTH, HEIGHT, PAPER)
    _draw_points(canvas, plotted, letters)
    _draw_curve(canvas, plotted, letters)
    return canvas.pixels


def _draw_points(canvas: Canvas, plotted: Plotted, letters: Letters) -> None:
    diagram = plotted.diagram
    everything = np.concatenate([diagram.points.ravel(), diagram.essential.ravel()])
    bottom, top = float(everything.min()), float(everything.max())
    margin = 0.06 * (top - bottom) or 1.0
    first, last = np.full(2, bottom - margin), np.full(2, top + margin)
    frame = _Frame(canvas, letters, np.array([120.0, 150.0]), np.array([800.0, 830.0]), first, last)
    band = plotted.threshold * (top - bottom)
    for across, up in ((0, 1), (1, 0)) if band > 0 else ():
        corners = np.array([first, last, last, first])
        corners[2, across] -= band
        corners[3, up] += band
        canvas.polygon(frame.place(corners), BAND)
    for axis in (0, 1):
        _draw_axis(frame, axis, _ticks(first[axis], last[axis]))
    canvas.line(frame.place(np.array([first, last])), QUIET, 1.5)
    _draw_box(frame)
    points = diagram.points[-MOST_POINTS:]
    radius = 7 if len(points) < CROWD else 4
    for (x, y), centre in zip(points, frame.place(points), strict=True):
        _draw_dot(canvas, centre, BLUE if x < y else RED, radius)
    for centre in frame.place(diagram.components):
        canvas.diamond(centre, 11, PAPER)
        canvas.diamond(centre, 9, INK)
    for centre in frame.place(diagram.loops):
        canvas.diamond(centre, 10, PAPER)
        canvas.diamond(centre, 8, PURPLE)
    frame.write(plotted.title, (frame.low[0], 868), size=27, colour=INK, align=(0, 0.5))
    frame.write("value at the extremum", (460, 84))
    frame.write("value at the saddle", (36, 490), angle=np.pi / 2)
    _draw_legend(frame, diagram)


def _draw_legend(frame: _Frame, diagram: compute.PersistenceDiagram) -> None:
    rows = [
        (_counted(len(diagram.minima), "minimum", "minima"), BLUE, frame.canvas.disk, 7),
        (_counted(len(diagram.maxima), "maximum", "maxima"), RED, frame.canvas.disk, 7),
        (_counted(len(diagram.components), "whole surface", "whole surfaces"), INK, frame.canvas.diamond, 9),
        (_counted(len(diagram.loops), "loop of the surface", "loops of the surface"), PURPLE, frame.canvas.diamond, 9),
    ]
    x = frame.low[0]
    for text, colour, draw, radius in rows:
        if text:
            draw((x + 9, LEGEND), radius, colour)
            frame.write(text, (x + 26, LEGEND), size=17, colour=INK, align=(0, 0.5))
            x += 60 + frame.letters(text)[..., 0].max() * 17


def _counted(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}" if count else ""


def _draw_curve(canvas: Canvas, plotted: Plotted, letters: Letters) -> None:
    """Draw how many pairs there are above each persistence; logarithmic, since noise is by powers of ten smaller."""
    lowest, highest = plotted.diagram.components[:, 0].min(), plotted.diagram.components[:, 1].max()
    persistence = np.sort(plotted.diagram.persistence) / ((highest - lowest) or 1.0)
    persistence = persistence[persistence > 0]
    smallest = min(plotted.noise, float(persistence.min(initial=plotted.noise)))
    first_power = max(np.floor(np.log10(smallest)), -8.0)
    shown = np.maximum(np.log10(persistence), first_power)
    most = max(len(shown), 1)
    frame = _Frame(
        canvas,
        letters,
        np.array([930.0, 150.0]),
        np.array([1540.0, 830.0]),
        np.array([first_power, 0.0]),
        np.array([0.0, 1.08 * most]),
    )
    if plotted.noise > 10**first_power:
        left, right = frame.place(np.array([[first_power, 0], [np.log10(plotted.noise), 1.08 * most]]))
        canvas.rectangle(left, right, BAND)
        frame.write("noise", (right[0] - 10, frame.high[1] - 18), size=17, align=(1, 0.5))
    powers = np.arange(first_power, 1)
    _draw_axis(frame, 0, {power: _percent(power) for power in powers})
    _draw_axis(frame, 1, {k: f"{k:.0f}" for k in _ticks(0, 1.08 * most) if k.is_integer()})
    count = np.arange(most, 0, -1) if len(shown) else np.zeros(0)
    edges = np.repeat(np.concatenate([[first_power], shown, [0.0]]), 2)[1:-1]
    heights = np.repeat(np.concatenate([count, [0]]), 2)
    canvas.line(frame.place(np.stack([edges, heights], axis=1)), GREEN, 3)
    level = int((persistence >= plotted.threshold).sum())
    mark = frame.place(np.array([np.log10(plotted.threshold), level]))
    canvas.dashes((mark[0], frame.low[1]), (mark[0], frame.high[1]), QUIET, 1.5)
    _draw_box(frame)
    _draw_dot(canvas, mark, GREEN)
    frame.write(
        f"{level} above {plotted.threshold:.0%}", mark + np.array([14, 22]), size=19, colour=INK, align=(0, 0.5)
    )
    frame.write("Pairs by persistence", (frame.low[0], 868), size=27, colour=INK, align=(0, 0.5))
    frame.write("persistence, as a part of the range", (1235, 84))
    frame.write("pairs", (872, 490), angle=np.pi / 2)


def _draw_axis(frame: _Frame, axis: int, ticks: dict[float, str]) -> None:
    for value, text in ticks.items():
        place = frame.place(np.full(2, value))[axis]
        line = np.array([frame.low, frame.high])
        line[:, axis] = place
        frame.canvas.line(line, GRID, 1)
        at = frame.low - 14
        at[axis] = place
        frame.write(text, at, size=17, align=(0.5, 1.0) if axis == 0 else (1.0, 0.5))


def _draw_box(frame: _Frame) -> None:
    (left, bottom), (right, top) = frame.low, frame.high
    corners = [[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]]
    frame.canvas.line(np.array(corners), INK, 1.5)


def _draw_dot(canvas: Canvas, centre: Floats, colour: tuple[float, ...], radius: float = 7) -> None:
    canvas.disk(centre, 1.2 * radius, PAPER)
    canvas.disk(centre, radius, colour)


def _ticks(first: float, last: float) -> dict[float, str]:
    """Return round values between two, about six of them, and how they are written."""
    rough = (last - first) / 6
    power = 10.0 ** np.floor(np.log10(rough))
    step = power * next(s for s in (1, 2, 5, 10) if s * power >= rough)
    digits = max(0, int(-np.floor(np.log10(step) + 1e-9)))
    values = np.arange(np.ceil(first / step), np.floor(last / step) + 1) * step
    if digits > 4 or np.abs(values).max(initial=0) >= 1e5:
        return {value: f"{value:.2g}" for value in values.tolist()}
    return {value: f"{value + 0.0:.{digits}f}" for value in np.round(values, digits).tolist()}


def _percent(power: float) -> str:
    return f"{100 * 10.0**power:.{max(0, int(-power) - 2)}f} %"
