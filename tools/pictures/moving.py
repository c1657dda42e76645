"""Moving pictures: frames with their times as a GIF with one palette, small because what rests is not stored again."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.spatial import cKDTree

# Of red, green and blue in one number.
PLACES = np.array([65536, 256, 1])
N_COLOURS, N_GREYS = 255, 72
# The darkest of the greys, and how far apart red, green and blue of a grey may be, of 255.
DARKEST, GREY = 110, 6
# Steps of 255 that a pixel may change from frame to frame and still count as resting: what is left of the noise.
REST = 4


@dataclass(frozen=True)
class Frame:
    """A picture and how long it is shown.

    Attributes
    ----------
    image : PIL.Image.Image
    milliseconds : int
    """

    image: Image.Image
    milliseconds: int


def write_gif(frames: Sequence[Frame], target: Path) -> Path:
    """Write a moving picture that begins again when it has ended."""
    pixels = np.stack(_calmed([np.asarray(frame.image.convert("RGB")) for frame in frames]))
    code, place = np.unique(pixels.astype(np.int64) @ PLACES, return_inverse=True)
    colours = np.stack([code // step % 256 for step in PLACES], axis=1)
    palette = _palette(colours, np.bincount(place.ravel()))
    _, nearest = cKDTree(palette).query(colours)
    indices = nearest.astype(np.uint8)[place].reshape(pixels.shape[:3])
    first, *rest = [_with_palette(index, palette) for index in indices]
    times = [frame.milliseconds for frame in frames]
    first.save(target, save_all=True, append_images=rest, duration=times, loop=0, optimize=False, disposal=1)
    return target


def _with_palette(index: np.ndarray, palette: np.ndarray) -> Image.Image:
    image = Image.fromarray(index, "P")
    image.putpalette(palette.astype(np.uint8).ravel().tolist())
    return image


def _calmed(images: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return pictures in which a pixel keeps its colour as long as it does not change visibly."""
    calm = [images[0]]
    for image in images[1:]:
        rests = np.abs(image.astype(int) - calm[-1]).max(axis=2, keepdims=True) <= REST
        calm.append(np.where(rests, calm[-1], image))
    return calm


def _palette(colours: np.ndarray, n_times: np.ndarray) -> np.ndarray:
    """Return (n, 3) colours for all frames, so that nothing flickers; greys are set, as shadows show every step.

    Parameters
    ----------
    colours : (c, 3) int64
        All colours of all frames.
    n_times : (c,) int64
        How often each occurs. Each counts with the root of that, so that small parts have their colours as well.
    """
    is_grey = np.ptp(colours, axis=1) <= GREY
    repeated = colours[~is_grey].repeat(np.sqrt(n_times[~is_grey]).astype(int), axis=0)
    sheet = Image.fromarray(repeated.astype(np.uint8)[None])
    found = sheet.quantize(N_COLOURS - N_GREYS, method=Image.Quantize.MEDIANCUT, kmeans=2).getpalette()
    # The brightest grey of all is the background, which has to be met exactly.
    background = colours[n_times.argmax()]
    greys = DARKEST + np.linspace(0, 1, N_GREYS)[:, None] * (background - DARKEST)
    return np.concatenate([np.reshape(found, (-1, 3))[: N_COLOURS - N_GREYS], greys.round().astype(int)])
