"""What all commands share: how they end, how they tell of errors, how they show progress."""

from __future__ import annotations

import argparse
import gc
import os
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

DONE = 0
WRONG_CONTENT = 1
WRONG_USAGE = 2
INTERRUPTED = 130
# As a shell tells of a program that wrote to a pipe nobody reads.
NOT_READ = 141


class UsageError(Exception):
    """What a person asked for cannot be done as they asked for it."""


def run_command(program: str, command: Callable[[], int]) -> int:
    """Run a command and return its exit code; what goes wrong is told in one line on standard error.

    0 done; 1 the content of a file is wrong; 2 a file cannot be opened or written; 130 interrupted; 141 nobody reads
    the output.
    """
    from mlmg_runtime.errors import MlmgError

    try:
        code = command()
        sys.stdout.flush()
        return code
    except UsageError as error:
        tell(f"{program}: error: {error}")
        return WRONG_USAGE
    except MlmgError as error:
        tell(f"{program}: error: {error}")
        return WRONG_CONTENT
    except BrokenPipeError:
        # Whoever read our output has gone; standard output must not be flushed again at exit.
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return NOT_READ
    except OSError as error:
        name = f"{error.filename}: " if error.filename else ""
        tell(f"{program}: error: {name}{error.strerror or error}")
        return WRONG_USAGE
    except KeyboardInterrupt:
        tell(f"{program}: interrupted")
        return INTERRUPTED


def refuse_overwriting(outputs: Sequence[str | Path | None], inputs: Iterable[str | Path | None]) -> None:
    """Refuse to write a file that is read, or one file twice; - and None are no files.

    Raises
    ------
    UsageError
        That names the file.
    """
    read = {Path(path).resolve() for path in inputs if path is not None and str(path) != "-"}
    written: set[Path] = set()
    for path in outputs:
        if path is None or str(path) == "-":
            continue
        if Path(path).resolve() in read:
            raise UsageError(f"{path}: this file is read; the output needs another name")
        if Path(path).resolve() in written:
            raise UsageError(f"{path}: two outputs cannot be one file")
        written.add(Path(path).resolve())


def refuse_unwritable(outputs: Iterable[str | Path | None]) -> None:
    """Try whether files could be written, before the work whose result they are to hold.

    Raises
    ------
    OSError
        If one could not.
    """
    from mlmg_runtime.files import check_output

    for path in outputs:
        if path is not None and str(path) != "-":
            check_output(path)


def frame_rate(text: str) -> float:
    """Return frames a second as an option has them.

    Raises
    ------
    argparse.ArgumentTypeError
        If it is no number from 1 to 10,000, as clips may have.
    """
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 1 <= rate <= 10000:
        raise argparse.ArgumentTypeError(f"expected a number of frames a second from 1 to 10000, found {text!r}")
    return rate


def tell(message: str) -> None:
    """Say something to the person, on standard error; results alone go to standard output."""
    print(message, file=sys.stderr)


def one_thread_a_product() -> None:
    """Keep matrix products, of which no command has large ones, on one thread; to be called before numpy is imported.

    The threads of a BLAS wait by spinning: on a busy machine a build took five times as long with them. What is to run
    at once is run at once by `--jobs`.
    """
    for variable in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
        os.environ.setdefault(variable, "1")


def seldom_collect() -> None:
    """Look seldom for garbage that refers to itself.

    Of a long script millions of small objects stay; going through them again and again took a sixth of its check.
    """
    gc.set_threshold(50_000, 20, 20)


def utf8_streams() -> None:
    """Make standard input, output and error speak UTF-8, whatever the locale; one that is closed is as if empty."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115
    for stream in (sys.stdin, sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="surrogateescape" if stream is sys.stdin else "replace")


@dataclass(slots=True)
class ProgressLine:
    """One line on a terminal that says how far long work is, and how long it will still take; elsewhere, nothing."""

    stream: TextIO = field(default_factory=lambda: sys.stderr)
    clock: Callable[[], float] = time.monotonic
    _stage: str = ""
    _begun: float = 0.0
    _shown: int = 0

    def __call__(self, stage: str, done: int, total: int) -> None:
        """Show that `done` of `total` steps of a stage are done."""
        if not self.stream.isatty():
            return
        now = self.clock()
        if stage != self._stage:
            self._stage, self._begun = stage, now
        text = f"{stage} {done}/{total}"
        elapsed = now - self._begun
        if 0 < done < total and elapsed > 3.0:
            text += f", {elapsed * (total - done) / done:.0f} s left"
        self.stream.write("\r" + text.ljust(self._shown))
        self._shown = len(text)
        self.stream.flush()

    def clear(self) -> None:
        """Take the line away again."""
        if self._shown:
            self.stream.write("\r" + " " * self._shown + "\r")
            self.stream.flush()
            self._shown = 0


def add_use_option(parser: argparse.ArgumentParser) -> None:
    """Add the option that lets scripts use files of other folders than their own."""
    parser.add_argument(
        "--allow-use",
        metavar="FOLDER",
        action="append",
        default=[],
        help='let scripts use definitions from this folder too (use "file.ms"); may be given again',
    )
