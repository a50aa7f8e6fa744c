"""The rules of the grammar -> railroad diagrams: every way along the rails is a text that the rule allows."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from itertools import pairwise
from typing import Final

from mlmg_grammar.definitions import Definition
from mlmg_grammar.ebnf import ebnf
from mlmg_grammar.expressions import Choice, Expression, Optional, Pattern, Repeat, Sequence, Symbol, Text

_CURVE: Final = 10
_GAP: Final = 12
_HALF: Final = 15
"""Half the height of a station."""
_LETTER: Final = 8.5
"""The width of a letter of 14 pixels in the fonts that have equal ones."""
_MARGIN: Final = 14

_STYLE: Final = """
.ground{fill:#fff;stroke:#d1d9e0}
path{fill:none;stroke:#59636e;stroke-width:2}
text{font:14px ui-monospace,SFMono-Regular,Menlo,Consolas,"DejaVu Sans Mono",monospace;text-anchor:middle;fill:#1f2328}
.word{fill:#ddf4ff;stroke:#0969da}
.token{fill:#fff8c5;stroke:#9a6700}
.rule{fill:#f6f8fa;stroke:#59636e}
@media(prefers-color-scheme:dark){
.ground{fill:#0d1117;stroke:#3d444d}
path{stroke:#9198a1}
text{fill:#f0f6fc}
.word{fill:#0c2d6b;stroke:#4493f8}
.token{fill:#3b2300;stroke:#d29922}
.rule{fill:#21262d;stroke:#9198a1}
}
"""


@dataclass(frozen=True, slots=True)
class Track:
    """A stretch of rails, drawn from its entry at (0, 0) to its exit at (width, 0).

    Attributes
    ----------
    up, down : how far it reaches above and below the line of its entry and exit, in pixels.
    """

    width: int
    up: int
    down: int
    drawing: str


def railroad(definition: Definition) -> str:
    """Return the diagram of a rule as an SVG file, readable on light and on dark pages."""
    track = _sequence((_stop(), _track(definition.expression), _stop()))
    width, height = track.width + 2 * _MARGIN, track.up + track.down + 2 * _MARGIN
    said = escape(ebnf(definition))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}"'
        f' role="img" aria-label="{said}">\n<title>{said}</title>\n<style>{_STYLE}</style>\n'
        f'<rect class="ground" x="0.5" y="0.5" width="{width - 1}" height="{height - 1}" rx="6"/>\n'
        f"{_placed(track, _MARGIN, _MARGIN + track.up)}\n</svg>\n"
    )


def _track(expression: Expression) -> Track:
    match expression:
        case Symbol(name):
            track = _station(name, "token" if expression.is_terminal else "rule")
        case Text(text):
            track = _station(text, "word")
        case Pattern(regexp):
            track = _station(f"/{regexp}/", "token")
        case Sequence(parts):
            track = _sequence(tuple(map(_track, parts)))
        case Choice(options):
            track = _choice(tuple(map(_track, options)))
        case Optional(part):
            track = _bypass(_track(part))
        case Repeat(part, separator):
            track = _loop(_track(part), None if separator is None else _track(separator))
    return track


def _station(label: str, kind: str) -> Track:
    """Return a box with words: a rounded one for what stands in the text as it is."""
    width = round(len(label) * _LETTER) + 2 * _GAP
    corner = 3 if kind == "rule" else _HALF
    box = f'<rect class="{kind}" x="0" y="-{_HALF}" width="{width}" height="{2 * _HALF}" rx="{corner}"/>'
    return Track(width, _HALF, _HALF, f'{box}<text x="{width / 2:g}" y="5">{escape(label)}</text>')


def _stop() -> Track:
    return Track(0, _HALF, _HALF, _rails("M0 -8v16"))


def _sequence(tracks: tuple[Track, ...]) -> Track:
    """Return tracks one after the other."""
    drawn, at = [_placed(tracks[0], 0, 0)], tracks[0].width
    for _, track in pairwise(tracks):
        drawn += [_rails(f"M{at} 0h{_GAP}"), _placed(track, at + _GAP, 0)]
        at += _GAP + track.width
    return Track(at, max(track.up for track in tracks), max(track.down for track in tracks), "".join(drawn))


def _choice(tracks: tuple[Track, ...]) -> Track:
    """Return tracks below each other: one of them is taken."""
    inner = max(track.width for track in tracks)
    width = inner + 4 * _CURVE
    first, *others = tracks
    drawn = [_rails(f"M0 0h{2 * _CURVE}"), _in_row(first, 0, inner), _rails(f"M{width} 0h-{2 * _CURVE}")]
    down = first.down
    for track in others:
        row = max(down + _GAP + track.up, 2 * _CURVE)
        fall = row - 2 * _CURVE
        drawn += [
            _rails(f"M0 0{_turn(1, 1)}v{fall}{_turn(1, 1, out=True)}"),
            _in_row(track, row, inner),
            _rails(f"M{width - 2 * _CURVE} {row}{_turn(1, -1)}v-{fall}{_turn(1, -1, out=True)}"),
        ]
        down = row + track.down
    return Track(width, first.up, down, "".join(drawn))


def _in_row(track: Track, y: int, width: int) -> str:
    """Return a track in a row of a choice, with rails to the end of the row."""
    start = 2 * _CURVE
    rails = _rails(f"M{start + track.width} {y}h{width - track.width}") if track.width < width else ""
    return _placed(track, start, y) + rails


def _bypass(track: Track) -> Track:
    """Return a track with a way above it."""
    width, height = track.width + 4 * _CURVE, max(track.up + _GAP, 2 * _CURVE)
    climb = height - 2 * _CURVE
    above = (
        f"M0 0{_turn(1, -1)}v-{climb}{_turn(1, -1, out=True)}h{track.width}{_turn(1, 1)}v{climb}{_turn(1, 1, out=True)}"
    )
    through = _rails(f"M0 0h{2 * _CURVE}") + _rails(f"M{width - 2 * _CURVE} 0h{2 * _CURVE}")
    return Track(width, height, track.down, _rails(above) + through + _placed(track, 2 * _CURVE, 0))


def _loop(track: Track, between: Track | None) -> Track:
    """Return a track with a way back below it, on which the separator stands."""
    back = between or Track(0, 0, 0, "")
    inner = max(track.width, back.width + 4 * _CURVE)
    width, fall = inner + 2 * _CURVE, max(track.down + _GAP + back.up, 2 * _CURVE)
    left, spare = _CURVE + (inner - back.width) // 2, inner - track.width
    drawn = [
        _rails(f"M0 0h{_CURVE + spare // 2}"),
        _placed(track, _CURVE + spare // 2, 0),
        _rails(f"M{width} 0h-{_CURVE + spare - spare // 2}"),
        _rails(f"M{width - _CURVE} 0{_turn(1, 1)}v{fall - 2 * _CURVE}{_turn(-1, 1, out=True)}H{left + back.width}"),
        _placed(back, left, fall),
        _rails(f"M{left} {fall}H{_CURVE}{_turn(-1, -1)}v-{fall - 2 * _CURVE}{_turn(1, -1, out=True)}"),
        _rails(f"M{(_CURVE + left) // 2 + 4} {fall - 4}l-6 4l6 4"),
    ]
    return Track(width, track.up, fall + max(back.down, 4), "".join(drawn))


def _turn(right: int, down: int, out: bool = False) -> str:
    """Return a quarter of a circle that ends `right` and `down` of its start (1, or -1 for left and up).

    It sets out along the row and ends across it; with `out`, the other way round.
    """
    clockwise = (right * down > 0) != out
    return f"a{_CURVE} {_CURVE} 0 0 {int(clockwise)} {right * _CURVE} {down * _CURVE}"


def _placed(track: Track, x: int, y: int) -> str:
    return f'<g transform="translate({x} {y})">{track.drawing}</g>' if track.drawing else ""


def _rails(path: str) -> str:
    return f'<path d="{path}"/>'
