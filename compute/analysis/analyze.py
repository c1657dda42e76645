"""The heavy step: from a mesh to everything that levels and parts are read from."""

from functools import partial

from numpy.typing import ArrayLike

from ..choices import BORDERS, EDGES
from ..errors import MeshError
from ..fem.matching_basis import MatchingBasis
from ..fields.field_choice import choose_field
from ..fields.shell_fields import choose_fields
from ..memory import told_if_full
from ..msc.links import links_of
from ..msc.morse_smale import FieldTopology
from ..progress import Progress, rising, section, silent
from ..segmentation.hierarchy.levels import Hierarchy
from ..segmentation.hierarchy.measured_hierarchy import measured_hierarchy
from ..surface.cleaning import Surface, analyzed_surface
from ..surface.mesh import TriangleMesh
from .analysis import Analysis


@told_if_full
def analyze(
    mesh: TriangleMesh,
    *,
    field: str | int | ArrayLike = "diffusion",
    n_functions: int | None = None,
    order: int | str = "auto",
    boundary: str = "neumann",
    shells: str = "bridged",
    borders: str = EDGES,
    progress: Progress | None = None,
) -> Analysis:
    """Compute a field on the mesh and the hierarchy of its features.

    Parameters
    ----------
    mesh : TriangleMesh
        Any mesh; of several shells those that prolong the largest are analyzed with it.
    field : "diffusion", int or (V,) array
        The auto diffusion function (without unit), the eigenfunction of that number (from 1; in 1/length), or the
        user's own values on the vertices.
    n_functions : int, optional
        Eigenfunctions to compute; 30 for "diffusion", otherwise 12 or as many as needed.
    order : 1, 2, 3 or "auto"
        Degree of the finite elements; "auto" takes linear ones where they are accurate enough for the parts, otherwise
        cubic ones as long as memory allows.
    boundary : "neumann" or "dirichlet"
        Whether the eigenfunctions are free or zero on the boundary of an open mesh.
    shells : "bridged", "largest" or "separate"
        Whether loose parts are bridged where they nearly touch, only the largest one is analyzed, or each that is no
        detail by itself, with parts of its own and what is left of it as a part of its own beside the body.
    borders : "edges" or "exact"
        Whether labels of whole faces end at short lines of edges near the level sets, or each face goes where its
        greater half lies.
    progress : callable, optional
        ``progress(fraction, text)`` is called often; it may raise :class:`Cancelled`.

    Returns
    -------
    Analysis

    Raises
    ------
    MeshError, FieldError, SpectrumError
        With a sentence that says what is wrong with the mesh, the field or the numbers asked for; all are an
        :class:`EngineError`.

    References
    ----------
    .. [1] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
       Eigenfunctions", IJCV 2010, sections 3 and 4.
    .. [2] Gebal et al., "Shape analysis using the auto diffusion function", SGP 2009.

    Examples
    --------
    >>> mesh = TriangleMesh(vertices, triangles)
    >>> analysis = analyze(mesh)
    >>> analysis.segment().n_parts
    6
    """
    progress = rising(progress or silent)
    progress(0.0, "Checking the mesh")
    if borders not in BORDERS:
        raise MeshError(f'Borders are "edges" or "exact", not "{borders}".')
    surface = analyzed_surface(mesh, shells)
    choose = choose_fields if surface.is_apart else choose_field
    chosen = choose(surface, field, n_functions, order, boundary, section(progress, 0.02, 0.8))
    progress(0.8, "Finding the features")
    net = chosen.field.net
    topology = FieldTopology(links_of(net.triangles, len(net.positions)), net.positions, chosen.field.values)
    progress(0.9, "Ordering the features")
    hierarchy, arcs, measures = measured_hierarchy(surface, chosen.field, topology, chosen.basis, ends_at_handles=False)
    progress(1.0, "Done")
    return Analysis(
        mesh=mesh,
        surface=surface,
        field=chosen.field,
        hierarchy=hierarchy,
        measures=measures,
        warnings=(*_warnings_of(surface, hierarchy), *chosen.warnings),
        field_choice=field,
        face_borders=borders,
        _topology=topology,
        _arc_of_vertex=arcs,
        _known_basis=chosen.basis,
        _matching=MatchingBasis(surface, chosen.basis),
        _analyze=partial(analyze, borders=borders),
    )


def _warnings_of(surface: Surface, hierarchy: Hierarchy) -> list[str]:
    warnings = []
    if surface.n_left_out:
        warnings.append(
            f"Triangles that have collapsed or repeat others: {surface.n_left_out}; each has the part of what is next"
            " to it."
        )
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
