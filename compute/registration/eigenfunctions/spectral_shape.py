"""A surface as matching sees it: unit area, wound outward, with its first eigenfunctions."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from ...fem.assembly import stiffness_matrix
from ...fem.eigenbasis import Eigenbasis
from ...fem.space import function_space
from ...fields.scalar_field import refined_net
from ...progress import Progress, silent
from ...surface.mesh import Floats, Ints, TriangleMesh, vertex_normals
from ...surface.orientation import reversed_where, wrongly_wound
from ...surface.ties import CHOICE
from .moments import Moments, moments_of, point_areas

# Points at which functions of two shapes are compared.
N_SAMPLES = 1000
# Functions that moments are taken of: the last level of matching and the places a function may move by.
MOMENT_FUNCTIONS = 18
# Attributes that matching asks of any shape, which keeps them; of the source it asks for self-maps, too.
KEPT = ("samples", "moments", "normals", "curvature", "fine_curvature")
# Time of the smoothing of curvature, in units of the area: details below 2 % of the shape's size do not count.
CURVATURE_TIME = 5e-4
FINE_TIME = 1e-4


@dataclass(frozen=True, eq=False)
class SpectralShape:
    """A surface of area 1 around the origin with its first eigenfunctions, the constant among them; n points.

    Attributes
    ----------
    positions : (n, 3) float64
    triangles : (m, 3) int64
        Wound consistently and outward.
    values : (k,) float64
        Eigenvalues of the unit surface, ascending from the zero of the constant.
    functions : (n, k) float64
        Orthonormal on the unit surface; the first is the constant 1.
    node : (n,) int64
        The unknown of the eigenbasis that each point is; numbers below V are vertices of the input.
    input_triangle : (m,) int64
        The triangle of the input that each triangle lies in.
    """

    positions: Floats
    triangles: Ints
    values: Floats
    functions: Floats
    node: Ints
    input_triangle: Ints

    @property
    def n_functions(self) -> int:
        """Number of functions, the constant included."""
        return len(self.values)

    def mirrored(self) -> "SpectralShape":
        """Return the mirror image, wound outward again; its functions stay."""
        return replace(self, positions=self.positions * [-1.0, 1.0, 1.0], triangles=self.triangles[:, ::-1])

    @cached_property
    def area_vectors(self) -> Floats:
        """(m, 3) outward normal of each triangle, as long as its area."""
        a, b, c = self.positions[self.triangles].swapaxes(0, 1)
        return np.cross(b - a, c - a) / 2

    @cached_property
    def areas(self) -> Floats:
        """(m,) area of each triangle."""
        return np.linalg.norm(self.area_vectors, axis=1)

    @cached_property
    def point_areas(self) -> Floats:
        """(n,) a third of the area of the triangles around each point."""
        return point_areas(self.triangles, self.areas, len(self.positions))

    @cached_property
    def normals(self) -> Floats:
        """(n, 3) unit normal at each point."""
        return vertex_normals(self.triangles, self.area_vectors, len(self.positions))

    @cached_property
    def moments(self) -> Moments:
        """Moment tensors of the first functions, without the constant."""
        return moments_of(self.functions[:, 1 : 1 + MOMENT_FUNCTIONS], self.triangles, self.areas)

    @cached_property
    def samples(self) -> Ints:
        """(s,) points spread evenly over the surface, far from each other."""
        return farthest_points(self.positions, N_SAMPLES)

    @cached_property
    def curvature(self) -> Floats:
        """(n,) mean curvature, smoothed and cut off softly: positive where the surface bulges outward."""
        mesh = TriangleMesh(self.positions, self.triangles)
        bending = stiffness_matrix(function_space(mesh, 1)) @ self.positions
        integrated = np.einsum("ij,ij->i", bending, self.normals) / 2
        coefficients = self.functions.T @ integrated / (1 + CURVATURE_TIME * self.values)
        smooth = self.functions @ coefficients
        return np.tanh(smooth / (3 * np.median(np.abs(smooth)) + np.finfo(float).tiny))

    @cached_property
    def self_maps(self) -> list[Floats]:
        """Maps (k, k) of the functions onto themselves, the constant included, under which the shape nearly fits."""
        from .self_maps import find_self_maps

        return find_self_maps(self)

    @cached_property
    def fine_curvature(self) -> Floats:
        """(n,) mean curvature smoothed for a short time, finer than functions show it, cut off softly.

        Faces, toes and knees tell front from back where a shape fits itself turned round.
        """
        stiffness = stiffness_matrix(function_space(TriangleMesh(self.positions, self.triangles), 1))
        integrated = np.einsum("ij,ij->i", stiffness @ self.positions, self.normals) / 2
        smooth = splu((diags_array(self.point_areas) + FINE_TIME * stiffness).tocsc()).solve(integrated)
        return np.tanh(smooth / (3 * np.median(np.abs(smooth)) + np.finfo(float).tiny))

    def shares_at_points(self, labels: Ints, n_labels: int) -> csr_array:
        """Return (n, n_labels) the area of each label around each point, a third of each triangle at the point.

        Parameters
        ----------
        labels : (m,) int
            Label of each of the shape's triangles.
        """
        columns = np.repeat(labels, 3)
        entries = (np.repeat(self.areas / 3, 3), (self.triangles.ravel(), columns))
        return coo_array(entries, shape=(len(self.positions), n_labels)).tocsr()

    def project(self, values: Floats) -> Floats:
        """Return (k, ...) coefficients of values (n, ...) given at the points."""
        return (self.functions * self.point_areas[:, None]).T @ values


def spectral_shape(basis: Eigenbasis) -> SpectralShape:
    """Return the surface of an eigenbasis of free ("neumann") functions, on the net through its nodes."""
    net = refined_net(basis)
    turned = wrongly_wound(basis.surface.mesh)[net.triangle_of_surface]
    node, corner = np.unique(reversed_where(net.triangles, turned), return_inverse=True)
    area = net.areas.sum()
    constant = np.ones((len(node), 1))
    return SpectralShape(
        positions=_unit_positions(net.positions[node], corner.reshape(-1, 3), area),
        triangles=corner.reshape(-1, 3),
        values=np.append(0.0, basis.values * area),
        functions=np.hstack([constant, basis.functions[node] * np.sqrt(area)]),
        node=node,
        input_triangle=basis.surface.input_triangle[net.triangle_of_surface],
    )


def prepare_shape(shape: SpectralShape, progress: Progress = silent, *, with_self_maps: bool = False) -> None:
    """Compute the attributes that a shape keeps, with a report before each; the callback may raise `Cancelled`."""
    names = (*KEPT, "self_maps") if with_self_maps else KEPT
    for number, name in enumerate(names):
        progress(number / len(names), "Measuring the functions")
        getattr(shape, name)


def farthest_points(positions: Floats, n_points: int) -> Ints:
    """Return up to ``n_points`` indices, each the farthest from all before it; the first is farthest from the mean."""
    if len(positions) <= n_points:
        return np.arange(len(positions))
    columns = np.ascontiguousarray(positions.T)
    chosen = np.empty(n_points, dtype=np.int64)
    distance = np.full(len(positions), np.inf)
    chosen[0] = _first_farthest(((positions - positions.mean(axis=0)) ** 2).sum(axis=1))
    for place in range(1, n_points):
        x, y, z = columns - positions[chosen[place - 1]][:, None]
        np.minimum(distance, x * x + y * y + z * z, out=distance)
        chosen[place] = _first_farthest(distance)
    return chosen


def _first_farthest(distance: Floats) -> int:
    """Return the place of the largest of positive numbers, the first of those that tie; faster than `first_largest`."""
    return int((distance >= (1 - CHOICE) * distance.max()).argmax())


def _unit_positions(positions: Floats, triangles: Ints, area: float) -> Floats:
    """Return positions scaled to area 1, with the surface's centre of mass at the origin."""
    unit = (positions - positions[triangles].mean(axis=(0, 1))) / np.sqrt(area)
    a, b, c = unit[triangles].swapaxes(0, 1)
    weights = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return unit - np.average((a + b + c) / 3, axis=0, weights=weights)
