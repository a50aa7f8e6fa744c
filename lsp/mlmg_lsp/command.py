"""Serve editors by the language server protocol: diagnostics, completion, formatting, fixes.

Editors start it themselves and speak to it over standard input and output; docs/editors.md says how. With an address,
each client that connects there has a server of its own.

examples:
  mlmg lsp
  mlmg lsp --library my.mlmg
  mlmg lsp --tcp 127.0.0.1:4711
"""

from __future__ import annotations

import argparse
import sys
from typing import get_args

from mlmg_lang.commands.console import UsageError, add_use_option
from mlmg_lsp.positions import Encoding

_LOOPBACK = ("127.0.0.1", "localhost", "::1")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--stdio", action="store_true", help="over standard input and output, as without an option")
    way.add_argument("--tcp", metavar="HOST:PORT", help="wait for clients at an address of this machine")
    way.add_argument("--ws", metavar="HOST:PORT", help="the same, over web sockets")
    parser.add_argument(
        "--library",
        metavar="L.mlmg",
        help="the library of all scripts, whatever a client or an mlmg.toml says; demo is the demo library",
    )
    parser.add_argument(
        "--position-encoding",
        choices=get_args(Encoding),
        default="utf-16",
        help="what a client counts characters in that does not say so itself; the protocol has it that this is utf-16",
    )
    add_use_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Serve until the client, or a signal, ends it; return 1 if the client left without saying so."""
    import logging

    from mlmg_lsp import pipes, sockets
    from mlmg_lsp.libraries import Shelf
    from mlmg_lsp.memory import give_back
    from mlmg_lsp.server import MotionScriptServer
    from mlmg_lsp.transports import Server
    from mlmg_lsp.work import tell_unraisable
    from mlmg_lsp.workspace import Settings

    # It tells of each request that is cancelled, with a traceback.
    logging.getLogger("pygls").setLevel(logging.CRITICAL)
    # The thread that reads messages gets its turn sooner beside those that work.
    sys.setswitchinterval(0.001)
    sys.unraisablehook = tell_unraisable
    give_back()
    shelf = Shelf()
    settings = Settings(arguments.library, tuple(arguments.allow_use), arguments.position_encoding)

    def build() -> Server:
        return MotionScriptServer(settings, shelf)

    if arguments.tcp is None and arguments.ws is None:
        return pipes.serve_stdio(build)
    host, port = _address(arguments.tcp or arguments.ws)
    serve = sockets.serve_ws if arguments.tcp is None else sockets.serve_tcp
    return serve(build, host, port)


def _address(text: str) -> tuple[str, int]:
    """Return host and port.

    Raises
    ------
    UsageError
        If it is no address of this machine that only this machine can reach: who connects can read files.
    """
    host, _, port = text.rpartition(":")
    host = host.strip("[]") or _LOOPBACK[0]
    if not (port.isascii() and port.isdigit() and int(port) < 1 << 16):
        raise UsageError(f"expected an address as 127.0.0.1:4711, found {text!r}")
    if host not in _LOOPBACK:
        raise UsageError(f"{host}: only this machine may connect; expected one of {', '.join(_LOOPBACK)}")
    return host, int(port)
