"""Diagnostics -> one line each, as compilers have always written them."""

from __future__ import annotations

from collections.abc import Iterable

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.rendering.wording import head, place, safe
from mlmg_lang.source import Source


def render_concise(diagnostics: Iterable[Diagnostic], source: Source) -> str:
    """Return diagnostics one a line: `file:line:column: error[MS021]: message`."""
    return "".join(f"{place(source, one.span)}: {head(one)}: {safe(one.message)}\n" for one in diagnostics)
