"""Work off the thread that reads messages, which stops where nobody waits for it any more."""

from __future__ import annotations

import asyncio
import ctypes
from collections.abc import Callable
from contextlib import suppress
from threading import Thread
from typing import TypeVar

T = TypeVar("T")


async def off_loop(work: Callable[[], T]) -> T:
    """Return what some work comes to that is done in a thread of its own.

    Where the caller is cancelled, the work is interrupted between two steps of the interpreter: a thread that was only
    asked to stop could go on for seconds, and slow down all that is asked after it. As each thread does one piece of
    work, none but that can be hit. What must not be interrupted, as the first import of a module, is to be shielded.
    """
    loop = asyncio.get_running_loop()
    future: asyncio.Future[T] = loop.create_future()

    def run() -> None:
        with suppress(SystemExit):  # nobody waits for it any more
            settle = _settling(future, work)
            with suppress(RuntimeError):  # the loop has ended, and with it all who waited
                loop.call_soon_threadsafe(settle)

    thread = Thread(target=run, daemon=True)
    thread.start()
    try:
        return await future
    except asyncio.CancelledError:
        _stop(thread)
        raise


def _settling(future: asyncio.Future[T], work: Callable[[], T]) -> Callable[[], None]:
    """Do the work; return what tells the waiting one how it went."""
    try:
        result = work()
    except Exception as error:
        failure = error
        return lambda: None if future.done() else future.set_exception(failure)
    return lambda: None if future.done() else future.set_result(result)


def _stop(thread: Thread) -> None:
    """End a thread by the one exception that threads end with without a word, wherever it hits them."""
    if thread.ident is not None and thread.is_alive():
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), ctypes.py_object(SystemExit))
