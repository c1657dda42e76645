"""Pictures of maps: the source coloured by its places, and the target with the colours of where it lands."""

from itertools import product
from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.collections import PolyCollection

from compute.registration.eigenfunctions.matching import match_shapes
from compute.registration.eigenfunctions.spectral_shape import SpectralShape
from compute.registration.eigenfunctions.zoomout import nearest_points, with_constant
from compute.surface.mesh import Floats

# Directions that shapes are seen from: at the two axes that they are widest along, and turned by half a turn.
VIEWS = ((1, "front"), (-1, "back"))
LIGHT, DARK = 0.75, 0.25


def draw_map(source: SpectralShape, target: SpectralShape, path: Path) -> None:
    """Match two shapes and draw the map."""
    matching = match_shapes(source, target)
    landed = nearest_points(with_constant(matching.map), source.functions, target.functions)
    extent = np.ptp(source.positions, axis=0)
    colours = (source.positions - source.positions.min(axis=0)) / extent
    figure, places = plt.subplots(1, 2 * len(VIEWS), figsize=(16, 6))
    drawn = ((source, colours, "source"), (target, colours[landed], "target"))
    for place, ((shape, own, name), (side, view)) in zip(places, product(drawn, VIEWS), strict=True):
        _draw(place, shape, own, side)
        place.set_title(f"{name}, {view}")
    figure.suptitle(f"{path.stem}, confidence {matching.confidence:.2f}")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=80, bbox_inches="tight")
    plt.close(figure)


def _draw(place: plt.Axes, shape: SpectralShape, colours: Floats, side: int) -> None:
    """Draw a shape from one side, far triangles first."""
    up, across, depth = np.argsort(-np.ptp(shape.positions, axis=0), kind="stable")
    seen = shape.positions[:, [across, up]] * [side, 1]
    towards = side * shape.positions[:, depth]
    shade = side * shape.area_vectors[:, depth] / np.maximum(shape.areas, np.finfo(float).tiny)
    order = np.argsort(towards[shape.triangles].mean(axis=1), kind="stable")
    lit = colours[shape.triangles].mean(axis=1) * (LIGHT + DARK * shade)[:, None]
    colour = np.clip(lit, 0, 1)[order]
    place.add_collection(PolyCollection(seen[shape.triangles][order], facecolors=colour, linewidths=0))
    place.autoscale_view()
    place.set_aspect("equal")
    place.axis("off")
