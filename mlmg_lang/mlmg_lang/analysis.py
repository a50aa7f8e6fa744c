"""What is known of a script: made whole at once, or kept in pieces and put together when somebody asks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from mlmg_lang.catalog import Catalog
from mlmg_lang.definitions.gather import Definitions, Files
from mlmg_lang.diagnostics import Diagnostic, has_errors
from mlmg_lang.moving import by, moved
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

if TYPE_CHECKING:
    from mlmg_lang.planning.names import Names
    from mlmg_lang.planning.pieces import Piece, Placed, Played
    from mlmg_lang.planning.resolve import Resolution
    from mlmg_lang.planning.resolved import ResolvedPlan
    from mlmg_lang.planning.typed import TypedPlan


_UNUSED: Final = "MS054"
_UNKNOWN: Final = frozenset({"MS021", "MS025", "MS026", "MS027", "MS028"})
"""Names that mean nothing where they stand: what seems not to be used may be what they were to be."""


@dataclass(frozen=True, slots=True)
class Question:
    """What a script is analysed against; without a library there are no names."""

    catalog: Catalog | None
    names: Names | None
    start: str | None
    files: Files


@dataclass(frozen=True, slots=True)
class Found:
    """All that there is to say of a script, before it is known what of it is told.

    Attributes
    ----------
    read : of its text, names and types. played : of what it plays. hints : what to tell if nothing is wrong.
    """

    read: tuple[Diagnostic, ...]
    played: tuple[Diagnostic, ...] = ()
    hints: tuple[Diagnostic, ...] = ()

    @property
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


@dataclass(frozen=True, slots=True)
class Whole:
    """What the stages have made of a whole script. Without a library there is neither plan nor resolution."""

    source: Source
    tokens: tuple[Token, ...]
    script: syntax.Script
    expanded: syntax.Script
    plan: TypedPlan | None = None
    resolution: Resolution | None = None

    @property
    def playable(self) -> ResolvedPlan | None:
        """Return what is to be played, if nothing is wrong."""
        return None if self.resolution is None else self.resolution.plan


@dataclass(frozen=True)
class InPieces:
    """The same in pieces, of a script that defines nothing.

    Attributes
    ----------
    starts : where the pieces begin; last, where the script ends.
    played : as many as `pieces`; None without a library.
    start : the motion that the script starts in.
    serial : how many times pieces have changed.
    """

    source: Source
    pieces: Sequence[Piece]
    starts: Sequence[int]
    played: Sequence[Played] | None
    start: str
    serial: int

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """Return the tokens of the script."""
        return tuple(token for piece, at in self._placed() for token in _at(piece, piece.tokens, at))

    @cached_property
    def script(self) -> syntax.Script:
        """Return the syntax tree."""
        items = tuple(item for piece, at in self._placed() for item in _at(piece, piece.items, at))
        return syntax.Script(items, Span(0, len(self.source.text)))

    @property
    def expanded(self) -> syntax.Script:
        """Return the syntax tree again, as nothing is defined."""
        return self.script

    @cached_property
    def plan(self) -> TypedPlan | None:
        """Return the typed plan."""
        if self.played is None:
            return None
        from mlmg_lang.planning.typed import TypedPlan

        return TypedPlan(tuple(one for piece, at in self._placed() for one in _at(piece, piece.statements, at)))

    @cached_property
    def playable(self) -> ResolvedPlan | None:
        """Return what is to be played, if nothing is wrong."""
        if self.played is None:
            return None
        from mlmg_lang.planning.pieces import played_at
        from mlmg_lang.planning.resolved import ResolvedPlan

        placed = ((one, at, self.source.position(at)[0]) for one, at in zip(self.played, self.starts, strict=False))
        return ResolvedPlan(
            self.source, self.start, tuple(one for p, at, row in placed for one in played_at(p, at, row))
        )

    def _placed(self) -> Iterator[tuple[Piece, int]]:
        return zip(self.pieces, self.starts, strict=False)


def _at(piece: Piece, values: tuple[Placed, ...], start: int) -> tuple[Placed, ...]:
    """Return values of a piece as they are where it begins at an offset."""
    return values if piece.origin == start else moved(values, by(start - piece.origin))


def in_pieces(whole: Whole) -> InPieces:
    """Return a script that defines nothing in pieces."""
    from mlmg_lang.planning.pieces import pieces_of, played_of, starts_of

    statements = () if whole.plan is None else whole.plan.statements
    pieces = pieces_of(len(whole.source.text), whole.tokens, whole.script.items, statements)
    starts, played, start = starts_of(pieces), None, ""
    if whole.resolution is not None:
        played, start = played_of(pieces, starts, whole.resolution, whole.source), whole.resolution.plan.start
    return InPieces(whole.source, pieces, starts, played, start, 0)


@dataclass(frozen=True)
class Analysis:
    """What each stage has made of a script.

    Attributes
    ----------
    source : the script; with it the files that it uses.
    definitions : what the names mean that it defines.
    diagnostics : in the order of the text.
    question, found, made : what it was analysed against, and what came of it, for the next analysis.
    """

    source: Source
    definitions: Definitions
    diagnostics: tuple[Diagnostic, ...]
    question: Question
    found: Found
    made: Whole | InPieces

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
        return self.made.plan

    @property
    def resolved(self) -> ResolvedPlan | None:
        """Return what is to be played; None without a library, or if there are errors."""
        return None if self.found.wrong else self.made.playable

    @cached_property
    def pieces(self) -> InPieces:
        """Return the script in pieces; it must define nothing."""
        return self.made if isinstance(self.made, InPieces) else in_pieces(self.made)
