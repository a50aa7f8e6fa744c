"""A duration behind a definition that says itself how long it lasts -> what is wrong, and where it belongs."""

from __future__ import annotations

from mlmg_lang.definitions.parameters import Kind, Signature
from mlmg_lang.diagnostics import Diagnostic, Fix, Note
from mlmg_lang.parsing import syntax
from mlmg_lang.source import Span


def lasts_already(
    let: syntax.Let, signature: Signature, use: syntax.Reference | syntax.Call, command: syntax.Command
) -> Diagnostic:
    """Return what is wrong with the `for` or `once` of a command that is the use of a definition which lasts."""
    span = command.once or (command.duration.span if command.duration is not None else command.span)
    message = f"`{let.name.text}` says itself how long it lasts"
    note = Note("it is defined here", let.name.span)
    given = None
    if isinstance(command.duration, syntax.Quantity):
        given = _as_argument(signature, use, command.duration)
    if given is None:
        fix = Fix(Span(use.span.end, span.end), "", safe=False)
        return Diagnostic("MS057", message, span, "take this out", (note,), (fix,))
    start, argument, text = given
    before = "..., " if isinstance(use, syntax.Call) and use.arguments else ""
    advice = f"write `{use.name.text}({before}{argument})`"
    return Diagnostic("MS057", message, span, advice, (note,), (Fix(Span(start, span.end), text, safe=True),))


def _as_argument(
    signature: Signature, use: syntax.Reference | syntax.Call, duration: syntax.Quantity
) -> tuple[int, str, str] | None:
    """Return where a duration is given as an argument, the argument, and what to write from there on; None: nowhere."""
    arguments = use.arguments if isinstance(use, syntax.Call) else ()
    names = list(signature.kinds)
    given = {names[at] if one.name is None else one.name.text for at, one in enumerate(arguments) if at < len(names)}
    wanted = next((name for name, kind in signature.kinds.items() if kind is Kind.DURATION and name not in given), None)
    if wanted is None:
        return None
    value = f"{duration.number} {duration.unit}"
    is_next = names.index(wanted) == len(arguments) and all(one.name is None for one in arguments)
    argument = value if is_next else f"{wanted} = {value}"
    if isinstance(use, syntax.Reference):
        return use.span.end, argument, f"({argument})"
    return use.span.end - 1, argument, f"{', ' if arguments else ''}{argument})"
