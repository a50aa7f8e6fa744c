"""Random edits of scripts, as the people and the programs behind editors make them.

No library of editing is used here, and nothing of the server: what a text comes to is worked out by plain strings.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

LINES = (
    *("WALK for 10 sec\n", "WALK with Upper-Body TALK for 10 sec\n", "IDLE\n", "IDLE for 3 sec\n", "Walk_01\n"),
    *("(WALK or IDLE) for 2 sec\n", "Upper-Body TALK\n", "IDLE with Left-Hand WAVE for 4 sec\n", "Talk_01 once\n"),
    *("end Upper-Body\n", "end Left-Hand\n", "wait 2 sec\n", "# a note: 走路 😀\n", "\n", "\t\n", "Music for 8 sec\n"),
    *("WALK; IDLE; WALK\n", "let 走 = WALK\n", "let 😀 = IDLE\n", "走\n", "y\n"),
    *(
        "TALK and IDLE\n",
        "WALK and not IDLE for 40 frames\n",
        "WLAK for 3 sec\n",
        "walk01 FOR 2\n",
        "WALK; IDLE; WALK\n",
    ),
    *("repeat 2 { IDLE; Upper-Body Talk_01 }\n", "choose { WALK | IDLE for 2 sec }\n", "# mlmg: ignore[MS047]\n"),
    *(
        "let x = WALK\n",
        "let x = IDLE or WALK\n",
        "let y = x with Upper-Body TALK\n",
        "let 走 = WALK\n",
        "let 😀 = IDLE\n",
    ),
    *(
        "let G(p, t = 2 sec) = p with Upper-Body TALK for t\n",
        "G(x)\n",
        "G(IDLE, 3 sec)\n",
        "x for 2 sec\n",
        "走\n",
        "y\n",
    ),
    *('use "used.ms"\n', 'use "missing.ms"\n', "of_used for 2 sec\n", "also_of_used\n", '"WALK" for 2 sec\n'),
    *("WALK for 10 sec # end\r\n", "IDLE\rWALK\r", "WALK for 2 sec # a\u2028b\n", "IDLE\x0c\n", "\u00a0IDLE\x85\n"),
)
BLOCKS = (
    "repeat 3 {\n    WALK for 2 sec\n    Upper-Body TALK\n    end Upper-Body\n}\n",
    "choose {\n    WALK\n|\n    IDLE for 2 sec\n    WALK\n}\n",
    "let stroll(t) = WALK for t\nrepeat 2 {\n    stroll(2 sec)\n    choose { IDLE | TALK }\n}\n",
    "repeat 2 {\n\tlet z = WALK\n\tz for 1 sec\n}\nz\n",
)
WRITTEN = (*LINES, *BLOCKS, *BLOCKS)
WORDS = (
    *(
        "WALK",
        "IDLE",
        "TALK",
        "Upper-Body",
        "Left-Hand",
        "with",
        "and",
        "or",
        "not",
        "for",
        "once",
        "sec",
        "let",
        "use",
    ),
    *("x", "y", "G", "走", "wait", "end", "repeat", "choose", "2", "0.5", "min", "Walk_01", "of_used", " ", "  ", ";"),
)
BRACKETS = ("{", "}", "(", ")", "|", '"', "#", "# ", "\\", ",", "=", "/*", "*/", "//", "“", "（", "｛", "；")
ODD = (
    *("😀", "走路", "\u2028", "\u2029", "\t", "\r", "\x85", "\x0c", "\x00", "é", "e\u0301", "\ufeff", "\u200d"),
    *("👩\u200d👩\u200d👧", "\U0010ffff"),
)
USED = "let of_used = WALK or IDLE\nlet also_of_used = WLAK\n"
"""What the file `used.ms` beside a script says."""
_UNITS = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}
_LINE_END = re.compile("\r\n|\r|\n")


class Change(NamedTuple):
    """Something in place of a stretch of a text, in code points; `whole` if it is sent as the whole text."""

    start: int
    end: int
    new: str
    whole: bool = False


Edit: TypeAlias = tuple[Change, ...]
"""Changes one after the other, each of the text after the one before."""


def after(text: str, edit: Edit) -> str:
    """Return a text after an edit."""
    for change in edit:
        text = text[: change.start] + change.new + text[change.end :]
    return text


def as_sent(text: str, edit: Edit, encoding: str) -> list[dict[str, Any]]:
    """Return an edit as the protocol has it."""
    sent: list[dict[str, Any]] = []
    for change in edit:
        ends = {"start": position(text, change.start, encoding), "end": position(text, change.end, encoding)}
        text = after(text, (change,))
        sent.append({"text": text} if change.whole else {"range": ends, "text": change.new})
    return sent


def position(text: str, offset: int, encoding: str) -> dict[str, int]:
    """Return an offset as the protocol has it."""
    n_lines = text.count("\n", 0, offset) + text.count("\r", 0, offset) - text.count("\r\n", 0, offset)
    start = 1 + max(text.rfind("\n", 0, offset), text.rfind("\r", 0, offset))
    codec, n_bytes = _UNITS[encoding]
    return {"line": n_lines, "character": len(text[start:offset].encode(codec)) // n_bytes}


def difference(text: str, other: str) -> Edit:
    """Return the one change that makes another text of a text."""
    limit = min(len(text), len(other))
    head = next((at for at in range(limit) if text[at] != other[at]), limit)
    tail = next((at for at in range(limit - head) if text[-1 - at] != other[-1 - at]), limit - head)
    start, end = head, len(text) - tail
    if _in_line_end(text, start) or _in_line_end(other, start):
        start -= 1
    if _in_line_end(text, end):
        end += 1
        tail -= 1
    return (Change(start, end, other[start : len(other) - tail]),)


def _in_line_end(text: str, offset: int) -> bool:
    """Return whether an offset is one that the protocol cannot name: between the signs of a CRLF."""
    return text[max(offset - 1, 0) : offset + 1] == "\r\n"


def _can_be_sent(text: str, edit: Edit) -> bool:
    """Return whether the protocol can name all places of an edit: what is put in may make a CRLF around one."""
    for change in edit:
        if not change.whole and (_in_line_end(text, change.start) or _in_line_end(text, change.end)):
            return False
        text = after(text, (change,))
    return True


class Author:
    """Someone who edits a text at random, always the same for the same seed."""

    def __init__(
        self, seed: int, text: str | None = None, written: Sequence[str] = WRITTEN, n_lines: tuple[int, int] = (0, 80)
    ) -> None:
        """Begin with a text, or with a few random lines.

        Parameters
        ----------
        written : lines, and blocks of them. n_lines : the fewest that the text has in the long run, and the most.
        """
        self._draw = random.Random(seed)
        self._written, self._n_lines = written, n_lines
        self.text = "".join(self._lines(self._draw.randrange(40))) if text is None else text
        self._cursor = 0
        self._typed = ""
        self._undone: list[str] = []
        self._done: list[str] = []
        self._kinds: tuple[tuple[int, Callable[[], Edit]], ...] = (
            *((20, self._type), (10, self._insert), (8, self._delete), (8, self._replace), (7, self._bracket)),
            *((5, self._odd), (9, self._paste), (4, self._cut), (4, self._repeat_line), (3, self._comment_out)),
            *(
                (3, self._indent),
                (3, self._rename),
                (2, self._flip),
                (8, self._undo),
                (4, self._redo),
                (1, self._afresh),
            ),
        )

    def edit(self) -> Edit:
        """Make one edit and return it."""
        kinds = [kind for _, kind in self._kinds]
        kind = self._draw.choices(kinds, [weight for weight, _ in self._kinds])[0]
        fewest, most = self._n_lines
        n_lines = self.text.count("\n") + self.text.count("\r") - self.text.count("\r\n")
        made = self._shorten() if n_lines > most else self._lengthen(fewest - n_lines) if n_lines < fewest else kind()
        made = made if _can_be_sent(self.text, made) else difference(self.text, after(self.text, made))
        if made and kind not in (self._undo, self._redo):
            self._done = [*self._done[-30:], self.text]
            self._undone = []
        self.text = after(self.text, made)
        return made

    def take_back(self, text: str) -> Edit:
        """Make another text of it, as when a file is restored."""
        made = difference(self.text, text)
        self._done, self._undone, self._typed = [], [], ""
        self.text = text
        return made

    # --- places ---

    def _at(self) -> int:
        """Return an offset, as often as not near the one before."""
        near = self._cursor + self._draw.randint(-12, 12)
        self._cursor = near if self._draw.random() < 0.5 else self._draw.randint(0, len(self.text))
        self._cursor = min(max(self._cursor, 0), len(self.text))
        return self._cursor - _in_line_end(self.text, self._cursor)

    def _stretch(self, most: int) -> tuple[int, int]:
        start = self._at()
        end = min(start + self._draw.randint(0, most), len(self.text))
        return start, end + _in_line_end(self.text, end)

    def _line_starts(self) -> list[int]:
        return [0, *(found.end() for found in _LINE_END.finditer(self.text))]

    def _some_lines(self, most: int) -> tuple[int, int]:
        """Return a stretch of whole lines."""
        starts = self._line_starts()
        first = self._draw.randrange(len(starts))
        last = first + self._draw.randint(1, most)
        return starts[first], starts[last] if last < len(starts) else len(self.text)

    def _lines(self, n_lines: int) -> list[str]:
        return [self._draw.choice(self._written) for _ in range(n_lines)]

    # --- edits ---

    def _type(self) -> Edit:
        """Type one key more of a line."""
        if not self._typed:
            self._typed = self._draw.choice(self._written)
            self._at()
        at = min(self._cursor, len(self.text))
        at -= _in_line_end(self.text, at)
        key, self._typed = self._typed[0], self._typed[1:]
        self._cursor = at + 1
        return (Change(at, at, key),)

    def _insert(self) -> Edit:
        at = self._at()
        return (Change(at, at, self._draw.choice((*WORDS, *self._written))),)

    def _delete(self) -> Edit:
        return (Change(*self._stretch(self._draw.choice((1, 1, 3, 20))), ""),)

    def _replace(self) -> Edit:
        return (Change(*self._stretch(8), self._draw.choice((*WORDS, *ODD))),)

    def _bracket(self) -> Edit:
        """Open or close something, here or at two places at once."""
        at = self._at()
        first = Change(at, at, self._draw.choice(BRACKETS))
        if self._draw.random() < 0.7:
            return (first,)
        later = self._draw.randint(at + len(first.new), len(self.text) + len(first.new))
        later += _in_line_end(after(self.text, (first,)), later)
        return (first, Change(later, later, self._draw.choice(BRACKETS)))

    def _odd(self) -> Edit:
        at = self._at()
        return (Change(at, at, self._draw.choice(ODD)),)

    def _paste(self) -> Edit:
        """Put in some lines: new ones, or some of the text; in place of what is selected."""
        start, end = self._some_lines(5)
        lines = self.text[start:end] if self._draw.random() < 0.4 else "".join(self._lines(self._draw.randint(1, 6)))
        at = self._at() if self._draw.random() < 0.3 else self._some_lines(1)[0]
        return (Change(at, at, lines),)

    def _cut(self) -> Edit:
        return (Change(*self._some_lines(6), ""),)

    def _repeat_line(self) -> Edit:
        """Move or copy a few lines elsewhere, in one edit."""
        start, end = self._some_lines(3)
        lines = self.text[start:end]
        gone = Change(start, end, "") if self._draw.random() < 0.5 else Change(start, start, "")
        rest = after(self.text, (gone,))
        at = self._draw.choice([0, *(found.end() for found in _LINE_END.finditer(rest))])
        return (gone, Change(at, at, lines))

    def _comment_out(self) -> Edit:
        return self._at_each_line("# ", 4)

    def _indent(self) -> Edit:
        return self._at_each_line(self._draw.choice(("\t", "    ")), 6)

    def _at_each_line(self, sign: str, most: int) -> Edit:
        """Put a sign before some lines, or take it away: the last line first, as editors do it."""
        start, end = self._some_lines(most)
        begins = [at for at in self._line_starts() if start <= at < end]
        if all(self.text.startswith(sign, at) for at in begins):
            return tuple(Change(at, at + len(sign), "") for at in reversed(begins))
        return tuple(Change(at, at, sign) for at in reversed(begins))

    def _rename(self) -> Edit:
        """Write another word in the first places of one."""
        old, new = self._draw.sample(WORDS[:22], 2)
        found = [match.start() for match in re.finditer(re.escape(old), self.text)]
        return tuple(Change(at, at + len(old), new) for at in reversed(found[:20]))

    def _flip(self) -> Edit:
        """Write all line ends otherwise."""
        end = self._draw.choice(("\n", "\r\n", "\r\n", "\r"))
        other = _LINE_END.sub(end, self.text)
        if self._draw.random() < 0.5:
            return (Change(0, len(self.text), other, whole=True),)
        found = list(_LINE_END.finditer(self.text))
        return tuple(Change(one.start(), one.end(), end) for one in reversed(found))

    def _undo(self) -> Edit:
        return self._back(self._done, self._undone)

    def _redo(self) -> Edit:
        return self._back(self._undone, self._done)

    def _back(self, those: list[str], others: list[str]) -> Edit:
        if not those:
            return ()
        others.append(self.text)
        return difference(self.text, those.pop())

    def _afresh(self) -> Edit:
        """Write something else altogether."""
        text = "".join(self._lines(self._draw.randrange(40)))
        return (Change(0, len(self.text), text, whole=self._draw.random() < 0.5),)

    def _shorten(self) -> Edit:
        """Cut a quarter of a text that has become too long for its author."""
        starts = self._line_starts()
        first = self._draw.randrange(len(starts) * 3 // 4)
        return (Change(starts[first], starts[first + len(starts) // 4], ""),)

    def _lengthen(self, n_lines: int) -> Edit:
        """Put in lines where a text has become too short."""
        at = self._some_lines(1)[0]
        return (Change(at, at, "".join(self._lines(n_lines))),)
