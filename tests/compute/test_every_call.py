"""Whatever a script calls with whatever it has: a result that is right, or a sentence, soon and without a warning."""

import inspect

import pytest

import compute
from tests.fuzzing.calls import ALSO, CALLS, INNER, tried, without_maker
from tests.selection import draws

# Cases of each call in the usual tests; each long draw has more.
N_CASES, N_LONG = 3, 40


@pytest.mark.parametrize("draw", draws(5))
@pytest.mark.parametrize("path", CALLS)
def test_every_call_gives_a_right_result_or_a_sentence(path, draw):
    first = 1000 * draw
    outcomes = {number: tried(path, 0, number) for number in range(first, first + (N_LONG if draw else N_CASES))}
    assert {number: outcome.faults for number, outcome in outcomes.items() if outcome.faults} == {}


@pytest.mark.parametrize("path", CALLS)
def test_there_is_a_maker_for_every_parameter(path):
    assert without_maker(path) == set()


def test_no_function_is_left_out():
    functions = {name for name in dir(compute) if inspect.isfunction(getattr(compute, name))}
    assert {name for name in functions if name[0] != "_"} - {"import_module"} == {
        *(path for path in CALLS if "." not in path),
        *INNER,
    }
    assert not INNER & {*compute.__all__, *ALSO}
