"""Drive the real Blender application on a screen that is not there: keys, Python inside it, and pictures.

The application is the one that the variable EIGENPARTS_BLENDER names, else ``blender`` on the path, else one in a usual
place. It starts with settings and extensions of its own, so that nothing of the user's is touched.
"""

import os
import secrets
import shutil
import subprocess
import time
from collections.abc import Callable
from multiprocessing.connection import Listener
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tools.screen import SIZE, Screen, write_png

VARIABLE = "EIGENPARTS_BLENDER"
USUAL_PLACES = (
    *("/usr/bin/blender", "/usr/local/bin/blender", "/snap/bin/blender", "/opt/blender*/blender"),
    *("~/blender*/blender", "~/Applications/blender*/blender", "~/Downloads/blender*/blender"),
)
INSIDE = Path(__file__).with_name("inside_window.py")
DIGITS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
KEYS = {" ": "SPACE"} | {str(digit): name for digit, name in enumerate(DIGITS)}
# Seconds; drawing may be done by the processor.
PATIENCE = 120.0


class WindowError(Exception):
    """A failure in the application; the text is its traceback or its last words."""


def find_application() -> str | None:
    """Return the path of a Blender with windows, None if there is none."""
    named = os.environ.get(VARIABLE) or shutil.which("blender")
    return named or next((str(path) for pattern in USUAL_PLACES for path in _matches(pattern)), None)


def _application() -> str:
    application = find_application()
    if application is None:
        raise WindowError(what_is_missing())
    return application


def what_is_missing() -> str:
    """Return why no window can be driven here, in a sentence; nothing if one can."""
    if not Screen.is_possible():
        return "Needs Xvfb (Debian, Ubuntu: apt install xvfb)."
    if find_application() is None:
        return f"Needs the Blender application; name it in the variable {VARIABLE}."
    return ""


class Window:
    """A Blender that runs on a screen of its own until it is closed.

    Parameters
    ----------
    folder : Path
        For its settings and extensions; the application must see it under this path.
    size : tuple of int
        Pixels of the screen, which the window fills.
    """

    def __init__(self, folder: Path, size: tuple[int, int] = SIZE) -> None:
        self.folder = folder
        self._screen = Screen(folder, size)
        inside = Path(shutil.copy(INSIDE, folder))
        key = secrets.token_bytes(16)
        # If the application dies before it calls, nobody else would end the waiting.
        self._listener = Listener(("localhost", 0), authkey=key)
        # Python's own way to that is private, so that its types leave it out.
        self._listener._listener._socket.settimeout(PATIENCE)  # type: ignore[attr-defined]
        # Blender does not believe in a folder that is not there, and takes the user's own.
        (folder / "user").mkdir(exist_ok=True)
        own = {"BLENDER_USER_RESOURCES": str(folder / "user"), "PYTHONUNBUFFERED": "1"}
        address = str(self._listener.address[1])
        command = [_application(), "--enable-event-simulate", "--python", str(inside), "--", address, key.hex()]
        self.log = folder / "log.txt"
        self._mouse = (0, 0)
        with self.log.open("w") as log:
            self._process = subprocess.Popen(
                command, env={**os.environ, "DISPLAY": self._screen.name, **own}, stdout=log, stderr=log
            )
        try:
            self._connection = self._listener.accept()
        except OSError as error:
            self._end()
            raise WindowError(self.log.read_text()) from error

    def run(self, source: str) -> None:
        """Carry out Python in the application; names stay for the next piece."""
        self._ask("run", source)

    def value(self, source: str) -> Any:
        """Return what an expression is in the application."""
        return self._ask("value", source)

    def press(self, key: str, **modifiers: bool) -> None:
        """Press and release a key or button, named as Blender names it, where the mouse is."""
        for value in ("PRESS", "RELEASE"):
            self._simulate(key, value, **modifiers)

    def point(self, x: int, y: int) -> None:
        """Move the mouse to pixels of the window, counted from below."""
        self._mouse = (x, y)
        self._simulate("MOUSEMOVE", "NOTHING")

    def click(self, x: int, y: int, **modifiers: bool) -> None:
        """Click with the left button."""
        self.point(x, y)
        self.press("LEFTMOUSE", **modifiers)

    def drag(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        """Press the left button in one place and release it in another."""
        self.point(*start)
        self._simulate("LEFTMOUSE", "PRESS")
        for share in (0.25, 0.5, 1.0):
            self.point(*(round(a + share * (b - a)) for a, b in zip(start, end, strict=True)))
        self._simulate("LEFTMOUSE", "RELEASE")

    def place(self, point: tuple[float, float, float]) -> tuple[int, int]:
        """Return the pixel of the window that shows a point of the world in the largest 3D view."""
        return self.value(f"pixel_of({point})")

    def write(self, text: str) -> None:
        """Type letters, digits and spaces."""
        for letter in text:
            name = KEYS.get(letter, letter.upper())
            self._simulate(name, "PRESS", unicode=letter)
            self._simulate(name, "RELEASE")

    def wait_for(self, expression: str, seconds: float = PATIENCE) -> float:
        """Wait until an expression is true, and return how many seconds it took."""
        start = time.monotonic()
        while not self.value(expression):
            if time.monotonic() - start > seconds:
                raise WindowError(f"In {seconds} seconds this never came true: {expression}")
            time.sleep(0.02)
        return time.monotonic() - start

    def settle(self, seconds: float = 1.0) -> None:
        """Let the window be drawn."""
        for _ in range(2):
            self.value("None")
            time.sleep(seconds / 2)

    def pixels(self) -> NDArray[np.uint8]:
        """Return (height, width, 3) uint8 of the screen, top row first."""
        return self._screen.pixels()

    def picture(self, path: Path, crop: tuple[slice, slice] = (slice(None), slice(None))) -> Path:
        """Write what the screen shows as a PNG."""
        self.settle()
        write_png(path, self.pixels()[crop])
        return path

    def close(self) -> None:
        """End the application and its screen."""
        self._connection.close()
        self._end()

    def _end(self) -> None:
        self._listener.close()
        _end_within(5.0, self._process.wait, self._process.kill)
        self._screen.close()

    def _ask(self, way: str, source: str) -> Any:
        self._connection.send((way, source))
        if not self._connection.poll(PATIENCE):
            raise WindowError(f"No answer in {PATIENCE} seconds to: {source}")
        try:
            kind, answer = self._connection.recv()
        except EOFError as error:
            raise WindowError(f"Blender ended.\n{self.log.read_text()[-4000:]}") from error
        if kind == "error":
            raise WindowError(answer)
        return answer

    def _simulate(self, key: str, value: str, **details: Any) -> None:
        x, y = self._mouse
        told = "".join(f", {name}={detail!r}" for name, detail in {"x": x, "y": y, **details}.items())
        self.run(f"bpy.context.window_manager.windows[0].event_simulate({key!r}, {value!r}{told})")


def _matches(pattern: str) -> list[Path]:
    path = Path(pattern).expanduser()
    return sorted(path.parent.parent.glob(f"{path.parent.name}/{path.name}"))[::-1]


def _end_within(seconds: float, wait: Callable[..., Any], kill: Callable[[], None]) -> None:
    try:
        wait(timeout=seconds)
    except subprocess.TimeoutExpired:
        kill()
        wait()
