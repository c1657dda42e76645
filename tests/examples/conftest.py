"""The characters, each made once."""

import pytest

import examples

MAKERS = ("humanoid", "octopus", "quadruped", "hand", "handles")


@pytest.fixture(scope="session", params=MAKERS)
def character(request):
    """Each character at its usual size."""
    return getattr(examples, request.param)()


@pytest.fixture(scope="session", params=("humanoid", "octopus", "quadruped"))
def symmetric_character(request):
    return getattr(examples, request.param)()


@pytest.fixture(scope="session")
def coarse_humanoid():
    """The humanoid with as few vertices as it allows."""
    return examples.humanoid(4000)
