"""What all tests share."""

import os
import sys

import pytest

pytest_plugins = ["tests.selection"]

_exit_status = pytest.StashKey[int]()


def pytest_sessionfinish(session, exitstatus):
    session.config.stash[_exit_status] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    # As a Python module, Blender waits for ever at the end if anything still refers to it, such as a failed test.
    if "bpy" in sys.modules and _exit_status in config.stash:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(config.stash[_exit_status])
