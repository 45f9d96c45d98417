"""Progress, Ctrl-C, and other threads."""

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import left_behind
from tqdm import tqdm

import sweepsim

LONG = {"program": "fixtures/jobs/impeller.ron", "cells": (1600, 1600)}


@pytest.fixture(autouse=True)
def heard() -> Iterator[None]:
    """What is started in the background ignores Ctrl-C, and so would Python."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupting(after: float) -> threading.Timer:
    timer = threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    return timer


def test_progress_is_told() -> None:
    steps: list[tuple[int, int, str]] = []
    main = threading.get_ident()

    def progress(done: int, total: int, phase: str) -> None:
        assert threading.get_ident() == main
        steps.append((done, total, phase))

    sweepsim.verify("fixtures/verify/bracket.ron", proof=False, progress=progress)
    phases = [phase for _, _, phase in steps]
    assert "stock" in phases and "target" in phases and "verify" in phases
    assert all(0 <= done <= total for done, total, _ in steps)
    assert any(total > 0 and done == total for done, total, phase in steps if phase == "verify")


def test_progress_as_a_bar(facing: str) -> None:
    with tqdm(disable=None) as bar:

        def progress(done: int, total: int, phase: str) -> None:
            bar.set_description(phase, refresh=False)
            bar.total = total or None
            bar.update(done - bar.n)

        sweepsim.simulate(
            facing, tools={1: "Flat(radius: 6, length: 20)"}, stock="block:0,0,-10,40,20,0", progress=progress
        )


def test_ctrl_c_ends_a_run() -> None:
    timer = interrupting(0.5)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        sweepsim.simulate(**LONG)
    timer.join()
    assert 0.4 < time.monotonic() - start < 10
    # And what comes after is as ever.
    assert sweepsim.verify("fixtures/verify/bracket.ron", proof=False).verdict == "pass"


def test_ctrl_c_leaves_nothing_half_written(tmp_path: Path) -> None:
    outcome = sweepsim.simulate("fixtures/jobs/quickstart.ron", cells=(150, 150))
    # What is made once is made by now.
    outcome.save(tmp_path / "first")
    start = time.monotonic()
    whole = {name: (tmp_path / "whole" / name).stat().st_size for name in outcome.save(tmp_path / "whole")}
    elapsed = time.monotonic() - start
    interrupted, cut_short = 0, 0
    # Later on the page is made, and Ctrl-C is heard when that is done.
    for part in (0.05, 0.15, 0.3):
        folder = tmp_path / str(part)
        timer = interrupting(part * elapsed)
        try:
            outcome.save(folder)
            # The signal may come when all is done.
            timer.join()
            time.sleep(0.2)
        except KeyboardInterrupt:
            interrupted += 1
        timer.join()
        names = set(left_behind(folder))
        cut_short += names < set(whole)
        for name in names:
            # The report says how long it took.
            if not name.startswith("report"):
                assert (folder / name).stat().st_size == whole[name]
    assert interrupted == 3 and cut_short > 0


def test_an_exception_of_the_callback_ends_a_run() -> None:
    def progress(done: int, total: int, phase: str) -> None:
        if total > 0:
            raise RuntimeError("enough")

    start = time.monotonic()
    with pytest.raises(RuntimeError, match="enough"):
        sweepsim.simulate(**LONG, progress=progress)
    assert time.monotonic() - start < 10


def test_other_threads_go_on() -> None:
    count, done = 0, threading.Event()

    def counting() -> None:
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.001)

    thread = threading.Thread(target=counting)
    thread.start()
    start = time.monotonic()
    sweepsim.simulate("fixtures/jobs/quickstart.ron", cells=(900, 900))
    elapsed = time.monotonic() - start
    done.set()
    thread.join()
    # At worst the other thread slept much longer than it asked for.
    assert elapsed > 0.1 and count > 10 * elapsed


def test_two_runs_at_once(facing: str) -> None:
    found: list[float] = []

    def run() -> None:
        outcome = sweepsim.simulate(facing, tools={1: "Flat(radius: 6, length: 20)"}, stock="block:0,0,-10,40,20,0")
        found.append(outcome.report["volume_removed"])

    threads = [threading.Thread(target=run) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 3 and len(set(found)) == 1
