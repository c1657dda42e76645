"""Lagrange elements of order 1, 2 and 3 on the reference triangle, with exact integrals."""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import factorial

import numpy as np
from numpy.typing import NDArray

from ..errors import SpectrumError
from ..surface.mesh import Floats, Ints

ORDERS = (1, 2, 3)


@dataclass(frozen=True, eq=False)
class ReferenceElement:
    """Nodes, basis and integrals on the triangle (0, 0), (1, 0), (0, 1); n nodes.

    Attributes
    ----------
    order : int
        Degree of the polynomials.
    lattice : (n, 2) int64
        Nodes times ``order``: corners 0, 1, 2, then the edges 0-1, 1-2 and 2-0, each along its direction, then the
        interior.
    coefficients : (n, order + 1, order + 1) object of Fraction
        Basis function l is the sum of ``coefficients[l, i, j] * xi**i * eta**j``.
    dirichlet : (3, n, n) float64
        Integrals of d/dxi d/dxi, of d/deta d/deta, and of the two mixed products together.
    mass : (n, n) float64
        Integrals of the products of two basis functions.
    subdivision : (order**2, 3) int64
        Small triangles through the nodes, wound like the element; the net on which a field becomes linear.

    References
    ----------
    .. [1] Reuter, "Hierarchical Shape Segmentation and Registration ...", IJCV 2010, section 4.1 and Table 1.
    """

    order: int
    lattice: Ints
    coefficients: NDArray[np.object_]
    dirichlet: Floats
    mass: Floats
    subdivision: Ints

    @property
    def n_nodes(self) -> int:
        """Number of nodes: 3, 6 or 10."""
        return len(self.lattice)

    @property
    def n_inside_edge(self) -> int:
        """Number of nodes between the ends of an edge."""
        return self.order - 1

    @property
    def n_interior(self) -> int:
        """Number of nodes that belong to no edge."""
        return self.n_nodes - 3 * self.order

    @property
    def barycentric(self) -> Floats:
        """(n, 3) weights of the three corners at each node."""
        xi, eta = self.lattice.T / self.order
        return np.stack([1 - xi - eta, xi, eta], axis=1)

    def evaluate(self, points: Floats) -> Floats:
        """Return (P, n) values of the basis functions at (P, 2) points of the reference triangle."""
        powers = points[:, :, None] ** np.arange(self.order + 1)
        return np.einsum("pi,pj,lij->pl", powers[:, 0], powers[:, 1], self.coefficients.astype(float))


@lru_cache(maxsize=len(ORDERS))
def reference_element(order: int) -> ReferenceElement:
    """Return the element of an order.

    Parameters
    ----------
    order : int
        1, 2 or 3.

    Raises
    ------
    SpectrumError
        For any other order.
    """
    if order not in ORDERS:
        raise SpectrumError(f"Elements of order {order} do not exist here; choose 1 (linear), 2 or 3 (cubic).")
    lattice = _lattice(order)
    basis = np.stack([_basis_function(order, i, j) for i, j in lattice.tolist()])
    along_xi, along_eta = _derivative(basis, axis=1), _derivative(basis, axis=2)
    mixed = _integrals(along_xi, along_eta)
    dirichlet = [_integrals(along_xi, along_xi), _integrals(along_eta, along_eta), mixed + mixed.T]
    return ReferenceElement(
        order=order,
        lattice=lattice,
        coefficients=basis,
        dirichlet=np.array(dirichlet, dtype=float),
        mass=_integrals(basis, basis).astype(float),
        subdivision=_subdivision(lattice),
    )


def _lattice(order: int) -> Ints:
    """Return the nodes times order: corners, edges, interior."""
    steps = range(1, order)
    corners = [(0, 0), (order, 0), (0, order)]
    edges = [(i, 0) for i in steps] + [(order - i, i) for i in steps] + [(0, order - i) for i in steps]
    interior = [(i, j) for j in steps for i in steps if i + j < order]
    return np.array(corners + edges + interior, dtype=np.int64)


def _basis_function(order: int, i: int, j: int) -> NDArray[np.object_]:
    """Return the coefficients of the polynomial that is 1 at the node (i, j)/order and 0 at all others."""
    # Silvester's product: zero on every lattice line between the node and each of the three sides.
    polynomial = np.full((order + 1, order + 1), Fraction(0), dtype=object)
    polynomial[0, 0] = Fraction(1)
    for position, (constant, xi, eta) in ((order - i - j, (1, -1, -1)), (i, (0, 1, 0)), (j, (0, 0, 1))):
        for line in range(position):
            shifted = xi * np.roll(polynomial, 1, axis=0) + eta * np.roll(polynomial, 1, axis=1)
            polynomial = (order * (constant * polynomial + shifted) - line * polynomial) / Fraction(position - line)
    return polynomial


def _derivative(basis: NDArray[np.object_], axis: int) -> NDArray[np.object_]:
    """Return the coefficients of the derivatives along one axis of the coefficient arrays."""
    factors = np.arange(basis.shape[axis]).astype(object)
    shape = [1] * basis.ndim
    shape[axis] = -1
    return np.roll(basis * factors.reshape(shape), -1, axis=axis)


def _integrals(first: NDArray[np.object_], second: NDArray[np.object_]) -> NDArray[np.object_]:
    """Return the exact integrals of all products of two lists of polynomials over the reference triangle."""
    n = first.shape[1]
    powers = [(i, j) for i in range(n) for j in range(n)]
    moments = [[_monomial_integral(i + k, j + m) for k, m in powers] for i, j in powers]
    return first.reshape(len(first), -1) @ np.array(moments, dtype=object) @ second.reshape(len(second), -1).T


def _monomial_integral(i: int, j: int) -> Fraction:
    """Return the integral of xi^i eta^j over the reference triangle."""
    return Fraction(factorial(i) * factorial(j), factorial(i + j + 2))


def _subdivision(lattice: Ints) -> Ints:
    """Return the small triangles between lattice points, all wound like the element."""
    order = int(lattice.max())
    node = {point: number for number, point in enumerate(map(tuple, lattice.tolist()))}
    upright = [((i, j), (i + 1, j), (i, j + 1)) for j in range(order) for i in range(order - j)]
    inverted = [((i, j), (i, j + 1), (i - 1, j + 1)) for j in range(order) for i in range(1, order - j)]
    return np.array([[node[point] for point in triangle] for triangle in upright + inverted], dtype=np.int64)
