"""Tokens -> the syntax tree, and what is wrong with the syntax. Whatever the tokens, this does not fail."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

from mlmg_lang.diagnostics import Brace, Diagnostic
from mlmg_lang.parsing import layout, syntax
from mlmg_lang.parsing.build_syntax import name_from_token
from mlmg_lang.parsing.layout import MAX_DEPTH, mark
from mlmg_lang.parsing.lexical import check_tokens, join_quoted
from mlmg_lang.parsing.line_parser import Stuck, read
from mlmg_lang.parsing.lookalikes import as_far_as_read, lookalikes, narrowed, without_comments
from mlmg_lang.parsing.nesting import Around, Braces, Mark, Opened, nested
from mlmg_lang.parsing.quotes import CURLY, requoted, without_lone
from mlmg_lang.parsing.strays import stray_signs, without_strays
from mlmg_lang.parsing.swapped import in_order, swapped
from mlmg_lang.parsing.tokenize import MAX_TOKENS
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.source import Source, Span

MAX_MISTAKES = 200
"""After so many a text is no script; reading what is left would take long and help nobody."""
_MAX_MENDED = 2_000
"""The longest line, in tokens, whose mistakes are looked into."""
MAX_STATEMENT = 10_000
"""The longest line, in tokens, that is read."""


@dataclass(frozen=True, slots=True)
class Parsed:
    """A syntax tree with what is wrong with it."""

    script: syntax.Script
    diagnostics: tuple[Diagnostic, ...]


@dataclass(frozen=True, slots=True)
class Read:
    """Statements and what holds them, as they stand one after the other, with what is wrong with each.

    Attributes
    ----------
    deep : whether braces are nested too deep: what stands in them is left out.
    narrow : all tokens, with quotes without a partner and signs of other keyboards as they were meant.
    """

    marks: tuple[Mark, ...]
    diagnostics: tuple[Diagnostic, ...]
    deep: bool
    narrow: Sequence[Token]


def parse(source: Source, tokens: Sequence[Token], base: int = 0) -> Parsed:
    """Return the syntax tree of a whole file; a statement that cannot be read is `Broken` in it.

    Parameters
    ----------
    base : where the file begins whose tokens these are: the script itself, or one that it uses.
    """
    found = read_marks(source, tokens)
    items, wrong = nested(found.marks, end_of(tokens))
    span = Span(base, base + len(source.file(base)[0].text))
    return Parsed(syntax.Script(items, span), (*found.diagnostics, *wrong))


def end_of(tokens: Sequence[Token]) -> int:
    """Return where the last of some tokens ends that is neither comment nor line end."""
    return next((token.span.end for token in reversed(tokens) if token.type not in ("NEWLINE", "COMMENT")), 0)


def read_marks(source: Source, tokens: Sequence[Token], around: Around = (), n_before: int = 0) -> Read:
    """Return what some text says, as far as that does not depend on what stands before and after it.

    Parameters
    ----------
    around : the braces that it stands in.
    n_before : how many mistakes have been told before it, that nothing more is read too; see `counted`.
    """
    left = max(MAX_MISTAKES - n_before, 0)
    quoted = requoted(tokens)
    is_cut_off = MAX_TOKENS in (len(tokens), len(quoted))
    tokens = as_far_as_read(quoted)
    last = tokens[-1] if is_cut_off or tokens is not quoted else None
    narrow = narrowed(tokens)
    wrong = list(islice(lookalikes(tokens, narrow, source), left))
    tokens = join_quoted(without_comments(narrow), source)
    wrong += islice(check_tokens(tokens), left)
    tokens = without_lone(tokens)
    wrong += islice(swapped(tokens), left)
    tokens = in_order(tokens)
    wrong += islice(stray_signs(tokens, len(around)), left)
    marked = mark(without_strays(tokens, len(around)), [braces.bars for braces in around])
    wrong += islice(marked.diagnostics, left)
    reader = _Reader(source, sorted(wrong, key=_start), n_before)
    marks = tuple(reader.marks(marked.marks, around))
    told = reader.told()
    return Read(marks, told if last is None else (*told, _cut_off(last)), marked.deep, narrow)


def counted(n_before: int, told: Sequence[Diagnostic]) -> range:
    """Return how many mistakes have been told before and behind some text in which these are told.

    At most `MAX_MISTAKES` are counted, and one more once it has been said that nothing is read any more.
    """
    ends = n_before > MAX_MISTAKES or any(one.code == "MS006" for one in told)
    return range(n_before, MAX_MISTAKES + 1 if ends else min(n_before + len(told), MAX_MISTAKES))


def _start(one: Diagnostic) -> int:
    assert one.span is not None
    return one.span.start


def _cut_off(last: Token) -> Diagnostic:
    """Say that there is more text than is read."""
    message = f"a script may have at most {MAX_TOKENS:,} words and signs; what comes after this is not read"
    return Diagnostic("MS007", message, last.span, "leave some of it to another script")


class _Reader:
    """Makes nodes of lines and what stands before braces, and collects what is wrong."""

    def __init__(self, source: Source, signs: Sequence[Diagnostic], n_before: int) -> None:
        """Take what is wrong with words and signs, whatever lines they are in, in the order of the text."""
        self.diagnostics: list[Diagnostic] = []
        self._source = source
        self._in_choose = False
        self._signs, self._n_signs = signs, 0
        self._n_before = n_before
        self._ends = n_before > MAX_MISTAKES

    def told(self) -> tuple[Diagnostic, ...]:
        """Return what is wrong, as far as there is not too much of it."""
        self._tell_signs(len(self._signs))
        return (*self._signs[: self._n_signs], *self.diagnostics)

    def _tell_signs(self, end: int) -> None:
        """Count the first signs, up to a number, as told, while that is not too many mistakes."""
        room = MAX_MISTAKES - self._n_before - self._n_signs - len(self.diagnostics)
        self._n_signs += max(min(end - self._n_signs, room), 0)

    def marks(self, marks: Iterable[layout.Mark], around: Around) -> Iterator[Mark]:
        """Yield the nodes of lines and of what stands before braces."""
        outside = list(around)
        for one in marks:
            self._in_choose = bool(outside) and outside[-1].in_choose
            match one:
                case layout.Open():
                    before, opened = self._opened(one)
                    yield from before
                    yield opened
                    outside.append(opened.braces)
                case layout.Close():
                    outside.pop()
                    yield one
                case layout.Line(tokens):
                    yield _weight(tokens) or self._statement(tokens)
                case _:
                    yield one

    def _statement(self, tokens: tuple[Token, ...]) -> syntax.Item | syntax.Weight:
        """Return the statement, or the weight, of a line that has no braces after it."""
        n_before = len(self.diagnostics)
        node = self._read(tokens)
        if isinstance(node, syntax.RepeatHead | syntax.ChooseHead):
            if len(self.diagnostics) > n_before:
                return syntax.Broken(node.span)
            braces = "{ ... }" if isinstance(node, syntax.RepeatHead) else "{ ... | ... }"
            word = tokens[0].text
            message = f"`{word}` needs its statements in `{{ }}`"
            self._say("MS013", message, node.span, f"write `{braces}` after it", Brace.MISSING)
            return syntax.Broken(node.span)
        return node

    def _opened(self, opened: layout.Open) -> tuple[tuple[syntax.Item, ...], Opened]:
        """Return a brace; if nothing takes it, behind what stands before it."""
        before, head = self._before(opened)
        in_choose = self._in_choose if head is None else isinstance(head, syntax.ChooseHead)
        braces, span = Braces(opened.chooses, in_choose), Span(opened.start, opened.brace.end)
        return before, Opened(head, opened.brace, span if head else opened.brace, braces, head is None)

    def _before(
        self, opened: layout.Open
    ) -> tuple[tuple[syntax.Item, ...], syntax.RepeatHead | syntax.ChooseHead | None]:
        """Return what takes a brace; if nothing does, the statement that stands before it, if there is one."""
        if not opened.head:
            if not self._gives_up(opened.brace):
                message = "this `{` has no `repeat` or `choose` before it"
                self._say("MS013", message, opened.brace, "take the braces out", Brace.NEEDLESS)
            return (), None
        n_before = len(self.diagnostics)
        head = self._head(opened)
        told = self.diagnostics[n_before:]
        self.diagnostics[n_before:] = [replace(one, brace=None) if one.brace is Brace.MISSING else one for one in told]
        if isinstance(head, syntax.RepeatHead | syntax.ChooseHead):
            return (), head
        if isinstance(head, syntax.Broken):
            # What stands behind `choose` has been reported; its branches are there all the same.
            is_choice = any(token.type == "CHOOSE" for token in opened.head)
            return ((), syntax.ChooseHead(head.span)) if is_choice else ((head,), None)
        if isinstance(head, syntax.Let):
            return (head,), None
        message = "only `repeat` and `choose` are followed by `{`"
        self._say("MS013", message, opened.brace, "take the braces out", Brace.NEEDLESS)
        return (syntax.Broken(head.span) if isinstance(head, syntax.Weight) else head,), None

    def _head(self, block: layout.Open) -> syntax.Line | syntax.Broken:
        """Return what stands before a brace, also if that is said as in other languages."""
        span = Span(block.head[0].span.start, block.head[-1].span.end)
        if block.head[0].type in ("REPEAT", "CHOOSE") or self._gives_up(span):
            return self._read(block.head)
        from mlmg_lang.parsing.mistakes.blocks import other_head

        mistake = other_head(block.head, block.brace)
        if mistake is None:
            return self._read(block.head)
        self.diagnostics.append(mistake.diagnostic)
        if mistake.meant is not None:
            return self._read(mistake.meant)
        whole = read(self._source, block.head) if block.head[0].type == "LET" else None
        return replace(whole, mended=True) if isinstance(whole, syntax.Let) else _broken(block.head, span)

    def _read(self, tokens: tuple[Token, ...]) -> syntax.Line | syntax.Broken:
        """Return the node of a line, mended as far as one can tell what was meant."""
        span = Span(tokens[0].span.start, tokens[-1].span.end)
        if self._gives_up(span):
            return syntax.Broken(span)
        deep = _too_deep(tokens)
        if deep is not None:
            message = f"parentheses and `not` are nested more than {MAX_DEPTH} deep here"
            self._say("MS005", message, deep.span, "take out those that say nothing")
            return syntax.Broken(span)
        if len(tokens) > MAX_STATEMENT:
            message = f"a statement may have at most {MAX_STATEMENT:,} words and signs"
            self._say("MS007", message, tokens[MAX_STATEMENT].span, "say it in several statements")
            return syntax.Broken(span)
        n_before = len(self.diagnostics)
        node = self._mended(tuple(_as_names(tokens)))
        told = self.diagnostics[n_before:]
        if node is None or _is_doubtful(tokens, told):
            return _broken(tokens, span)
        if isinstance(node, syntax.Let) and not all(map(_is_sure, told)):
            return replace(node, span=span, mended=True)
        return replace(node, span=span) if told else node

    def _mended(self, tokens: tuple[Token, ...]) -> syntax.Line | None:
        """Parse; where the parser is stuck, say why, and return what was meant if that can be told."""
        tokens = self._with_use(tokens)
        outcome = read(self._source, tokens, self._in_choose)
        if not isinstance(outcome, Stuck):
            return outcome
        if len(tokens) > _MAX_MENDED:
            message = "something does not fit here, in a statement too long to look into"
            self.diagnostics.append(Diagnostic("MS010", message, outcome.span))
            return None
        # Most scripts have no such mistake, and these modules take as long to import as a small script to parse.
        from mlmg_lang.parsing.mistakes import mend

        mended = mend(outcome)
        self.diagnostics += mended.diagnostics
        return mended.line

    def _with_use(self, tokens: tuple[Token, ...]) -> tuple[Token, ...]:
        """Return tokens with `use` where a word beside the path of a script is meant for it, and say so."""
        if len(tokens) != 2 or not any(token.type == "STRING" and token.text.endswith('.ms"') for token in tokens):
            return tokens
        from mlmg_lang.parsing.mistakes.heads import use_meant

        mistake = use_meant(tokens)
        if mistake is None or mistake.meant is None:
            return tokens
        self.diagnostics.append(mistake.diagnostic)
        return mistake.meant

    def _gives_up(self, span: Span) -> bool:
        """Return whether too many mistakes come before a place, and say it once."""
        self._tell_signs(bisect_left(self._signs, span.start, key=_start))
        if not self._ends and self._n_before + self._n_signs + len(self.diagnostics) >= MAX_MISTAKES:
            self._ends = True
            message = f"more than {MAX_MISTAKES} mistakes; what comes after this is not read"
            self._say("MS006", message, span, "is this file a script?")
        return self._ends

    def _say(self, code: str, message: str, span: Span, help_: str, brace: Brace | None = None) -> None:
        self.diagnostics.append(Diagnostic(code, message, span, help=help_, brace=brace))


def _weight(tokens: Sequence[Token]) -> syntax.Weight | None:
    """Return the weight that a line is, if it is one."""
    if [token.type for token in tokens] != ["INTEGER", "COLON"]:
        return None
    return syntax.Weight(tokens[0].text, Span(tokens[0].span.start, tokens[1].span.end))


def _is_doubtful(tokens: Sequence[Token], told: Sequence[Diagnostic]) -> bool:
    """Return whether a definition had to be mended before its `=`: then nobody knows what it defines."""
    if not told or tokens[0].type != "LET":
        return False
    head = _head_of(tokens)
    equals = tokens[len(head)].span.start if len(head) < len(tokens) else 0
    return any(one.span is not None and one.span.start < equals and not _is_sure(one) for one in told)


def _head_of(tokens: Sequence[Token]) -> Sequence[Token]:
    """Return what stands before the `=` of a definition; those of defaults stand in parentheses."""
    depth, at = 0, len(tokens)
    for number, token in enumerate(tokens):
        depth += (token.type == "LEFT") - (token.type == "RIGHT")
        if token.type == "EQUALS":
            at = number
            if depth <= 0:
                break
    return tokens[:at]


def _is_sure(one: Diagnostic) -> bool:
    return any(fix.safe for fix in one.fixes)


def _broken(tokens: Sequence[Token], span: Span) -> syntax.Broken:
    """Return what stands for a line that cannot be read, with the names that it may have been meant to define."""
    kinds = [token.type for token in tokens]
    if "LET" not in kinds:
        return syntax.BrokenDefinition(span, ()) if kinds[0] == "USE" else syntax.Broken(span)
    first = kinds.index("LET")
    if kinds[first + 1 : first + 2] in (["EQUALS"], ["LEFT"]) and not first:
        return syntax.BrokenDefinition(span, ())
    names = tuple(name_from_token(token).text for token in _head_of(tokens) if token.type in NAMES)
    return syntax.BrokenDefinition(span, names[:1] if "EQUALS" not in kinds else names)


def _as_names(tokens: Iterable[Token]) -> Iterator[Token]:
    """Yield tokens with names in odd quotes, which have been reported, as if these were sound where they have to be."""
    before = ""
    for token in tokens:
        if token.type == "UNCLOSED":
            is_printed = token.text[-1] in CURLY and len(token.text) > 2
            yield replace(token, type="STRING", text=f'"{token.text[1:-1]}"' if is_printed else token.text)
        elif before == "USE" and token.type == "NAME" and token.text[0] in CURLY:
            yield replace(token, type="STRING", text=f'"{token.text[1:-1]}"')
        else:
            yield token
        before = token.type


def _too_deep(tokens: Iterable[Token]) -> Token | None:
    """Return the first parenthesis or `not` that is nested too deeply in others, if there is one."""
    depth = nots = 0
    outside: list[int] = []
    for token in tokens:
        if token.type in ("NOT", "LEFT"):
            depth += 1
            if depth > MAX_DEPTH:
                return token
        if token.type == "NOT":
            nots += 1
        elif token.type == "LEFT":
            outside.append(nots)
            nots = 0
        else:
            depth -= nots
            nots = 0
            if token.type == "RIGHT" and outside:
                depth -= 1 + outside.pop()
    return None
