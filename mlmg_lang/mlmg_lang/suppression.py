"""Comments that ask for silence -> the diagnostics that are left, and what is wrong with those comments.

`# mlmg: ignore[MS047]` at the end of a line is about that line, on a line of its own about the next statement;
`# mlmg: ignore-file[MS020, MS047]` is about its whole file. What follows the bracket is for people.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final

from mlmg_lang.diagnostics import CODES, Diagnostic, Fix, Severity
from mlmg_lang.parsing.layout import Block, Line, lay_out
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import Token
from mlmg_lang.source import Source, Span

_DIRECTIVE: Final = re.compile(r"#\s*mlmg\s*:\s*")
_IGNORE: Final = re.compile(r"(ignore|ignore-file)\s*\[([^\]]*)\]\s*(.*)", re.DOTALL)
_EXAMPLE: Final = "write which diagnostics to ignore, as in `# mlmg: ignore[MS047]`"


@dataclass(slots=True)
class _Ignore:
    """A comment that asks for silence.

    Attributes
    ----------
    codes : each with its place in the comment.
    reason : what a person has written behind the bracket.
    removal : the edit that takes the comment out.
    about : where it asks for silence.
    whole : whether that is all of the script.
    used : the codes of diagnostics that it has silenced.
    """

    comment: Span
    word: str
    codes: tuple[tuple[str, Span], ...]
    reason: str
    removal: Span
    about: Span
    whole: bool
    used: set[str] = field(default_factory=set)

    def covers(self, one: Diagnostic) -> bool:
        """Return whether it asks for silence about a diagnostic."""
        if one.severity is Severity.ERROR or one.code not in {code for code, _ in self.codes}:
            return False
        if one.span is None:
            return self.whole
        return one.span.start <= self.about.end and self.about.start <= one.span.end


def suppress(
    diagnostics: Sequence[Diagnostic], tokens: Sequence[Token], source: Source, complete: bool
) -> tuple[Diagnostic, ...]:
    """Return the diagnostics that no comment silences, and what is to be said of such comments.

    Parameters
    ----------
    complete : whether all that can be said of the script has been said; else nobody knows which comments are idle.
    """
    ignores: list[_Ignore] = []
    remarks: list[Diagnostic] = []
    for found in _comments(tokens, source):
        if isinstance(found, _Ignore):
            ignores.append(found)
        else:
            remarks.append(found)
    if not ignores:
        return (*diagnostics, *remarks)
    left = [one for one in diagnostics if not _silenced(one, ignores)]
    for ignore in ignores:
        remarks += _remarks(ignore, complete)
    return (*left, *remarks)


def _silenced(one: Diagnostic, ignores: Iterable[_Ignore]) -> bool:
    covering = [ignore for ignore in ignores if ignore.covers(one)]
    for ignore in covering:
        ignore.used.add(one.code)
    return bool(covering)


# --- reading the comments ---


def _comments(tokens: Sequence[Token], source: Source) -> Iterator[_Ignore | Diagnostic]:
    """Yield the comments that are meant for the compiler; of those that say nothing it knows, what is wrong.

    Parameters
    ----------
    tokens : of the script; those of the files that it uses are read here.
    """
    base = 0
    for file in (source, *source.used):
        if "mlmg" in file.text:
            yield from _File(file, base, tokenize(source, base) if base else tokens).comments()
        base += len(file.text) + 1


@dataclass(frozen=True, slots=True)
class _File:
    """A file, and where it begins."""

    file: Source
    base: int
    tokens: Sequence[Token]

    def comments(self) -> Iterator[_Ignore | Diagnostic]:
        """Yield its comments to the compiler."""
        statements: list[Span] | None = None
        for at, token in enumerate(self.tokens):
            directive = _DIRECTIVE.match(token.text) if token.type == "COMMENT" else None
            if directive is None:
                continue
            if statements is None:
                statements = list(_statements(lay_out(self.tokens).items))
            alone = at == 0 or self.tokens[at - 1].type == "NEWLINE"
            yield self._read(token, directive.end(), statements if alone else None)

    def _read(self, token: Token, at: int, statements: Sequence[Span] | None) -> _Ignore | Diagnostic:
        """Return what a comment asks for; `statements` are those of the file if it stands on a line of its own."""
        said = _IGNORE.fullmatch(token.text, at)
        codes = () if said is None else tuple(_codes(said[2], token.span.start + said.start(2)))
        removal = self._removal(token.span, alone=statements is not None)
        if said is None or not codes:
            asks = token.text.startswith("ignore", at)
            message = "this comment does not say what to ignore" if asks else "this comment to mlmg is not understood"
            fixes = (Fix(removal, "", safe=True, name="take the comment out"),) if asks else ()
            return Diagnostic("MS071", message, token.span, _EXAMPLE, fixes=fixes)
        whole = said[1] == "ignore-file"
        about = Span(self.base, self.base + len(self.file.text)) if whole else self._about(token.span, statements)
        return _Ignore(token.span, said[1], codes, said[3].strip(), removal, about, whole and self.base == 0)

    def _about(self, comment: Span, statements: Sequence[Span] | None) -> Span:
        if statements is not None:
            return _next(comment, statements)
        row, _ = self.file.position(comment.start - self.base)
        return Span(self.base + self.file.line_starts[row - 1], comment.start)

    def _removal(self, comment: Span, alone: bool) -> Span:
        """Return what to take out with a comment: the spaces before it, and its line if nothing else is there."""
        text, start, end = self.file.text, comment.start - self.base, comment.end - self.base
        while start > 0 and text[start - 1] not in "\r\n" and text[start - 1].isspace():
            start -= 1
        if alone:
            end += 2 if text.startswith("\r\n", end) else int(end < len(text))
        return Span(self.base + start, self.base + end)


def _codes(text: str, start: int) -> Iterator[tuple[str, Span]]:
    """Yield the codes in the brackets; `start` is where these begin."""
    for word in re.finditer(r"[^\s,]+", text):
        yield word[0].upper(), Span(start + word.start(), start + word.end())


def _statements(items: Iterable[Line | Block]) -> Iterator[Span]:
    """Yield where statements are, as they begin; a block before what is in it. Weights of branches are left out."""
    for item in items:
        if isinstance(item, Block):
            yield item.span
            for branch in item.branches:
                yield from _statements(branch)
        elif [token.type for token in item.tokens] != ["INTEGER", "COLON"]:
            yield Span(item.tokens[0].span.start, item.tokens[-1].span.end)


def _next(comment: Span, statements: Sequence[Span]) -> Span:
    """Return the statement behind a comment, or the rest of the one that it stands in; else no place at all."""
    following = next((one for one in statements if one.start >= comment.end), None)
    around = [one for one in statements if one.start < comment.start and comment.end < one.end]
    if around and (following is None or around[-1].end < following.start):
        return Span(comment.end, around[-1].end)
    return following or Span(comment.end, comment.end)


# --- what is wrong with them ---


def _remarks(ignore: _Ignore, complete: bool) -> Iterator[Diagnostic]:
    for code, span in ignore.codes:
        without = _without(ignore, code)
        if code not in CODES:
            yield Diagnostic("MS071", f"there is no diagnostic `{code}`", span, _alike(code), fixes=(without,))
        elif CODES[code].severity is Severity.ERROR:
            message = f"`{code}` cannot be ignored: it is an error, and keeps the script from being played"
            yield Diagnostic("MS072", message, span, "take it out, and mend the script", fixes=(without,))
        elif complete and code not in ignore.used:
            where = "in this file" if ignore.word == "ignore-file" else "here"
            yield Diagnostic("MS070", f"there is no `{code}` {where} to ignore", span, "take it out", fixes=(without,))


def _alike(code: str) -> str:
    from mlmg_lang.spelling import listed, nearest

    near = nearest(code, CODES)
    return f"there is {listed(near, 'or')}; `mlmg rule` lists all" if near else "`mlmg rule` lists all"


def _without(ignore: _Ignore, code: str) -> Fix:
    """Return the edit that takes a code out of a comment, and with the last code the comment."""
    kept = ", ".join(other for other, _ in ignore.codes if other != code)
    name = f"ignore `{code}` no longer"
    if kept:
        reason = f" {ignore.reason}" if ignore.reason else ""
        return Fix(ignore.comment, f"# mlmg: {ignore.word}[{kept}]{reason}", safe=True, name=name)
    if ignore.reason:
        return Fix(ignore.comment, f"# {ignore.reason.lstrip('#').lstrip()}", safe=True, name=name)
    return Fix(ignore.removal, "", safe=True, name=name)
