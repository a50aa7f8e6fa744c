"""An explanation -> a flowchart in the language of Mermaid."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from mlmg_lang.explaining.explanation import Choose, Command, End, Explanation, Layer, Repeat, Statement, Wait
from mlmg_lang.explaining.wording import seconds, share
from mlmg_lang.rendering.wording import safe
from mlmg_lang.spelling import joined

_PLAIN = frozenset(" .,:=-/()%")
"""The signs that mean nothing to Mermaid within quotes."""


def render_mermaid(explanation: Explanation) -> str:
    """Return an explanation as a flowchart: a box for each statement, with what is likely taken, and how soon."""
    chart = _Chart()
    begin = chart.box([explanation.start, "at its first frame"], "([", "])")
    ends = chart.body(explanation.statements, [_Exit(begin)])
    end = chart.box([seconds(explanation.totals.takes), "in all"], "([", "])")
    chart.lead(ends, end)
    return "\n".join(["flowchart TD", *(f"  {line}" for line in chart.lines)]) + "\n"


@dataclass(frozen=True, slots=True)
class _Exit:
    """A box that something comes after, with what is written at the arrow."""

    box: str
    label: str = ""


@dataclass(slots=True)
class _Chart:
    lines: list[str] = field(default_factory=list)
    n_boxes: int = 0
    depth: int = 0

    def body(self, statements: Iterable[Statement], before: list[_Exit]) -> list[_Exit]:
        """Draw statements in a row; return what comes before the next."""
        for statement in statements:
            before = self._statement(statement, before)
        return before

    def box(self, texts: Sequence[str], opening: str = "[", closing: str = "]") -> str:
        """Draw a box with some lines of text; return its name."""
        name = f"s{self.n_boxes}"
        self.n_boxes += 1
        label = "<br/>".join(escaped(text) for text in texts)
        self._line(f'{name}{opening}"{label}"{closing}')
        return name

    def lead(self, before: Iterable[_Exit], box: str) -> None:
        """Draw the arrows to a box."""
        for one in before:
            label = f'|"{escaped(one.label)}"|' if one.label else ""
            self._line(f"{one.box} -->{label} {box}")

    def _statement(self, statement: Statement, before: list[_Exit]) -> list[_Exit]:
        match statement:
            case Repeat():
                return self._repeat(statement, before)
            case Choose():
                return self._choose(statement, before)
            case _:
                box = self.box(list(_texts(statement)))
                self.lead(before, box)
                return [_Exit(box)]

    def _repeat(self, repeat: Repeat, before: list[_Exit]) -> list[_Exit]:
        if not repeat.body or not repeat.count:
            return before
        self._open(f"repeat {repeat.count}, {seconds(repeat.once_through)} each time")
        first = self.box([f"line {repeat.place.line}", f"{repeat.count} times"], "{{", "}}")
        ends = self.body(repeat.body, [_Exit(first)])
        self.lead([_Exit(one.box, one.label or "again") for one in ends], first)
        self._close()
        self.lead(before, first)
        return ends

    def _choose(self, choose: Choose, before: list[_Exit]) -> list[_Exit]:
        if not choose.branches:
            return before
        self._open("choose")
        first = self.box([f"line {choose.place.line}", "draw one"], "{", "}")
        ends = []
        for branch in choose.branches:
            ends += self.body(branch.body, [_Exit(first, share(branch.chance))])
        self._close()
        self.lead(before, first)
        return ends

    def _open(self, title: str) -> None:
        self._line(f'subgraph g{self.n_boxes}["{escaped(title)}"]')
        self.depth += 1

    def _close(self) -> None:
        self.depth -= 1
        self._line("end")

    def _line(self, text: str) -> None:
        self.lines.append("  " * self.depth + text)


def _texts(statement: Command | Wait | End) -> Iterator[str]:
    """Yield the lines of a statement's box."""
    yield f"{statement.place.line}: {statement.text}"
    match statement:
        case Command():
            yield from map(_layer, statement.layers)
            for ending in statement.ends:
                yield f"ends {ending.graph}" + ("" if ending.chance >= 1.0 else f" in {share(ending.chance)}")
            arrives = (
                "arrives at once" if statement.arrives.most == 0 else f"arrives after {seconds(statement.arrives)}"
            )
            yield arrives if statement.duration.unit == "none" else f"{arrives}, lasts {seconds(statement.lasts)}"
        case Wait():
            yield f"lasts {seconds(statement.lasts)}"
        case End():
            yield f"takes {seconds(statement.arrives)}"


def _layer(layer: Layer) -> str:
    likely = sorted((one for one in layer.candidates if one.chance > 0), key=lambda one: -one.chance)
    told = [one.motion if one.chance >= 1.0 else f"{one.motion} ({share(one.chance)})" for one in likely[:4]]
    if len(likely) > len(told):
        told.append(f"{len(likely) - len(told)} more")
    return f"{layer.graph}: {joined(told, 'or') if told else 'cannot be foretold'}"


def escaped(text: str) -> str:
    """Return a text for a label in quotes; what Mermaid or HTML could act upon as the number of its character."""
    text = safe(text)
    return "".join(one if _is_plain(text, at) else _number(one) for at, one in enumerate(text))


def _number(character: str) -> str:
    """Return a character by its number; where two in a row would still be a sign of line's end or formula, apart."""
    return f"#{ord(character)};" + ("\u200b" if character in "\\$" else "")


def _is_plain(text: str, at: int) -> bool:
    """Return whether a character means nothing but itself; a `_` does so within a word."""
    one = text[at]
    if one == "_":
        return text[at - 1 : at].isalnum() and text[at + 1 : at + 2].isalnum()
    return one.isalnum() or one in _PLAIN or ord(one) > 127
