"""A table of a TOML file, whose values are checked as they are taken."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NoReturn

from mlmg_runtime.building.toml_files import TomlFile
from mlmg_runtime.building.toml_lines import KeyPath


@dataclass(frozen=True, slots=True)
class Table:
    """A table, and where in its file it stands.

    What takes a value out of it raises a `ConfigurationError` with the line if the value is not what it must be.
    """

    file: TomlFile
    at: KeyPath
    values: dict[str, Any]

    def __contains__(self, key: str) -> bool:
        """Return whether the table has a key."""
        return key in self.values

    def __iter__(self) -> Iterator[str]:
        """Go over the keys."""
        return iter(self.values)

    def get(self, key: str, default: Any) -> Any:
        """Return a value as it is."""
        return self.values.get(key, default)

    def fail(self, message: str, *below: str | int) -> NoReturn:
        """Raise a `ConfigurationError` about the table, or about what it has below some keys."""
        self.file.fail((*self.at, *below), message)

    def expect_keys(self, *keys: str) -> None:
        """Check that the table has no other keys."""
        self.file.check_keys(self.values, self.at, keys)

    def table(self, key: str) -> Table:
        """Return a table inside this one; empty where there is none."""
        value = self.get(key, {})
        if not isinstance(value, dict):
            self.fail(f"{key} must be a table, found {value!r}", key)
        return Table(self.file, (*self.at, key), value)

    def tables(self, key: str, default: list[dict[str, Any]], otherwise: str) -> list[Table]:
        """Return the tables of a `[[key]]`; `otherwise` is said where these are none."""
        value = self.get(key, default)
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            self.fail(otherwise, key)
        return [Table(self.file, (*self.at, key, index), item) for index, item in enumerate(value)]

    def text(self, key: str, default: str | None = None) -> str | None:
        """Return a text."""
        value = self.get(key, default)
        if value is not None and not isinstance(value, str):
            self.fail(f"{key} must be a text, found {value!r}", key)
        return value

    def texts(self, key: str, default: tuple[str, ...] = ()) -> tuple[str, ...]:
        """Return a list of texts."""
        value = self.get(key, list(default))
        if isinstance(value, str):
            self.fail(f'{key} must be a list of texts, as in ["{value}"], found a text alone', key)
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            self.fail(f"{key} must be a list of texts, found {value!r}", key)
        return tuple(value)

    def choice(self, key: str, choices: tuple[str, ...], default: str) -> str:
        """Return one of some texts."""
        value = self.text(key, default)
        if value not in choices:
            self.fail(f"{key} must be one of {', '.join(choices)}, found {value!r}", key)
        return str(value)


def is_number(value: object) -> bool:
    """Return whether a value is a finite number, and not `true` or `false`."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def composed(name: str) -> str:
    """Return a name in Unicode's composed form (NFC), in which names are compared."""
    return unicodedata.normalize("NFC", name)
