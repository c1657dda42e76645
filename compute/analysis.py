"""The heavy step: from a mesh to everything that levels and parts are read from."""

import dataclasses
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import ArrayLike

from .choices import NESTED
from .errors import LevelError, RegistrationError
from .fem.eigenbasis import Eigenbasis, solve_on_surface
from .fem.matching_basis import solve_for_matching
from .fields.field_choice import DEFAULT_FUNCTIONS, choose_field, n_available
from .fields.scalar_field import DIFFUSION, Net, ScalarField, eigenfunction_field
from .fields.shell_fields import choose_fields
from .msc.diagram import PersistenceDiagram
from .msc.links import links_of
from .msc.morse_smale import FieldTopology, MorseSmaleComplex
from .msc.reeb import ReebGraph
from .progress import Progress, rising, section, silent
from .segmentation.borders.edge_profile import EdgeProfile, edge_profile
from .segmentation.borders.level_set_borders import (
    Polyline,
    closing_heights,
    cross_edges,
    part_of_border,
    trace_borders,
)
from .segmentation.faces.arc_areas import arc_areas
from .segmentation.faces.branches import build_branches
from .segmentation.faces.face_graph import face_graph
from .segmentation.faces.part_tree import PartTree
from .segmentation.hierarchy.arc_measures import ArcMeasures, measure_arcs
from .segmentation.hierarchy.levels import Hierarchy, build_hierarchy
from .segmentation.hierarchy.shell_bodies import with_bodies
from .segmentation.parts.part_labels import Segmentation, label_branches
from .segmentation.parts.subparts import inserted
from .segmentation.parts.zero_level import divide_at_zero
from .surface.cleaning import Surface, analyzed_surface, clean_surface
from .surface.mesh import Ints, TriangleMesh

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
    """What is known of a mesh after the heavy step; every level is read from it at once.

    Attributes
    ----------
    mesh : TriangleMesh
        The input.
    surface : Surface
        What of it was analyzed.
    field : ScalarField
    hierarchy : Hierarchy
    measures : tuple of ArcMeasures
        One for each tree of the hierarchy.
    warnings : tuple of str
        Sentences for the user.
    field_choice : "diffusion", int or (V,) array
        The field that was asked for.
    """

    mesh: TriangleMesh
    surface: Surface
    field: ScalarField
    hierarchy: Hierarchy
    measures: tuple[ArcMeasures, ...]
    warnings: tuple[str, ...]
    field_choice: str | int | ArrayLike
    _topology: FieldTopology
    _arc_of_vertex: tuple[Ints, ...]
    _known_basis: Eigenbasis | None = dataclasses.field(repr=False)

    @property
    def net(self) -> Net:
        """The triangles the field is linear on."""
        return self.field.net

    @cached_property
    def eigenbasis(self) -> Eigenbasis:
        """The eigenfunctions the field was made of; computed when first asked for if the field is the user's.

        Those of the largest shell if each was analyzed by itself.
        """
        if self._known_basis is not None:
            return self._known_basis
        surface = clean_surface(self.mesh) if self.surface.is_apart else self.surface
        return solve_on_surface(surface, min(DEFAULT_FUNCTIONS, n_available(surface, "neumann")))

    @property
    def matching_basis(self) -> Eigenbasis:
        """Up to 100 free eigenfunctions for matching and dense maps, with the signs that ``eigenbasis`` has.

        Computed when first asked for and kept.
        """
        return self.find_matching_basis(silent)

    def find_matching_basis(self, progress: Progress) -> Eigenbasis:
        """Return ``matching_basis``, telling how far it is if it has to be computed.

        Raises
        ------
        RegistrationError
            If each shell was analyzed by itself: there is no one shape to be matched.
        """
        self.require_one_shape()
        kept = vars(self)
        if "_matching_basis" not in kept:
            kept["_matching_basis"] = solve_for_matching(self.surface, self._known_basis, progress)
        return kept["_matching_basis"]

    def require_one_shape(self) -> None:
        """Raise a RegistrationError if each shell was analyzed by itself: there is nothing to be matched or to move."""
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
        """Return the complex with what survives at a level, the default one if None.

        Where only maxima are features, minima and handles are kept as far as they are as persistent as those.
        """
        hierarchy = self.hierarchy
        level = hierarchy.default_level if level is None else hierarchy.checked_level(level)
        persistence = hierarchy.persistence[::-1]
        least = np.inf if level == 0 else persistence[level - 1]
        return self.complex.above(float(least))

    @cached_property
    def _ended_at_handles(self) -> "Analysis":
        hierarchy, arcs, measures = _hierarchy(self.surface, self.field, self._topology, ends_at_handles=True)
        return dataclasses.replace(self, hierarchy=hierarchy, measures=measures, _arc_of_vertex=arcs)

    def part_tree(self, face_of_triangle: Ints | None = None) -> PartTree:
        """Return the hierarchy with the faces of its arcs: all that the parts of any level are read from.

        Parameters
        ----------
        face_of_triangle : (T,) int64, optional
            The polygon each triangle of the input belongs to; the triangles themselves if None.
        """
        if face_of_triangle is None:
            return self._triangle_tree
        return self._part_tree(np.asarray(face_of_triangle, dtype=np.int64))

    @cached_property
    def _triangle_tree(self) -> PartTree:
        return self._part_tree(np.arange(len(self.mesh.triangles)))

    def _part_tree(self, face_of_triangle: Ints) -> PartTree:
        graph = face_graph(self.mesh, self.surface, face_of_triangle)
        face = face_of_triangle[self.surface.input_triangle][self.net.triangle_of_surface]
        trees, shares = self.hierarchy.trees, []
        for tree, arc in zip(trees, self._arc_of_vertex, strict=True):
            rising = -self.field.values if tree.is_of_maxima else self.field.values
            shares.append(arc_areas(rising, arc, tree, self.net, face))
        heights = tuple(closing_heights(self.field.values, tree) for tree in trees)
        branches = build_branches([tree.parent for tree in trees], shares, graph)
        return PartTree(self.hierarchy, self.measures, heights, branches)

    def profile(self, edges: Ints | None = None) -> EdgeProfile:
        """Return the field along edges (E, 2) of the input, those of its triangles if None."""
        edges = self.mesh.edges.vertices if edges is None else edges
        return edge_profile(self.surface, self.field, self._arc_of_vertex, edges)

    def borders(self, level: int | None = None, mode: str = NESTED) -> tuple[Polyline, ...]:
        """Return the lines where the parts of a level, the default one if None, end on the triangles of the input."""
        hierarchy, part_tree = self.hierarchy, self.part_tree()
        level = hierarchy.default_level if level is None else hierarchy.checked_level(level)
        cuts = part_tree.cut_arcs(level, mode)
        crossings = cross_edges(self.profile(), part_tree.trees, part_tree.closing_heights, cuts)
        return trace_borders(self.mesh, crossings, part_of_border(cuts))

    def segment(
        self,
        *,
        level: int | None = None,
        threshold: float | None = None,
        n_parts: int | None = None,
        mode: str = NESTED,
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
            How many labels, the body included.
        mode : "nested" or "features"
            The features and what lies between them when all levels up to this one are overlaid, or the features alone.
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
            If there is no such level, mode or part, or more than one of the three choices is given.

        References
        ----------
        .. [1] Reuter, IJCV 2010, section 4.7, on the analysis of subparts.
        """
        if essential:
            return self._ended_at_handles.segment(
                level=level, threshold=threshold, n_parts=n_parts, mode=mode, within=within
            )
        part_tree = self.part_tree()
        labels = label_branches(part_tree, level=level, threshold=threshold, n_parts=n_parts, mode=mode)
        whole = Segmentation(
            labels=labels.of_faces(part_tree),
            parts=labels.parts,
            level=labels.level,
            warnings=labels.warnings,
            _trace=partial(self.borders, labels.level, mode),
        )
        return whole if within is None else _divided_further(self, whole, within, mode)


def analyze(
    mesh: TriangleMesh,
    *,
    field: str | int | ArrayLike = "diffusion",
    n_functions: int | None = None,
    order: int | str = "auto",
    boundary: str = "neumann",
    shells: str = "bridged",
    progress: Progress | None = None,
) -> Analysis:
    """Compute a field on the mesh and the hierarchy of its features.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh; of several shells those that prolong the largest are analyzed with it.
    field : "diffusion", int or (V,) array
        The auto diffusion function, the eigenfunction of that number (from 1), or the user's own values.
    n_functions : int, optional
        Eigenfunctions to compute; 30 for "diffusion", otherwise 12 or as many as needed.
    order : 1, 2, 3 or "auto"
        Degree of the finite elements; "auto" takes cubic ones as long as they are cheap.
    boundary : "neumann" or "dirichlet"
    shells : "bridged", "largest" or "separate"
        Whether loose parts are bridged where they nearly touch, only the largest one is analyzed, or each that is no
        detail by itself, with parts of its own and what is left of it as a part of its own beside the body.
    progress : callable, optional
        ``progress(fraction, text)``; may raise :class:`Cancelled`.

    Raises
    ------
    EngineError
        With a sentence that says what is wrong with the mesh, the field or the numbers asked for.
    """
    progress = rising(progress or silent)
    progress(0.0, "Checking the mesh")
    surface = analyzed_surface(mesh, shells)
    choose = choose_fields if surface.is_apart else choose_field
    chosen = choose(surface, field, n_functions, order, boundary, section(progress, 0.02, 0.8))
    progress(0.8, "Finding the features")
    net = chosen.field.net
    topology = FieldTopology(links_of(net.triangles, len(net.positions)), net.positions, chosen.field.values)
    progress(0.9, "Ordering the features")
    hierarchy, arcs, measures = _hierarchy(surface, chosen.field, topology, ends_at_handles=False)
    progress(1.0, "Done")
    return Analysis(
        mesh=mesh,
        surface=surface,
        field=chosen.field,
        hierarchy=hierarchy,
        measures=measures,
        warnings=(*_warnings_of(surface, hierarchy), *chosen.warnings),
        field_choice=field,
        _topology=topology,
        _arc_of_vertex=arcs,
        _known_basis=chosen.basis,
    )


def _hierarchy(
    surface: Surface, scalar_field: ScalarField, topology: FieldTopology, *, ends_at_handles: bool
) -> tuple[Hierarchy, tuple[Ints, ...], tuple[ArcMeasures, ...]]:
    """Return the hierarchy, and for each of its trees the arcs of the net's vertices and the measures of the arcs."""
    hierarchy, arcs = build_hierarchy(
        topology,
        minima_are_features=scalar_field.minima_are_features,
        least_range=scalar_field.least_range,
        ends_at_handles=ends_at_handles,
    )
    if surface.is_apart:
        hierarchy = with_bodies(hierarchy, _shell_of_vertex(surface, scalar_field.net))
    measures = (measure_arcs(tree, arc, scalar_field) for tree, arc in zip(hierarchy.trees, arcs, strict=True))
    return hierarchy, arcs, tuple(measures)


def _shell_of_vertex(surface: Surface, net: Net) -> Ints:
    """Return the shell (n,) of each vertex of a net; -1 for those in no triangle."""
    shell = np.full(len(net.positions), -1)
    shell[net.triangles] = surface.mesh.component_of_triangle[net.triangle_of_surface, None]
    return shell


def reeb_graph(analysis: Analysis, *, level: int | None = None) -> ReebGraph:
    """Return the Reeb graph of the field with the net triangles of each arc.

    Parameters
    ----------
    analysis : Analysis
    level : int, optional
        Which extrema and saddles to keep; the default level if None.

    Raises
    ------
    LevelError
        If the level does not exist, or has too many critical points.
    """
    return analysis.complex_at_level(level).reeb_graph


def zero_level(analysis: Analysis, function: int = 1) -> Segmentation:
    """Divide a mesh along the zero level of an eigenfunction: a torso, which no feature divides, into halves.

    Parameters
    ----------
    analysis : Analysis
    function : int
        Number of the eigenfunction, from 1.

    Raises
    ------
    FieldError
        If there is no such eigenfunction.

    References
    ----------
    .. [1] Reuter, IJCV 2010, section 5.1.
    """
    basis = analysis.eigenbasis
    return divide_at_zero(eigenfunction_field(basis, function), analysis.mesh, basis.surface)


def _divided_further(analysis: Analysis, whole: Segmentation, part: int, mode: str) -> Segmentation:
    """Analyze one part on its own and put its parts in its place."""
    own = analyze_part(analysis, whole, part)
    inside = np.flatnonzero(whole.labels == part)
    return inserted(whole, part, inside, segment_part(own, mode), own.net, analysis.net)


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
    return analyze(piece, field=analysis.field_choice, boundary="dirichlet" if holds_border else "neumann")


def segment_part(own: Analysis, mode: str = NESTED) -> Segmentation:
    """Divide a part that was analyzed on its own at the level that is usual for parts."""
    holds_border = own.field.name == DIFFUSION and own.eigenbasis.boundary == "dirichlet"
    return own.segment(threshold=WITHIN_THRESHOLD / own.field.value_range if holds_border else None, mode=mode)


def _warnings_of(surface: Surface, hierarchy: Hierarchy) -> list[str]:
    warnings = []
    if surface.n_components > 1:
        alone = ", each by itself" if surface.is_apart else ""
        warnings.append(
            f"The mesh has {surface.n_components} loose parts; {surface.n_joined} of them were analyzed{alone}, the"
            " others follow what is next to them."
        )
    if hierarchy.n_levels == 1 and surface.is_apart:
        warnings.append("The loose parts have no features: each is one part.")
    elif hierarchy.n_levels == 1:
        warnings.append("The shape has no features: it is one part.")
    return warnings
