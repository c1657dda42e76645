"""The dense map: a point of the source for each vertex of the target.

Four ways lead to it, tried in this order: by number, by place, by faces, by shape. Where both shapes have the same
faces, under whatever numbers, vertices correspond exactly; where one lies on the other, as clothes do, nearest points
are taken.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...analysis.analysis import Analysis
from ...choices import METHODS
from ...errors import RegistrationError
from ...memory import told_if_full
from ...progress import Progress, rising, section, silent
from ...surface.mesh import Bools, Floats, Ints, TriangleMesh
from ...surface.ties import first_largest
from ..eigenfunctions.given_points import FAR
from ..eigenfunctions.matching import Matching, held_to_points, match_surfaces, share_topology
from ..eigenfunctions.pair_memory import BYTES_OF_MAP, require_pair
from ..eigenfunctions.spectral_shape import spectral_shape
from .by_faces import map_by_faces
from .by_number import map_by_number
from .by_place import lie_together, map_by_place
from .by_shape import map_by_shape
from .confidence import SURE
from .shape_pair import Image, ShapePair, triangle_around
from .surface_points import SurfacePoints

BY_NUMBER, BY_FACES, BY_PLACE, BY_SHAPE = "number", "faces", "place", "shape"


@dataclass(frozen=True, eq=False)
class Correspondence:
    """A map from a target (Vt vertices, Tt triangles) to points of a source (Vs, Ts).

    Attributes
    ----------
    triangles : (Vt,) int64
        Triangle of the source for each vertex of the target.
    barycentric : (Vt, 3) float64
        Weights of that triangle's corners; they sum to 1.
    triangle_of_triangle : (Tt,) int64
        The source's triangle at the middle of each of the target's.
    confidence : (Vt,) float64
        From 0 to 1: how far each place can be trusted if the matching is right, for which that has a confidence of its
        own. High where the shapes came to lie on one another without much stretch; 0 on loose parts that were not
        analyzed, which follow the nearest vertex in space that was.
    matching : Matching or None
        Of the functions of the two shapes; None if they correspond by place.
    found_by : str
        "number" where both meshes have the same triangles, so that vertices correspond by their numbers; "faces" where
        they do under other numbers; "place" where one lies on the other; "shape" otherwise.
    source_triangles : (Ts, 3) int64
        Vertices of the source's triangles.

    Examples
    --------
    >>> import numpy as np
    >>> from compute import TriangleMesh, analyze, correspond
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> source, target = (analyze(square, field=square.vertices[:, 0]) for _ in range(2))
    >>> correspondence = correspond(source, target)
    >>> correspondence.transfer([0.0, 1.0, 2.0, 3.0]).tolist(), correspondence.nearest_vertex.tolist()
    ([0.0, 1.0, 2.0, 3.0], [0, 1, 2, 3])
    """

    triangles: Ints
    barycentric: Floats
    triangle_of_triangle: Ints
    confidence: Floats
    matching: Matching | None
    found_by: str
    source_triangles: Ints

    @cached_property
    def is_sure(self) -> Bools:
        """(Vt,) whether the place of a vertex can be trusted, if the matching can."""
        return self.confidence >= SURE

    @property
    def overlap(self) -> float:
        """The share of vertices whose place can be trusted; by place the target lies on the source so far."""
        return float(self.is_sure.mean())

    @cached_property
    def nearest_vertex(self) -> Ints:
        """(Vt,) the vertex of the source next to each place."""
        return self.source_triangles[self.triangles, first_largest(self.barycentric)]

    def transfer(self, values: ArrayLike) -> Floats:
        """Return (Vt, ...) values (Vs, ...) of the source's vertices on the target's, linear on each triangle."""
        return self.points.blend(np.asarray(values, dtype=np.float64), self.source_triangles)

    def transfer_labels(self, labels: ArrayLike) -> NDArray[np.generic]:
        """Return (Vt, ...) labels (Vs, ...) of the nearest vertices of the source; labels cannot be blended."""
        return np.asarray(labels)[self.nearest_vertex]

    def transfer_faces(self, labels: ArrayLike) -> NDArray[np.generic]:
        """Return (Tt, ...) labels (Ts, ...) of the source's triangles at the middles of the target's."""
        return np.asarray(labels)[self.triangle_of_triangle]

    @property
    def points(self) -> SurfacePoints:
        """The places of the vertices."""
        return SurfacePoints(self.triangles, self.barycentric)


@told_if_full
def correspond(
    source: Analysis,
    target: Analysis,
    *,
    matching: Matching | None = None,
    method: str = METHODS[0],
    points: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Correspondence:
    """Find for each vertex of a target the point of the source that it corresponds to.

    Parameters
    ----------
    source, target : Analysis
    matching : Matching, optional
        Of the two; found now if None.
    method : str
        "number" if vertices correspond by their numbers, "place" if the meshes lie on one another in space, as clothes
        on a body do or a decimated mesh on the first one, "shape" if neither. "auto" finds out; by place only where no
        matching and no points are given.
    points : (p, 2) int, optional
        Pairs of vertices, of the source and the target, that belong together; those of the matching if None. They are
        kept exactly, and what surrounds them follows. The ``warnings`` of the matching name those that contradict it.
    progress : callable, optional
        ``progress(fraction, text)``; may raise `Cancelled`.

    Returns
    -------
    Correspondence
        From the target's vertices to points of the source.

    Raises
    ------
    RegistrationError
        If the matching is for other shapes, points are no pairs of vertices of the two that have faces, or a shape was
        analyzed shell by shell; if there is no such method, meshes with other triangles are to correspond by number, or
        a matching or points are given to another method than by shape.

    References
    ----------
    .. [1] Melzi et al., "ZoomOut: Spectral Upsampling for Efficient Shape Correspondence", SIGGRAPH Asia 2019.
    .. [2] Sumner, Schmid, Pauly, "Embedded Deformation for Shape Manipulation", SIGGRAPH 2007.

    Examples
    --------
    >>> from compute import TriangleMesh, analyze, correspond
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> moved = TriangleMesh(square.vertices + 5, square.triangles)
    >>> source, target = (analyze(mesh, field=mesh.vertices[:, 0]) for mesh in (square, moved))
    >>> correspond(source, target).found_by
    'number'
    """
    is_led = matching is not None or points is not None
    _check_method(method, source, target, is_led=is_led)
    is_free = method == "auto" and not is_led and not share_topology(source.surface, target.surface)
    if method == "place" or is_free:
        by_place = correspond_by_place(source.mesh, target.mesh)
        if method == "place" or lie_together(source.mesh, target.mesh, by_place.points, by_place.is_sure):
            return by_place
    require_pair(source.surface, target.surface, BYTES_OF_MAP)
    progress = rising(progress or silent)
    progress(0.0, "Computing functions")
    shapes = spectral_shape(source.matching_basis), spectral_shape(target.matching_basis)
    if matching is None:
        progress(0.3, "Matching")
        matching = match_surfaces(source.surface, target.surface, *shapes, points=points)
    elif points is not None:
        matching = held_to_points(matching, points, source.surface, target.surface, *shapes)
    source_shape = shapes[0].mirrored() if matching.mirrored else shapes[0]
    pair = ShapePair(source=source, target=target, source_shape=source_shape, target_shape=shapes[1], matching=matching)
    return _correspond_matched(pair, progress)


def _correspond_matched(pair: ShapePair, progress: Progress) -> Correspondence:
    image, found_by = _matched_image(pair, progress)
    return _correspondence(_with_points_kept(pair, image), pair.matching, found_by, pair.source.mesh)


def _matched_image(pair: ShapePair, progress: Progress) -> tuple[Image, str]:
    if pair.matching.same_topology:
        return map_by_number(pair.source, pair.target), BY_NUMBER
    _check_matching(pair)
    progress(0.5, "Comparing the faces")
    if (image := map_by_faces(pair)) is not None:
        return image, BY_FACES
    return map_by_shape(pair, section(progress, 0.5, 1.0)), BY_SHAPE


def _check_method(method: str, source: Analysis, target: Analysis, *, is_led: bool) -> None:
    if method not in METHODS:
        raise RegistrationError(f'Vertices correspond by {", ".join(METHODS[1:])} or "auto", not by "{method}".')
    if is_led and method in ("number", "place"):
        raise RegistrationError(f"A matching and points lead a map by shape, not one by {method}; leave them out.")
    if method == "number" and not share_topology(source.surface, target.surface):
        raise RegistrationError("Meshes whose triangles differ do not correspond by the numbers of their vertices.")


@told_if_full
def correspond_by_place(source: TriangleMesh, target: TriangleMesh) -> Correspondence:
    """Find the nearest point of a source for each vertex of a target that lies on it.

    A vertex is sure where the source is near and looks the same way or straight against it; `fill_unsure` makes up for
    the others. Neither mesh has to be analyzed, and a closed one or one piece is not asked for.

    Parameters
    ----------
    source, target : TriangleMesh
        In one space, such as the world.

    Returns
    -------
    Correspondence
        Without a matching.

    Examples
    --------
    A patch of cloth over a square, with one corner that hangs over:

    >>> from compute import TriangleMesh, correspond_by_place
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> patch = TriangleMesh([[0.2, 0.2, 0.01], [0.8, 0.2, 0.01], [1.6, 0.8, 0.01]], [[0, 1, 2]])
    >>> correspond_by_place(square, patch).is_sure.tolist()
    [True, True, False]
    """
    return _correspondence(map_by_place(source, target), None, BY_PLACE, source)


def _check_matching(pair: ShapePair) -> None:
    n_target, n_source = pair.matching.map.shape
    if n_target >= pair.target_shape.n_functions or n_source >= pair.source_shape.n_functions:
        raise RegistrationError("The matching is for other shapes than these two.")


def _with_points_kept(pair: ShapePair, image: Image) -> Image:
    """Return an image in which the vertices that were given, and their doubles, lie where they were given."""
    if not len(pair.matching.points):
        return image
    place_of_vertex = pair.target.surface.vertex_of_input
    triangle, corner = triangle_around(pair.source.mesh.triangles, len(pair.source.mesh.vertices))
    triangles, barycentric = image.points.triangles.copy(), image.points.barycentric.copy()
    confidence = image.confidence.copy()
    doubles = [np.flatnonzero(place_of_vertex == place_of_vertex[vertex]) for _, vertex in pair.matching.points]
    for kept in (doubles, pair.matching.points[:, 1]):
        for (vertex, _), targets, gap in zip(pair.matching.points, kept, pair.matching.point_gaps, strict=True):
            triangles[targets], barycentric[targets] = triangle[vertex], np.eye(3)[corner[vertex]]
            confidence[targets] = 1.0 if gap <= FAR else confidence[targets]
    return Image(SurfacePoints(triangles, barycentric), image.triangles, confidence)


def _correspondence(image: Image, matching: Matching | None, found_by: str, source: TriangleMesh) -> Correspondence:
    return Correspondence(
        triangles=image.points.triangles,
        barycentric=image.points.barycentric,
        triangle_of_triangle=image.triangles,
        confidence=image.confidence,
        matching=matching,
        found_by=found_by,
        source_triangles=source.triangles,
    )
