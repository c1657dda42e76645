"""The heavy step: from a mesh to everything that levels and parts are read from."""

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..choices import EXACT, NESTED
from ..errors import LevelError, RegistrationError
from ..fem.eigenbasis import Eigenbasis, solve_on_surface
from ..fem.matching_basis import MatchingBasis
from ..fields.field_choice import DEFAULT_FUNCTIONS, n_available
from ..fields.scalar_field import DIFFUSION, USER, Net, ScalarField
from ..memory import require_memory, told_if_full
from ..msc.diagram import PersistenceDiagram
from ..msc.morse_smale import FieldTopology, MorseSmaleComplex
from ..progress import Progress, silent
from ..segmentation.borders.edge_paths import along_edges, border_costs
from ..segmentation.borders.edge_profile import EdgeProfile, edge_profile
from ..segmentation.borders.level_set_borders import (
    Polyline,
    closing_heights,
    cross_edges,
    part_of_border,
    trace_borders,
)
from ..segmentation.faces.arc_areas import arc_areas
from ..segmentation.faces.branches import build_branches
from ..segmentation.faces.exact_labels import exact_labels
from ..segmentation.faces.face_graph import face_graph
from ..segmentation.faces.part_tree import BYTES_PER_NODE, TOO_MANY_FACES, PartTree
from ..segmentation.hierarchy.arc_measures import ArcMeasures
from ..segmentation.hierarchy.levels import Hierarchy
from ..segmentation.hierarchy.measured_hierarchy import measured_hierarchy
from ..segmentation.parts.part_labels import Segmentation, label_branches, reading_of
from ..segmentation.parts.subparts import inserted
from ..surface.cleaning import Surface, clean_surface
from ..surface.mesh import Ints, TriangleMesh, checked_labels

# A part that is divided further keeps the features of this persistence (the diffusion field has no unit): fingers of an
# arm have 0.01 and more, the ripples of its skin less than 0.001.
WITHIN_THRESHOLD = 0.004
# And has at least this many faces.
LEAST_FACES_WITHIN = 8
APART = (
    "Each loose part was analyzed by itself, so there is no one shape to be matched or to get bones; analyze the mesh"
    " with its loose parts bridged, or the largest alone."
)


@dataclass(frozen=True, eq=False)
class Analysis:
    """A mesh with its field and the hierarchy of its features, from which every level is read at once.

    It is made by :func:`analyze`.

    Attributes
    ----------
    mesh : TriangleMesh
        The input; V vertices, T triangles.
    surface : Surface
        The surface that was analyzed: the input cleaned, its loose parts bridged.
    field : ScalarField
        The function that the features are those of, on a net of n vertices.
    hierarchy : Hierarchy
        All pairs of the field by persistence, and the levels.
    measures : tuple of ArcMeasures
        The sizes of the arcs, one for each tree of the hierarchy.
    warnings : tuple of str
        Sentences for the user.
    field_choice : "diffusion", int or (V,) array
        The field that was asked for.
    face_borders : "edges" or "exact"
        Where parts end on whole faces.

    Examples
    --------
    >>> analysis = analyze(mesh)
    >>> analysis.hierarchy.n_levels
    5
    >>> analysis.segment(level=4).n_parts
    6
    """

    mesh: TriangleMesh
    surface: Surface
    field: ScalarField
    hierarchy: Hierarchy
    measures: tuple[ArcMeasures, ...]
    warnings: tuple[str, ...]
    field_choice: str | int | ArrayLike
    face_borders: str
    _topology: FieldTopology
    _arc_of_vertex: tuple[Ints, ...]
    _known_basis: Eigenbasis | None = dataclasses.field(repr=False)
    _matching: MatchingBasis = dataclasses.field(repr=False)
    # The call that made this, for parts that are analyzed on their own.
    _analyze: Callable[..., "Analysis"] = dataclasses.field(repr=False)

    @property
    def net(self) -> Net:
        """The triangles the field is linear on."""
        return self.field.net

    @property
    def order(self) -> int | None:
        """Degree of the finite elements that the field was computed with; None if it is the user's own."""
        if self.field.name == USER:
            return None
        # The net has a triangle for each square of the order.
        return math.isqrt(len(self.net.triangles) // len(self.surface.mesh.triangles))

    @cached_property
    def eigenbasis(self) -> Eigenbasis:
        """The eigenfunctions that the field was made of, with their eigenvalues in 1/length².

        Computed when first asked for if the field is the user's own. Those of the largest shell if each was analyzed
        by itself.
        """
        if self._known_basis is not None:
            return self._known_basis
        surface = clean_surface(self.mesh) if self.surface.is_apart else self.surface
        return solve_on_surface(surface, min(DEFAULT_FUNCTIONS, n_available(surface, "neumann")))

    @property
    def matching_basis(self) -> Eigenbasis:
        """Up to 100 free eigenfunctions for matching and dense maps, with the signs that ``eigenbasis`` has.

        Computed when first asked for, which takes seconds, and kept.

        Raises
        ------
        RegistrationError
            If each shell was analyzed by itself: there is no one shape to be matched.
        """
        return self.find_matching_basis(silent)

    @told_if_full
    def find_matching_basis(self, progress: Progress) -> Eigenbasis:
        """Return ``matching_basis``, and report progress if it has to be computed.

        Parameters
        ----------
        progress : callable
            ``progress(fraction, text)``; may raise :class:`Cancelled`.

        Returns
        -------
        Eigenbasis

        Raises
        ------
        RegistrationError
            If each shell was analyzed by itself: there is no one shape to be matched.

        Examples
        --------
        >>> basis = analysis.find_matching_basis(lambda fraction, text: None)
        >>> basis is analysis.matching_basis
        True
        """
        self.require_one_shape()
        return self._matching.solve(progress)

    def require_one_shape(self) -> None:
        """Refuse an analysis of each shell by itself, which has no one shape to be matched or to move.

        Raises
        ------
        RegistrationError
            If each shell was analyzed by itself.

        Examples
        --------
        >>> analysis.require_one_shape()
        """
        if self.surface.is_apart:
            raise RegistrationError(APART)

    @cached_property
    def complex(self) -> MorseSmaleComplex:
        """The critical points of the field with all that lies between them, each part made when first asked for."""
        return MorseSmaleComplex(self._topology)

    @property
    def diagram(self) -> PersistenceDiagram:
        """The separated persistence diagram of the field."""
        return self.complex.diagram

    def complex_at_level(self, level: int | None = None) -> MorseSmaleComplex:
        """Return the complex with what survives at a level.

        Where only maxima are features, minima and handles are kept as far as they are as persistent as those.

        Parameters
        ----------
        level : int, optional
            From 0 to ``hierarchy.n_levels - 1``; the default level if None.

        Returns
        -------
        MorseSmaleComplex

        Raises
        ------
        LevelError
            If there is no such level.

        Examples
        --------
        >>> analysis.complex_at_level(2).euler_characteristic
        2
        """
        hierarchy = self.hierarchy
        level = hierarchy.default_level if level is None else hierarchy.checked_level(level)
        persistence = hierarchy.persistence[::-1]
        least = np.inf if level == 0 else persistence[level - 1]
        return self.complex.above(float(least))

    @cached_property
    def _ended_at_handles(self) -> "Analysis":
        hierarchy, arcs, measures = measured_hierarchy(
            self.surface, self.field, self._topology, self._known_basis, ends_at_handles=True
        )
        return dataclasses.replace(self, hierarchy=hierarchy, measures=measures, _arc_of_vertex=arcs)

    @told_if_full
    def part_tree(self, face_of_triangle: Ints | None = None) -> PartTree:
        """Return the hierarchy with the faces of its arcs: all that the parts of any level are read from.

        Parameters
        ----------
        face_of_triangle : (T,) int64, optional
            The polygon each triangle of the input belongs to; the triangles themselves if None.

        Returns
        -------
        PartTree

        Examples
        --------
        >>> pairs_of_triangles = np.arange(len(mesh.triangles)) // 2
        >>> analysis.part_tree(pairs_of_triangles).n_faces
        640
        """
        if face_of_triangle is None:
            return self._triangle_tree
        return self._part_tree(np.asarray(face_of_triangle, dtype=np.int64))

    def exact_labels(self, labels: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return labels in which each triangle is in the part that has the greater half of it, wherever borders run.

        Joints, twins and partners on other shapes are found by these; labels that are exact stay as they are.

        Parameters
        ----------
        labels : (T,) int32
            Of a segmentation, corrected or not.

        Returns
        -------
        (T,) int32

        Raises
        ------
        MeshError
            If there is not one label from 0 on for each triangle.

        Examples
        --------
        >>> exact = analysis.exact_labels(analysis.segment().labels)
        >>> bool((exact == analysis.segment().labels).mean() > 0.9)
        True
        """
        labels = checked_labels(self.mesh, labels)
        graph = face_graph(self.mesh, self.surface, np.arange(len(self.mesh.triangles)))
        return exact_labels(labels, self.part_tree(), graph)

    @cached_property
    def _triangle_tree(self) -> PartTree:
        return self._part_tree(np.arange(len(self.mesh.triangles)))

    def _part_tree(self, face_of_triangle: Ints) -> PartTree:
        require_memory(BYTES_PER_NODE * len(self.net.positions), TOO_MANY_FACES, len(self.mesh.triangles))
        graph = face_graph(self.mesh, self.surface, face_of_triangle)
        face = face_of_triangle[self.surface.input_triangle][self.net.triangle_of_surface]
        shares = [
            arc_areas(self.field.values, arc, tree, self.net, face)
            for tree, arc in zip(self.hierarchy.trees, self._arc_of_vertex, strict=True)
        ]
        heights = tuple(closing_heights(self.field.values, tree) for tree in self.hierarchy.trees)
        branches = build_branches([tree.parent for tree in self.hierarchy.trees], shares, graph)
        exact = PartTree(self.hierarchy, self.measures, heights, branches)
        if self.face_borders == EXACT:
            return exact
        return along_edges(exact, shares, graph, border_costs(self.surface, self.field)[graph.shared])

    def profile(self, edges: Ints | None = None) -> EdgeProfile:
        """Return the field along edges of the input.

        Parameters
        ----------
        edges : (E, 2) int64, optional
            Pairs of input vertices; the edges of its triangles if None.

        Returns
        -------
        EdgeProfile

        Examples
        --------
        >>> profile = analysis.profile(mesh.edges.vertices[:10])
        >>> len(profile.heights)
        10
        """
        edges = self.mesh.edges.vertices if edges is None else edges
        return edge_profile(self.surface, self.field, self._arc_of_vertex, edges)

    @told_if_full
    def borders(self, level: int | None = None, mode: str = NESTED, joints: bool | None = None) -> tuple[Polyline, ...]:
        """Return the lines on the triangles of the input along which the parts of a level end.

        Parameters
        ----------
        level : int, optional
            The default level if None.
        mode : "nested" or "features"
        joints : bool, optional
            As in :meth:`segment`.

        Returns
        -------
        tuple of Polyline
            Each with the ``part`` it cuts off, its ``points`` (n, 3) in the mesh's unit of length, and ``is_closed``.

        Raises
        ------
        LevelError
            If there is no such level, or joints are asked for among features.

        Examples
        --------
        >>> sorted(line.part for line in analysis.borders())
        [1, 2, 3, 4, 5]
        """
        hierarchy, part_tree = self.hierarchy, self.part_tree()
        level = hierarchy.default_level if level is None else hierarchy.checked_level(level)
        cuts = part_tree.cut_arcs(level, reading_of(mode, joints))
        crossings = cross_edges(self.profile(), part_tree.trees, part_tree.closing_heights, cuts)
        return trace_borders(self.mesh, crossings, part_of_border(cuts))

    @told_if_full
    def segment(
        self,
        *,
        level: int | None = None,
        threshold: float | None = None,
        n_parts: int | None = None,
        mode: str = NESTED,
        joints: bool | None = None,
        essential: bool = False,
        within: int | None = None,
    ) -> Segmentation:
        """Divide the mesh into parts.

        Parameters
        ----------
        level : int, optional
            How many of the most persistent features to keep, from 0 to ``hierarchy.n_levels - 1``.
        threshold : float, optional
            Least persistence of a feature, as a fraction of the field's range.
        n_parts : int, optional
            How many labels, the body included; reached without joints where it is not with them, if ``joints`` is None.
        mode : "nested" or "features"
            The features and what lies between them when all levels up to this one are overlaid, or the features alone.
        joints : bool, optional
            Whether limbs are cut where they narrow on both sides, such as at wrists and ankles; if None they are
            in nested parts, the only ones that have joints.
        essential : bool
            Whether parts end at essential saddles, too: where a handle begins, such as a leg that a tail touches.
        within : int, optional
            A part of this segmentation that is analyzed on its own and divided further.

        Returns
        -------
        Segmentation
            At the default level if none of the three is given.

        Raises
        ------
        LevelError
            If there is no such level, mode or part, if more than one of the three choices is given, or if joints are
            asked for among features.

        References
        ----------
        .. [1] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
           Eigenfunctions", IJCV 2010, section 4.7, on the analysis of subparts.

        Examples
        --------
        >>> segmentation = analysis.segment(n_parts=5)
        >>> segmentation.labels.shape
        (1280,)
        >>> segmentation.n_parts
        5
        >>> analysis.segment().n_parts >= analysis.segment(joints=False).n_parts
        True
        """
        if essential:
            return self._ended_at_handles.segment(
                level=level, threshold=threshold, n_parts=n_parts, mode=mode, joints=joints, within=within
            )
        part_tree = self.part_tree()
        read = partial(label_branches, part_tree, level=level, threshold=threshold, n_parts=n_parts)
        labels = read(mode=reading_of(mode, joints))
        if joints is None and n_parts is not None and len(labels.parts) != n_parts:
            without = read(mode=mode)
            if len(without.parts) == n_parts:
                labels, joints = without, False
        whole = Segmentation(
            labels=labels.of_faces(part_tree),
            parts=labels.parts,
            level=labels.level,
            warnings=labels.warnings,
            _trace=partial(self.borders, labels.level, mode, joints),
        )
        return whole if within is None else _divided_further(self, whole, within, mode, joints)


def _divided_further(
    analysis: Analysis, whole: Segmentation, part: int, mode: str, joints: bool | None
) -> Segmentation:
    """Analyze one part on its own and put its parts in its place."""
    alone = analyze_part(analysis, whole, part)
    inside = np.flatnonzero(whole.labels == part)
    return inserted(whole, part, inside, segment_part(alone, mode, joints), alone.net, analysis.net)


def analyze_part(analysis: Analysis, whole: Segmentation, part: int) -> Analysis:
    """Return the analysis of one part on its own, cut off along the edges of its triangles.

    Raises
    ------
    LevelError
        If the part has too few faces.
    """
    inside = np.flatnonzero(whole.labels == part)
    if len(inside) < LEAST_FACES_WITHIN:
        raise LevelError(f"Part {part} has {len(inside)} faces at this level, too few to be divided further.")
    piece = TriangleMesh(analysis.mesh.vertices, analysis.mesh.triangles[inside])
    # No heat stays at the border: with a free one the part would have an end of its own where it was cut off.
    holds_border = analysis.field.name == DIFFUSION and bool((piece.edges.n_triangles == 1).any())
    return analysis._analyze(piece, field=analysis.field_choice, boundary="dirichlet" if holds_border else "neumann")


def segment_part(part: Analysis, mode: str, joints: bool | None = None) -> Segmentation:
    """Divide a part that was analyzed on its own at the level that is usual for parts."""
    holds_border = part.field.name == DIFFUSION and part.eigenbasis.boundary == "dirichlet"
    threshold = WITHIN_THRESHOLD / part.field.value_range if holds_border else None
    return part.segment(threshold=threshold, mode=mode, joints=joints)
