"""What the compiler has to say, as data; and the table of all that it can say."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from mlmg_lang.source import Span


class Severity(StrEnum):
    """How bad it is: an error keeps a script from being played, a warning or a hint does not."""

    ERROR = "error"
    WARNING = "warning"
    HINT = "hint"


@dataclass(frozen=True, slots=True)
class Rule:
    """One kind of diagnostic."""

    severity: Severity
    title: str


def _table() -> dict[str, Rule]:
    error, warning, hint = Severity.ERROR, Severity.WARNING, Severity.HINT
    return {
        # the text
        "MS001": Rule(error, "the file is not UTF-8"),
        "MS002": Rule(error, "a quoted name that is not closed"),
        "MS003": Rule(error, "a character that cannot stand here"),
        "MS004": Rule(error, "a quoted name that is empty or has an unknown escape"),
        "MS005": Rule(error, "nested too deeply"),
        "MS006": Rule(error, "too many mistakes"),
        "MS007": Rule(error, "more text than is read"),
        "MS008": Rule(error, "a file that is no script"),
        # the syntax
        "MS010": Rule(error, "a word or sign that does not fit here"),
        "MS011": Rule(error, "a word of the language in the wrong case"),
        "MS012": Rule(error, "a parenthesis without its partner"),
        "MS013": Rule(error, "a brace without its partner, or in the wrong place"),
        "MS014": Rule(error, "`with`, `and`, `or` or `not` without a motion beside it"),
        "MS015": Rule(error, "a definition that is not at the top level"),
        "MS016": Rule(error, "a duration without a unit, or with an unknown one"),
        "MS017": Rule(error, "a duration that is not one number and one unit"),
        "MS018": Rule(error, "a word of the language used as a name"),
        "MS019": Rule(error, "a misspelt word of the language"),
        # the names
        "MS020": Rule(hint, "a name that is spelt otherwise in the library"),
        "MS021": Rule(error, "an unknown name"),
        "MS022": Rule(error, "a motion or tag that is not on this graph"),
        "MS023": Rule(error, "a spelling that fits several names"),
        "MS024": Rule(error, "a graph where a motion is expected"),
        "MS025": Rule(error, "a motion or tag where a graph is expected"),
        "MS026": Rule(error, "an unknown graph"),
        "MS027": Rule(error, "a parameter that does not exist"),
        "MS028": Rule(error, "arguments for something that takes none"),
        # the types
        "MS030": Rule(error, "a graph that is not below the one before it"),
        "MS031": Rule(error, "a graph that is named twice in a command"),
        "MS032": Rule(error, "a combination that no motion has"),
        "MS033": Rule(error, "`Sub` without a graph before it, or without one below it"),
        "MS034": Rule(error, "layers where a set of motions is expected"),
        "MS035": Rule(error, "different graphs in one set of motions"),
        # the playing
        "MS040": Rule(error, "rule 1 leaves nothing to play"),
        "MS041": Rule(error, "nothing that can be reached"),
        "MS042": Rule(error, "the end of the whole body"),
        "MS043": Rule(warning, "the end of a part that does not run on its own"),
        "MS044": Rule(error, "an unknown start motion"),
        "MS045": Rule(warning, "a duration of nothing"),
        "MS046": Rule(error, "an absurd duration"),
        "MS047": Rule(hint, "a command that is left as soon as it is reached"),
        "MS048": Rule(error, "a script that becomes too large when it is expanded"),
        "MS049": Rule(error, "a choice that nothing can be drawn from"),
        # the definitions
        "MS050": Rule(error, "a name that is defined twice"),
        "MS051": Rule(error, "a definition in terms of itself"),
        "MS052": Rule(error, "a definition that is named like a graph"),
        "MS053": Rule(warning, "a definition that is named like a motion or tag"),
        "MS054": Rule(warning, "a definition or parameter that is not used"),
        "MS055": Rule(error, "arguments that do not fit the parameters"),
        "MS056": Rule(error, "a motion where a duration is expected, or the other way round"),
        "MS057": Rule(error, "a definition that says how long, where that cannot be said"),
        "MS058": Rule(error, "a file that cannot be used"),
        "MS059": Rule(error, "files that use each other in a circle"),
        # the looks
        "MS061": Rule(warning, "a combination that may look unnatural"),
        # the comments
        "MS070": Rule(warning, "a comment that ignores what is not there"),
        "MS071": Rule(warning, "a comment to the compiler that says nothing it knows"),
        "MS072": Rule(warning, "an error that a comment cannot silence"),
    }


CODES: Final[Mapping[str, Rule]] = MappingProxyType(_table())
"""All codes, with their severity and what they mean in a few words. A code never changes its meaning."""


class Brace(StrEnum):
    """What a diagnostic says of the braces of a script, for what else is wrong with them: see `parsing.unbalanced`."""

    UNCLOSED = "a `{` to which there is no `}`"
    UNOPENED = "a `}` to which there is no `{`"
    NEEDLESS = "a `{` that is too much"
    MISSING = "a `{` that is missing"
    OUTSIDE = "what stands in braces alone"
    PARENTHESIS = "a `)` that may stand in place of a `}`"
    LOOP = "a loop of another language"
    OPEN_PARENTHESIS = "a `(` in place of whose `)` there may be a `}`"


@dataclass(frozen=True, slots=True)
class Fix:
    """An edit that would mend it.

    Attributes
    ----------
    safe : whether the edit is sure to say what the script was meant to say.
    name : what the edit does, as an editor offers it; without one, `title` finds words for it.
    """

    span: Span
    replacement: str
    safe: bool
    name: str = ""

    @property
    def applicability(self) -> str:
        """Return `safe` or `unsafe`."""
        return "safe" if self.safe else "unsafe"

    @property
    def title(self) -> str:
        """Return what the edit does, in a few words for a menu."""
        if self.name:
            return self.name
        if not self.replacement.strip():
            return "take it out"
        return f"{'add' if self.span.start == self.span.end else 'write'} `{self.replacement.strip()}`"


@dataclass(frozen=True, slots=True)
class Label:
    """A few words about another place, drawn beside it in the same picture."""

    span: Span
    message: str


@dataclass(frozen=True, slots=True)
class Note:
    """A sentence that one should know as well; with a place, it is drawn as a label."""

    message: str
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """Something that is wrong with a script, or could be better.

    Attributes
    ----------
    code : a key of `CODES`.
    span : where; None if it is not about a place in the text.
    help : what to do about it.
    fixes : edits that would do it, the likeliest first.
    labels : other places that have to do with it.
    brace : what it says of braces.
    """

    code: str
    message: str
    span: Span | None
    help: str | None = None
    notes: tuple[Note, ...] = ()
    fixes: tuple[Fix, ...] = ()
    labels: tuple[Label, ...] = ()
    brace: Brace | None = None

    @property
    def severity(self) -> Severity:
        """Return how bad it is."""
        return CODES[self.code].severity

    @property
    def places(self) -> tuple[Label, ...]:
        """Return the other places, those of notes too."""
        noted = (Label(note.span, note.message) for note in self.notes if note.span is not None)
        return (*self.labels, *noted)


def has_errors(diagnostics: tuple[Diagnostic, ...]) -> bool:
    """Return whether one of them keeps the script from being played."""
    return n_errors(diagnostics) > 0


def n_errors(diagnostics: Iterable[Diagnostic]) -> int:
    """Return how many of them keep the script from being played."""
    return sum(diagnostic.severity is Severity.ERROR for diagnostic in diagnostics)
