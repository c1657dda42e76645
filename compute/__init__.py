"""The scripting API of the engine: arrays in, arrays out, no Blender."""

from .analysis import Analysis, analyze
from .errors import Cancelled, EngineError, FieldError, LevelError, MeshError, RegistrationError, SpectrumError
from .fem.eigenbasis import Eigenbasis, solve_eigenbasis
from .mesh import TriangleMesh
from .registration.matching import Matching, match
from .segmentation.parts import Segmentation

__all__ = [
    "Analysis",
    "Cancelled",
    "Eigenbasis",
    "EngineError",
    "FieldError",
    "LevelError",
    "Matching",
    "MeshError",
    "RegistrationError",
    "Segmentation",
    "SpectrumError",
    "TriangleMesh",
    "analyze",
    "match",
    "solve_eigenbasis",
]
