"""Another name for a definition or a parameter -> the edits that give it, in all files, or why it cannot be given.

A name is refused that means something already where the old one is used, so that the script goes on to play the same.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from mlmg_grammar import reserved_words
from mlmg_lang.analysis import Analysis
from mlmg_lang.ide.occurrences import RENAMED, Occurrence, Place, Sort, Symbol, occurrence_at, occurrences_of, place_of
from mlmg_lang.ide.references import everywhere
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.amounts import UNITS
from mlmg_lang.parsing.build_syntax import motion_script, name_from_token
from mlmg_lang.parsing.lexical import check_tokens, script_name
from mlmg_lang.parsing.structure import SUB
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.source import Edit, Source, Span
from mlmg_lang.spelling import normal


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why something cannot be done, in words for the one who asked for it."""

    why: str


@dataclass(frozen=True, slots=True)
class Renameable:
    """A name that can be another: where it stands, and what it is without quotes."""

    span: Span
    name: str


def prepare_rename(analysis: Analysis, offset: int) -> Renameable | Refusal:
    """Return the name at an offset if it can be renamed."""
    found = occurrence_at(analysis, offset)
    return _renameable(found) if found is None or found.symbol.sort not in RENAMED else _named(found)


def _named(found: Occurrence) -> Renameable:
    return Renameable(found.span, found.symbol.name)


def _renameable(found: Occurrence | None) -> Refusal:
    """Return why something cannot be renamed that no script defines."""
    if found is None:
        return Refusal("there is no name here")
    name = found.symbol.name
    match found.symbol.sort:
        case Sort.MOTION | Sort.TAG | Sort.GRAPH as sort:
            return Refusal(f"`{name}` is a {sort} of the library; a script can rename what it defines alone")
        case Sort.SUB:
            return Refusal(f"`{SUB}` is a word of the language")
        case Sort.FILE:
            return Refusal(f"`{name}` is a file, not a name")
    return Refusal(f"`{name}` is not defined")


def rename(
    analysis: Analysis,
    offset: int,
    new: str,
    others: Sequence[Analysis] = (),
    seen: Container[str] | None = None,
) -> Mapping[str, tuple[Edit, ...]] | Refusal:
    """Return the edits, by file and in the order of its text, that give the name at an offset another.

    Parameters
    ----------
    new : with or without quotes. It is written in quotes where it has to be.
    others : scripts that may use the same files, or this one.
    seen : the names of the files that the person sees; None if that is all. In others nothing is edited that could not
        be read.
    """
    found = occurrence_at(analysis, offset)
    if found is None or found.symbol.sort not in RENAMED:
        return _renameable(found)
    name = _valid(new)
    if isinstance(name, Refusal) or name == found.symbol.name:
        return name if isinstance(name, Refusal) else {}
    places = list(everywhere(analysis, found.symbol, others))
    scripts = {id(script): script for script in (analysis, *(script for script, _ in places))}
    refusals = (refusal for script in scripts.values() for refusal in _refusals(script, found.symbol, name, seen))
    return next(refusals, None) or _edits(places, found.symbol.sort, name)


def _refusals(script: Analysis, symbol: Symbol, name: str, seen: Container[str] | None) -> Iterator[Refusal]:
    yield from _unread(script, symbol, seen)
    is_seen = seen is None or script.source.name in seen
    for clash in _clashes(script, symbol, name):
        yield clash if is_seen else Refusal(f"{script.source.name}: {clash.why}")


def _edits(places: Iterable[tuple[Analysis, Occurrence]], sort: Sort, name: str) -> dict[str, tuple[Edit, ...]]:
    by_file: dict[str, dict[Span, Edit]] = {}
    for script, one in places:
        place = place_of(script.source, one.span)
        file, _ = script.source.file(one.span.start)
        text = name if sort is Sort.PARAMETER else _written(name, file.text, place)
        by_file.setdefault(place.file, {})[place.span] = Edit(place.span, text)
    return {file: tuple(edits[span] for span in sorted(edits)) for file, edits in by_file.items()}


def _written(name: str, text: str, place: Place) -> str:
    """Return a name as it has to be written in a place: in quotes too if it would be joined to what stands around."""
    plain = script_name(name)
    before, after = text[: place.span.start][-1:], text[place.span.end :][:1]
    joins = any(sign == "-" or f"_{sign}".isidentifier() for sign in (before, after) if sign)
    return f'"{name}"' if not plain.startswith('"') and (joins or name in UNITS) else plain


# --- names that can be given -----------------------------------------------------------------------------


def _valid(new: str) -> str | Refusal:
    """Return a new name in NFC and without quotes, or why it cannot be one."""
    tokens = tokenize(Source(new.strip()))
    name = normal(new.strip())
    if len(tokens) == 1 and tokens[0].type == "STRING":
        name = normal(name_from_token(tokens[0]).text)
    elif name.startswith('"'):
        return Refusal(f"`{name}` is not a whole name in quotes")
    if not name.strip():
        return Refusal("a name cannot be empty")
    written = tokenize(Source(script_name(name)))
    wrong = next(check_tokens(written), None)
    if wrong is not None or len(written) != 1 or written[0].type not in NAMES or not name.isprintable():
        return Refusal(f"`{new}` cannot be a name" + (f": {wrong.message}" if wrong is not None else ""))
    if name.lower() in reserved_words(motion_script()) or name.casefold() == SUB.casefold():
        return Refusal(f"`{name}` is a word of the language")
    return name


def _clashes(script: Analysis, symbol: Symbol, name: str) -> Iterator[Refusal]:
    """Yield what a new name means already in a script."""
    lets = script.made.gathered.definitions.lets
    if name in lets:
        yield Refusal(f"there is a definition `{name}` already")
    yield from _in_library(script, name)
    if symbol.sort is Sort.PARAMETER:
        if script_name(name).startswith('"'):
            yield Refusal(f"`{name}` would have to stand in quotes, which parameters cannot")
        yield from _taken_in(lets.get(symbol.owner), name)
    else:
        yield from (_hidden(let, name) for let in lets.values() if _would_hide(let, symbol.name, name))
        yield from _meant_already(script, name)


def _unread(script: Analysis, symbol: Symbol, seen: Container[str] | None) -> Iterator[Refusal]:
    """Yield where something stands in a statement that could not be read, in a file that the person does not see."""
    hint = Symbol(Sort.DEFINITION, symbol.owner) if symbol.sort is Sort.PARAMETER else symbol
    for one in occurrences_of(script, hint):
        file, _ = script.source.file(one.span.start)
        if one.broken and seen is not None and file.name not in seen:
            line, _ = script.source.position(one.span.start)
            yield Refusal(f"`{hint.name}` stands in line {line} of {file.name}, which cannot be read: mend that first")


def _in_library(script: Analysis, name: str) -> Iterator[Refusal]:
    names = script.question.names
    if names is None:
        return
    if names.graph(name) is not None:
        yield Refusal(f"`{names.graph(name)}` is a graph of the library")
    match = next((found for graph in names.graphs if (found := names.find(graph, name, exactly=True))), None)
    if match is not None:
        yield Refusal(f"`{name}` is a {match.entry.kind} of the library")


def _taken_in(let: syntax.Let | None, name: str) -> Iterator[Refusal]:
    """Yield what a name means already in the definition that a parameter is of."""
    if let is None:
        return
    if any(normal(parameter.name.text) == name for parameter in let.parameters or ()):
        yield Refusal(f"`{let.name.text}` has a parameter `{name}` already")
    elif _names(let.command, name):
        yield Refusal(f"`{name}` means something else in `{let.name.text}` already")


def _would_hide(let: syntax.Let, old: str, name: str) -> bool:
    """Return whether a parameter of a new name would stand for a definition that is used beside it."""
    own = {normal(parameter.name.text) for parameter in let.parameters or ()}
    return name in own and old not in own and _names(let.command, old)


def _hidden(let: syntax.Let, name: str) -> Refusal:
    return Refusal(f"`{name}` is a parameter of `{let.name.text}`, which uses this definition")


def _names(node: syntax.Node, name: str) -> bool:
    """Return whether something in an expression has a name that a definition or a parameter could have."""
    return any(normal(part.text) == name for part in _free_names(node))


def _free_names(node: syntax.Node) -> Iterator[syntax.Name]:
    for part in syntax.walk(node):
        match part:
            case syntax.Reference(name) | syntax.Call(name) | syntax.Command(duration=syntax.Name() as name):
                yield name


def _meant_already(script: Analysis, name: str) -> Iterator[Refusal]:
    """Yield where a script has a name already that it does not define: with a definition it would mean that."""
    for symbol in _undefined(script, name):
        for one in occurrences_of(script, symbol):
            written = script.source.slice(one.span)
            kind = "STRING" if written.startswith('"') else "NAME"
            if normal(name_from_token(Token(kind, written, one.span)).text) == name:
                line, _ = script.source.position(one.span.start)
                yield Refusal(f"`{name}` means something else in line {line} already")


def _undefined(script: Analysis, name: str) -> Iterator[Symbol]:
    """Yield what a name can stand for that no script defines."""
    yield Symbol(Sort.UNKNOWN, name)
    names = script.question.names
    places = () if names is None else names.places(name)
    match = names.find_unqualified(places[0], name) if names is not None and places else None
    if match is not None:
        yield Symbol(Sort(match.entry.kind), match.entry.name)
