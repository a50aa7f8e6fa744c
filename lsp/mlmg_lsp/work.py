"""Work off the thread that reads messages, which stops where nobody waits for it any more."""

from __future__ import annotations

import asyncio
import ctypes
import sys
from collections.abc import Callable
from contextlib import suppress
from threading import Lock, Thread, get_ident
from typing import TypeVar

T = TypeVar("T")


async def off_loop(work: Callable[[], T], is_whole: bool = False) -> T:
    """Return what some work comes to that is done in a thread of its own.

    Where the caller is cancelled, the work is interrupted between two steps of the interpreter: a thread that was only
    asked to stop could go on for seconds, and slow down all that is asked after it. As each thread does one piece of
    work, none but that can be hit.

    Parameters
    ----------
    is_whole : whether it is not to be interrupted, as what imports a module for the first time.
    """
    loop = asyncio.get_running_loop()
    future: asyncio.Future[T] = loop.create_future()
    doing = _Doing()

    def run() -> None:
        with suppress(SystemExit):  # nobody waits for it any more
            doing.begin()
            try:
                settle = _settling(future, work)
            finally:
                doing.end()
            with suppress(RuntimeError):  # the loop has ended, and with it all who waited
                loop.call_soon_threadsafe(settle)

    Thread(target=run, daemon=True).start()
    try:
        return await future
    except asyncio.CancelledError:
        if not is_whole:
            doing.stop()
        raise


def tell_unraisable(error: sys.UnraisableHookArgs) -> None:
    """Say, as Python does, what went wrong where nothing can be raised: but not that a thread was stopped there."""
    if not isinstance(error.exc_value, SystemExit):
        sys.__unraisablehook__(error)


def _settling(future: asyncio.Future[T], work: Callable[[], T]) -> Callable[[], None]:
    """Do the work; return what tells the waiting one how it went."""
    try:
        result = work()
    except Exception as error:
        failure = error
        return lambda: None if future.done() else future.set_exception(failure)
    return lambda: None if future.done() else future.set_result(result)


class _Doing:
    """Some work that a thread does: only while it does it can it be hit, not as the thread begins and ends."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._thread: int | None = None
        self._is_stopped = False

    def begin(self) -> None:
        """Say in the thread that the work begins; raises `SystemExit` if nobody waits for it any more."""
        with self._lock:
            if self._is_stopped:
                raise SystemExit
            self._thread = get_ident()

    def end(self) -> None:
        """Say in the thread that the work is done."""
        with self._lock:
            self._thread = None

    def stop(self) -> None:
        """End the work by the one exception that threads end with without a word, wherever it hits it."""
        with self._lock:
            self._is_stopped = True
            if self._thread is not None:
                thread, error = ctypes.c_ulong(self._thread), ctypes.py_object(SystemExit)
                ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, error)
