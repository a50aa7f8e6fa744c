"""What is known of a script: kept in pieces, and put together when somebody asks."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Final, TypeVar

from mlmg_lang.blocks import Statement
from mlmg_lang.catalog import Catalog
from mlmg_lang.chunks import Chunks, all_of
from mlmg_lang.definitions.gather import Definitions, Files, Gathered
from mlmg_lang.diagnostics import Diagnostic, has_errors
from mlmg_lang.moving import moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece
from mlmg_lang.places import Addressed, Places
from mlmg_lang.source import Source, Span

if TYPE_CHECKING:
    from mlmg_lang.planning import resolved
    from mlmg_lang.planning.flow import State
    from mlmg_lang.planning.names import Names
    from mlmg_lang.planning.resolution import Resolution
    from mlmg_lang.planning.resolve_again import Played
    from mlmg_lang.planning.resolved import ResolvedPlan
    from mlmg_lang.planning.typed import TypedPlan

T = TypeVar("T")
_LATER: Final = re.compile(r"(?<=^what line )\d+")
"""In the words of what a later command has ruled out, the number of its line."""


_UNUSED: Final = "MS054"
_UNKNOWN: Final = frozenset({"MS021", "MS025", "MS026", "MS027", "MS028"})
"""Names that mean nothing where they stand: what seems not to be used may be what they were to be."""


@dataclass(frozen=True, slots=True)
class Question:
    """What a text is analysed against; without a library there are no names.

    Attributes
    ----------
    start : the motion of the root graph to start in; without it, the script or the library says which.
    files : where the files are found that the text uses.
    state : what is playing already; None if the text is what the character starts with.
    """

    catalog: Catalog | None
    names: Names | None
    start: str | None
    files: Files
    state: State | None = None


@dataclass(frozen=True)
class Found:
    """All that there is to say of a script, before it is known what of it is told.

    Attributes
    ----------
    read : of its text, names and types. played : of what it plays. hints : what to tell if nothing is wrong.
    """

    read: tuple[Diagnostic, ...]
    played: tuple[Diagnostic, ...] = ()
    hints: tuple[Diagnostic, ...] = ()

    @cached_property
    def wrong(self) -> bool:
        """Return whether the script cannot be played."""
        return has_errors(self.read) or has_errors(self.played)

    @property
    def told(self) -> tuple[Diagnostic, ...]:
        """Return what is to be told as long as no comment asks for silence."""
        read = self.read
        if any(one.code in _UNKNOWN for one in read):
            read = tuple(one for one in read if one.code != _UNUSED)
        return (*read, *self.played, *(() if self.wrong else self.hints))


@dataclass(frozen=True)
class InPieces:
    """A script in pieces.

    Attributes
    ----------
    source : with the files that it uses.
    places : its pieces, and where addresses are now.
    defined : what is wrong with its definitions.
    untold : says where mistakes begin that are not told, if there are too many.
    room : the first address that nothing has had.
    unused : says which definitions are not used.
    start : the motion that it starts in; empty without a library.
    resolution : what it plays, if all of it was resolved together.
    played : else, what each of `pieces` plays; none without a library.
    keys : by line, those of its steps; none without a library, or if all was resolved together.
    serial : how many times pieces have changed; until they do, addresses are offsets.
    """

    source: Source
    places: Places
    gathered: Gathered
    defined: tuple[Diagnostic, ...]
    untold: tuple[Diagnostic, ...]
    room: int
    unused: tuple[Diagnostic, ...] = ()
    start: str = ""
    resolution: Resolution | None = None
    played: Chunks[Played] = field(default_factory=Chunks)
    keys: Chunks[range] = field(default_factory=Chunks)
    serial: int = 0

    @property
    def lines(self) -> Chunks[Piece]:
        """Return its logical lines: the pieces one after the other, those in blocks too."""
        return self.places.lines

    @property
    def pieces(self) -> Chunks[Statement]:
        """Return those of them that stand in no block, and the blocks whole."""
        return self.places.pieces

    def edited(self, source: Source, lines: Chunks[Piece], size: int) -> InPieces:
        """Return another text in pieces, for which addresses have been taken; what they mean is not known yet."""
        return replace(
            self.with_lines(lines),
            source=replace(source, used=self.source.used),
            room=self.room + size + 1,
            serial=self.serial + 1,
        )

    def using(self, gathered: Gathered) -> InPieces:
        """Return it with other definitions, those of the files that it uses from the first address that is free."""
        further = gathered.source.end - len(self.source.text) - 1
        places = replace(self.places, files=range(self.room, self.room + further))
        return replace(self, source=gathered.source, gathered=gathered, places=places, room=self.room + further + 1)

    def with_lines(self, lines: Chunks[Piece]) -> InPieces:
        """Return it with other lines; which blocks lie across them is not known yet."""
        return self.with_pieces(lines, lines)

    def with_pieces(self, pieces: Chunks[Statement], lines: Chunks[Piece]) -> InPieces:
        """Return it with other pieces."""
        return replace(self, places=Places(pieces, lines, self.places.files))

    @property
    def addressed(self) -> Source:
        """Return the source for those who ask with addresses."""
        return Addressed(self.source.text, self.source.name, self.source.used, places=self.places)

    def now(self, value: T) -> T:
        """Return a value with offsets in place of addresses."""
        return moved(value, self.places) if self.serial else value

    @cached_property
    def definitions(self) -> Definitions:
        """Return what the names mean that it defines."""
        kept = self.gathered.definitions
        return replace(kept, lets={name: self.now(let) for name, let in kept.lets.items()})

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """Return the tokens of the script."""
        return self.now(tuple(all_of(self.lines, "tokens")))

    @cached_property
    def script(self) -> syntax.Script:
        """Return the syntax tree."""
        return self._script(tuple(all_of(self.pieces, "items")))

    @cached_property
    def expanded(self) -> syntax.Script:
        """Return the syntax tree with what its definitions say in place of their names."""
        if all(line.expanded is line.items for line in self.lines):
            return self.script
        return self._script(tuple(all_of(self.pieces, "expanded")))

    def _script(self, items: tuple[syntax.Item, ...]) -> syntax.Script:
        return syntax.Script(self.now(items), Span(0, len(self.source.text)))

    @cached_property
    def plan(self) -> TypedPlan:
        """Return the typed plan."""
        from mlmg_lang.planning.typed import TypedPlan

        return TypedPlan(self.now(tuple(all_of(self.pieces, "statements"))))

    @cached_property
    def playable(self) -> ResolvedPlan:
        """Return what is to be played, if nothing is wrong."""
        if self.resolution is not None:
            return self.resolution.plan
        from mlmg_lang.planning.resolved import ResolvedPlan

        parts = enumerate(self.played)
        row = self.places.row
        now = (on_lines(one, row(at) - played.row) for at, played in parts for one in played.statements)
        return ResolvedPlan(self.source, self.start, self.now(tuple(now)))


@dataclass(frozen=True)
class Analysis:
    """What each stage has made of a script.

    Attributes
    ----------
    diagnostics : in the order of the text.
    question, found, made : what it was analysed against, and what came of it, for the next analysis.
    """

    diagnostics: tuple[Diagnostic, ...]
    question: Question
    found: Found
    made: InPieces

    @property
    def source(self) -> Source:
        """Return the script; with it the files that it uses."""
        return self.made.source

    @property
    def definitions(self) -> Definitions:
        """Return what the names mean that it defines."""
        return self.made.definitions

    @property
    def tokens(self) -> tuple[Token, ...]:
        """Return the tokens, comments and line ends too."""
        return self.made.tokens

    @property
    def script(self) -> syntax.Script:
        """Return the script as it is written."""
        return self.made.script

    @property
    def expanded(self) -> syntax.Script:
        """Return the script with what its definitions say in place of their names."""
        return self.made.expanded

    @property
    def plan(self) -> TypedPlan | None:
        """Return the script with its types; None without a library."""
        return None if self.question.catalog is None else self.made.plan

    @property
    def resolved(self) -> ResolvedPlan | None:
        """Return what is to be played; None without a library, or if there are errors."""
        return None if self.question.catalog is None or self.found.wrong else self.made.playable

    @cached_property
    def ready(self) -> InPieces:
        """Return the script with what an edit needs to know of each piece, which takes a while the first time."""
        return _ready(self.made, self.question)


def _ready(made: InPieces, question: Question) -> InPieces:
    if made.resolution is None or question.names is None or question.catalog is None:
        return made
    from mlmg_lang.planning.resolve_again import Player, keyed

    keys = keyed(made.lines)
    player = Player(made.places, keys, (question.names, question.catalog), made.source, made.start)
    return replace(made, resolution=None, played=player.played(made.resolution), keys=keys)


def on_lines(statement: resolved.Statement, further: int) -> resolved.Statement:
    """Return a statement as it is when all lines that it tells of stand further down."""
    from mlmg_lang.planning import resolved

    match statement:
        case resolved.Command(layers) if further:
            return replace(statement, layers=tuple(_layer_on_lines(layer, further) for layer in layers))
        case resolved.Repeat(body=body) if further:
            return replace(statement, body=tuple(on_lines(one, further) for one in body))
        case resolved.Choose(branches) if further:
            bodies = [tuple(on_lines(one, further) for one in branch.body) for branch in branches]
            kept = [replace(branch, body=body) for branch, body in zip(branches, bodies, strict=True)]
            return replace(statement, branches=tuple(kept))
    return statement


def _layer_on_lines(layer: resolved.Layer, further: int) -> resolved.Layer:
    left_out = (
        replace(one, because=_LATER.sub(lambda found: str(int(found[0]) + further), one.because))
        for one in layer.left_out
    )
    return replace(layer, left_out=tuple(left_out))
