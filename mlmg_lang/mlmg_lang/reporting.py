"""What has been found in the pieces of a script -> what is told of it: what follows from something else is not."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from functools import partial
from operator import attrgetter

from mlmg_lang.analysis import Analysis, Found, InPieces, Question
from mlmg_lang.chunks import all_of
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.following import without_following
from mlmg_lang.parsing.nesting import Mark
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.pieces import Piece
from mlmg_lang.suppression import suppress


def wrong_as_read(made: InPieces) -> tuple[Diagnostic, ...]:
    """Return all that is wrong with the text, the names and the types of a script."""
    return (*_defined(made), *made.unused, *made.untold, *made.pieces.all("told"))


def wrong_as_played(played: tuple[Diagnostic, ...], made: InPieces) -> tuple[Diagnostic, ...]:
    """Return what is wrong with what a script plays, but not what may follow from what is wrong with its text."""
    misread = [made.lines[at] for at in made.lines.where("misread")] if played else []
    return _not_following(played, misread)


def reported(question: Question, found: Found, made: InPieces) -> Analysis:
    """Return the analysis, with what is told of what has been found."""
    complete = question.catalog is not None and not found.wrong
    told = _sorted(suppress(_each_once(found.told, made), _speaking(made), made.source, complete))
    return Analysis(told, question, found, made)


def _defined(made: InPieces) -> Sequence[Diagnostic]:
    """Return what is wrong with the definitions, but not what may follow from what is wrong with their text."""
    defining = (made.lines[at] for at in made.lines.where("defining")) if made.defined else ()
    return _not_following(made.defined, [line for line in defining if line.misread])


def _not_following(told: tuple[Diagnostic, ...], misread: list[Piece]) -> tuple[Diagnostic, ...]:
    """Return what is told, but not what may follow from what is wrong with the text of some lines."""
    if not misread or not told:
        return told
    misread.sort(key=attrgetter("address"))
    return tuple(one for one in told if not _follows(one, misread))


def _follows(one: Diagnostic, misread: Sequence[Piece]) -> bool:
    """Return whether it may follow from what is wrong with the text of the line it is in; these are by address."""
    if one.span is None:
        return False
    at = bisect_right(misread, one.span.start, key=attrgetter("address")) - 1
    line = misread[max(at, 0)]
    if not line.address <= one.span.start < line.address + line.size:
        return False
    return not any(without_following((one,), line.misread, line.items))


def _each_once(told: tuple[Diagnostic, ...], made: InPieces) -> tuple[Diagnostic, ...]:
    """Return what is told, where it is in the text: what several of them tell of one slip only once."""
    if not told:
        return ()
    # Imported here, as sound scripts, which are most, do not need them.
    from mlmg_lang.definitions.misnamed import Naming, told_once
    from mlmg_lang.parsing.unbalanced import balanced

    known = made.gathered.definitions
    is_used = partial(_is_used, made)
    naming = Naming(made.addressed, made.places, known.lets.values(), known.unread, is_used)
    return tuple(balanced(made.now(tuple(told_once(told, naming))), _braces(made), made.source))


def _is_used(made: InPieces, name: str) -> bool:
    return any(True for _ in made.lines.where_among("names", frozenset({name})))


def _braces(made: InPieces) -> Iterator[Mark]:
    """Yield what stands in and around braces that have their partners in other lines, where these are now."""
    for at in made.lines.where("marks"):
        yield from made.now(made.lines[at].marks)


def _speaking(made: InPieces) -> tuple[Token, ...]:
    """Return the tokens of comments that may be meant for the compiler, of the lines these are about, and of blocks."""
    lines = made.lines
    if "mlmg" not in made.source.text or not lines.has("speaks"):
        return ()
    numbers = sorted({*lines.where("speaks"), *lines.where("marks")})
    return made.now(tuple(all_of((lines[at] for at in numbers), "tokens")))


def _sorted(diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    """Return diagnostics in the order of the text, each once; those without a place come first."""
    once = {(one.code, one.span, one.message): one for one in reversed(diagnostics)}
    return tuple(sorted(once.values(), key=lambda one: (one.span is not None, one.span, one.code)))
