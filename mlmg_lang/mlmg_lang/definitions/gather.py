"""The syntax tree of a script -> all definitions that it can use: its own, and those of the files that it uses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, runtime_checkable

from mlmg_lang.definitions.parameters import Kind, Kinds, Signature, signatures
from mlmg_lang.diagnostics import Diagnostic, Note
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.parse import parse
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import normal

MAX_FILES = 100
"""The most files that a script may use, itself and by way of others."""

__all__ = [
    "Definitions",
    "Files",
    "Gathered",
    "Kind",
    "Kinds",
    "Listing",
    "NoFiles",
    "Signature",
    "Used",
    "gather",
    "gather_with",
]


class Files(Protocol):
    """Where used files are found."""

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return a file and what is wrong with its bytes; or, in words, why it cannot be used.

        Parameters
        ----------
        path : as written. user : the name of the file that it is written in.
        """


@runtime_checkable
class Listing(Protocol):
    """Where it can be told which files there are to use."""

    def paths(self, begun: str, user: str) -> Sequence[str]:
        """Return the paths that the beginning of one could become.

        Parameters
        ----------
        user : the name of the file that it is written in.
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
    signatures : by name, the parameters of those that can be used; those with mistakes, in their text too, have none.
    complete : False if a file with more of them could not be used, or one cannot be told by its name.
    unread : the names, in NFC, of those that could not be read.
    """

    lets: Mapping[str, syntax.Let]
    signatures: Mapping[str, Signature]
    complete: bool
    unread: frozenset[str] = frozenset()

    def find(self, name: syntax.Name) -> syntax.Let | None:
        """Return the definition of a name."""
        return self.lets.get(normal(name.text))


@dataclass(frozen=True, slots=True)
class Used:
    """The files that a script uses, itself and by way of others, with what is wrong with them.

    Attributes
    ----------
    source : the script, with these files.
    complete : False if one could not be used.
    earlier : the files that came with the source: of their definitions the last of a name holds.
    named : by the place of a path, the name of the file that it leads to.
    """

    source: Source
    scripts: tuple[syntax.Script, ...]
    complete: bool
    diagnostics: tuple[Diagnostic, ...]
    earlier: tuple[syntax.Script, ...] = ()
    named: Mapping[Span, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Gathered:
    """Definitions, with the files that some of them are from, and what is wrong with all this."""

    definitions: Definitions
    used: Used
    diagnostics: tuple[Diagnostic, ...]

    @property
    def source(self) -> Source:
        """Return the script, with the files that it uses."""
        return self.used.source


def gather(source: Source, script: syntax.Script, files: Files, base: int | None = None) -> Gathered:
    """Return the definitions that a script can use. Whatever it says, this does not fail.

    Parameters
    ----------
    source : with files, if there are any, whose definitions can be used without saying so.
    base : where places in the files begin that it uses, the first in all of them; None if that is behind the source.
    """
    opener = _Opener(source, files, source.end if base is None else base)
    opener.use_given()
    n_earlier = len(opener.scripts)
    opener.use(script, source.name, ())
    earlier, scripts = tuple(opener.scripts[:n_earlier]), tuple(opener.scripts[n_earlier:])
    used = Used(opener.source, scripts, opener.complete, tuple(opener.diagnostics), earlier, opener.named)
    return gather_with(script, used)


def gather_with(script: syntax.Script, used: Used) -> Gathered:
    """Return the definitions of a script that uses these files; they take the place of earlier ones."""
    earlier = {normal(item.name.text): item for part in used.earlier for item in _lets(part) if item.name.sound}
    own: dict[str, syntax.Let] = {}
    twice = [one for part in (script, *used.scripts) for one in _defined(part, own)]
    lets = earlier | own
    found, wrong = signatures(lets)
    found = {name: signature for name, signature in found.items() if not lets[name].mended}
    parts = (*used.earlier, script, *used.scripts)
    broken = [item for part in parts for item in part.items if isinstance(item, syntax.BrokenDefinition)]
    unread = frozenset(normal(name) for item in broken for name in item.names) - lets.keys()
    complete = used.complete and all(item.names for item in broken)
    return Gathered(Definitions(lets, found, complete, unread), used, (*used.diagnostics, *twice, *wrong))


def _defined(script: syntax.Script, lets: dict[str, syntax.Let]) -> Iterator[Diagnostic]:
    """Take the definitions of one file; those in braces too, as these have been reported, and are used."""
    for item in _lets(script):
        if not item.name.sound:
            continue
        first = lets.setdefault(normal(item.name.text), item)
        if first is not item:
            message = f"`{item.name.text}` is defined twice"
            note = Note("it is defined here first", first.name.span)
            yield Diagnostic("MS050", message, item.name.span, "give one of them another name", (note,))


@dataclass(slots=True)
class _Opener:
    """Opens the files that are used; for its values see `Used`. `base`: where places in the next begin."""

    source: Source
    files: Files
    base: int
    complete: bool = True
    scripts: list[syntax.Script] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    named: dict[Span, str] = field(default_factory=dict)

    def use_given(self) -> None:
        """Take the files that came with the source, and open those that they use."""
        for file in self.source.used:
            base = self.source.base(file)
            script = parse(self.source, tokenize(self.source, base), base).script
            self.scripts.append(script)
            self.use(script, file.name, ())

    def use(self, script: syntax.Script, name: str, users: Sequence[str]) -> None:
        """Open the files that a file uses, and those that they use."""
        for item in script.items:
            if isinstance(item, syntax.Use) and item.path.sound:
                self._open(item, name, (*users, name))
            elif isinstance(item, syntax.Use):
                self.complete = False

    def _open(self, use: syntax.Use, user: str, users: Sequence[str]) -> None:
        found = self.files.find(use.path.text, user)
        if isinstance(found, str):
            self._refuse(use, "MS058", found, 'name a file of definitions, as in `use "gestures.ms"`')
            return
        file, unreadable = found
        self.named[use.path.span] = file.name
        if file.name in users:
            circle = " -> ".join(f"`{name}`" for name in (*users[users.index(file.name) :], file.name))
            self._refuse(use, "MS059", f"these files use each other in a circle: {circle}", "take one `use` out")
        elif unreadable:
            self._refuse(use, "MS058", f"`{use.path.text}`: {unreadable[0].message}", unreadable[0].help)
        elif len(self.source.used) >= MAX_FILES:
            self._refuse(use, "MS058", f"a script may use at most {MAX_FILES} files", None)
        elif file.name not in {other.name for other in self.source.used}:
            alone = Source(file.text, file.name)
            parsed = moved(parse(alone, tokenize(alone)), by(self.base))
            self.source = replace(self.source, used=(*self.source.used, file))
            self.base += len(file.text) + 1
            self.diagnostics += parsed.diagnostics
            self.scripts.append(parsed.script)
            self.use(parsed.script, file.name, users)

    def _refuse(self, use: syntax.Use, code: str, message: str, advice: str | None) -> None:
        self.complete = False
        self.diagnostics.append(Diagnostic(code, message, use.path.span, advice))


def _lets(script: syntax.Script) -> Iterator[syntax.Let]:
    for item in script.items:
        for node in syntax.walk(item) if isinstance(item, syntax.Repeat | syntax.Choose) else (item,):
            if isinstance(node, syntax.Let):
                yield node
