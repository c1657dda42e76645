"""Every call that a script may make, tried with random arguments: a result that is right, or a sentence."""

import inspect
import signal
import traceback
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any
from zlib import crc32

import compute
from tests.fuzzing.arguments import MAKERS, Case
from tests.fuzzing.results import faults, same

# CPU seconds that a call may take on these small meshes; most take less than one, but busy machines count generously.
LONGEST = 30.0
# Functions beside the scripting API that take what a user has at hand.
ALSO = (
    *("fill_unsure", "transfer_displacements", "transfer_corners", "softened_labels", "judge_eigenfunctions"),
    "matching_shape",
)
# Functions that take what other functions of the engine returned, and nothing of the user's.
INNER = {
    *("agreed_matchings", "analyzed_surface", "carried", "carried_painting", "colour_places", "connected_branches"),
    *("corrected_crossings", "cross_edges", "divisible", "drawn_borders", "exact_labels", "face_graph"),
    *("first_own_part", "hill_of"),
    *("joined_parts", "label_branches", "label_mapped", "lie_together", "majority_of_polygons", "map_to_reference"),
    *("match_divisible", "match_members", "match_shape_diagrams", "mixed", "mode_of", "naming", "needs_faces"),
    *("number_behind", "reading_of"),
    *("places_at_all_levels", "point_warnings", "prepare_reference", "redraw", "relief_of", "renumbered", "section"),
    *(
        "shortened_borders",
        "sides",
        "silent",
        "taken_over",
        "tracked_parts",
        "tracked_pieces",
        "undivided",
        "vertex_heights",
    ),
    *("visible_parts", "welded_vertices", "with_parts", "without_necks"),
}


@dataclass(frozen=True)
class Outcome:
    """The end of one call: its sentence if it was refused, and what is wrong with it, if anything is."""

    sentence: str | None = None
    faults: tuple[str, ...] = ()


class TooLong(BaseException):
    """The end of a call that does not end."""


def calls() -> dict[str, Callable[..., Any]]:
    """Return every function, and every method as a function of ``self``, by its path; `results` reads properties."""
    found: dict[str, Callable[..., Any]] = {}
    for name in (*compute.__all__, *ALSO):
        subject = getattr(compute, name)
        if not inspect.isclass(subject):
            found[name] = subject
        elif not issubclass(subject, Exception):
            methods = {name: value for name, value in vars(subject).items() if inspect.isfunction(value)}
            found |= {f"{name}.{method}": call for method, call in methods.items() if not method.startswith("_")}
    return found


CALLS = calls()


def without_maker(path: str) -> set[str]:
    """Return the parameters of a call that nothing is made for."""
    return {name for name in inspect.signature(CALLS[path]).parameters if _maker(path, name) is None}


def _maker(path: str, name: str) -> Any:
    owner = path.partition(".")[0]
    return MAKERS.get(f"{owner}.self") if name == "self" else MAKERS.get(f"{path}.{name}", MAKERS.get(name))


def tried(path: str, seed: int, number: int) -> Outcome:
    """Call with the random arguments of a number; every third from the start once more, which must give the same."""
    result, outcome = _called(path, seed, number)
    if outcome.faults or number % 3:
        return outcome
    other, repeated = _called(path, seed, number)
    if repeated != outcome or not same(result, other):
        return Outcome(faults=(f"not the same twice: {outcome}, {repeated}",))
    return outcome


def _called(path: str, seed: int, number: int) -> tuple[Any, Outcome]:
    case = Case(seed, number, crc32(path.encode()))
    try:
        with warnings.catch_warnings(), bounded(LONGEST):
            warnings.simplefilter("error")
            result = CALLS[path](**_arguments(path, case))
            return result, Outcome(faults=tuple(faults(path, result, case.mesh, case.last_mesh)))
    except compute.EngineError as refusal:
        told = str(refusal)
        return None, Outcome(told, () if told.endswith(".") else ("a refusal that is no sentence",))
    except (Exception, TooLong) as error:
        return None, Outcome(faults=(_place(error),))


def _arguments(path: str, case: Case) -> dict[str, Any]:
    """Return a value for each parameter that has to be given, and for some of the others."""
    given = {}
    for name, parameter in inspect.signature(CALLS[path]).parameters.items():
        if parameter.default is inspect.Parameter.empty or case.rng.random() < 0.3:
            given[name] = _maker(path, name)(case)
    return given


def _place(error: BaseException) -> str:
    """Return what was raised, and where."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} ({'/'.join(last.filename.split('/')[-3:])}, line {last.lineno})"


@contextmanager
def bounded(seconds: float) -> Iterator[None]:
    """End what takes longer, in CPU seconds, with `TooLong`, where the system has such a clock."""
    if not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGPROF, _end)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def _end(*_: Any) -> None:
    raise TooLong(f"after {LONGEST:g} s")
