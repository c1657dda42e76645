"""Work for a worker process, which finds it here; knows no Blender, as there is none."""

import os
import signal
import sys
import time
from pathlib import Path

import numpy as np


class StubbornError(Exception):
    """An error that cannot be made again from its text."""

    def __init__(self, first, second):
        super().__init__(first)


def answer(value, progress):
    return value


def wait_for_file(path, progress):
    """Tell that it is half way, and go on when there is a file."""
    progress(0.5, "Half way")
    while not Path(path).exists():
        time.sleep(0.01)
    return 42


def touch(path, progress):
    Path(path).touch()


def sleep_for_ever(progress):
    progress(0.5, "Half way")
    while True:
        time.sleep(1)


def solve_for_long(path, progress):
    """Be in one call of a compiled library for far longer than any test."""
    matrix = np.random.default_rng(1).random((8000, 8000))
    Path(path).touch()
    for _ in range(100):
        np.linalg.svd(matrix)


def divide_by_zero(progress):
    return 1 / 0


def fail_stubbornly(progress):
    raise StubbornError(1, 2)


def end_at_report(n, work, progress):
    """Do some work in a process that is killed at its n-th report."""
    n_reports = 0

    def report(fraction, text):
        nonlocal n_reports
        n_reports += 1
        if n_reports == n:
            os.kill(os.getpid(), signal.SIGKILL)

    work(report)
    return n_reports


def end_with_a_crash(progress):
    os.abort()


def with_memory_for(n_bytes, work, progress):
    """Do some work in a process that gets no more memory than it has and so many bytes."""
    import resource

    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limits = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + n_bytes, limits[1]))
    try:
        return work(progress)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, limits)


def take_memory(n_bytes, progress):
    return len(np.ones(n_bytes, np.uint8))


def add_one(arrays, progress):
    for array in arrays:
        array += 1
    return arrays


def in_processes(function, arguments, progress):
    """Call a function with each of some arguments, as long work that can be shared does."""
    from eigenparts.tasks.shared_calls import run_all

    return run_all(function, arguments, progress)


def meet(number, folder, progress):
    """Wait until two processes do this at once; return the number and the process."""
    Path(folder, str(os.getpid())).touch()
    while len(list(Path(folder).iterdir())) < 2:
        time.sleep(0.01)
    return number, os.getpid()


def end_the_first_time(path, progress):
    """End the process that does this, unless one did before."""
    if not Path(path).exists():
        Path(path).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "done"


def tell_process_and_sleep(path, progress):
    Path(path).write_text(str(os.getpid()))
    sleep_for_ever(progress)


def raise_late(seconds, text, progress):
    time.sleep(seconds)
    raise ValueError(text)


def path_of_imports(progress):
    return list(sys.path)


def modules_of_blender(work, progress):
    """Do some work, and return which modules of Blender that took."""
    work(progress)
    return sorted({"bmesh", "bpy", "gpu", "mathutils"} & set(sys.modules))
