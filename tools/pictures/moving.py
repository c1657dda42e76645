"""Moving pictures: frames with their times as a GIF with one palette, small because what rests is not stored again."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.cluster.vq import kmeans2
from scipy.spatial import cKDTree

from eigenparts.compute.surface.mesh import Floats, Ints
from tools.pictures.lettering import INK

Bytes = NDArray[np.uint8]

# Of red, green and blue in one number.
PLACES = np.array([65536, 256, 1])
N_COLOURS, N_GREYS = 255, 72
# The darkest of the greys, and how far apart red, green and blue of a grey may be, of 255.
DARKEST, GREY = 110, 6
# Greys that are darker than that, and colours that the palette is chosen from.
N_DARK, N_DRAWN = 8, 20_000
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


def _with_palette(index: Bytes, palette: Ints) -> Image.Image:
    image = Image.fromarray(index, "P")
    image.putpalette(palette.astype(np.uint8).ravel().tolist())
    return image


def _calmed(images: Sequence[Bytes]) -> list[Bytes]:
    """Return pictures in which a pixel keeps its colour as long as it does not change visibly."""
    calm = [images[0]]
    for image in images[1:]:
        rests = np.abs(image.astype(int) - calm[-1]).max(axis=2, keepdims=True) <= REST
        calm.append(np.where(rests, calm[-1], image))
    return calm


def _palette(colours: Ints, n_times: Ints) -> Ints:
    """Return (n, 3) colours for all frames, so that nothing flickers; greys are set, as shadows show every step.

    Parameters
    ----------
    colours : (c, 3) int64
        All colours of all frames.
    n_times : (c,) int64
        How often each occurs. Each counts with the root of that, so that small parts have their colours as well.
    """
    is_grey = np.ptp(colours, axis=1) <= GREY
    found = _clustered(colours[~is_grey], np.sqrt(n_times[~is_grey]))
    # The brightest grey of all is the background, which has to be met exactly; texts have some dark ones.
    light = DARKEST + np.linspace(0, 1, N_GREYS - N_DARK)[:, None] * (colours[n_times.argmax()] - DARKEST)
    dark = np.linspace(INK, np.full(3, DARKEST), N_DARK, endpoint=False)
    return np.concatenate([found, dark, light]).round().astype(int)


def _clustered(colours: Ints, weights: Floats) -> Ints | Floats:
    """Return few colours for many, or these themselves if they are few."""
    n_clusters = N_COLOURS - N_GREYS
    if len(colours) <= n_clusters:
        return colours
    drawn = np.random.default_rng(0).choice(len(colours), N_DRAWN, p=weights / weights.sum())
    found, _ = kmeans2(colours[drawn].astype(float), n_clusters, minit="++", seed=0)
    return found
