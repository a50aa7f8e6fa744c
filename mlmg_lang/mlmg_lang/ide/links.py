"""A script -> the files that it uses, as links."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_lang.analysis import Analysis
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Span


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
