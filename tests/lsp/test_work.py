"""Work in threads: done, failed, or stopped where nobody waits for it any more."""

from __future__ import annotations

import asyncio
from threading import Event, Thread, current_thread

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
