"""TOML files that people write: read with the line of every key, and what to say of a word that means nothing."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NoReturn

from mlmg_runtime.building.toml_lines import KeyPath, key_lines
from mlmg_runtime.errors import ConfigurationError
from mlmg_runtime.library_file import SQLITE

_PLAINER: Final[Mapping[str, str]] = MappingProxyType(
    {
        "Cannot overwrite a value": "this key or table has been given before",
        "Invalid value": "expected a value: a text stands in double quotes, a list in [ ]",
        "Invalid statement": "expected `key = value` or a [table]",
    }
)
"""What the parser says of the commonest mistakes, and what that means."""


@dataclass(frozen=True, slots=True)
class TomlFile:
    """A parsed file; `lines` tells where each table and key stands."""

    path: Path
    document: dict[str, Any]
    lines: Mapping[KeyPath, int]

    def fail(self, at: KeyPath, message: str) -> NoReturn:
        """Raise a `ConfigurationError` about a key, with the line of it, or of what is nearest to it."""
        inside = min((line for path, line in self.lines.items() if path[: len(at)] == at), default=None)
        above = (self.lines[at[:length]] for length in range(len(at) - 1, 0, -1) if at[:length] in self.lines)
        raise ConfigurationError(self.path, inside if inside is not None else next(above, None), message)

    def check_keys(self, table: Mapping[str, Any], at: KeyPath, keys: Iterable[str]) -> None:
        """Raise a `ConfigurationError` if a table holds another key than these."""
        expected = list(keys)
        for key in table:
            if key not in expected:
                few = "expected" if len(expected) == 1 else "expected one of"
                message = f"unknown key `{key}`; {few} {', '.join(expected)}{did_you_mean(key, expected)}"
                self.fail((*at, key), message)


def read_toml(path: Path) -> TomlFile:
    """Read a TOML file; a byte order mark is left out.

    Raises
    ------
    ConfigurationError
        With the line, if the file is not UTF-8 or not TOML.
    OSError
        If it cannot be opened.
    """
    data = path.read_bytes()
    if data.startswith(SQLITE):
        message = "a library that has been built already, not a configuration; a configuration is a TOML file"
        raise ConfigurationError(path, None, message)
    try:
        text = data.decode("utf-8-sig")
        return TomlFile(path, tomllib.loads(text), key_lines(text))
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        message = "found bytes that are not UTF-8; a configuration is a UTF-8 text"
        raise ConfigurationError(path, line, message) from None
    except RecursionError:
        raise ConfigurationError(path, None, "too many brackets stand inside each other") from None
    except tomllib.TOMLDecodeError as error:
        what, _, where = str(error).rpartition(" (at ")
        number = where.removeprefix("line ").split(",")[0]
        line = int(number) if number.isdigit() else len(text.splitlines())
        told = _PLAINER.get(what, what or str(error))
        raise ConfigurationError(path, line, f"not valid TOML: {told}") from None


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean `...`?" with the known name that is most like one, whatever its case; or nothing."""
    folded: dict[str, str] = {}
    for other in known:
        folded.setdefault(other.casefold(), other)
    near = get_close_matches(name.casefold(), folded, n=1)
    return f"; did you mean `{folded[near[0]]}`?" if near else ""
