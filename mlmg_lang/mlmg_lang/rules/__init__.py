"""What each diagnostic means, in a file `MS021.md` for each code, with examples that a test holds to be true.

A file has the meaning, then `## Why`, `## Wrong` with a script that is told so, `## Told` with what it is told, and
`## Right` with what to write instead. Scripts are read against the demo library, or the one that stands behind
`motion-script` as `library=NAME`; `start=MOTION` there is the option of that name, and `times=N` says that what is
shown stands in the script that many times.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from pkgutil import get_data
from typing import Final

_FENCE: Final = re.compile(r"```(\w[\w-]*)([^\n]*)\n(.*?)```", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Example:
    """A script.

    Attributes
    ----------
    options : how it is read: `library`, `start`, `times`; and `bytes`, if `\\x..` in it stands for a byte.
    """

    text: str
    options: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class RuleText:
    """What is told of a code.

    Attributes
    ----------
    told : what is said of the wrong script, as it is drawn.
    """

    meaning: str
    why: str
    wrong: Example
    told: str
    right: Example


def read_rule(code: str) -> RuleText:
    """Return what is told of a code that is in the table of all codes."""
    data = get_data(__name__, f"{code}.md")
    assert data is not None, "the texts are part of this package"
    meaning, *parts = re.split(r"^## ", data.decode("utf-8"), flags=re.MULTILINE)
    sections = dict(part.split("\n", 1) for part in parts)
    return RuleText(
        meaning.strip(),
        sections["Why"].strip(),
        _example(sections["Wrong"]),
        _example(sections["Told"]).text,
        _example(sections["Right"]),
    )


def page_of(code: str) -> Path | None:
    """Return the file of a code, in Markdown; None where this package does not lie in files."""
    path = Path(__file__).with_name(f"{code}.md")
    return path if path.is_file() else None


def _example(section: str) -> Example:
    """Return what stands between the fences of a section."""
    found = _FENCE.search(section)
    assert found is not None, section
    words = (word.partition("=") for word in found[2].split())
    return Example(found[3], {key: value for key, _, value in words})
