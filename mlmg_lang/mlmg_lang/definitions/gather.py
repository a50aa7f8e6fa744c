"""The syntax tree of a script -> all definitions that it can use: its own, and those of the files that it uses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

from mlmg_lang.definitions.parameters import Kind, Kinds, Signature, signatures
from mlmg_lang.diagnostics import Diagnostic, Note
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source
from mlmg_lang.spelling import normal

MAX_FILES = 100
"""The most files that a script may use, itself and by way of others."""

__all__ = ["Definitions", "Files", "Gathered", "Kind", "Kinds", "NoFiles", "Signature", "gather"]


class Files(Protocol):
    """Where used files are found."""

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return a file and what is wrong with its bytes; or, in words, why it cannot be used.

        Parameters
        ----------
        path : as written. user : the name of the file that it is written in.
        """


class NoFiles:
    """For texts that stand in no folder."""

    def find(self, path: str, user: str) -> str:
        """Return why there is no file."""
        return f"this text is not a file in a folder, from which `{path}` could be found"


@dataclass(frozen=True, slots=True)
class Definitions:
    """What the names mean that a script defines.

    Attributes
    ----------
    lets : by name, in NFC.
    signatures : by name, the parameters of those that can be used; those with mistakes have none.
    complete : False if a file with more of them could not be used.
    """

    lets: Mapping[str, syntax.Let]
    signatures: Mapping[str, Signature]
    complete: bool

    def find(self, name: syntax.Name) -> syntax.Let | None:
        """Return the definition of a name."""
        return self.lets.get(normal(name.text))


@dataclass(frozen=True, slots=True)
class Gathered:
    """Definitions, with the source that has the used files with it, and what is wrong with all this."""

    definitions: Definitions
    source: Source
    diagnostics: tuple[Diagnostic, ...]


def gather(source: Source, script: syntax.Script, files: Files) -> Gathered:
    """Return the definitions that a script can use. Whatever it says, this does not fail."""
    gatherer = _Gatherer(source, files)
    gatherer.use(script, source.name, ())
    lets = dict(gatherer.lets)
    found, wrong = signatures(lets)
    definitions = Definitions(lets, found, gatherer.complete)
    return Gathered(definitions, gatherer.source, (*gatherer.diagnostics, *wrong))


@dataclass(slots=True)
class _Gatherer:
    source: Source
    files: Files
    complete: bool = True
    lets: dict[str, syntax.Let] = field(default_factory=dict)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def use(self, script: syntax.Script, name: str, users: Sequence[str]) -> None:
        """Take the definitions of a file, and of the files that it uses."""
        self.diagnostics += self._defined(script)
        for item in script.items:
            if isinstance(item, syntax.Use) and item.path.sound:
                self._open(item, name, (*users, name))

    def _defined(self, script: syntax.Script) -> Iterator[Diagnostic]:
        """Take the definitions of one file; those in braces too, as these have been reported, and are used."""
        for item in _lets(script):
            if not item.name.sound:
                continue
            first = self.lets.setdefault(normal(item.name.text), item)
            if first is not item:
                message = f"`{item.name.text}` is defined twice"
                note = Note("it is defined here first", first.name.span)
                yield Diagnostic("MS050", message, item.name.span, "give one of them another name", (note,))

    def _open(self, use: syntax.Use, user: str, users: Sequence[str]) -> None:
        found = self.files.find(use.path.text, user)
        if isinstance(found, str):
            self._refuse(use, "MS058", found, 'name a file of definitions, as in `use "gestures.ms"`')
            return
        file, unreadable = found
        if file.name in users:
            circle = " -> ".join(f"`{name}`" for name in (*users[users.index(file.name) :], file.name))
            self._refuse(use, "MS059", f"these files use each other in a circle: {circle}", "take one `use` out")
        elif unreadable:
            self._refuse(use, "MS058", f"`{use.path.text}`: {unreadable[0].message}", unreadable[0].help)
        elif len(self.source.used) >= MAX_FILES:
            self._refuse(use, "MS058", f"a script may use at most {MAX_FILES} files", None)
        elif file.name not in {other.name for other in self.source.used}:
            base = self.source.end
            self.source = replace(self.source, used=(*self.source.used, file))
            parsed = parse(self.source, tokenize(self.source, base), base)
            self.diagnostics += parsed.diagnostics
            self.use(parsed.script, file.name, users)

    def _refuse(self, use: syntax.Use, code: str, message: str, advice: str | None) -> None:
        self.complete = False
        self.diagnostics.append(Diagnostic(code, message, use.path.span, advice))


def _lets(script: syntax.Script) -> Iterator[syntax.Let]:
    for item in script.items:
        for node in syntax.walk(item) if isinstance(item, syntax.Repeat | syntax.Choose) else (item,):
            if isinstance(node, syntax.Let):
                yield node
