"""What a character did for an entry -> lines that a person can read, and data for a program."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from mlmg_lang.diagnostics import Diagnostic, has_errors
from mlmg_lang.explaining.explanation import Event
from mlmg_lang.explaining.tree import table
from mlmg_lang.rendering import render_full
from mlmg_lang.rendering.colour import BLUE, DIM, Painter
from mlmg_lang.rendering.json_list import entries_of
from mlmg_lang.rendering.wording import safe
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.reply import Reply
from mlmg_lang.session.answer import Answer, Deed
from mlmg_lang.source import Source

MOST_DEEDS: Final = 12
"""So many statements of one entry are told of; a loop may execute many more."""
_RED: Final = "31"


@dataclass(frozen=True, slots=True)
class Telling:
    """How to tell of answers.

    Attributes
    ----------
    blend_s : by graph, how long one of its transitions lasts, in seconds.
    """

    blend_s: Mapping[str, float]
    colour: bool = False

    def reply(self, answer: Answer) -> Reply:
        """Return the reply to an entry."""
        ok = answer.problem is None and not has_errors(answer.diagnostics)
        return Reply("".join(self._lines(answer)), self._data(answer), ok)

    def _lines(self, answer: Answer) -> Iterator[str]:
        if answer.diagnostics:
            yield render_full(answer.diagnostics, answer.source, self.colour)
        if answer.problem is not None:
            yield f"{Painter(self.colour)('error', _RED)}: {safe(answer.problem)}\n"
        for deed in answer.deeds[:MOST_DEEDS]:
            if len(answer.deeds) > 1:
                yield f"  {Painter(self.colour)(safe(deed.text), BLUE)}\n"
            yield from (f"  {line}\n" for line in self._deed(deed))
        if len(answer.deeds) > MOST_DEEDS:
            yield f"  ... and {len(answer.deeds) - MOST_DEEDS} more\n"
        if answer.deeds and answer.n_seconds is not None:
            yield f"  {answer.n_seconds:.1f} s of motion\n"

    def _deed(self, deed: Deed) -> Iterator[str]:
        """Yield, for each graph, what it plays and how it came there; those that were only ended come last."""
        went, paint = deed.went, Painter(self.colour)
        told = {one.graph: one.motion for one in went.taken}
        for graph in dict.fromkeys((*told, *(event.graph for event in went.events))):
            events = [event for event in went.events if event.graph == graph]
            yield f"{paint(graph, BLUE)}  {self._arrival(told.get(graph), graph, went.begin_s, events)}"
            yield from (f"    {paint(line, DIM)}" for line in table(_row(event, went.begin_s) for event in events))
        if went.lasted_s:
            yield f"then {went.lasted_s:.1f} s" if told else f"{went.lasted_s:.1f} s pass"

    def _arrival(self, motion: str | None, graph: str, begin_s: float, events: list[Event]) -> str:
        if motion is None:
            after = f" after {events[-1].begin_s + self.blend_s[graph] - begin_s:.1f} s" if events else ""
            return f"goes with the body again{after}"
        if not events:
            return f"{motion}, as it was"
        # Loops after the last of these are what the graph plays while others are still on their way.
        into = [event for event in events if event.target is None or event.source[0] != event.target[0]] or events
        return f"{motion} after {into[-1].begin_s + self.blend_s[graph] - begin_s:.1f} s"

    def _data(self, answer: Answer) -> dict[str, Any]:
        return {
            "diagnostics": entries_of(answer.source, answer.diagnostics),
            "problem": answer.problem,
            "statements": [_deed_data(deed) for deed in answer.deeds],
            "seconds": answer.n_seconds,
        }


def telling_of(desk: Desk) -> Telling:
    """Return what tells of the answers of a session."""
    library = desk.session.library
    return Telling({name: own.window / library.frame_rate for name, own in library.by_name.items()}, desk.colour)


def refused_by_compiler(desk: Desk, source: Source, diagnostics: tuple[Diagnostic, ...]) -> Reply:
    """Return the reply that a text has mistakes."""
    data = {"diagnostics": entries_of(source, diagnostics)}
    return Reply(render_full(diagnostics, source, desk.colour), data, ok=False)


def _row(event: Event, begin_s: float) -> tuple[str, ...]:
    target = "the body" if event.target is None else f"{event.target[0]}:{event.target[1]}"
    how = f"cost {event.cost:.2f}" if event.cost is not None else "a blend on the spot"
    return f"+{event.begin_s - begin_s:.1f} s", f"{event.source[0]}:{event.source[1]} -> {target}", how


def _deed_data(deed: Deed) -> dict[str, Any]:
    went = deed.went
    return {
        "text": deed.text,
        "begin": went.begin_s,
        "arrive": round(went.begin_s + went.arrived_s, 3),
        "end": round(went.begin_s + went.arrived_s + went.lasted_s, 3),
        "cost": went.cost,
        "motions": {one.graph: one.motion for one in went.taken},
        "transitions": [
            {"graph": e.graph, "kind": e.what, "begin": e.begin_s, "from": e.source, "to": e.target, "cost": e.cost}
            for e in went.events
        ],
    }
