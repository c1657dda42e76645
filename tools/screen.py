"""A screen that is not there: started for one application, and pictures of what it shows."""

import struct
import subprocess
import zlib
from pathlib import Path
from shutil import which

import numpy as np
from numpy.typing import NDArray

# Pixels, where no others are asked for.
SIZE = 1600, 1000


class Screen:
    """An X screen kept in a file, by Xvfb."""

    def __init__(self, folder: Path, size: tuple[int, int] = SIZE) -> None:
        # Events are made in the application, so the cursor of the screen would only lie in the way.
        options = ["-fbdir", str(folder), "+extension", "GLX", "-nocursor"]
        command = ["Xvfb", "-displayfd", "1", "-screen", "0", "{}x{}x24".format(*size), *options]
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert self._process.stdout is not None
        with self._process.stdout as answer:
            self.name = f":{answer.readline().strip()}"
        self._file = folder / "Xvfb_screen0"

    @staticmethod
    def is_possible() -> bool:
        """Whether this machine has Xvfb."""
        return which("Xvfb") is not None

    def pixels(self) -> NDArray[np.uint8]:
        """Return (height, width, 3) uint8 sRGB, top row first."""
        dump = self._file.read_bytes()
        # The header of the X window dump format, in numbers of four bytes.
        header = struct.unpack(">25I", dump[:100])
        size, width, height, bytes_per_line, n_colours = header[0], header[4], header[5], header[12], header[19]
        start = size + 12 * n_colours
        rows = np.frombuffer(dump, np.uint8, bytes_per_line * height, start).reshape(height, bytes_per_line)
        return rows[:, : 4 * width].reshape(height, width, 4)[..., 2::-1].copy()

    def close(self) -> None:
        """Take the screen away."""
        self._process.terminate()
        self._process.wait()


def write_png(path: Path, pixels: NDArray[np.uint8]) -> None:
    """Write (height, width, 3) uint8 as a PNG file."""
    height, width, _ = pixels.shape
    # Rows as differences from those above are smaller; each begins with the number of this filter, 2.
    rows = np.diff(pixels.reshape(height, 3 * width), axis=0, prepend=np.uint8(0))
    rows = np.pad(rows, ((0, 0), (1, 0)), constant_values=((0, 0), (2, 0)))
    chunks = {b"IHDR": struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0), b"IDAT": zlib.compress(rows.tobytes(), 9)}
    with path.open("wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, content in (*chunks.items(), (b"IEND", b"")):
            file.write(struct.pack(">I", len(content)) + kind + content)
            file.write(struct.pack(">I", zlib.crc32(kind + content)))
