"""Diagnostics -> drawings for a person: each with its lines, and what is meant underlined."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.rendering.colour import BLUE, BOLD, SEVERITIES, Painter
from mlmg_lang.rendering.picture import Mark, last_line, picture
from mlmg_lang.rendering.wording import head, place, safe
from mlmg_lang.source import Source, Span


def render_full(diagnostics: Iterable[Diagnostic], source: Source, colour: bool = False) -> str:
    """Return diagnostics with their lines drawn and underlined, an empty line between them."""
    paint = Painter(colour)
    return "\n".join("\n".join(_drawn(one, source, paint)) + "\n" for one in diagnostics)


@dataclass(frozen=True, slots=True)
class _Scene:
    """The places in one file that are drawn together.

    Attributes
    ----------
    begin : the offset that the file begins with.
    """

    file: Source
    begin: int
    marks: list[Mark]


def _drawn(one: Diagnostic, source: Source, paint: Painter) -> Iterator[str]:
    """Yield the lines of one diagnostic."""
    colour = SEVERITIES[one.severity]
    scenes = _scenes(one, source, (BOLD, colour))
    edge = " " * (max((len(str(last_line(scene.file, scene.marks))) for scene in scenes), default=0) + 2)
    yield f"{paint(head(one), BOLD, colour)}{paint(f': {safe(one.message)}', BOLD)}"
    yield f"{edge[1:]}{paint('-->', BLUE)} {place(source, one.span)}"
    for number, scene in enumerate(scenes):
        if number:
            yield f"{edge[1:]}{paint(':::', BLUE)} {_begins(source, scene)}"
        yield f"{edge}{paint('|', BLUE)}"
        yield from picture(scene.file, scene.marks, edge, paint)
    for note in one.notes:
        if note.span is None:
            yield f"{edge}{paint('=', BLUE)} note: {safe(note.message)}"
    if one.help is not None:
        yield f"{edge}{paint('=', BLUE)} help: {safe(one.help)}"


def _scenes(one: Diagnostic, source: Source, styles: tuple[str, ...]) -> list[_Scene]:
    """Return the places of a diagnostic, by file; its own file comes first."""
    if one.span is None:
        return []
    scenes = [_scene(source, one.span, styles, "^")]
    for label in one.places:
        scene = _scene(source, label.span, (BOLD, BLUE), "-", label.message)
        known = next((other for other in scenes if other.begin == scene.begin), None)
        if known is None:
            scenes.append(scene)
        else:
            known.marks.extend(scene.marks)
    return scenes


def _scene(source: Source, span: Span, styles: tuple[str, ...], sign: str, words: str = "") -> _Scene:
    """Return the scene of one place."""
    file, begin = source.file(span.start)
    local = span.shifted(-begin)
    return _Scene(file, begin, [Mark(local, sign, styles, words)])


def _begins(source: Source, scene: _Scene) -> str:
    """Return where the first place of a scene is."""
    start = scene.begin + scene.marks[0].span.start
    return place(source, Span(start, start))
