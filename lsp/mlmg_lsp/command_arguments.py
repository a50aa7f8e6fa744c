"""The arguments of a command of workspace/executeCommand -> what it is about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcException, JsonRpcInvalidParams

from mlmg_lsp.open_text import path_of


class Refused(JsonRpcException):
    """What cannot be done, and why, in words for the person."""

    CODE = types.LSPErrorCodes.RequestFailed.value


@dataclass(frozen=True, slots=True)
class CommandArguments:
    """What a command is about.

    Attributes
    ----------
    uri : of the script; empty for a command that is about none.
    position : of a statement in it.
    to : the BVH to write; None if the script says where. chosen : whether the person has chosen that file.
    report : what is to tell of it, if anything.
    shown : whether the person is to be shown what comes of it; else it is only answered.
    code : of a diagnostic.
    """

    uri: str = ""
    position: types.Position | None = None
    to: Path | None = None
    report: Path | None = None
    shown: bool = True
    code: str = ""
    chosen: bool = False


def arguments_from(arguments: Sequence[Any] | None) -> CommandArguments:
    """Return what a command is about: an object, or the URI of a script alone.

    Raises
    ------
    JsonRpcInvalidParams
        If it says neither which script nor which diagnostic it is about, or a file to write has no path.
    """
    first = (arguments or [None])[0]
    said: Mapping[str, Any] = first if isinstance(first, Mapping) else {"uri": first}
    uri, code = _text(said, "uri"), _text(said, "code")
    if not (uri or code):
        raise JsonRpcInvalidParams('expected an argument such as {"uri": "file:///stroll.ms"}')
    to, report, shown = _path(said, "to"), _path(said, "report"), said.get("shown") is not False
    return CommandArguments(uri, _position(said), to, report, shown, code, chosen=to is not None)


def _text(said: Mapping[str, Any], name: str) -> str:
    value = said.get(name)
    return value if isinstance(value, str) else ""


def _position(said: Mapping[str, Any]) -> types.Position | None:
    place = said.get("position")
    numbers = [place.get(name) for name in ("line", "character")] if isinstance(place, Mapping) else []
    line, character = numbers if len(numbers) == 2 else (None, None)
    is_place = isinstance(line, int) and isinstance(character, int) and min(line, character) >= 0
    return types.Position(line, character) if is_place else None  # type: ignore[arg-type]


def _path(said: Mapping[str, Any], name: str) -> Path | None:
    uri = _text(said, name)
    path = path_of(uri)
    if uri and path is None:
        raise JsonRpcInvalidParams(f"`{name}` should be the URI of a file, found {uri!r}")
    return path
