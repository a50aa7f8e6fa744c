"""Pieces of a script -> what they mean, and what is wrong with their names and types: what is defined is put in."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING

from mlmg_lang.analysis import Question
from mlmg_lang.chunks import Chunks
from mlmg_lang.definitions.expand import Expander
from mlmg_lang.definitions.gather import Gathered
from mlmg_lang.diagnostics import Diagnostic, Severity, n_errors
from mlmg_lang.following import without_following
from mlmg_lang.parsing.case import guess_case
from mlmg_lang.parsing.parse import MAX_MISTAKES
from mlmg_lang.parsing.structure import check_definition, check_structure, misplaced
from mlmg_lang.parsing.syntax import Item, Let, Script, Use
from mlmg_lang.pieces import Piece
from mlmg_lang.source import Source, Span

if TYPE_CHECKING:
    from mlmg_lang.planning import typed
    from mlmg_lang.planning.plan import Planner


class Reader:
    """Finds out what pieces mean, one after the other."""

    def __init__(self, question: Question, gathered: Gathered, source: Source) -> None:
        """Take what is defined, and the text that addresses in pieces are of."""
        self._question = question
        self._source = source
        self._gathered = gathered
        self._expander = Expander(gathered.definitions)
        self._own = tuple(let.name.text for let in gathered.definitions.lets.values())
        self._frame_rate = None if question.catalog is None else question.catalog.frame_rate
        self._planners = {explains: self._new_planner(explains) for explains in (True, False)}

    def _new_planner(self, explains: bool = True) -> Planner | None:
        if self._question.names is None or self._frame_rate is None:
            return None
        from mlmg_lang.planning.plan import Planner

        definitions, names = self._gathered.definitions, self._question.names
        return Planner(definitions, names, self._frame_rate, self._source, explains=explains)

    def defined(self) -> tuple[Diagnostic, ...]:
        """Return what is wrong with the definitions."""
        lets = self._gathered.definitions.lets.values()
        structural = (one for let in lets for one in check_definition(let, self._frame_rate))
        planner = self._new_planner()
        if planner is not None:
            planner.define(self._gathered.definitions)
        return (*self._gathered.diagnostics, *structural, *(() if planner is None else planner.diagnostics))

    def all_understood(self, lines: Chunks[Piece], numbers: Collection[int]) -> dict[int, Piece]:
        """Return what some pieces are with what they mean; and others, as they may be told of now, or no longer.

        When as many mistakes in names have been told as anybody reads, what is wrong with the next is not worked out.
        """
        done: dict[int, Piece] = {}
        n_told = 0
        for at in sorted({*lines.where("is_faulty"), *numbers}):
            line, tells = lines[at], n_told <= MAX_MISTAKES
            if at in numbers or (line.n_named >= 0) is not tells:
                line = done[at] = self._understood(line, tells)
            n_told += max(line.n_named, 0)
        return done

    def _understood(self, piece: Piece, tells: bool) -> Piece:
        """Return a piece with what it means; `tells`: and with what is wrong with its names, not hints alone."""
        script = Script(piece.items, Span(piece.address, piece.address + piece.size))
        expanded, n_nodes, said = self._expanded(piece)
        said += misplaced(script) if piece.defining else ()
        known = self._gathered.definitions
        said += check_structure(
            replace(script, items=expanded), self._frame_rate, known.complete, self._own, known.unread
        )
        statements: tuple[typed.Statement, ...] = ()
        planner, is_faulty, n_named = self._planners[tells], False, 0
        if planner is None:
            said += guess_case(script)
        else:
            statements = planner.body(expanded)
            is_faulty, named = planner.take()
            n_named = n_errors(named) if tells else -is_faulty
            said += (one for one in named if tells or one.severity is not Severity.ERROR)
        told = without_following(said, piece.misread, piece.items) if piece.misread else said
        understood = replace(
            piece,
            expanded=expanded,
            n_nodes=n_nodes,
            statements=statements,
            said=tuple(told),
            retold=None,
            is_faulty=is_faulty,
            n_named=n_named,
        )
        return replace(understood, retold=self._retold(understood)) if understood.told else understood

    def _retold(self, piece: Piece) -> tuple[Diagnostic, ...] | None:
        """Return what is wrong with a piece if it is told otherwise, as there are spaces in names; else None."""
        names = self._question.names
        if names is None:
            return None
        # Imported here, as sound scripts, which are most, do not need it.
        from mlmg_lang.planning.binding.apart import told_of_names

        retold = told_of_names(piece.told, piece.tokens, names)
        return None if retold == piece.told else retold

    def _expanded(self, piece: Piece) -> tuple[tuple[Item, ...], int, list[Diagnostic]]:
        """Return what a piece says with what is defined put in, how large that has made it, and what is wrong."""
        if not self._gathered.definitions.lets:
            if not piece.defining:
                return piece.items, 0, []
            return tuple(item for item in piece.items if not isinstance(item, Let | Use)), 0, []
        before, n_nodes = len(self._expander.diagnostics), self._expander.all_nodes
        items = self._expander.body(piece.items)
        said = self._expander.diagnostics[before:]
        return items if items != piece.items else piece.items, self._expander.all_nodes - n_nodes, said
