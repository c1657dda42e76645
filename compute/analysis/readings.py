"""The Reeb graph and the zero levels of an analysis: what is read from it beside the parts of levels."""

from ..fields.scalar_field import eigenfunction_field
from ..memory import told_if_full
from ..msc.reeb import ReebGraph
from ..segmentation.parts.part_labels import Segmentation
from ..segmentation.parts.zero_level import divide_at_zero
from .analysis import Analysis


@told_if_full
def reeb_graph(analysis: Analysis, *, level: int | None = None) -> ReebGraph:
    """Return the Reeb graph of the field with the net triangles of each arc.

    Parameters
    ----------
    analysis : Analysis
    level : int, optional
        The level whose extrema and saddles are kept; the default level if None.

    Returns
    -------
    ReebGraph

    Raises
    ------
    LevelError
        If the level does not exist, or has too many critical points.

    References
    ----------
    .. [1] Pascucci et al., "Robust on-line computation of Reeb graphs: simplicity and speed", SIGGRAPH 2007.

    Examples
    --------
    >>> graph = reeb_graph(analysis)
    >>> graph.n_loops
    0
    >>> int((graph.degree == 1).sum())
    7
    """
    return analysis.complex_at_level(level).reeb_graph


@told_if_full
def zero_level(analysis: Analysis, function: int = 1) -> Segmentation:
    """Divide a mesh along the zero level of an eigenfunction: a torso, which no feature divides, into halves.

    Parameters
    ----------
    analysis : Analysis
    function : int
        Number of the eigenfunction, from 1.

    Returns
    -------
    Segmentation
        The connected pieces on which the eigenfunction has one sign, by falling area, from 1.

    Raises
    ------
    FieldError
        If there is no such eigenfunction.

    References
    ----------
    .. [1] Reuter, "Hierarchical Shape Segmentation and Registration via Topological Features of Laplace-Beltrami
       Eigenfunctions", IJCV 2010, section 5.1.

    Examples
    --------
    >>> zero_level(analysis, 1).n_parts
    2
    """
    basis = analysis.eigenbasis
    return divide_at_zero(eigenfunction_field(basis, function), analysis.mesh, basis.surface)
