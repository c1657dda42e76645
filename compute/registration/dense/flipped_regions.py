"""Regions that a rough map of points turns inside out, such as a head whose left it takes for its right.

The functions of a nearly round part that is symmetric by itself do not know its sides: a functional map can take the
part for its mirror image while the rest of the shape is right. The surface then turns over between the two, which no
rigid motion of nodes can follow. In such a region nodes change places with their mirror images: the pose stays, the
sides are those of what surrounds it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.spatial import cKDTree

from ...surface.mesh import Bools, Floats, Ints, connected_pieces, unit_rows
from .deformation_graph import DeformationGraph, Motion, motion_towards
from .nonrigid_alignment import Samples

# A map is 1 where it is a similarity that keeps the sides, -1 where it is a reflection, near 0 where it is blurred.
# A region has nodes below the first number and reaches as far as they are below the second.
FLIPPED, UNCLEAR = -0.3, 0.3
# Rounds in which the orientations of neighbouring nodes are averaged.
AVERAGED = 2
# Rings of nodes around a region that belong to it, since they lie in the twist, and those beyond that tell its sides.
TWISTED, TELLING = 1, 3
# Fewer nodes tell no motion; a region of more than this share of all nodes has no surroundings to go by.
FEWEST_NODES, LARGEST_SHARE = 4, 0.5
# Rounds in which the plane of symmetry of a region is improved.
PLANE_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class RoughMap:
    """Where samples of one shape come to lie on another.

    Attributes
    ----------
    samples : Samples
        Points of a deformation graph.
    places, normals : (s, 3) float64
        On the other shape.
    """

    samples: Samples
    places: Floats
    normals: Floats


def with_regions_unflipped(graph: DeformationGraph, motion: Motion, rough: RoughMap) -> Motion:
    """Return a motion in which the nodes of regions that a rough map flips have changed sides."""
    orientation = node_orientations(graph, rough)
    places = graph.nodes + motion.shifts
    for region in _flipped_regions(graph, orientation):
        swapped = _grown(graph, region, TWISTED)
        around = _grown(graph, swapped, TELLING) & ~swapped & (orientation >= UNCLEAR)
        if around.sum() >= FEWEST_NODES:
            reflection = _nearest_rotation(graph.nodes[region], places[region], -1)
            rotation = _nearest_rotation(graph.nodes[around], places[around], 1)
            # What a reflection is before a rotation, if the region turns as its surroundings do: one in its own plane.
            normal = np.linalg.eigh(reflection.T @ rotation + rotation.T @ reflection)[1][:, 0]
            places[swapped] = places[swapped][_mirror_images(graph.nodes[swapped], normal)]
    return motion_towards(graph, places) if (places != graph.nodes + motion.shifts).any() else motion


def _nearest_rotation(points: Floats, places: Floats, determinant: int) -> Floats:
    """Return the rotation (3, 3), or reflection for a determinant of -1, that turns points best as places are."""
    left, _, right = np.linalg.svd((points - points.mean(axis=0)).T @ (places - places.mean(axis=0)))
    left[:, 2] *= determinant * np.sign(np.linalg.det(left @ right))
    return (left @ right).T


def _mirror_images(points: Floats, normal: Floats) -> Ints:
    """Return for each point the one nearest to its mirror image, in a plane of symmetry that looks about that way."""
    tree, centred = cKDTree(points), points - points.mean(axis=0)
    for _ in range(PLANE_ROUNDS):
        image = tree.query(points - 2 * np.outer(centred @ normal, normal))[1]
        between = points[image] - points
        normal = np.linalg.eigh(between.T @ between)[1][:, -1]
    return tree.query(points - 2 * np.outer(centred @ normal, normal))[1]


def node_orientations(graph: DeformationGraph, rough: RoughMap) -> Floats:
    """Return (m,) from -1 to 1 whether a rough map keeps or reverses the sides around each node."""
    around = _samples_around(graph, rough.samples)
    points, places = graph.points[rough.samples.points], rough.places
    mean_point, mean_place = around @ points, around @ places
    products = (around @ (places[:, :, None] * points[:, None]).reshape(-1, 9)).reshape(-1, 3, 3)
    products -= mean_place[:, :, None] * mean_point[:, None]
    normals, other_normals = unit_rows(around @ rough.samples.normals), unit_rows(around @ rough.normals)
    # Two directions along the surface, and where the map turns them.
    along = unit_rows(np.cross(normals, np.eye(3)[np.abs(normals).argmin(axis=1)]))
    first, second = (np.einsum("nij,nj->ni", products, axis) for axis in (along, np.cross(normals, along)))
    size = ((first**2).sum(axis=1) + (second**2).sum(axis=1)) / 2
    turned = (np.cross(first, second) * other_normals).sum(axis=1) / np.maximum(size, np.finfo(float).tiny)
    return _averaged(graph, turned)


def _samples_around(graph: DeformationGraph, samples: Samples) -> csr_array:
    """Return (m, s) the weights of the samples around each node, which sum to 1."""
    followed, weights = graph.followed[samples.points], graph.weights[samples.points].ravel()
    total = np.bincount(followed.ravel(), weights, len(graph.nodes))
    weights = weights / np.maximum(total, np.finfo(float).tiny)[followed.ravel()]
    sample = np.repeat(np.arange(len(followed)), followed.shape[1])
    return coo_array((weights, (followed.ravel(), sample)), shape=(len(graph.nodes), len(followed))).tocsr()


def _averaged(graph: DeformationGraph, values: Floats) -> Floats:
    start, stop = graph.edges.T
    n_nodes = len(values)
    for _ in range(AVERAGED):
        values = (np.bincount(start, values[stop], n_nodes) + values) / (np.bincount(start, minlength=n_nodes) + 1)
    return values


def _flipped_regions(graph: DeformationGraph, orientation: Floats) -> list[Bools]:
    """Return the masks (m,) of the connected regions that are flipped."""
    n_nodes = len(orientation)
    low = orientation < UNCLEAR
    pairs = graph.edges[low[graph.edges].all(axis=1)]
    region = connected_pieces(pairs[:, 0], pairs[:, 1], n_nodes)
    masks = [region == number for number in np.unique(region[orientation < FLIPPED]).tolist()]
    return [mask for mask in masks if FEWEST_NODES <= mask.sum() <= LARGEST_SHARE * n_nodes]


def _grown(graph: DeformationGraph, mask: Bools, n_rings: int) -> Bools:
    """Return the mask with so many rings of nodes around it."""
    start, stop = graph.edges.T
    for _ in range(n_rings):
        mask = mask.copy()
        mask[stop[mask[start]]] = True
    return mask
