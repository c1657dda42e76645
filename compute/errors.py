"""What can go wrong, as sentences that are shown to the user unchanged."""


class EngineError(Exception):
    """Base of every error the engine raises on purpose."""


class MeshError(EngineError):
    """The mesh is not a surface that can be analyzed."""


class SpectrumError(EngineError):
    """The eigenvalue problem was posed wrongly or could not be solved."""


class FieldError(EngineError):
    """The scalar field does not fit the mesh or the question."""


class RegistrationError(EngineError):
    """The shapes cannot be matched the way it was asked."""


class LevelError(EngineError):
    """The asked level, threshold or number of parts does not exist."""


class Cancelled(Exception):  # noqa: N818 - not an error: the user's own wish
    """The user stopped the computation; raised by a progress callback."""
