"""Scalar fields on a surface, each on the net of triangles it is linear on."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from ..choices import FIELDS
from ..errors import FieldError
from ..fem.eigenbasis import Eigenbasis
from ..fem.lagrange import reference_element
from ..surface.cleaning import Surface
from ..surface.mesh import LARGEST_NUMBER, Floats, Ints
from ..surface.ties import evened

DIFFUSION = FIELDS[0]
# The name of a field of values of one's own.
USER = "user"
# Functions used by the diffusion field, at the most.
DIFFUSION_FUNCTIONS = 30
# Time of the diffusion in units of 1 / (first eigenvalue); 1 gave the best parts on the Princeton benchmark.
DIFFUSION_TIME = 1.0
# Beyond this multiple of the first eigenvalue a function's weight in the diffusion field is below 1e-8.
LARGEST_RATIO = np.log(1e8) / DIFFUSION_TIME
# Eigenvalues closer than this, relatively, count as one eigenvalue that several functions share.
SAME_EIGENVALUE = 0.01
# The diffusion field of a round sphere varies by 1e-3 through its triangulation alone; that of a slightly stretched
# ellipsoid (1 : 1.05) by 0.2.
FLAT_DIFFUSION = 0.05
# With Dirichlet sides no heat stays at the boundary; the logarithm is cut off this far below the mean.
LEAST_HEAT = 1e-6


@dataclass(frozen=True, eq=False)
class Net:
    """A triangle net over a surface: what critical points, parts and borders refer to.

    Attributes
    ----------
    positions : (n, 3) float64
    triangles : (m, 3) int64
    triangle_of_surface : (m,) int64
        The analyzed triangle that each triangle of the net lies in.
    areas : (m,) float64
        Area of each triangle of the net, in length².
    """

    positions: Floats
    triangles: Ints
    triangle_of_surface: Ints
    areas: Floats

    @cached_property
    def used(self) -> Ints:
        """(U,) the vertices of the triangles, rising."""
        return np.unique(self.triangles)


@dataclass(frozen=True, eq=False)
class ScalarField:
    """A function that is linear on each triangle of its net.

    Attributes
    ----------
    values : (n,) float64
        Without unit for "diffusion", 1/length for an eigenfunction, the user's own otherwise.
    net : Net
    name : str
    minima_are_features : bool
        Whether minima are parts as maxima are.
    least_range : float
        A range below this means that the field is flat: the shape has no features.
    """

    values: Floats
    net: Net
    name: str
    minima_are_features: bool
    least_range: float = 0.0

    @cached_property
    def value_range(self) -> float:
        """Highest minus lowest value."""
        return float(np.ptp(self.values[self.net.triangles]))


def diffusion_field(basis: Eigenbasis) -> ScalarField:
    """Return ``log sum_i exp(-t values_i / values_1) functions_i(x)^2``, which has a maximum on every protrusion.

    It has no sign to flip, and does not depend on the basis of an eigenspace as long as the sum ends with a whole
    one; functions of the last, perhaps incomplete, eigenspace are left out.

    References
    ----------
    .. [1] Gebal et al., "Shape analysis using the auto diffusion function", SGP 2009.
    """
    n_whole = _whole_eigenspaces(basis.values)
    weights = np.exp(-DIFFUSION_TIME * basis.values[:n_whole] / basis.values[0])
    heat = basis.functions[:, :n_whole] ** 2 @ weights
    used = np.unique(basis.elements)
    # The functions have the unit 1/length; relative to the mean the field does not depend on the scale.
    mean = weights.sum() / basis.mass.sum()
    values = np.zeros(len(heat))
    values[used] = np.log(np.maximum(heat[used] / mean, LEAST_HEAT))
    values[used] = _even_field(values[used])
    return ScalarField(values, refined_net(basis), DIFFUSION, minima_are_features=False, least_range=FLAT_DIFFUSION)


def eigenfunction_field(basis: Eigenbasis, number: int) -> ScalarField:
    """Return one eigenfunction; the first one that is not constant has the number 1."""
    n_functions = basis.functions.shape[1]
    if not 1 <= number <= n_functions:
        raise FieldError(f"Eigenfunction {number} does not exist; there are 1 to {n_functions}.")
    values = _even_field(basis.functions[:, number - 1])
    return ScalarField(values, refined_net(basis), f"eigenfunction {number}", True)


def user_field(surface: Surface, values: ArrayLike) -> ScalarField:
    """Return the user's own values on the mesh itself: interpolating them further would make plateaus.

    Raises
    ------
    FieldError
        If there is not one finite number for each vertex of the surface, or the numbers are too large or too close to
        each other to be computed with.
    """
    numbers = np.asarray(values, dtype=np.float64)
    n_vertices = len(surface.mesh.vertices)
    if numbers.shape != (n_vertices,):
        raise FieldError(f"The field needs one value for each of the {n_vertices} vertices, not {numbers.shape}.")
    mesh = surface.mesh
    of_surface = numbers[mesh.used]
    _check_numbers(of_surface)
    numbers = np.zeros(n_vertices)
    numbers[mesh.used] = _even_field(of_surface)
    net = Net(mesh.vertices, mesh.triangles, np.arange(len(mesh.triangles)), mesh.areas)
    return ScalarField(numbers, net, USER, True)


def _check_numbers(values: Floats) -> None:
    if not np.isfinite(values).all():
        raise FieldError("The field has values that are not finite numbers.")
    largest, spread = float(np.abs(values).max()), float(np.ptp(values))
    if largest > LARGEST_NUMBER or 0 < spread < 1 / LARGEST_NUMBER:
        raise FieldError(
            f"The values of the field reach {largest:.0e} and differ by {spread:.0e}, too much or too little to be"
            " computed with; scale them."
        )


def _even_field(values: Floats) -> Floats:
    """Return values that are equal where symmetry makes them so, so that the order of their vertices decides."""
    return evened(values, float(np.ptp(values)))


def refined_net(basis: Eigenbasis) -> Net:
    """Return the net through the nodes of the elements: 9 triangles in a cubic one, 4 in a quadratic one.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 4.2.
    """
    return net_of_elements(basis.nodes, basis.elements, basis.order, basis.surface)


def net_of_elements(nodes: Floats, elements: Ints, order: int, surface: Surface) -> Net:
    """Return the net through the nodes of elements of an order, one on each triangle of a surface."""
    cells = reference_element(order).subdivision
    triangles = elements[:, cells].reshape(-1, 3)
    of_surface = np.repeat(np.arange(len(elements)), len(cells))
    return Net(nodes, triangles, of_surface, surface.mesh.areas[of_surface] / len(cells))


def _whole_eigenspaces(values: Floats) -> int:
    """Return how many functions come before the last eigenspace, which the end of the list may have cut in two."""
    starts = np.flatnonzero(np.diff(values) > SAME_EIGENVALUE * values[1:])
    return int(starts[-1]) + 1 if len(starts) else len(values)


def share_below(heights: Floats, level: Floats) -> Floats:
    """Return the fraction of each triangle that lies below a level, for sorted corner heights (m, 3)."""
    low, middle, high = heights.T
    with np.errstate(divide="ignore", invalid="ignore"):
        rising = (level - low) ** 2 / ((middle - low) * (high - low))
        falling = 1 - (high - level) ** 2 / ((high - middle) * (high - low))
    share = np.where(level <= middle, rising, falling)
    share = np.where(level <= low, 0.0, np.where(level >= high, 1.0, share))
    return np.nan_to_num(share, nan=0.0)


def steepness(corners: Floats, heights: Floats) -> Floats:
    """Return the length of the gradient in triangles (m, 3, 3), 0 where one has collapsed."""
    first, second = (corners[:, [1, 2]] - corners[:, :1]).swapaxes(0, 1)
    rises = heights[:, [1, 2]] - heights[:, :1]
    across = np.linalg.norm(rises[:, :1] * second - rises[:, 1:] * first, axis=1)
    area = np.linalg.norm(np.cross(first, second), axis=1)
    return np.divide(across, area, out=np.zeros_like(area), where=area > 0)
