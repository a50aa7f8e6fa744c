"""Work in threads: done, failed, or stopped where nobody waits for it any more."""

from __future__ import annotations

import asyncio
import gc
import sys
import threading
from contextlib import suppress
from threading import Event, Thread, current_thread
from weakref import WeakSet

import pytest

from mlmg_lsp.work import off_loop


def test_what_work_comes_to_is_returned_and_what_it_raises_raised():
    async def both() -> None:
        assert await off_loop(lambda: 6 * 7) == 42
        with pytest.raises(ZeroDivisionError):
            await off_loop(lambda: 1 // 0)

    asyncio.run(both())


def test_work_that_nobody_waits_for_is_stopped():
    begun = Event()
    threads: list[Thread] = []

    def endless() -> None:
        threads.append(current_thread())
        begun.set()
        while True:
            pass

    async def given_up() -> None:
        task = asyncio.ensure_future(off_loop(endless))
        while not begun.is_set():
            await asyncio.sleep(0)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    asyncio.run(given_up())
    threads[0].join(30)
    assert not threads[0].is_alive()


def test_a_thread_ends_without_a_word_and_lets_go_of_its_work_whenever_it_is_stopped(monkeypatch):
    said: list[object] = []
    works: WeakSet[object] = WeakSet()
    monkeypatch.setattr(sys, "unraisablehook", lambda error: said.append(error.exc_value))
    monkeypatch.setattr(threading, "excepthook", lambda error: said.append(error.exc_value))

    class Work:
        def __call__(self) -> None:
            pass

    def work() -> Work:
        begun = Work()
        works.add(begun)
        return begun

    async def given_up(n_turns: int) -> None:
        task = asyncio.ensure_future(off_loop(work()))
        for _ in range(n_turns):
            await asyncio.sleep(0)
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task

    async def often() -> None:
        for attempt in range(2_000):
            await given_up(attempt % 5)

    before = set(threading.enumerate())
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)  # so that threads are stopped at all moments
    try:
        asyncio.run(often())
    finally:
        sys.setswitchinterval(interval)
    while left := set(threading.enumerate()) - before:
        left.pop().join(30)
    gc.collect()
    assert not said
    assert not works
