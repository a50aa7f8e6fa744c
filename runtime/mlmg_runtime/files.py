"""Writing files all or nothing."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def atomic_output(path: str | Path) -> Iterator[Path]:
    """Give a new, empty file beside `path` to write, and rename it to `path` at the end of the block.

    Until then, and for good if the block raises, `path` is untouched, and nothing is left beside it. A
    symbolic link keeps pointing at what is replaced; the permissions of an existing file are kept, and a new
    one gets the usual ones. What is no regular file, such as /dev/stdout or a pipe, cannot be replaced: then
    the path itself is given.

    Raises
    ------
    OSError
        If `path` is a folder, may not be written, no file can be made beside it, or the disk is full; the error
        names `path`.
    """
    if _is_device(path):
        yield Path(path)
        return
    target = Path(os.path.realpath(path))
    beside = _made_beside(target, path)
    try:
        yield beside
        if target.exists():
            beside.chmod(stat.S_IMODE(target.stat().st_mode))
        os.replace(beside, target)
    except BaseException as error:
        beside.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.errno is not None and error.filename is None:
            error.filename = str(path)
        raise


def check_output(path: str | Path) -> None:
    """Try whether `atomic_output(path)` would do, and leave nothing behind; for before a long work.

    Raises
    ------
    OSError
        As `atomic_output` does.
    """
    if not _is_device(path):
        _made_beside(Path(os.path.realpath(path)), path).unlink()


def _made_beside(target: Path, path: str | Path) -> Path:
    """Make an empty file beside `target`; errors name `path`."""
    _check_writable(target, path)
    beside = target.with_name(f".{os.urandom(8).hex()}.tmp")
    try:
        # Made by `open`, not by `tempfile`, so that it gets the permissions of any new file.
        os.close(os.open(beside, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    except OSError as error:
        raise type(error)(error.errno, error.strerror, str(path)) from None
    return beside


def _is_device(path: str | Path) -> bool:
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def _check_writable(target: Path, path: str | Path) -> None:
    """Raise what opening `target` for writing would raise: a rename does not ask."""
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if target.exists() and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
