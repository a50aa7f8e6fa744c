"""A process that becomes language servers: what all of them import is imported once, which takes most of a start.

It is told over a pipe, whose number is its argument, where and with which words and environment a server begins, and is
handed its standard input and output; it tells the server's process, and later how that has ended.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Mapping
from importlib import import_module
from multiprocessing.connection import Connection
from multiprocessing.reduction import recv_handle
from pkgutil import walk_packages
from typing import NoReturn

from mlmg_lang.commands import mlmg


def main() -> None:
    """Begin a server, or wait for the end of one, for each thing told."""
    get_ready()
    told = Connection(int(sys.argv[1]))
    while True:
        try:
            what = told.recv()
        except EOFError:
            return
        if what[0] == "wait":
            told.send(wait(*what[1:]))
            continue
        pipes = [recv_handle(told), recv_handle(told)]
        process = os.fork()
        if process == 0:
            told.close()
            become_server(pipes, *what[1:])
        for pipe in pipes:
            os.close(pipe)
        told.send(process)


def get_ready() -> None:
    """Import all that a server may, and do once what it does before its first answer."""
    mlmg.one_thread_a_product()
    for package in ("mlmg_lsp", "mlmg_lang.explaining", "mlmg_lang.planning", "mlmg_runtime.playing"):
        for found in walk_packages(import_module(package).__path__, f"{package}."):
            import_module(found.name)
    import_module("mlmg_lsp.features").warm()


def become_server(pipes: list[int], folder: str, words: list[str], environment: Mapping[str, str]) -> NoReturn:
    """Go on as `mlmg` with these words."""
    for number, pipe in enumerate(pipes):
        os.dup2(pipe, number)
        os.close(pipe)
    sys.stdin, sys.stdout = open(0, closefd=False), open(1, "w", closefd=False)  # noqa: SIM115
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    sys.exit(mlmg.main(words))


def wait(process: int, most_s: float) -> int | None:
    """Return the exit code of a server, negative if a signal has ended it; nothing if it has not ended in time."""
    until = time.monotonic() + most_s
    while True:
        ended, status = os.waitpid(process, os.WNOHANG)
        if ended or time.monotonic() >= until:
            return os.waitstatus_to_exitcode(status) if ended else None
        time.sleep(0.002)


if __name__ == "__main__":
    main()
