"""Words of the language in the wrong case, where they could be names: `WALK ONCE`, `END Upper-Body`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from mlmg_grammar import reserved_words
from mlmg_lang.diagnostics import Diagnostic, Fix
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.build_syntax import motion_script

_WHOLE: Final = frozenset({"end", "wait", "use"})
"""Words that make a whole statement of themselves and one name."""


def is_shouted(name: syntax.Name) -> bool:
    """Return whether a name would be a word of the language, were it in lower case."""
    low = name.text.lower()
    return not name.quoted and low != name.text and low in reserved_words(motion_script())


def wrong_case(name: syntax.Name) -> Diagnostic:
    """Return what to say of such a name."""
    message = f"`{name.text}`: the words of the language are written in lower case"
    low = name.text.lower()
    return Diagnostic("MS011", message, name.span, f"write `{low}`", fixes=(Fix(name.span, low, safe=True),))


def guess_case(script: syntax.Script) -> Iterator[Diagnostic]:
    """Yield the words that make sense in lower case alone, for where no library knows the names."""
    for node in syntax.walk(script):
        if isinstance(node, syntax.Command):
            last = _last_operand(node.motion)
            whole = isinstance(node.motion, syntax.Qualified) and node.duration is None
            for part in syntax.walk(node.motion):
                if isinstance(part, syntax.Qualified):
                    yield from _guess(part, ends=part is last and node.once is None, whole=whole)


def _guess(part: syntax.Qualified, ends: bool, whole: bool) -> Iterator[Diagnostic]:
    """Yield a word in `NAME NAME` that stands where it could be meant."""
    first, second = part.graph, part.motion.name
    low = first.text.lower()
    if is_shouted(first) and (low == "not" or (whole and low in _WHOLE)):
        yield wrong_case(first)
    elif ends and is_shouted(second) and second.text.lower() == "once":
        yield wrong_case(second)


def _last_operand(motion: syntax.Motion) -> syntax.Motion:
    while isinstance(motion, syntax.With | syntax.Or | syntax.And):
        motion = motion.operands[-1]
    return motion
