"""Runs inside the application that is driven: carries out the Python it is sent, a piece at a time."""

import os
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Client
from typing import Any, Literal

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d

# Seconds between looks at what was sent.
INTERVAL = 0.02


class Ticks:
    """The silences of the window, between ticks of a timer that asks for one each hundredth of a second.

    With each gap goes what ``told`` says at its end.
    """

    def __init__(self, told: Callable[[], str] = lambda: "") -> None:
        self.gaps: list[tuple[float, str]] = []
        self._told, self._last, self._goes_on = told, time.perf_counter(), True
        bpy.app.timers.register(self._tick, persistent=True)

    def _tick(self) -> float | None:
        now = time.perf_counter()
        self.gaps.append((now - self._last, self._told()))
        self._last = now
        return 0.01 if self._goes_on else None

    def stop(self) -> list[tuple[float, str]]:
        """Return pairs of seconds and what was told."""
        self._goes_on = False
        return self.gaps


@contextmanager
def over_view() -> Iterator[bpy.types.Context]:
    """Do as if the mouse were over the largest 3D view."""
    windows = bpy.context.window_manager
    assert windows is not None
    window = windows.windows[0]
    views = [area for area in window.screen.areas if area.type == "VIEW_3D"]
    area = max(views, key=lambda area: area.width * area.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, screen=window.screen, area=area, region=region):
        yield bpy.context


def pixel_of(point: tuple[float, float, float]) -> tuple[int, int]:
    """Return the pixel of the window, counted from below, that shows a point of the world in the largest 3D view."""
    with over_view() as context:
        region, view = context.region, context.space_data
        assert region is not None
        assert isinstance(view, bpy.types.SpaceView3D)
        assert view.region_3d is not None
        pixel = location_3d_to_region_2d(region, view.region_3d, point)
        return round(region.x + pixel.x), round(region.y + pixel.y)


def _carry_out() -> float:
    try:
        while connection.poll():
            connection.send(_answer(*connection.recv()))
    except (EOFError, OSError):
        # Whoever drove the application is gone. Blender's own way out would ask whether to save.
        os._exit(0)
    return INTERVAL


def _answer(way: Literal["run", "value"], source: str) -> tuple[Literal["value", "error"], Any]:
    try:
        if way == "value":
            return "value", eval(source, namespace)
        exec(source, namespace)
        return "value", None
    except Exception:
        return "error", traceback.format_exc()


namespace: dict[str, Any] = {"bpy": bpy, "over_view": over_view, "pixel_of": pixel_of, "Ticks": Ticks, "time": time}
address, key = sys.argv[sys.argv.index("--") + 1 :]
connection = Client(("localhost", int(address)), authkey=bytes.fromhex(key))
preferences = bpy.context.preferences
assert preferences is not None
preferences.view.show_splash = False
bpy.app.timers.register(_carry_out, persistent=True)
