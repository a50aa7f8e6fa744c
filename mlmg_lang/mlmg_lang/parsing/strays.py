"""Signs that would cut a statement in two -> the tokens without them, and what is wrong.

`;`, `|` and braces end a statement and begin the next. Where what stands before them cannot end one, or what stands
behind them cannot begin one, they are the mistake themselves: read as they stand, they would make two of one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Final

from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing.foreign import defines, opens_block, other_word
from mlmg_lang.parsing.tokens import CONTINUES, JOINERS, NAMES, NUMBERS, OPENS_STATEMENT, Token, n_open_braces
from mlmg_lang.source import Span

_SIGNS: Final = frozenset({"SEMICOLON", "BAR", "OPEN", "CLOSE"})
_GOES_ON: Final = JOINERS | {"FOR", "WAIT", "LET", "USE", "END", "EQUALS", "COMMA", "LEFT"}
"""What no statement ends with."""
_WITHIN: Final = CONTINUES | {"RIGHT", "EQUALS", "COMMA"}
"""What no statement begins with."""
_REACH: Final = 60
"""So many tokens before and behind a sign are looked at."""
_ENDS_STATEMENT: Final = _SIGNS | {"NEWLINE"}
_BETWEEN: Final = frozenset({"NEWLINE", "COMMENT"})


@dataclass(frozen=True, slots=True)
class Stray:
    """A sign that is not meant.

    Attributes
    ----------
    at : its index. partner : that of the brace that goes with it, if there is one.
    is_told : whether what it stands in is told as a whole.
    is_right : whether it is a brace in place of the parenthesis that was meant.
    """

    at: int
    partner: int | None = None
    is_told: bool = False
    is_right: bool = False


def without_strays(tokens: Sequence[Token], depth: int = 0) -> Sequence[Token]:
    """Return tokens without signs that would cut a statement in two; the very same if there are none.

    Braces around a part of a statement are read as the parentheses that were meant. For `depth` see `find_strays`.
    """
    changed: dict[int, Token | None] = {}
    for stray in find_strays(tokens, depth):
        changed[stray.at] = replace(tokens[stray.at], type="RIGHT", text=")") if stray.is_right else None
        if stray.partner is not None:
            opening, closing = tokens[stray.at], tokens[stray.partner]
            is_group = _groups(tokens, stray.at)
            changed[stray.at] = replace(opening, type="LEFT", text="(") if is_group else None
            changed[stray.partner] = replace(closing, type="RIGHT", text=")") if is_group else None
    if not changed:
        return tokens
    kept = (changed.get(at, token) for at, token in enumerate(tokens))
    return [token for token in kept if token is not None]


def stray_signs(tokens: Sequence[Token], depth: int = 0) -> Iterator[Diagnostic]:
    """Yield what is wrong with such signs; for `depth` see `find_strays`."""
    for stray in find_strays(tokens, depth):
        if stray.is_told:
            continue
        sign = tokens[stray.at]
        if stray.partner is not None and _groups(tokens, stray.at):
            yield _braces(sign.span, tokens[stray.partner].span, tokens[stray.at + 1 : stray.partner])
            continue
        yield _needless(sign) if not stray.is_right else _for_right(sign)


def _needless(sign: Token) -> Diagnostic:
    fix = Fix(sign.span, "", safe=False)
    code = "MS013" if sign.type in ("OPEN", "CLOSE") else "MS010"
    message = f"`{sign.text}` cannot stand in the midst of a statement"
    return Diagnostic(code, message, sign.span, "take it out", fixes=(fix,))


def _for_right(brace: Token) -> Diagnostic:
    """Say what is wrong with `(TALK and IDLE}`."""
    fix = Fix(brace.span, ")", safe=True)
    return Diagnostic("MS012", "a `(` is closed by `)`, not by `}`", brace.span, "write `)`", fixes=(fix,))


def _braces(opening: Span, closing: Span, inside: Sequence[Token]) -> Diagnostic:
    message = "a part of a statement stands in `( )`, not in braces"
    span = Span(opening.start, closing.end)
    return Diagnostic("MS013", message, span, "write `(` and `)`")


def find_strays(tokens: Sequence[Token], depth: int = 0) -> list[Stray]:
    """Return the signs that would cut a statement in two, in the order of the text.

    Parameters
    ----------
    depth : how many blocks are open before the tokens.
    """
    signs = [at for at, token in enumerate(tokens) if token.type in _SIGNS]
    found: list[Stray] = []
    partners: set[int] = set()
    in_loop_heads = frozenset(_in_loop_heads(tokens)) if signs else frozenset()
    for at in signs:
        if at in partners:
            continue
        stray = Stray(at, is_told=True) if at in in_loop_heads else _stray(tokens, at, depth)
        if stray is None:
            depth = max(0, depth + (tokens[at].type == "OPEN") - (tokens[at].type == "CLOSE"))
            continue
        found.append(stray)
        partners |= {stray.partner} if stray.partner is not None else set()
    return found


def _stray(tokens: Sequence[Token], at: int, depth: int) -> Stray | None:
    """Return a sign if it is not meant; `depth`: how many blocks are open before it."""
    kind, before, after = tokens[at].type, _before(tokens, at), _after(tokens, at)
    if kind != "OPEN" and _is_before_brace(tokens, at):
        return Stray(at)
    if before in _ENDS_STATEMENT | {"COLON"}:
        return None
    if kind == "OPEN":
        return _stray_opening(tokens, at, before, after)
    if kind == "CLOSE":
        return _stray_closing(tokens, at, before, after, depth)
    if after == "NEWLINE":
        return None
    splits = after not in _SIGNS | OPENS_STATEMENT and _splits(tokens, at)
    is_within = kind == "SEMICOLON" and after in _WITHIN
    return Stray(at) if (splits or is_within) and _is_meant(tokens, at, splits) else None


def _is_before_brace(tokens: Sequence[Token], at: int) -> bool:
    """`choose | {`, `repeat 2 } {`."""
    kinds = [token.type for token in _line_before(tokens, at)]
    return kinds in (["CHOOSE"], ["REPEAT", "INTEGER"]) and _after(tokens, at) == "OPEN"


def _stray_closing(tokens: Sequence[Token], at: int, before: str, after: str, depth: int) -> Stray | None:
    """Return a `}` if it is not meant."""
    is_for_right = depth == 0 and before in NAMES | {"RIGHT"} and _is_inside(tokens, at)
    if after == "NEWLINE" and not is_for_right:
        return None
    # Where the block begins in the same line, and ends nowhere else in it, this is its end.
    is_end = depth > 0 and _n_open_before(tokens, at) > 0 and _n_closing_behind(tokens, at) == 0
    if _is_inside(tokens, at) and not is_end and before in NAMES | {"RIGHT"}:
        if _closing(tokens, at) is not None:
            return Stray(at)
        return Stray(at, is_right=True) if after in CONTINUES or depth == 0 else None
    splits = after not in _SIGNS | OPENS_STATEMENT and _splits(tokens, at)
    side_by_side = depth == 0 and before in NAMES and after in NAMES | {"LEFT"}
    is_cut = after in _WITHIN and not is_end
    return Stray(at) if splits or side_by_side or is_cut or (depth == 0 and after == "OPEN") else None


def _n_open_before(tokens: Sequence[Token], at: int) -> int:
    """Return how many braces are open before a sign that are opened in its line."""
    return n_open_braces(_whole_line_before(tokens, at))


def _n_closing_behind(tokens: Sequence[Token], at: int) -> int:
    """Return how many braces behind a sign, in its line, close one that is opened before it."""
    depth = least = 0
    for token in tokens[at + 1 : at + _REACH]:
        if token.type == "NEWLINE":
            break
        depth += (token.type == "OPEN") - (token.type == "CLOSE")
        least = min(least, depth)
    return -least


def _whole_line_before(tokens: Sequence[Token], at: int) -> Sequence[Token]:
    first = at
    while first > max(at - _REACH, 0) and tokens[first - 1].type != "NEWLINE":
        first -= 1
    return tokens[first:at]


def _splits(tokens: Sequence[Token], at: int) -> bool:
    """Return whether no statement ends with what stands before a sign."""
    before, after = _before(tokens, at), _after(tokens, at)
    if before in NUMBERS:
        return after == "UNIT"
    if before in ("FOR", "WAIT", "REPEAT"):
        return after in NUMBERS
    if before in NAMES and after == "LEFT":
        return _is_head(tokens, at) or _has_arguments(tokens, at + 1)
    return before in _GOES_ON and not _is_finished(tokens, at)


def _is_head(tokens: Sequence[Token], at: int) -> bool:
    """Return whether `let` stands before a sign, and no `=`."""
    kinds = [token.type for token in _line_before(tokens, at)]
    return kinds[:1] == ["LET"] and "EQUALS" not in kinds


def _has_arguments(tokens: Sequence[Token], at: int) -> bool:
    """Return whether there is a `,` or `=` in a parenthesis itself, as in none that begins a statement."""
    closing = _closing(tokens, at)
    kinds = [token.type for token in tokens[at : closing or at]]
    depths = accumulate((kind == "LEFT") - (kind == "RIGHT") for kind in kinds)
    return any(kind in ("COMMA", "EQUALS") and depth == 1 for kind, depth in zip(kinds, depths, strict=True))


def _is_meant(tokens: Sequence[Token], at: int, splits: bool) -> bool:
    """Return whether a statement goes on behind a sign that nothing should stand before, or behind."""
    before, after = _before(tokens, at), _after(tokens, at)
    if tokens[at].type == "BAR" or _is_inside(tokens, at):
        return True
    if before in JOINERS:
        is_sub = after == "NAME" and tokens[at + 1].text.lower() == "sub"
        return splits and (is_sub or _line_before(tokens, at)[0].type == "LET")
    return splits or (after in ("EQUALS", "COMMA") and not _is_finished(tokens, at))


def _in_loop_heads(tokens: Sequence[Token]) -> Iterator[int]:
    """Yield the signs that stand in `for (i = 0; i < 3; i++) {`."""
    for at in [at for at, token in enumerate(tokens) if token.type == "LEFT"]:
        is_head = at > 0 and (tokens[at - 1].type == "FOR" or other_word(tokens[at - 1].text, "repeat"))
        closing = _closing(tokens, at) if is_head and (at == 1 or tokens[at - 2].type in _ENDS_STATEMENT) else None
        if closing is not None and _after(tokens, closing) == "OPEN":
            yield from (inside for inside in range(at, closing) if tokens[inside].type == "SEMICOLON")


def _closing(tokens: Sequence[Token], at: int) -> int | None:
    """Return where the partner of a parenthesis stands, in the same line; of one before, where a sign stands there."""
    depth = int(tokens[at].type != "LEFT")
    for other in range(at, min(at + _REACH, len(tokens))):
        kind = tokens[other].type
        depth += (kind == "LEFT") - (kind == "RIGHT")
        if depth == 0:
            return other
        if kind == "NEWLINE":
            return None
    return None


def _is_inside(tokens: Sequence[Token], at: int) -> bool:
    """Return whether a parenthesis is open before a sign in its statement."""
    kinds = [token.type for token in _line_before(tokens, at)]
    return kinds.count("LEFT") > kinds.count("RIGHT")


def _is_finished(tokens: Sequence[Token], at: int) -> bool:
    """Return whether the statement before a sign has come to its end, whatever stands behind that."""
    return any(token.type in ("FOR", "ONCE", "WAIT") for token in _line_before(tokens, at))


def _stray_opening(tokens: Sequence[Token], at: int, before: str, after: str) -> Stray | None:
    """Return a `{` if it is not meant."""
    head = _line_before(tokens, at)
    is_split = before in NUMBERS and after == "UNIT" and "REPEAT" not in [token.type for token in head]
    if is_split:
        return Stray(at)
    if opens_block(head):
        return None
    closing = _partner(tokens, at)
    if _n_open_before(tokens, at) > 0 and closing is not None and _n_closing_behind(tokens, closing) == 0:
        closing = None  # It ends the block that is opened before.
    if defines(head) and (closing is not None or after != "NEWLINE"):
        return Stray(at) if closing is None and head[0].type == "LET" else None
    if closing is not None:
        behind = _after(tokens, closing)
        return Stray(at, closing) if before in _GOES_ON or after in _WITHIN or behind in _WITHIN else None
    splits = after not in OPENS_STATEMENT | _SIGNS and _splits(tokens, at)
    return Stray(at) if after != "NEWLINE" and (splits or after in _WITHIN) else None


def _groups(tokens: Sequence[Token], at: int) -> bool:
    """Return whether a brace and its partner stand around a whole part of a statement."""
    return _after(tokens, at) not in _WITHIN and _before(tokens, at) not in ("FOR", "WAIT")


def _partner(tokens: Sequence[Token], at: int) -> int | None:
    """Return where the brace stands, in the same line, that closes one."""
    depth = 0
    for other in range(at, min(at + _REACH, len(tokens))):
        kind = tokens[other].type
        depth += (kind == "OPEN") - (kind == "CLOSE")
        if depth == 0:
            return other
        if depth > 2 or kind in ("NEWLINE", "SEMICOLON", "BAR"):
            return None
    return None


def _line_before(tokens: Sequence[Token], at: int) -> Sequence[Token]:
    """Return what stands before a sign in its statement and line."""
    first = at
    while first > max(at - _REACH, 0) and tokens[first - 1].type not in _ENDS_STATEMENT:
        first -= 1
    return tokens[first:at]


def _before(tokens: Sequence[Token], at: int) -> str:
    """Return the type of what stands before a sign in its line, `NEWLINE` where nothing does."""
    return tokens[at - 1].type if at else "NEWLINE"


def _after(tokens: Sequence[Token], at: int) -> str:
    """Return the type of what stands behind a sign in its line, `NEWLINE` where nothing does."""
    return "NEWLINE" if at + 1 == len(tokens) or tokens[at + 1].type in _BETWEEN else tokens[at + 1].type
