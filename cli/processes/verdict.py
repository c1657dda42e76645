"""Words for the end of a process that did not do its file."""

import signal
from dataclasses import dataclass

# What programs say when they get no more memory: Python, NumPy, C++, Blender, OpenBLAS, the loader of libraries.
MEMORY_WORDS = (
    *("memoryerror", "bad_alloc", "unable to allocate", "cannot allocate memory", "out of memory"),
    *("alloc returns null", "allocarray", "failed to allocate", "memory allocation"),
)
# Signals that come from outside, not from what the process does: a second try may go better.
OUTSIDE = ("SIGKILL", "SIGTERM", "SIGINT", "SIGHUP")
SIGNALS = {
    "SIGSEGV": "it reached for memory that is not there",
    "SIGBUS": "it reached for memory that is not there",
    "SIGABRT": "it gave up",
    "SIGFPE": "it divided by zero",
    "SIGILL": "the processor does not know an instruction",
    "SIGXCPU": "the system's limit of processor time",
}
# The same on Windows, where they are exit codes.
WINDOWS_CODES = {
    0xC0000005: "it reached for memory that is not there",
    0xC00000FD: "it ran out of stack",
    0xC0000374: "its memory was damaged",
    0xC0000409: "it gave up",
}
NO_MEMORY = "there is not enough memory for this file; decimate its meshes"
MORE_MEMORY = ", do fewer files at a time (--jobs), or allow more (--memory-limit)."


@dataclass(frozen=True)
class ProcessEnd:
    """How a process ended.

    Attributes
    ----------
    code : int
        Its exit code; a signal with a minus.
    errors : str
        What it said last on stderr.
    """

    code: int
    errors: str

    @property
    def is_from_outside(self) -> bool:
        """Whether something else ended the process, such as a system that is short of memory."""
        return _name(self.code) in OUTSIDE

    def sentence(self) -> str:
        """Return what to tell of the file that the process was working on."""
        if self.is_from_outside:
            return (
                "its process ended twice before the file was done: it was ended from outside "
                f"(signal {-self.code}), as systems do when memory runs out; decimate its meshes{MORE_MEMORY}"
            )
        if any(word in self.errors.lower() for word in MEMORY_WORDS):
            return NO_MEMORY + MORE_MEMORY
        if cause := self._cause():
            return (
                f"Blender crashed while working on it ({cause}); the file is probably damaged: "
                "open it in the program that made it, and export it again."
            )
        last_line = self.errors.strip().splitlines()[-1:]
        return ", ".join([f"its process ended before the file was done: exit code {self.code}", *last_line]) + "."

    def _cause(self) -> str:
        """Return the signal in words, empty if there was none."""
        if self.code < 0:
            words = SIGNALS.get(_name(self.code))
            return f"signal {-self.code}" + (f": {words}" if words else "")
        words = WINDOWS_CODES.get(self.code & 0xFFFFFFFF)
        return f"code {self.code & 0xFFFFFFFF:#x}: {words}" if words else ""


def _name(code: int) -> str:
    return signal.Signals(-code).name if -code in set(signal.Signals) else ""


def too_slow(seconds: float) -> str:
    """Return what to tell of a file whose time is over."""
    return f"it took longer than {seconds:g} seconds; decimate its meshes, or give it more (--timeout)."
