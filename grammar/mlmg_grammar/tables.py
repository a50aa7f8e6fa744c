"""The grammar -> the parser's tables as a text, which is kept beside it; and from that text the parser.

Making the tables takes lark longer than all else takes that the check of a small script does.
"""

from __future__ import annotations

import json
import pickle
from collections.abc import Iterable, Mapping
from hashlib import sha256
from io import BytesIO
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lark import Lark, Token, Transformer

FILE = "motion_script.tables.json"


def tables_text(language: Lark, grammar: str) -> str:
    """Return the tables of the parser of a grammar, as JSON; the same grammar gives the same text."""
    saved = BytesIO()
    language.save(saved)
    kept = pickle.loads(saved.getvalue())
    _put_in_order(kept["data"]["parser"]["parser"])
    parts = {"mark": _mark(grammar), "memo": kept["memo"], "data": kept["data"]}
    lines = (f"{json.dumps(name)}:{json.dumps(_jsonable(part), separators=(',', ':'))}" for name, part in parts.items())
    return "{" + ",\n".join(lines) + "}\n"


def language_from_tables(text: str, grammar: str, transformer: Transformer[Token, Any] | None) -> Lark | None:
    """Return the parser of a grammar; None if the tables are those of another grammar, or of another lark."""
    kept = json.loads(text)
    if kept["mark"] != _mark(grammar):
        return None
    from lark import Lark

    data, memo = _from_jsonable(kept["data"]), _from_jsonable(kept["memo"])
    return Lark._load_from_dict(data, memo, transformer=transformer)  # type: ignore[no-untyped-call, no-any-return]


def _mark(grammar: str) -> str:
    """Return what tables are known by."""
    import lark

    return f"lark {lark.__version__}, {sha256(grammar.encode()).hexdigest()}"


# --- order ---


def _put_in_order(parser: dict[str, Any]) -> None:
    """Number tokens by their names, and states as they are reached: lark does so as its sets happen to be ordered."""
    names, states = parser["tokens"], parser["states"]
    ordered = {state: sorted((names[one], *action) for one, action in states[state].items()) for state in states}
    number = {state: at for at, state in enumerate(_reached(parser["start_states"], ordered))}
    token_number = {name: at for at, name in enumerate(sorted(names.values()))}
    parser["tokens"] = {at: name for name, at in token_number.items()}
    parser["states"] = {
        number[state]: {
            token_number[name]: (kind, argument if kind == _REDUCE else number[argument])
            for name, kind, argument in ordered[state]
        }
        for state in number
    }
    for ends in ("start_states", "end_states"):
        parser[ends] = {name: number[state] for name, state in sorted(parser[ends].items())}


_REDUCE = 1
"""How lark writes down that an action reduces by a rule; else it shifts to a state."""


def _reached(starts: Mapping[str, int], actions: Mapping[int, Iterable[tuple[str, int, Any]]]) -> list[int]:
    """Return all states, each once, in an order that only the grammar decides."""
    found = dict.fromkeys(state for _, state in sorted(starts.items()))
    pending = list(found)
    for state in pending:
        fresh = [argument for _, kind, argument in actions[state] if kind != _REDUCE and argument not in found]
        found.update(dict.fromkeys(fresh))
        pending += dict.fromkeys(fresh)
    return pending


# --- JSON, which knows no keys but texts ---


def _jsonable(value: Any) -> Any:
    if isinstance(value, Mapping):
        if all(isinstance(key, str) for key in value):
            return {key: _jsonable(part) for key, part in value.items()}
        return {_PAIRS: [[key, _jsonable(part)] for key, part in value.items()]}
    return [_jsonable(part) for part in value] if isinstance(value, list | tuple) else value


def _from_jsonable(value: Any) -> Any:
    if isinstance(value, dict):
        if _PAIRS in value:
            return {key: _from_jsonable(part) for key, part in value[_PAIRS]}
        return {key: _from_jsonable(part) for key, part in value.items()}
    return [_from_jsonable(part) for part in value] if isinstance(value, list) else value


_PAIRS = "pairs"
