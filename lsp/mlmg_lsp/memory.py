"""What is long known is left out of the search for garbage, which would look through all of a long script again.

That takes up to half a second, in the middle of whatever is being answered.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


def settle() -> None:
    """Leave out all that is there now; it goes as ever when nothing refers to it any more, unless it is in a circle."""
    gc.collect(1)  # circles that have just come about
    gc.freeze()


def unsettle() -> None:
    """Look through all again."""
    gc.unfreeze()


@contextmanager
def undisturbed() -> Iterator[None]:
    """Do something that makes very much of which nearly nothing goes again, without searching through it meanwhile."""
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
