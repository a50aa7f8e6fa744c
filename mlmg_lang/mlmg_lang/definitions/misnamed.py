"""What is wrong with names -> a definition or parameter whose own name is wrong told once, not at each of its uses.

Where something is used several times that means nothing, while what is defined is not used, the one slip is most often
in the definition: it is told at the first use, with the others and the definition beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

from mlmg_lang.diagnostics import Brace, Diagnostic, Fix, Label
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.source import Source, Span
from mlmg_lang.spelling import is_slip_of, nearest, normal

_OF_DEFINITIONS: Final = frozenset({"MS021", "MS026", "MS028"})
"""What is said of names that may be those of definitions."""
_OF_PARAMETERS: Final = frozenset({"MS021", "MS027", "MS055"})
"""What is said of names that may be those of parameters; of arguments too."""
_OF_DURATIONS: Final = frozenset({"MS017", "MS027"})
"""What is said of names in the place of a duration, or of its number."""
_ENDS_LOOP: Final = frozenset({"while", "until", "times"})
"""What stands behind the braces of a loop in other languages."""
_REACH: Final = 80
"""So many characters before such a word are looked at."""


@dataclass(frozen=True, slots=True)
class Naming:
    """What has to be known of a script to tell whose name is wrong.

    Attributes
    ----------
    source : asked for the places in what is told.
    place : where such a place is in the text.
    lets : its definitions, those of the files that it uses too.
    unread : the names, in NFC, of definitions that could not be read.
    is_used : whether statements use a name.
    """

    source: Source
    place: Callable[[Span], Span]
    lets: Iterable[syntax.Let]
    unread: Iterable[str]
    is_used: Callable[[str], bool]


@dataclass(frozen=True, slots=True)
class _Declared:
    """Something that is defined and not used: its name, and what to call it."""

    name: syntax.Name
    kind: str


def told_once(told: Sequence[Diagnostic], naming: Naming) -> Sequence[Diagnostic]:
    """Return what is wrong with a script, of definitions whose own names are wrong each told once."""
    if not any(one.code in _OF_DEFINITIONS | _OF_PARAMETERS | _OF_DURATIONS for one in told):
        return told
    told = _without_conditions(_without_unread(told, naming), naming)
    for let in naming.lets:
        if let.parameters:
            told = _with_parameters(told, let, naming)
    return _with_definitions(told, naming)


def _without_unread(told: Sequence[Diagnostic], naming: Naming) -> Sequence[Diagnostic]:
    """Leave out names that a definition probably has which could not be read: `let GREETx) = x`, `let t = 5 sec`."""
    unread = tuple(naming.unread)
    if not unread:
        return told

    def follows(one: Diagnostic) -> bool:
        if one.code in _OF_DURATIONS:
            return normal(_name(one, naming)) in unread
        name = _name(one, naming) if one.code in _OF_DEFINITIONS else ""
        return len(name) > 1 and any(word.startswith(name) or is_slip_of(word, name) for word in unread)

    return [one for one in told if not follows(one)]


def _without_conditions(told: Sequence[Diagnostic], naming: Naming) -> Sequence[Diagnostic]:
    """Leave out the end of `do { WALK } while`, which is told of where it begins."""
    if not any(one.brace is Brace.LOOP for one in told):
        return told
    text = naming.source.text

    def ends(one: Diagnostic) -> bool:
        if one.code not in {*_OF_DEFINITIONS, "MS019"} or _name(one, naming) not in _ENDS_LOOP:
            return False
        start = naming.place(_span(one)).start
        return text[max(0, start - _REACH) : start].rstrip().endswith("}")

    return [one for one in told if not ends(one)]


def _with_parameters(told: Sequence[Diagnostic], let: syntax.Let, naming: Naming) -> Sequence[Diagnostic]:
    """Return what is told with the parameters of a definition whose names are wrong each told once."""
    said = _said(let)
    parameters = [one.name for one in let.parameters or () if one.name.sound and normal(one.name.text) not in said]
    if not parameters:
        return told
    uses = _by_name((one for one in told if _may_name_parameter(one, let)), naming)
    for name, some in uses.items():
        if not any(_is_within(one, let) for one in some):
            continue
        unused = [_Declared(parameter, "parameter") for parameter in parameters]
        told = _joined(told, name, some, unused, len(uses) == 1, naming)
    return told


def _said(let: syntax.Let) -> frozenset[str]:
    """Return all names in what a definition stands for, in NFC."""
    return frozenset(normal(node.text) for node in syntax.walk(let.command) if isinstance(node, syntax.Name))


def _may_name_parameter(one: Diagnostic, let: syntax.Let) -> bool:
    if one.code not in _OF_PARAMETERS or one.span is None:
        return False
    return _is_within(one, let) or (one.code == "MS055" and let.name.span in (note.span for note in one.notes))


def _is_within(one: Diagnostic, let: syntax.Let) -> bool:
    return one.span is not None and let.span.start <= one.span.start and one.span.end <= let.span.end


def _with_definitions(told: Sequence[Diagnostic], naming: Naming) -> Sequence[Diagnostic]:
    """Return what is told with the definitions whose names are wrong each told once."""
    uses = _by_name((one for one in told if one.code in _OF_DEFINITIONS), naming)
    several = {name: some for name, some in uses.items() if len(some) > 1}
    if not several:
        return told
    said = {name for let in naming.lets for name in _said(let)}
    lets = [let for let in naming.lets if let.name.sound and normal(let.name.text) not in said]
    unused = [_Declared(let.name, "definition") for let in lets if not naming.is_used(normal(let.name.text))]
    for name, some in several.items():
        told = _joined(told, name, some, unused, len(uses) == 1, naming)
    return told


def _by_name(told: Iterable[Diagnostic], naming: Naming) -> Mapping[str, list[Diagnostic]]:
    """Return what is told by the names that it is about, each in the order of the text."""
    found: dict[str, list[Diagnostic]] = {}
    for one in told:
        name = _name(one, naming)
        if name:
            found.setdefault(name, []).append(one)
    for some in found.values():
        some.sort(key=lambda one: naming.place(_span(one)))
    return found


def _name(one: Diagnostic, naming: Naming) -> str:
    """Return the name that something is told about, as it is written."""
    return "" if one.span is None else naming.source.slice(one.span).split("(")[0].strip().strip('"')


def _joined(
    told: Sequence[Diagnostic],
    name: str,
    uses: Sequence[Diagnostic],
    unused: Sequence[_Declared],
    is_only: bool,
    naming: Naming,
) -> Sequence[Diagnostic]:
    """Return what is told, with what is said of a name in one if something unused was probably meant to have it.

    Parameters
    ----------
    is_only : whether it is the only name that means nothing.
    """
    first, *others = uses
    meant = _meant(name, first, unused, is_only)
    if meant is None or (first.fixes and not others):
        return told
    right = script_name(name)
    here = naming.place(meant.name.span).end <= len(naming.source.text)
    labels = [Label(_named(one, name, naming), "and here") for one in others]
    labels.append(Label(meant.name.span, f"this {meant.kind} is not used"))
    whole = replace(
        first,
        help=f"if the {meant.kind} `{meant.name.text}` is meant, give it the name `{right}`",
        fixes=(Fix(meant.name.span, right, safe=False),) if here else first.fixes,
        labels=(*first.labels, *labels),
    )
    left_out = set(map(id, others))
    return [whole if one is first else one for one in told if id(one) not in left_out]


def _meant(name: str, first: Diagnostic, unused: Sequence[_Declared], is_only: bool) -> _Declared | None:
    """Return what was probably meant to have a name: what is spelt much like it, else the only thing that is unused."""
    by_name = {one.name.text: one for one in unused}
    likely = [fix.replacement for fix in first.fixes[:1]]
    near = [by_name[word] for word in nearest(name, by_name, limit=1)]
    if near and (not likely or likely == [script_name(near[0].name.text)]):
        return near[0]
    return unused[0] if len(unused) == 1 and is_only and not likely else None


def _named(one: Diagnostic, name: str, naming: Naming) -> Span:
    """Return the place of the name alone, of which something is told."""
    span = _span(one)
    size = naming.source.slice(span).find(name) + len(name)
    return Span(span.start, span.start + size + (naming.source.slice(span)[size : size + 1] == '"'))


def _span(one: Diagnostic) -> Span:
    assert one.span is not None, "names have places"
    return one.span
