"""What is long known is left out of the search for garbage, which would look through all of a long script again.

That takes up to half a second, in the middle of whatever is being answered.
"""

from __future__ import annotations

import ctypes
import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Final

_ALLOCATOR: Final = ((-8, 1), (-3, 1 << 18), (-1, 1 << 20))
"""Of glibc (`mallopt`): how many arenas there are, from which size a block is one of its own, how much is kept free."""


def give_back() -> None:
    """Let memory that is free again go back to the system.

    Else each of the many threads that do one piece of work has it from another arena, and what they leave free in all
    of these comes to several times what is used.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError):  # another C library has no such thing
            for parameter, value in _ALLOCATOR:
                ctypes.CDLL(None).mallopt(parameter, value)


def settle() -> None:
    """Leave out all that is there now; it goes as ever when nothing refers to it any more, unless it is in a circle."""
    gc.collect(1)  # circles that have just come about
    gc.freeze()


def unsettle() -> None:
    """Look through all again."""
    gc.unfreeze()


def clear_out() -> None:
    """Look through all at once, and give back what is free, after something large has been let go of.

    The search would come too late, as it does not know how large it was.
    """
    gc.unfreeze()
    gc.collect()
    if sys.platform == "linux":  # what lies between what is still used is not given back by itself
        with suppress(OSError, AttributeError):
            ctypes.CDLL(None).malloc_trim(0)


def forget_way(error: BaseException | None) -> None:
    """Let go of where an error has been, once it has been told.

    Else it, those who have waited for it and the text that it is about keep one another, up to a search for garbage.
    """
    while error is not None:
        error.__traceback__ = None
        error = error.__context__


@contextmanager
def undisturbed() -> Iterator[None]:
    """Do something that makes very much of which nearly nothing goes again, without searching through it meanwhile."""
    try:
        gc.disable()  # within, as a thread may be stopped at any step
        yield
    finally:
        gc.enable()
