"""Colours of parts can be told apart, by colour-blind people too."""

import numpy as np
import pytest

# Machado, Oliveira, Fernandes, "A physiologically-based model for simulation of color vision deficiency", TVCG 2009:
# linear RGB as it is seen with one kind of cone missing.
SIGHT = {
    "normal": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
}
LINEAR_TO_XYZ = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.072175], [0.0193339, 0.119192, 0.9503041]]
WHITE = [0.95047, 1.0, 1.08883]


def lab_of(linear):
    """Return CIELAB for linear sRGB."""
    xyz = np.clip(linear, 0, 1) @ np.transpose(LINEAR_TO_XYZ) / WHITE
    root = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    x, y, z = np.moveaxis(root, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def ciede2000(first, second):
    """Return the difference of CIELAB colours (Sharma, Wu, Dalal 2005)."""
    (lightness, chroma), (mean_lightness, mean_chroma, mean_hue), turn = _differences(first, second)
    bend = (mean_lightness - 50) ** 2
    waves = [(0.17, 1, -30), (-0.24, 2, 0), (-0.32, 3, 6), (0.2, 4, -63)]
    t = 1 - sum(share * np.cos(np.radians(times * mean_hue + shift)) for share, times, shift in waves)
    rotation = 2 * np.sqrt(mean_chroma**7 / (mean_chroma**7 + 25.0**7))
    rotation *= -np.sin(np.radians(60 * np.exp(-(((mean_hue - 275) / 25) ** 2))))
    terms = [
        lightness / (1 + 0.015 * bend / np.sqrt(20 + bend)),
        chroma / (1 + 0.045 * mean_chroma),
        turn / (1 + 0.015 * mean_chroma * t),
    ]
    return np.sqrt(sum(term**2 for term in terms) + rotation * terms[1] * terms[2])


def _differences(first, second):
    (l1, a1, b1), (l2, a2, b2) = (np.moveaxis(np.asarray(lab, dtype=float), -1, 0) for lab in (first, second))
    mean = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    stretch = 1.5 - 0.5 * np.sqrt(mean**7 / (mean**7 + 25.0**7))
    c1, c2 = np.hypot(stretch * a1, b1), np.hypot(stretch * a2, b2)
    h1, h2 = (np.degrees(np.arctan2(b, stretch * a)) % 360 for a, b in ((a1, b1), (a2, b2)))
    hue = np.where(c1 * c2 == 0, 0, (h2 - h1 + 180) % 360 - 180)
    # The mean lies on the shorter way round; without chroma there is no hue to take the mean of.
    mean_hue = np.where(c1 * c2 == 0, h1 + h2, (h1 + hue / 2) % 360)
    turn = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(hue) / 2)
    return (l2 - l1, c2 - c1), ((l1 + l2) / 2, (c1 + c2) / 2, mean_hue), turn


@pytest.mark.parametrize(
    ("first", "second", "difference"),
    [
        ([50, 2.6772, -79.7751], [50, 0, -82.7485], 2.0425),
        ([50, 2.5, 0], [58, 24, 15], 19.4535),
        ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082),
        ([90.8027, -2.0831, 1.441], [91.1528, -1.6435, 0.0447], 1.4441),
    ],
)
def test_the_difference_is_that_of_the_published_examples(first, second, difference):
    assert ciede2000(first, second) == pytest.approx(difference, abs=1e-4)


@pytest.fixture(scope="module")
def distances(extension):
    """The least difference of each two colours over all kinds of sight, the body first."""
    linear = np.array(extension.operators.mesh_state.palette.standard_colours())
    seen = [lab_of(linear @ np.transpose(matrix)) for matrix in SIGHT.values()]
    return np.min([ciede2000(lab[:, None], lab[None]) for lab in seen], axis=0)


@pytest.mark.parametrize(("n_parts", "least"), [(3, 22), (6, 14), (10, 11), (19, 8)])
def test_the_first_colours_are_distinct_in_every_sight(distances, n_parts, least):
    among = distances[: n_parts + 1, : n_parts + 1]
    assert among[~np.eye(len(among), dtype=bool)].min() > least


def test_neighbouring_numbers_are_most_distinct(distances):
    assert np.diagonal(distances[1:], 2).min() > 20
