"""Long work in several processes: the same results, whatever becomes of the children."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cellcolor import memory
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.frontend import Scene, build_surface, forked, links
from cellcolor.frontend.forked import share_out, shared
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.reach import validity
from examples import examples

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="one process only elsewhere")

WOK = Path(__file__).parents[2] / "instances" / "scenes" / "wok.toml"


@pytest.fixture(autouse=True)
def four_cores(monkeypatch):
    """As on a machine that has them."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _process: {0, 1, 2, 3})


@examples(12)  # processes are begun
@given(st.integers(0, 40), st.integers(1, 9))
def test_every_part_is_done_once_in_as_many_processes_as_pay(parts, at_least):
    done = shared((parts, 2), np.int64)

    def work(part):
        done[part] += [1, os.getpid()]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "sched_getaffinity", lambda _process: {0, 1, 2, 3})
        count = share_out(work, parts, at_least)
    assert (done[:, 0] == 1).all()
    assert count == max(1, min(4, parts // at_least))
    assert len(set(done[:, 1].tolist())) == min(count, parts)


def test_what_a_killed_child_leaves_is_done_all_the_same():
    found, parent = shared((40,), np.int64), os.getpid()

    def work(part):
        if part >= 20 and os.getpid() != parent:
            os.kill(os.getpid(), signal.SIGKILL)
        found[part] = part * part

    share_out(work, 40)
    assert found.tolist() == [part * part for part in range(40)]


def test_an_error_in_a_child_is_the_callers():
    def work(part):
        if part == 7:  # not of the parent's own share, which is 0, 4, 8, …
            raise ZeroDivisionError("part 7")

    with pytest.raises(ZeroDivisionError, match="part 7"):
        share_out(work, 40)
    assert not multiprocessing.active_children()


def test_an_error_of_the_callers_own_ends_the_children():
    parent = os.getpid()

    def work(_part):
        if os.getpid() == parent:
            raise KeyboardInterrupt
        time.sleep(60)

    with pytest.raises(KeyboardInterrupt):
        share_out(work, 40)
    assert not multiprocessing.active_children()


def test_work_within_work_stays_in_its_process():
    found = shared((8,), np.int64)

    def work(part):
        found[part] = share_out(lambda _inner: None, 100)

    assert share_out(work, 8) == 4
    assert found.tolist() == [1] * 8
    assert share_out(lambda _part: None, 8) == 4  # and afterwards there are several again


def test_where_no_process_can_be_begun_there_is_one(monkeypatch):
    """And a second time there is nothing left of the first."""
    tries = []

    def no_room():
        tries.append(os.getpid())
        raise BlockingIOError

    monkeypatch.setattr(os, "fork", no_room)
    for time_ in (1, 2):
        found = shared((8,), np.int64)

        def work(part, found=found):
            found[part] += 1

        assert share_out(work, 8) == 1
        assert found.tolist() == [1] * 8 and len(tries) == time_


def test_a_daemon_has_no_children(monkeypatch):
    monkeypatch.setitem(multiprocessing.current_process()._config, "daemon", True)
    assert share_out(lambda _part: None, 8) == 1


@pytest.fixture(scope="module")
def fine_scene():
    return Scene.read(WOK).varied(object={"target_vertices": 250})


@pytest.mark.second
def test_the_same_surface_to_the_last_byte(fine_scene, monkeypatch):
    # So small that this surface has many of each kind of part.
    monkeypatch.setattr(memory, "MEMORY", 300_000)
    monkeypatch.setattr(validity, "_PAYS", 1)
    shares = []

    def noted(work, parts, at_least=1):
        shares.append(share_out(work, parts, at_least))
        return shares[-1]

    monkeypatch.setattr(validity, "share_out", noted)
    monkeypatch.setattr(links, "share_out", noted)
    several = build_surface(fine_scene)
    assert shares.count(4) >= 4  # candidates, links, room for the tip, links between vertices
    monkeypatch.setattr(forked, "_cores", lambda: 1)
    alone = build_surface(fine_scene)
    assert several.surface.sha256 == alone.surface.sha256
    assert several.candidates == alone.candidates


def test_a_time_out_in_several_processes(fine_scene, monkeypatch):
    """It comes while candidates are judged, shared out, and not before."""
    place = prepare(fine_scene).workplace
    monkeypatch.setattr(memory, "MEMORY", 300_000)
    monkeypatch.setattr(validity, "_PAYS", 1)
    begun, fork = [], forked._forked

    def noted(*arguments):
        begun.append(fork(*arguments))
        return begun[-1]

    monkeypatch.setattr(forked, "_forked", noted)
    with pytest.raises(OutOfTime):
        validity.Judge(place)(np.zeros((640, 6)), Deadline.after(0))
    assert len(begun) == 3 and not multiprocessing.active_children()


SLOW_BUILD = """
import os, sys, time
os.sched_getaffinity = lambda _process: {0, 1, 2}
from cellcolor import memory
from cellcolor.frontend.reach import validity
memory.MEMORY, validity._PAYS, judged = 300_000, 1, validity.Judge._judged
def slowly(judge, *given):
    time.sleep(1)
    return judged(judge, *given)
validity.Judge._judged = slowly
from cellcolor.cli import main
sys.exit(main())
"""


@pytest.mark.second
def test_ctrl_c_ends_all_processes_of_a_build(tmp_path):
    """As a terminal sends it: to parent and children at once."""
    out = tmp_path / "wok.json"
    command = [sys.executable, "-c", SLOW_BUILD, "build", str(WOK), "-o", str(out)]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True)
    try:
        of_it = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        children = []
        while len(children) < 2 and process.poll() is None:
            children = of_it.read_text().split()
            time.sleep(0.02)
        os.killpg(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=30)
    finally:
        process.kill()
    assert said == "cellcolor: interrupted\n" and process.returncode == 3
    assert len(children) == 2
    assert not any(Path(f"/proc/{child}").exists() for child in children)
    assert not list(tmp_path.iterdir())
