"""Moving pictures show what they are given, for as long as they are told."""

import numpy as np
import pytest

pytest.importorskip("bpy", reason="pictures are rendered with Blender as a Python module")
image = pytest.importorskip("PIL.Image")

from tools.pictures.moving import REST, Frame, write_gif  # noqa: E402

BACKGROUND = 244


def disc(place, colour):
    """Return a disc on a light ground, with a shadow that passes into it."""
    across, down = np.meshgrid(np.arange(80), np.arange(60))
    pixels = np.full((60, 80, 3), BACKGROUND, dtype=np.uint8)
    pixels[40:, :, :] = np.linspace(150, BACKGROUND, 80).astype(np.uint8)[:, None]
    pixels[(across - place) ** 2 + (down - 20) ** 2 < 100] = colour
    return image.fromarray(pixels)


@pytest.fixture
def moving(tmp_path):
    frames = [Frame(disc(place, colour), 40 * place) for place, colour in ((20, (187, 0, 0)), (50, (51, 153, 255)))]
    with image.open(write_gif(frames, tmp_path / "disc.gif")) as picture:
        yield frames, picture


def seen(picture, number):
    picture.seek(number)
    return np.asarray(picture.convert("RGB")).astype(int)


def test_every_frame_is_shown_in_its_colours(moving):
    frames, picture = moving
    assert picture.n_frames == len(frames)
    for number, frame in enumerate(frames):
        assert np.abs(seen(picture, number) - np.asarray(frame.image).astype(int)).max() <= REST + 1


def test_the_background_is_met_exactly(moving):
    _, picture = moving
    assert (seen(picture, 1)[0] == BACKGROUND).all()


def test_each_frame_is_shown_as_long_as_told(moving):
    frames, picture = moving
    for number, frame in enumerate(frames):
        picture.seek(number)
        assert picture.info["duration"] == frame.milliseconds
