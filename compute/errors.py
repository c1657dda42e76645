"""Errors, as sentences that are shown to the user unchanged."""


class EngineError(Exception):
    """Base class of every error that the engine raises on purpose.

    Examples
    --------
    >>> from compute import EngineError, TriangleMesh
    >>> try:
    ...     mesh = TriangleMesh([], [])
    ... except EngineError as error:
    ...     print(error)
    The vertices must have the shape (n, 3), not (0,).
    """


class MeshError(EngineError):
    """Error of a mesh that is not a surface that can be analyzed.

    Examples
    --------
    >>> from compute import TriangleMesh
    >>> TriangleMesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    Traceback (most recent call last):
    compute.errors.MeshError: The faces of the mesh have no area; check the scale of the object and merged vertices.
    """


class SpectrumError(EngineError):
    """Error of an eigenvalue problem that was posed wrongly or could not be solved.

    Examples
    --------
    >>> from compute import TriangleMesh, solve_eigenbasis
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> solve_eigenbasis(square, 0)
    Traceback (most recent call last):
    compute.errors.SpectrumError: Ask for at least one eigenfunction.
    """


class FieldError(EngineError):
    """Error of a scalar field that does not fit the mesh or the question.

    Examples
    --------
    >>> from compute import TriangleMesh, analyze
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> analyze(square, field=[1.0, 2.0, 3.0])
    Traceback (most recent call last):
    compute.errors.FieldError: The field needs one value for each of the 4 vertices, not (3,).
    """


class RegistrationError(EngineError):
    """Error of shapes that cannot be matched as it was asked.

    Examples
    --------
    >>> from compute import register
    >>> register([])
    Traceback (most recent call last):
    compute.errors.RegistrationError: There is no shape 0 to register to; there are 0 shapes.
    """


class LevelError(EngineError):
    """Error of a level, a threshold or a number of parts that does not exist.

    Examples
    --------
    >>> from compute import TriangleMesh, analyze
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> analyze(square, field=square.vertices[:, 0]).segment(level=-1)
    Traceback (most recent call last):
    compute.errors.LevelError: Level -1 does not exist; this shape has levels 0 to 0.
    """


class Cancelled(Exception):  # noqa: N818 - not an error: the user's own wish
    """The end of a computation that the user stopped; raised by a progress callback.

    Examples
    --------
    >>> from compute import Cancelled, TriangleMesh, analyze
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> def stop(fraction, text):
    ...     raise Cancelled
    >>> try:
    ...     analysis = analyze(square, progress=stop)
    ... except Cancelled:
    ...     print("stopped")
    stopped
    """
