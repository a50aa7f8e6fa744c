"""A script -> the same script in its one canonical form. Whatever the text, this does not fail."""

from __future__ import annotations

from dataclasses import dataclass

from mlmg_lang.formatting.printing import Printer
from mlmg_lang.parsing.layout import lay_out
from mlmg_lang.parsing.tokenize import tokenize
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

    What cannot be read is kept as written, but for line ends.
    """
    return format_script(source).text


def format_script(source: Source) -> Formatted:
    """Return the same, and whether all of it could be read."""
    tokens = tokenize(source)
    printer = Printer(source, tokens, lay_out(tokens))
    return Formatted(printer.script(), not printer.kept)
