"""A script -> the files that it uses, as links."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from mlmg_lang.analysis import Analysis
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Span

_QUOTED: Final = re.compile(r'"[^"\\\r\n]*+(?:\\[^\r\n][^"\\\r\n]*+)*+"')


@dataclass(frozen=True, slots=True)
class Link:
    """A path in a script, and the name of the file that it leads to."""

    span: Span
    file: str


def document_links(analysis: Analysis) -> tuple[Link, ...]:
    """Return the paths of a script, in the order of the text; those that lead nowhere are reported elsewhere."""
    made = analysis.made
    named = made.gathered.used.named
    paths = (item.path for item in made.lines.all("defining") if isinstance(item, syntax.Use))
    return tuple(Link(made.places(path.span), named[path.span]) for path in paths if path.span in named)


def paths_in(text: str) -> tuple[str, ...]:
    """Return the paths of all files that a text may use, and what else stands in quotes; it is not read for that."""
    if "use" not in text.lower():
        return ()
    quoted = (Token("STRING", one[0], Span(*one.span())) for one in _QUOTED.finditer(text))
    return tuple(dict.fromkeys(name_from_token(token).text for token in quoted))


def use_leading_to(analysis: Analysis, file: str) -> Span | None:
    """Return the path in a script by which it uses a file, itself or by way of others; None if it does not."""
    made = analysis.made
    uses: dict[str, list[tuple[Span, str]]] = {}
    for path, name in made.gathered.used.named.items():
        span = made.places(path)
        user, _ = made.source.file(span.start)
        uses.setdefault(user.name, []).append((span, name))
    leads = {file}
    for _ in uses:  # files do not use each other in a circle, so a way is no longer than there are files
        leads |= {user for user, paths in uses.items() if any(name in leads for _, name in paths)}
    own = sorted(uses.get(made.source.name, ()))
    return next((span for span, name in own if name in leads), None)
