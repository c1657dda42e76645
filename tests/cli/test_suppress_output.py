"""While Blender is quiet nothing reaches the streams, and afterwards everything does again."""

import os
import subprocess
import sys
from importlib import import_module

import pytest

from tools.extension import load_extension


@pytest.fixture
def quiet():
    load_extension()
    return import_module("eigenparts.cli.processes.suppress_output").blender_is_quiet


def speak(words):
    """Write to both streams, by Python, below it, and in a process of its own."""
    sys.stdout.write(f"{words}, Python\n")
    sys.stderr.write(f"{words}, Python\n")
    for stream in (1, 2):
        os.write(stream, f"{words}, below\n".encode())
    subprocess.run([sys.executable, "-c", f"print('{words}, child')"], check=True)


def test_nothing_is_heard_meanwhile_and_everything_before_and_after(quiet, capfd):
    speak("before")
    with quiet():
        speak("meanwhile")
    speak("after")
    out, err = capfd.readouterr()
    assert "meanwhile" not in out + err
    for words in ("before", "after"):
        assert {line for line in out.splitlines() if line.startswith(words)} == {
            *(f"{words}, Python", f"{words}, below", f"{words}, child")
        }
        assert f"{words}, Python" in err


def test_an_error_gives_the_streams_back_too(quiet, capfd):
    n_open = len(os.listdir("/proc/self/fd")) if sys.platform == "linux" else 0
    with pytest.raises(ZeroDivisionError), quiet():
        raise ZeroDivisionError
    speak("after")
    assert "after, below" in capfd.readouterr().out
    if n_open:
        assert len(os.listdir("/proc/self/fd")) == n_open
