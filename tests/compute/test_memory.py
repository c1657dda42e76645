"""What a process may have is the least of what machine, groups of processes and its own limits leave."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import compute
from compute import EngineError, TriangleMesh, analyze, binding_weights, correspond, match, memory, register, skeleton
from compute.skeletons import embedding
from tests.fuzzing.calls import CALLS as CALLS_OF_SCRIPTS
from tests.shapes import star

GB = 10**9
STAR = star(n_arms=4, n_subdivisions=2)


@pytest.fixture
def system(tmp_path, monkeypatch):
    """Pretend a system; return a function that writes one of its files."""

    def write(path, text):
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    monkeypatch.setattr(memory, "PROC", tmp_path / "proc")
    monkeypatch.setattr(memory.sys, "platform", "linux")
    write("proc/meminfo", f"MemTotal: 1 kB\nMemAvailable: {64 * GB // 1024} kB\n")
    write.root = tmp_path
    return write


def second_version(system, group):
    system("proc/self/cgroup", f"0::/{group}\n")
    system("proc/self/mountinfo", f"30 25 0:26 / {system.root}/sys rw shared:9 - cgroup2 cgroup2 rw\n")


def limits(system, group, **values):
    for name, value in values.items():
        system(f"sys/{group}/memory.{name}", f"{value}\n")


def test_the_memory_at_hand_is_known_here():
    assert 1e8 < memory.available_memory() < float("inf")


@pytest.mark.parametrize("name", ["max", "high"])
@pytest.mark.parametrize("group", ["pod/job", "pod", "."])
def test_every_group_around_limits(system, group, name):
    second_version(system, "pod/job")
    limits(system, group, current=3 * GB, **{"max": "max", "high": "max", name: 5 * GB})
    assert memory.available_memory() == 2 * GB


def test_cache_that_can_be_given_back_is_free(system):
    second_version(system, "job")
    limits(system, "job", max=5 * GB, current=4 * GB, stat=f"anon {3 * GB}\ninactive_file {1 * GB}")
    assert memory.available_memory() == 2 * GB


def test_a_full_group_leaves_nothing(system):
    second_version(system, "job")
    limits(system, "job", high=1 * GB, current=2 * GB)
    assert memory.available_memory() == 0


@pytest.mark.parametrize(("path", "root"), [("/docker/7f/job", "/docker/7f"), ("/job", "/"), ("/../../job", "/")])
def test_groups_of_the_first_version_limit_too(system, path, root):
    system("proc/self/cgroup", f"5:cpu:/elsewhere\n4:cpuset,memory:{path}\n")
    system("proc/self/mountinfo", f"35 31 0:32 {root} {system.root}/sys rw - cgroup cgroup rw,memory\n")
    group = "." if ".." in path else "job"
    system(f"sys/{group}/memory.limit_in_bytes", str(7 * GB))
    system(f"sys/{group}/memory.usage_in_bytes", str(4 * GB))
    assert memory.available_memory() == 3 * GB


def test_a_system_that_says_nothing_is_no_limit(system):
    for name in ("meminfo", "self/cgroup", "self/mountinfo"):
        system(f"proc/{name}", "")
    assert memory.available_memory() > 0


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits of a process as Linux has them")
@pytest.mark.parametrize("limit", ["RLIMIT_AS", "RLIMIT_DATA"])
def test_limits_of_the_process_are_heeded(limit):
    script = (
        f"import resource; resource.setrlimit(resource.{limit}, (2 * 10**9,) * 2)\n"
        "from compute.memory import available_memory; print(available_memory())"
    )
    root = Path(__file__).parents[2]
    run = subprocess.run([sys.executable, "-c", script], cwd=root, capture_output=True, text=True, check=True)
    assert 1 * GB < float(run.stdout) < 2 * GB


@pytest.fixture(scope="module")
def shape():
    analysis = analyze(STAR, order=1)
    other = analyze(TriangleMesh(STAR.vertices * [1, 1, 1.1], STAR.triangles[:-1]), order=1)
    return analysis, other, skeleton(analysis)


CALLS = {
    "match": lambda one, other, bones: match(one, other),
    "correspond": lambda one, other, bones: correspond(one, other),
    "register": lambda one, other, bones: register([one, other]),
    "skeleton": lambda one, other, bones: skeleton(one),
    "binding_weights": lambda one, other, bones: binding_weights(one, bones),
    "segment": lambda one, other, bones: analyze(STAR, order=1).part_tree(np.arange(len(STAR.triangles))),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_stage_that_does_not_fit_is_refused_with_both_numbers(shape, monkeypatch, name):
    monkeypatch.setattr(memory, "available_memory", lambda: 1e3)
    with pytest.raises(EngineError, match=r"about .* MB of memory, and 0\.0 MB are free; "):
        CALLS[name](*shape)


def test_a_memory_that_gets_full_inside_is_told_in_a_sentence(shape, monkeypatch):
    def full(*_, **__):
        raise MemoryError

    monkeypatch.setattr(embedding, "plan_limbs", full)
    with pytest.raises(EngineError, match="The memory is full"):
        skeleton(shape[0])


# They hardly take more than what they are given.
SMALL = {"persistence_curve", "size_function"}


@pytest.mark.parametrize("name", [path for path in CALLS_OF_SCRIPTS if "." not in path and path not in SMALL])
def test_every_function_tells_of_a_full_memory(name):
    assert getattr(compute, name).__wrapped__.__name__ == name
