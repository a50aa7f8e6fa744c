"""Text on pictures, each letter in a font that has it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import groupby
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw
    from PIL.ImageFont import FreeTypeFont, ImageFont

    Font: TypeAlias = FreeTypeFont | ImageFont

# Tried where Pillow's own font lacks a letter; found by name in the system's font folders.
_FALLBACKS = (
    "DejaVuSans.ttf",
    "NotoSansCJK-Regular.ttc",
    "wqy-zenhei.ttc",
    "msgothic.ttc",
    "Hiragino Sans GB.ttc",
    "Arial Unicode.ttf",
)
_SPELT_OUT = {"→": "->", "×": "x", "…": "...", "↺": "(again)"}
_NO_LETTER = "\uffff"


@dataclass(frozen=True, slots=True)
class Pen:
    """Writes on a picture; sizes and places in pixels."""

    image: ImageDraw
    size: int

    def width(self, text: str) -> float:
        """Return how wide a text is."""
        return sum(float(font.getlength(run)) for font, run in _runs(text, self.size))

    def write(self, left: float, top: float, text: str, colour: tuple[int, int, int]) -> float:
        """Write one line with its upper left corner at a place; return where it ends."""
        baseline = top + self.size
        for font, run in _runs(text, self.size):
            self.image.text((left, baseline), run, fill=colour, font=font, anchor="ls")
            left += float(font.getlength(run))
        return left

    def lines(self, text: str, width: float, most: int) -> list[str]:
        """Return a text broken between words into at most so many lines; what does not fit is cut."""
        lines = [""]
        for word in text.split():
            longer = f"{lines[-1]} {word}".strip()
            if self.width(longer) <= width or not lines[-1]:
                lines[-1] = longer
            else:
                lines.append(word)
        if len(lines) > most:
            lines = [*lines[: most - 1], " ".join(lines[most - 1 :])]
        return [self.cut(line, width) for line in lines]

    def cut(self, text: str, width: float) -> str:
        """Return a text, cut and ended with an ellipsis if it is wider."""
        if self.width(text) <= width:
            return text
        kept = len(text)
        while kept and self.width(text[:kept].rstrip() + "…") > width:
            kept -= 1
        return text[:kept].rstrip() + "…"


def _runs(text: str, size: int) -> Iterator[tuple[Font, str]]:
    """Yield the parts of a text that are written in one font."""
    own = _own_font(size)
    for font, letters in groupby(text, key=lambda letter: _font_for(letter, size)):
        run = "".join(letters)
        yield (font, run) if font else (own, "".join(_SPELT_OUT.get(letter, letter) for letter in run))


@lru_cache(maxsize=2048)
def _font_for(letter: str, size: int) -> Font | None:
    """Return the first font that has a letter, if any has."""
    own = _own_font(size)
    if letter.isspace() or _has_letter(own, letter):
        return own
    fallbacks = (_fallback(name, size) for name in _FALLBACKS)
    return next((font for font in fallbacks if font and _has_letter(font, letter)), None)


@lru_cache
def _own_font(size: int) -> Font:
    from PIL import ImageFont

    return ImageFont.load_default(size)


@lru_cache
def _fallback(name: str, size: int) -> Font | None:
    from PIL import ImageFont

    try:
        return ImageFont.truetype(name, size)
    except OSError:
        return None


def _has_letter(font: Font, letter: str) -> bool:
    return bytes(font.getmask(letter)) != bytes(font.getmask(_NO_LETTER))
