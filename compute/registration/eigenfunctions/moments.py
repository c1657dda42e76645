"""Moment tensors, which fix the signs of eigenfunctions, left and right included.

Both are integrals over the surface of products of three functions, so they do not depend on the triangulation or the
pose. The symmetric one does not see the orientation of the surface; the alternating one is the signed volume of the
spectral embedding, and changes sign under a reflection.
"""

from dataclasses import dataclass

import numpy as np

from ...surface.mesh import Floats, Ints


@dataclass(frozen=True, eq=False)
class Moments:
    """Moment tensors of K functions.

    Attributes
    ----------
    symmetric : (K, K, K) float64
        The integral of ``f_i f_j f_k`` over the surface.
    alternating : (K, K, K) float64
        The integral of ``f_i df_j ^ df_k`` over the oriented surface, made cyclic.
    """

    symmetric: Floats
    alternating: Floats

    def damped(self, values: Floats) -> "Moments":
        """Return the moments of the first functions scaled by the cube root of their eigenvalues, at norm 1.

        Parameters
        ----------
        values : (n,) float64
            Eigenvalues, for the first n <= K functions.
        """
        weight = values ** (-1 / 3)
        n, cube = len(values), np.einsum("i,j,k->ijk", weight, weight, weight)
        scaled = (tensor[:n, :n, :n] * cube for tensor in (self.symmetric, self.alternating))
        return Moments(*(tensor / max(np.linalg.norm(tensor), np.finfo(float).tiny) for tensor in scaled))

    def rotated(self, rotation: Floats) -> "Moments":
        """Return the moments of the functions ``f @ rotation.T``."""
        return Moments(rotate_tensor(rotation, self.symmetric), rotate_tensor(rotation, self.alternating))


def moments_of(functions: Floats, triangles: Ints, areas: Floats) -> Moments:
    """Return the moments of functions that are linear on each triangle.

    Parameters
    ----------
    functions : (n, K) float64
    triangles : (m, 3) int64
        Wound consistently.
    areas : (m,) float64
    """
    a, b, c = functions[triangles].swapaxes(0, 1)
    mean = (a + b + c) / 3
    alternating = _alternating(mean, b - a, c - b)
    return Moments(_symmetric(functions, point_areas(triangles, areas, len(functions))), alternating)


def point_areas(triangles: Ints, areas: Floats, n_points: int) -> Floats:
    """(n,) a third of the area of the triangles around each point."""
    return np.bincount(triangles.ravel(), np.repeat(areas / 3, 3), n_points).astype(float)


def _symmetric(functions: Floats, weights: Floats) -> Floats:
    weighted = functions * weights[:, None]
    return np.stack([(weighted * column[:, None]).T @ functions for column in functions.T])


def _alternating(mean: Floats, first: Floats, second: Floats) -> Floats:
    # One function at a time: all products of a large mesh at once would not fit in memory.
    products = np.stack([(first * column[:, None]).T @ second for column in mean.T])
    tensor = (products - products.swapaxes(1, 2)) / 2
    return (tensor + tensor.transpose(1, 2, 0) + tensor.transpose(2, 0, 1)) / 3


def rotate_tensor(rotation: Floats, tensor: Floats) -> Floats:
    """Return (..., n, n, n): each index of a (K, K, K) tensor rotated by (..., n, K) matrices."""
    transposed = np.swapaxes(rotation, -1, -2)
    first = np.einsum("...ai,ijk->...ajk", rotation, tensor, optimize=True)
    return rotation[..., None, :, :] @ first @ transposed[..., None, :, :]


def agreement(rotation: Floats, source: Floats, target: Floats) -> Floats:
    """Return (...) the inner product of the target's (n, n, n) tensor with the source's rotated one."""
    return (rotate_tensor(rotation, source) * target).sum(axis=(-3, -2, -1))


def agreement_gradient(rotation: Floats, source: Floats, target: Floats) -> Floats:
    """Return (..., n, K) the derivative of one third of `agreement` by the rotation, for cyclic tensors."""
    n, n_source = target.shape[0], source.shape[0]
    transposed = np.swapaxes(rotation, -1, -2)
    half = rotation[..., None, :, :] @ source @ transposed[..., None, :, :]
    flat = half.reshape(*half.shape[:-3], n_source, -1)
    return target.reshape(n, -1) @ np.swapaxes(flat, -1, -2)
