"""An explanation -> text that a person can read: a tree for each statement."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from mlmg_lang.explaining.explanation import (
    Branch,
    Candidate,
    Choose,
    Command,
    Duration,
    End,
    Ending,
    Execution,
    Explanation,
    Expression,
    Fit,
    Gain,
    Layer,
    Likely,
    Named,
    OnGraph,
    Part,
    PassedOver,
    Played,
    Ranking,
    Repeat,
    SetExpression,
    SetOperator,
    Shared,
    Statement,
    Totals,
    Use,
    Wait,
    With,
)
from mlmg_lang.explaining.tree import Tree, table, tree_lines
from mlmg_lang.planning.estimate import Estimate
from mlmg_lang.rendering.colour import BLUE, BOLD, Painter
from mlmg_lang.spelling import joined

WIDTH: Final = 100
_MOST_CANDIDATES: Final = 20
_GOALS = {
    "soonest": "whichever is reached soonest",
    "look ahead": "what was chosen for each round",
}
_MOST_EXECUTIONS: Final = 3
_GREEN: Final = "32"
_DIM: Final = "2"


def render_text(explanation: Explanation, width: int = WIDTH, colour: bool = False) -> str:
    """Return an explanation as trees of lines, after one line that sums it up.

    Parameters
    ----------
    width : in columns of a terminal.
    """
    summary = tree_lines(_summary(explanation), width, Painter(colour))
    return "\n".join(("".join(f"{line}\n" for line in summary), *_statements(explanation, width, colour)))


def render_statements(explanation: Explanation, width: int = WIDTH, colour: bool = False) -> str:
    """Return the trees of the statements alone."""
    return "\n".join(_statements(explanation, width, colour))


def _statements(explanation: Explanation, width: int, colour: bool) -> Iterator[str]:
    for one in explanation.statements:
        yield "".join(f"{line}\n" for line in tree_lines(_statement(one), width, Painter(colour)))


# --- the whole ---


def _summary(explanation: Explanation) -> Tree:
    totals = explanation.totals
    n = sum(1 for one in _flat(explanation.statements) if isinstance(one, Command))
    text = f"{n} command{'' if n == 1 else 's'} from {explanation.start} on, {seconds(totals.takes)}"
    children = [
        Tree("start", f"{explanation.start} at its first frame, {explanation.start_because}", style=(BLUE,)),
        Tree("library", f"{explanation.library}, {explanation.frame_rate:g} frames a second", style=(BLUE,)),
        Tree("on the way between motions", f"about {_under_way(totals.under_way, totals.cost)}", style=(BLUE,)),
    ]
    if explanation.gain is not None:
        children.append(Tree("planned over the whole script", _gain(explanation.gain, totals), style=(BLUE,)))
    if explanation.played is not None:
        children.append(_played("played", explanation.played))
    if explanation.gain is not None and explanation.gain.planned and explanation.gain.played is not None:
        children.append(_played("command by command, played", explanation.gain.played))
    return Tree(explanation.script, text, tuple(children), (BOLD,))


def _under_way(under_way: float, cost: float) -> str:
    return f"{under_way:.1f} s, cost {cost:.2f}"


def _gain(gain: Gain, totals: Totals) -> str:
    if not gain.planned:
        return f"no, {gain.because}"
    before, after = gain.greedy.under_way + gain.greedy.cost, totals.under_way + totals.cost
    told = _under_way(gain.greedy.under_way, gain.greedy.cost)
    return f"seconds on the way and costs come to {after:.2f} instead of {before:.2f} command by command ({told})"


def _played(label: str, played: Played) -> Tree:
    text = f"{played.seconds:.1f} s, on the way {_under_way(played.under_way, played.cost)}"
    return Tree(f"{label} with seed {played.seed}", text, style=(_GREEN,))


def _flat(statements: Iterable[Statement]) -> Iterator[Statement]:
    for one in statements:
        yield one
        if isinstance(one, Repeat):
            yield from _flat(one.body)
        elif isinstance(one, Choose):
            yield from _flat(inner for branch in one.branches for inner in branch.body)


# --- statements ---


def _statement(one: Statement) -> Tree:
    match one:
        case Command():
            return _command(one)
        case Wait():
            children = [*_before(one.before), Tree("", f"lasts {seconds(one.lasts)}"), *_executions(one.executions)]
            return _numbered(one.place.line, one.text, children)
        case End():
            ends = map(_ending, one.ends) if one.ends else (Tree("", f"{one.graph} does not run on its own here"),)
            children = [*_before(one.before), *ends, *_executions(one.executions, one.arrives)]
            return _numbered(one.place.line, one.text, children)
        case Repeat():
            text = f"repeat {one.count}" + (f", {seconds(one.once_through)} each time" if one.count else "")
            return _numbered(one.place.line, text, map(_statement, one.body))
        case Choose():
            return _numbered(one.place.line, "choose", map(_branch, one.branches))


def _numbered(line: int, text: str, children: Iterable[Tree]) -> Tree:
    return Tree(f"line {line}  {text}", "", tuple(children), (BOLD,))


def _branch(branch: Branch) -> Tree:
    text = seconds(branch.takes) if branch.body else "nothing"
    return Tree(f"{share(branch.chance)} of the draws", text, tuple(map(_statement, branch.body)), (BLUE,))


def _command(command: Command) -> Tree:
    children = [
        *map(_use, command.uses),
        *_before(command.before),
        _expression(command.expression),
        *map(_ending, command.ends),
        *map(_layer, command.layers),
        Tree("", _arrival(command)),
        *_executions(command.executions, command.arrives),
    ]
    return _numbered(command.place.line, command.text, children)


def _use(use: Use) -> Tree:
    return Tree(use.name, f"defined in {use.place.file}, line {use.place.line}: {use.text}", style=(BLUE,))


def _before(parts: Sequence[Part]) -> list[Tree]:
    if not any(part.runs for part in parts):
        return [Tree("before", "never executed", style=(BLUE,))]
    told = [f"{part.graph} {_plays(part)}" for part in parts]
    return [Tree("before", "; ".join(told), style=(BLUE,))]


def _plays(part: Part) -> str:
    likely = _chances(part.motions)
    if part.runs >= 1.0:
        return f"plays {likely}"
    return f"plays {likely} on its own, else follows" if part.runs else "follows the graph above"


def _chances(motions: Sequence[Likely]) -> str:
    """Return motions with their chances, the likeliest first; those without a chance that counts at the end."""
    known = sorted((one for one in motions if one.chance > 0), key=lambda one: -one.chance)
    others = [one.motion for one in motions if one.chance == 0]
    certain = len(known) == 1 and known[0].chance >= 1.0
    told = known[0].motion if certain else ", ".join(f"{one.motion} ({share(one.chance)})" for one in known)
    return f"{told}, less likely {_listed(others, 'or')}" if others else told


def _arrival(command: Command) -> str:
    if command.arrives.most == 0:
        arrives = "arrives at once"
    else:
        arrives = f"arrives after {seconds(command.arrives)}, cost {command.cost:.2f}"
    return f"{arrives}; {_then(command.duration, command.lasts)}"


def _then(duration: Duration, lasts: Estimate) -> str:
    match duration.unit:
        case "none":
            return "then the next statement begins"
        case "to the end":
            return f"then it plays to the clip's last frame, {seconds(lasts)}"
        case "once":
            return f"then it plays once to its last exit, {seconds(lasts)}"
        case "cycles":
            return f"then it plays for {_number(duration.number)} cycles, {seconds(lasts)}"
    return f"then it plays for {_number(duration.number)} s"


# --- expressions ---


def _expression(expression: Expression) -> Tree:
    match expression:
        case With():
            return _assignment("with", expression, map(_expression, expression.operands))
        case Shared():
            why = _passed(expression.passed_over)
            refused = (
                Tree("not over", f"{_listed(one.graphs)}: {one.because}", style=(_DIM,)) for one in expression.refused
            )
            return _assignment("and, shared out", expression, (*why, *refused, *map(_expression, expression.operands)))
        case OnGraph():
            whole = _set(expression.expression)
            passed = tuple(_passed(expression.passed_over))
            label = expression.text if isinstance(expression.expression, Named) else whole.label
            return Tree(label, whole.text, passed + whole.children, whole.style)


def _assignment(label: str, expression: With | Shared, children: Iterable[Tree]) -> Tree:
    graphs = _listed([one.graph for one in expression.assigned])
    return Tree(label, f"an assignment to {graphs}", tuple(children), (BLUE,))


def _passed(every: Sequence[PassedOver]) -> Iterator[Tree]:
    by: dict[str, list[str]] = {}
    for one in every:
        by.setdefault(one.because, []).append(one.graph)
    for because, graphs in by.items():
        yield Tree(f"not on {_listed(graphs, 'or')}", because, style=(_DIM,))


def _set(expression: SetExpression) -> Tree:
    motions = ", ".join(expression.motions) if expression.motions else "nothing"
    if isinstance(expression, SetOperator):
        children = tuple(map(_set, expression.operands))
        return Tree(expression.word, f"set on {expression.graph}: {motions}", children, (BLUE,))
    spelt = "" if expression.name == expression.text.strip('"') else f" {expression.name}"
    if expression.means == "motion" and not spelt and expression.motions:
        return Tree(expression.text, f"motion on {expression.graph}", style=(BLUE,))
    return Tree(expression.text, f"{expression.means}{spelt} on {expression.graph}: {motions}", style=(BLUE,))


# --- graphs ---


def _ending(one: Ending) -> Tree:
    way = "by a blend on the spot" if one.on_the_spot >= 1.0 else "by a path in its own graph"
    if 0 < one.on_the_spot < 1.0:
        way += f", in {share(one.on_the_spot)} by a blend on the spot"
    chance = "" if one.chance >= 1.0 else f"in {share(one.chance)}: "
    because = f", as {one.because}" if one.because else ""
    return Tree(f"ends {one.graph}", f"{chance}{seconds(one.takes)} {way}{because}", style=(BLUE,))


def _layer(layer: Layer) -> Tree:
    told = [*_staying(layer)]
    rows: list[Tree] = []
    if layer.sources:
        sources = ", ".join(_source(layer, one.graph, one.motion, one.chance) for one in layer.sources)
        if len(layer.candidates) == 1 and not _outranked(layer):
            told.append(f"from {sources} to {_only(layer)}")
        else:
            told.append(f"from {sources} to {_GOALS.get(layer.rule, 'what fits best')}")
            rows = _candidates(layer)
    children = [*rows, *map(_ranking, _told_apart(layer)), *_left_out(layer)]
    text = "; else ".join(told) or "no way is known from where it will probably be"
    return Tree(layer.graph, text, tuple(children), (BLUE,))


def _staying(layer: Layer) -> Iterator[str]:
    """Yield what a layer does where it need not move."""
    kept = [one.motion for one in layer.candidates if one.chance > 0]
    others = [one.motion for one in layer.candidates if one.chance == 0]
    if layer.stays >= 1.0:
        instead = f"; {_listed(others, 'or')} would do too" if others else ""
        yield f"stays in {_listed(kept, 'or')}, which it is to play{instead}"
    elif layer.stays:
        yield f"stays as it is in {share(layer.stays)}, as it plays a candidate"
    if layer.follows:
        chance = "" if layer.follows >= 1.0 else f" in {share(layer.follows)}"
        yield f"follows the graph above{chance}, which plays what it is to do"


def _only(layer: Layer) -> str:
    """Return what there is to say of the only candidate."""
    one = layer.candidates[0]
    _, motion, oms, takes, cost, _, way = _row(0, one, _oms_of(layer).get(one.motion, ""))
    return ", ".join(part for part in (motion, takes, cost, oms, way) if part)


def _source(layer: Layer, graph: str, motion: str, chance: float) -> str:
    where = "" if graph == layer.graph else f" of {graph}"
    return f"{motion}{where}" + ("" if chance >= 1.0 else f" ({share(chance)})")


def _candidates(layer: Layer) -> list[Tree]:
    shown = layer.candidates[:_MOST_CANDIDATES]
    outranked = _outranked(layer)[: _MOST_CANDIDATES - len(shown)]
    oms = _oms_of(layer)
    rows = [_row(number, one, oms.get(one.motion, "")) for number, one in enumerate(shown, 1)]
    numbered = enumerate(outranked, len(shown) + 1)
    rows += [(f"{number}.", motion, oms.get(motion, ""), "", "", "outranked", "") for number, motion in numbered]
    styles = [(_GREEN,) if one.chance > 0 else () for one in shown] + [(_DIM,)] * len(outranked)
    trees = [Tree(line, style=style) for line, style in zip(table(rows), styles, strict=True)]
    more = layer.candidates[_MOST_CANDIDATES:]
    if more:
        chance = sum(one.chance for one in more)
        trees.append(Tree("", f"and {len(more)} more, one of which is taken in {share(chance)}"))
    return trees


def _oms_of(layer: Layer) -> dict[str, str]:
    """Return how candidates fit, if there is but one motion that they can be compared with."""
    return {fit.motion: _fit(fit) for fit in layer.rankings[0].fits} if len(layer.rankings) == 1 else {}


def _fit(fit: Fit) -> str:
    return f"OMS {_oms(fit.oms)} ({fit.of_usual:.1f} of usual)"


def _row(number: int, one: Candidate, fits: str) -> tuple[str, ...]:
    takes = "" if one.takes is None else seconds(one.takes)
    cost = "" if one.cost is None else f"cost {one.cost:.2f}"
    taken = "taken" if one.chance >= 1.0 else f"taken in {share(one.chance)}" if one.chance > 0 else ""
    chance = "" if one.on_the_spot >= 1.0 else f"in {share(one.on_the_spot)} "
    way = f"{chance}by a blend on the spot" if one.on_the_spot else ""
    return f"{number}.", one.motion, fits, takes, cost, taken, way


def _told_apart(layer: Layer) -> Sequence[Ranking]:
    """Return the rankings of a layer where there are several, so that they are not told with the candidates."""
    return layer.rankings if len(layer.rankings) > 1 and len(layer.rankings[0].fits) > 1 else ()


def _ranking(one: Ranking) -> Tree:
    fits = " before ".join(f"{fit.motion} {_fit(fit)}" for fit in one.fits)
    return Tree(f"while the graph above plays {one.above} ({share(one.chance)})", fits, style=(_DIM,))


def _left_out(layer: Layer) -> Iterator[Tree]:
    by: dict[tuple[str, str], list[str]] = {}
    for one in layer.left_out:
        if layer.sources and one.reason == "outranked":
            continue  # They stand with the candidates, which come before them.
        by.setdefault((one.reason, one.because), []).append(one.motion)
    for (reason, because), motions in by.items():
        yield Tree("left out", f"{_listed(motions)} ({reason}): {because}", style=(_DIM,))


def _outranked(layer: Layer) -> list[str]:
    """Return the motions that would come after the candidates by their fit, the best first."""
    out = [one.motion for one in layer.left_out if one.reason == "outranked"]
    order = [fit.motion for fit in layer.rankings[0].fits] if layer.rankings else out
    return sorted(out, key=order.index)


# --- what happened ---


def _executions(executions: Sequence[Execution], expected: Estimate | None = None) -> Iterator[Tree]:
    for one in executions[:_MOST_EXECUTIONS]:
        taken = ", ".join(f"{drives.graph} {drives.motion}" for drives in one.taken)
        text = f"lasted {one.lasted_s:.1f} s"
        if expected is not None:
            text = f"arrived after {one.arrived_s:.1f} s (expected {expected.mean:.1f})"
            text += f", cost {one.cost:.2f}" if one.cost else ""
        yield Tree(f"played at {one.begin_s:.1f} s", text + (f": {taken}" if taken else ""), _events(one), (_GREEN,))
    more = executions[_MOST_EXECUTIONS:]
    if more:
        mean = sum(one.arrived_s for one in more) / len(more)
        yield Tree("", f"played {len(more)} times more, arrived after {mean:.1f} s on average", style=(_GREEN,))


def _events(execution: Execution) -> tuple[Tree, ...]:
    rows = []
    for one in execution.events:
        target = "the graph above" if one.target is None else f"{one.target[0]}:{one.target[1]}"
        how = f"cost {one.cost:.2f}" if one.cost is not None else "a blend on the spot"
        rows.append((f"{one.begin_s:.1f} s", one.graph, f"{one.source[0]}:{one.source[1]} -> {target}", how))
    return tuple(Tree(line) for line in table(rows))


# --- numbers ---


def seconds(estimate: Estimate) -> str:
    """Return an estimate in words: on average, and between what it lies."""
    mean, least, most = (f"{number:.1f}" for number in (estimate.mean, estimate.least, estimate.most))
    return f"{mean} s" if least == most else f"about {mean} s ({least} to {most})"


def share(chance: float) -> str:
    """Return a chance in per cent; what is not quite nothing or everything does not look like it."""
    per_cent = round(100 * chance)
    if per_cent == 0 and chance > 0:
        return "under 1%"
    return "over 99%" if per_cent == 100 and chance < 1.0 else f"{per_cent}%"


def _oms(oms: float) -> str:
    return f"{oms:,.0f}" if oms >= 1000 else f"{oms:.1f}"


def _number(number: float | None) -> str:
    return f"{number or 0.0:g}"


def _listed(names: Sequence[str], last: str = "and") -> str:
    return joined(names, last) if names else "nothing"
