"""What stops an analysis from outside: the user, a full memory, a factorization that fails."""

import pytest

from compute import Cancelled, SpectrumError, analyze
from compute.fem import shift_invert
from tests.shapes import icosphere, star


@pytest.mark.parametrize("order", [1, 3])
def test_every_report_of_progress_can_cancel(order):
    mesh = star(n_arms=3, n_subdivisions=1)
    reports = []
    analyze(mesh, order=order, progress=lambda fraction, text: reports.append(text))
    for last in range(len(reports)):
        told = []

        def cancel(fraction, text, told=told, last=last):
            told.append(text)
            if len(told) > last:
                raise Cancelled

        with pytest.raises(Cancelled):
            analyze(mesh, order=order, progress=cancel)
        assert told == reports[: last + 1]


@pytest.mark.parametrize(("error", "sentence"), [(MemoryError, "memory is full"), (RuntimeError, "collapse")])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_factorization_that_fails_is_told_in_a_sentence(monkeypatch, order, error, sentence):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr(shift_invert, "splu", fail)
    with pytest.raises(SpectrumError, match=sentence):
        analyze(icosphere(3), order=order)
