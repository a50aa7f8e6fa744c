"""A script -> the same script in its one canonical form."""

from __future__ import annotations

from mlmg_lang.formatting.printing import Printer
from mlmg_lang.parsing.layout import lay_out
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.source import Source


def format_source(source: Source) -> str:
    """Return a script in canonical form: the same statements and comments, written as docs/formatting.md says.

    What cannot be read is kept as written, but for line ends. Whatever the text, this does not fail.
    """
    tokens = tokenize(source)
    return Printer(source, tokens, lay_out(tokens)).script()
