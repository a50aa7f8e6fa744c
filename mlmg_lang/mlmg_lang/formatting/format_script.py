"""A script -> the same script in its one canonical form. Whatever the text, this does not fail."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_lang.formatting.printing import Printer
from mlmg_lang.formatting.reading import read_lines
from mlmg_lang.parsing.lookalikes import has_other_comments
from mlmg_lang.parsing.tokenize import MAX_TOKENS, tokenize
from mlmg_lang.source import Source


@dataclass(frozen=True, slots=True)
class Formatted:
    """A script in canonical form.

    Attributes
    ----------
    whole : False if something could not be read, and was kept as written.
    """

    text: str
    whole: bool


def format_source(source: Source) -> str:
    """Return a script in canonical form: the same statements and comments, written as docs/formatting.md says.

    What cannot be read is kept as written, but for line ends; so is all of a script that is too long to be read.
    """
    return format_script(source).text


def format_script(source: Source) -> Formatted:
    """Return the same, and whether all of it could be read."""
    tokens = tokenize(source)
    # Lines of other comments would be taken for statements, and broken up.
    if len(tokens) == MAX_TOKENS or has_other_comments(tokens):
        return Formatted(source.text, False)
    layout, strays = read_lines(tokens)
    printer = Printer(source, tokens, layout, strays=strays)
    return Formatted(printer.script(), not printer.kept)
