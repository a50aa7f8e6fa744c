"""The HIERARCHY of a BVH file: from its lines to joints."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TypeAlias

from mlmg_runtime.bvh.document import POSITION_CHANNELS, ROTATION_CHANNELS, Joint
from mlmg_runtime.bvh.lines import Lines, shown

_CHANNELS = {name.lower(): name for name in (*POSITION_CHANNELS, *ROTATION_CHANNELS)}
_BLANKS = re.compile(r"[ \t\v\f]+")
_Offset: TypeAlias = tuple[float, float, float]


def joints_from_lines(lines: Lines) -> tuple[Joint, ...]:
    """Return the joints of the one skeleton from HIERARCHY to its last brace, depth first.

    Raises
    ------
    BvhError
        If the text is no hierarchy, or two joints share a name.
    """
    return _Hierarchy(lines).joints()


@dataclass(slots=True)
class _OpenJoint:
    """A joint whose closing brace has not come yet."""

    name: str
    line: int
    index: int
    parent: int
    offset: _Offset | None = None
    channels: tuple[str, ...] | None = None
    end_site: _Offset | None = None


class _Hierarchy:
    """One pass over the lines; `_open` are the joints that the place lies in, the root first."""

    def __init__(self, lines: Lines) -> None:
        self._lines = lines
        self._open: list[_OpenJoint] = []
        self._closed: dict[int, Joint] = {}
        self._line_of_name: dict[str, int] = {}

    def joints(self) -> tuple[Joint, ...]:
        self._expect("HIERARCHY")
        part = self._lines.next_part()
        keyword, name = _split(part)
        if keyword != "root":
            raise self._lines.error("ROOT and a name", shown(part))
        self._open_joint(name)
        while self._open:
            self._take(self._lines.next_part(), self._open[-1])
        return tuple(self._closed[index] for index in range(len(self._closed)))

    def _take(self, part: str | None, joint: _OpenJoint) -> None:
        keyword, rest = _split(part)
        if keyword == "offset" and joint.offset is None:
            joint.offset = self._offset(rest)
        elif keyword == "channels" and joint.channels is None:
            joint.channels = self._channels(rest)
        elif keyword == "joint":
            self._open_joint(rest)
        elif keyword == "end":
            self._take_end_site(joint)
        elif keyword == "}":
            self._close_joint(joint)
        else:
            raise self._lines.error(f"{_wanted(joint)} in joint {shown(joint.name)}", shown(part))

    def _open_joint(self, name: str) -> None:
        line = self._lines.line
        if not name:
            raise self._lines.error("the name of the joint", "none")
        if name in self._line_of_name:
            raise self._lines.error("a new joint name", f"{shown(name)}, as in line {self._line_of_name[name]}")
        self._expect("{")
        parent = self._open[-1].index if self._open else -1
        self._open.append(_OpenJoint(name, line, len(self._line_of_name), parent))
        self._line_of_name[name] = line

    def _close_joint(self, joint: _OpenJoint) -> None:
        if joint.offset is None:
            raise self._lines.error(f"OFFSET in joint {shown(joint.name)}", "none", joint.line)
        if joint.channels is None:
            raise self._lines.error(f"CHANNELS in joint {shown(joint.name)}", "none", joint.line)
        self._closed[joint.index] = Joint(joint.name, joint.parent, joint.offset, joint.channels, joint.end_site)
        self._open.pop()

    def _take_end_site(self, joint: _OpenJoint) -> None:
        line = self._lines.line
        self._expect("{")
        part = self._lines.next_part()
        keyword, rest = _split(part)
        if keyword != "offset":
            raise self._lines.error("OFFSET in the End Site", shown(part))
        offset = self._offset(rest)
        self._expect("}")
        if joint.end_site is None:
            joint.end_site = offset
        else:
            self._lines.warnings.append(f"line {line}: a second End Site in joint {shown(joint.name)} is left out")

    def _offset(self, rest: str) -> _Offset:
        words = rest.split()
        if len(words) != 3:
            raise self._lines.error("3 numbers after OFFSET", str(len(words)))
        x, y, z = (self._lines.number(word, "a number after OFFSET") for word in words)
        return (x, y, z)

    def _channels(self, rest: str) -> tuple[str, ...]:
        count, *words = rest.split() or [""]
        if not re.fullmatch("[0-9]+", count):
            raise self._lines.error("the number of channels", shown(count))
        if count.lstrip("0") != str(len(words)).lstrip("0"):
            raise self._lines.error(f"{count[:9]} channel names", str(len(words)))
        for word in words:
            if word.lower() not in _CHANNELS:
                raise self._lines.error("a channel such as Xposition or Zrotation", shown(word))
        channels = tuple(_CHANNELS[word.lower()] for word in words)
        if len(set(channels)) < len(channels):
            raise self._lines.error("each channel once", shown(" ".join(channels)))
        return channels

    def _expect(self, word: str) -> None:
        part = self._lines.next_part()
        if part is None or part.upper() != word:
            raise self._lines.error(word, shown(part))


def _wanted(joint: _OpenJoint) -> str:
    missing = [("OFFSET", joint.offset), ("CHANNELS", joint.channels)]
    return ", ".join([keyword for keyword, value in missing if value is None] + ["JOINT, End Site or }"])


def _split(part: str | None) -> tuple[str, str]:
    """Return the keyword, in lower case, and what follows it."""
    keyword, *rest = _BLANKS.split(part or "", maxsplit=1)
    return keyword.lower(), rest[0] if rest else ""
