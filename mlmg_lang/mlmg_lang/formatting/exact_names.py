"""Names that are spelt otherwise in the library -> names as it spells them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.source import Source, Span

_INEXACT: Final = "MS020"


def with_exact_names(source: Source, diagnostics: Iterable[Diagnostic]) -> Source:
    """Return a script with the spellings that its diagnostics offer; a name that is offered two keeps its own."""
    offered: dict[Span, set[str]] = {}
    for one in diagnostics:
        if one.code == _INEXACT:
            for fix in one.fixes:
                if fix.safe and fix.span.end <= len(source.text):  # not in a file that the script uses
                    offered.setdefault(fix.span, set()).add(fix.replacement)
    pieces, end = [], 0
    for span, names in sorted(offered.items()):
        if len(names) == 1:
            pieces += [source.text[end : span.start], *names]
            end = span.end
    return replace(source, text="".join([*pieces, source.text[end:]]))
