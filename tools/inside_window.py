"""Runs inside the application that is driven: carries out the Python it is sent, a piece at a time."""

import os
import sys
import time
import traceback
from contextlib import contextmanager
from multiprocessing.connection import Client

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d

# Seconds between looks at what was sent.
INTERVAL = 0.02


class Ticks:
    """How long the window was silent between ticks of a timer that asks for one each hundredth of a second.

    With each gap goes what ``told`` says at its end.
    """

    def __init__(self, told=lambda: ""):
        self.gaps, self._told, self._last, self._goes_on = [], told, time.perf_counter(), True
        bpy.app.timers.register(self._tick, persistent=True)

    def _tick(self):
        now = time.perf_counter()
        self.gaps.append((now - self._last, self._told()))
        self._last = now
        return 0.01 if self._goes_on else None

    def stop(self):
        """Return pairs of seconds and what was told."""
        self._goes_on = False
        return self.gaps


@contextmanager
def over_view():
    """Do as if the mouse were over the largest 3D view."""
    window = bpy.context.window_manager.windows[0]
    views = [area for area in window.screen.areas if area.type == "VIEW_3D"]
    area = max(views, key=lambda area: area.width * area.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, screen=window.screen, area=area, region=region):
        yield bpy.context


def pixel_of(point):
    """Return the pixel of the window, counted from below, that shows a point of the world in the largest 3D view."""
    with over_view() as context:
        x, y = location_3d_to_region_2d(context.region, context.space_data.region_3d, point)
        return round(context.region.x + x), round(context.region.y + y)


def _carry_out():
    try:
        while connection.poll():
            connection.send(_answer(*connection.recv()))
    except (EOFError, OSError):
        # Whoever drove the application is gone. Blender's own way out would ask whether to save.
        os._exit(0)
    return INTERVAL


def _answer(way, source):
    try:
        if way == "value":
            return "value", eval(source, namespace)
        return "value", exec(source, namespace)
    except Exception:
        return "error", traceback.format_exc()


namespace = {"bpy": bpy, "over_view": over_view, "pixel_of": pixel_of, "Ticks": Ticks, "time": time}
address, key = sys.argv[sys.argv.index("--") + 1 :]
connection = Client(("localhost", int(address)), authkey=bytes.fromhex(key))
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(_carry_out, persistent=True)
