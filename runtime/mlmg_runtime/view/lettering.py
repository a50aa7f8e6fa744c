"""Text on pictures, each letter in a font that has it."""

from __future__ import annotations

import shutil
import subprocess
import unicodedata
from collections.abc import Iterable, Iterator
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
    "msyh.ttc",
    "malgun.ttf",
    "PingFang.ttc",
    "Hiragino Sans GB.ttc",
    "AppleSDGothicNeo.ttc",
    "Arial Unicode.ttf",
)
_SPELT_OUT = {"→": "->", "×": "x", "…": "...", "↺": "(again)"}
_NO_LETTER = "\uffff"
_LEAN_ON_OTHERS = frozenset({"Mn", "Mc", "Me", "Cf"})
_LONGEST_ANSWER_S = 10.0


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


def letters_without_font(texts: Iterable[str]) -> str:
    """Return the letters of some texts that no font here has, each once: they are spelt out, as in `\\u8d70`."""
    letters = dict.fromkeys(letter for text in texts for letter, font in _fonts(text, 16) if font is None)
    return "".join(letter for letter in letters if letter not in _SPELT_OUT)


def _runs(text: str, size: int) -> Iterator[tuple[Font, str]]:
    """Yield the parts of a text that are written in one font."""
    for font, pairs in groupby(_fonts(text, size), key=lambda pair: pair[1]):
        run = "".join(letter for letter, _ in pairs)
        yield (font, run) if font else (_own_font(size), "".join(map(_spelt_out, run)))


def _fonts(text: str, size: int) -> Iterator[tuple[str, Font | None]]:
    """Yield each letter with its font, None if no font has it; what leans on the letter before stays with it."""
    font: Font | None = _own_font(size)
    for letter in unicodedata.normalize("NFC", text):
        if unicodedata.category(letter) not in _LEAN_ON_OTHERS:
            font = _font_for(letter, size)
        yield letter, font


def _spelt_out(letter: str) -> str:
    return _SPELT_OUT.get(letter) or letter.encode("unicode_escape").decode("ascii")


@lru_cache(maxsize=2048)
def _font_for(letter: str, size: int) -> Font | None:
    """Return the first font that has a letter, if any has."""
    own = _own_font(size)
    if letter.isspace() or _has_letter(own, letter):
        return own
    for name in _FALLBACKS:
        font = _fallback(name, size)
        if font is not None and _has_letter(font, letter):
            return font
    font = _system_font(letter, size)
    return font if font is not None and _has_letter(font, letter) else None


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


def _system_font(letter: str, size: int) -> Font | None:
    """Return the font that fontconfig, where there is one, thinks best for a letter; it need not have it."""
    from PIL import ImageFont

    program = shutil.which("fc-match")
    if program is None:
        return None
    question = [program, "--format=%{file}\n%{index}", f":charset={ord(letter):x}"]
    try:
        answer = subprocess.run(question, capture_output=True, check=True, timeout=_LONGEST_ANSWER_S).stdout
        path, _, index = answer.decode("utf-8", "surrogateescape").rpartition("\n")
        # The upper half of the index names an instance of a variable font.
        return ImageFont.truetype(path, size, index=int(index) & 0xFFFF)
    except (OSError, ValueError, subprocess.SubprocessError):
        return None


def _has_letter(font: Font, letter: str) -> bool:
    return bytes(font.getmask(letter)) != bytes(font.getmask(_NO_LETTER))
