"""The scripting API of the engine: arrays in, arrays out, no Blender."""

from .analysis import Analysis, analyze, reeb_graph, zero_level
from .errors import Cancelled, EngineError, FieldError, LevelError, MeshError, RegistrationError, SpectrumError
from .fem.eigenbasis import Eigenbasis, solve_eigenbasis
from .mesh import TriangleMesh
from .msc.diagram import PersistenceDiagram, persistence_curve, size_function
from .msc.diagram_distance import diagram_distance
from .msc.morse_smale import MorseSmaleComplex
from .msc.reeb import ReebGraph
from .registration.correspondence import Correspondence, correspond
from .registration.matching import Matching, match
from .registration.population import register
from .segmentation.parts import Segmentation
from .skeleton.binding import binding_weights
from .skeleton.embedding import Skeleton, skeleton
from .skeleton.symmetry import mirror_parts

__all__ = [
    "Analysis",
    "Cancelled",
    "Correspondence",
    "Eigenbasis",
    "EngineError",
    "FieldError",
    "LevelError",
    "Matching",
    "MeshError",
    "MorseSmaleComplex",
    "PersistenceDiagram",
    "ReebGraph",
    "RegistrationError",
    "Segmentation",
    "Skeleton",
    "SpectrumError",
    "TriangleMesh",
    "analyze",
    "binding_weights",
    "correspond",
    "diagram_distance",
    "match",
    "mirror_parts",
    "persistence_curve",
    "reeb_graph",
    "register",
    "size_function",
    "skeleton",
    "solve_eigenbasis",
    "zero_level",
]
