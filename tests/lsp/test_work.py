"""Work in threads: done, failed, or stopped where nobody waits for it any more."""

from __future__ import annotations

import asyncio
from threading import Event

import pytest

from mlmg_lsp.work import off_loop


def test_what_work_comes_to_is_returned_and_what_it_raises_raised():
    async def both() -> None:
        assert await off_loop(lambda: 6 * 7) == 42
        with pytest.raises(ZeroDivisionError):
            await off_loop(lambda: 1 // 0)

    asyncio.run(both())


# Threads end with SystemExit without a word, but pytest has a word for it.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_work_that_nobody_waits_for_is_stopped():
    begun, ended = Event(), Event()

    def endless() -> None:
        begun.set()
        try:
            while True:
                pass
        finally:
            ended.set()

    async def given_up() -> None:
        task = asyncio.ensure_future(off_loop(endless))
        while not begun.is_set():
            await asyncio.sleep(0)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    asyncio.run(given_up())
    assert ended.wait(30)
