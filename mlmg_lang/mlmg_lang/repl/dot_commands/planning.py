"""Commands that ask what a command of the language would do from here, without playing it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from mlmg_lang.explaining.tree import table
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.planning.resolved import LeftOut
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.reply import Refusal, Reply
from mlmg_lang.repl.telling import refused_by_compiler
from mlmg_lang.session.candidates import Candidate, LayerOutlook, outlook


def candidates(desk: Desk, argument: str) -> Reply:
    """Tell what a command could take on each graph: how soon, at what cost, and what it would take."""
    if not argument:
        raise Refusal("name a command, as in `.candidates WALK with Upper-Body TALK`")
    analysis = desk.session.analyse(_command(desk, argument))
    if analysis.resolved is None:
        return refused_by_compiler(desk, analysis.source, analysis.diagnostics)
    layers = outlook(desk.session, analysis.resolved)
    if not layers:
        raise Refusal("this names no motion; name a command, as in `.candidates WALK`")
    told = "".join(f"{line}\n" for layer in layers for line in _lines(layer))
    return Reply(told, {"layers": [_data(layer) for layer in layers]})


def explain(desk: Desk, argument: str) -> Reply:
    """Tell the plan of a command from here: how it is understood, what it could take, how long that will take."""
    if not argument:
        raise Refusal("name a command, as in `.explain WALK with Upper-Body TALK`")
    analysis = desk.session.analyse(_command(desk, argument))
    if analysis.resolved is None:
        return refused_by_compiler(desk, analysis.source, analysis.diagnostics)
    # What explains takes as long to import as all the rest of a session does; most sessions ask for no explanation.
    from mlmg_lang.explaining.plan_json import plan_data
    from mlmg_lang.explaining.text import render_statements
    from mlmg_lang.session.explaining import explanation_from_session

    explanation = explanation_from_session(desk.session, analysis)
    return Reply(render_statements(explanation, colour=desk.colour), {"plan": plan_data(explanation)})


def _command(desk: Desk, argument: str) -> str:
    """Return what an argument says as a command: one name is enough, also without the quotes that a script needs."""
    return script_name(argument) if desk.session.names.places(argument) else argument


def _lines(layer: LayerOutlook) -> Iterator[str]:
    yield layer.graph
    yield from (f"  {line}" for line in table(_row(number, one) for number, one in enumerate(layer.candidates, 1)))
    by: dict[str, list[str]] = {}
    for one in layer.left_out:
        by.setdefault(_why(one), []).append(one.motion)
    yield from (f"  left out: {', '.join(motions)}: {why}" for why, motions in by.items())


def _row(number: int, one: Candidate) -> tuple[str, ...]:
    fit = "" if one.of_usual is None else f"OMS {one.of_usual:.2f} of usual"
    cost = f"cost {one.cost:.2f}" if one.seconds else ""
    return f"{number}.", one.motion, fit, _soon(one), cost, "taken" if one.taken else ""


def _soon(one: Candidate) -> str:
    if one.seconds is None:
        return "cannot be reached"
    return f"after {one.seconds:.1f} s" if one.seconds else "as it is"


def _why(one: LeftOut) -> str:
    return f"{one.reason}: {one.because}" if one.reason == "rule 1" else one.because


def _data(layer: LayerOutlook) -> dict[str, Any]:
    return {
        "graph": layer.graph,
        "candidates": [
            {
                "motion": one.motion,
                "seconds": one.seconds,
                "cost": one.cost,
                "of_usual": one.of_usual,
                "taken": one.taken,
            }
            for one in layer.candidates
        ],
        "left_out": [{"motion": one.motion, "reason": one.reason, "because": one.because} for one in layer.left_out],
    }
