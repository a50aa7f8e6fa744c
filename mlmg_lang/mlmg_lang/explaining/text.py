"""An explanation -> text that a person can read: a tree for each statement."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from mlmg_lang.explaining.explanation import (
    Branch,
    Choose,
    Command,
    Duration,
    End,
    Execution,
    Explanation,
    Gain,
    Likely,
    Part,
    Played,
    Repeat,
    Statement,
    Taken,
    Totals,
    Use,
    Wait,
)
from mlmg_lang.explaining.expression_tree import expression_tree
from mlmg_lang.explaining.layer_tree import ending_tree, layer_tree
from mlmg_lang.explaining.tree import Tree, table, tree_lines
from mlmg_lang.explaining.wording import listed, plain, seconds, share
from mlmg_lang.planning.estimate import Estimate
from mlmg_lang.rendering.colour import BLUE, BOLD, GREEN, Painter

WIDTH: Final = 100
_MOST_EXECUTIONS: Final = 3
_AS_GOOD_AS_ALWAYS: Final = 0.995


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
    return Tree(f"{label} with seed {played.seed}", text, style=(GREEN,))


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
            ends = map(ending_tree, one.ends) if one.ends else (Tree("", f"{one.graph} does not run on its own here"),)
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
        expression_tree(command.expression),
        *map(ending_tree, command.ends),
        *map(layer_tree, command.layers),
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
    return f"{told}, less likely {listed(others, 'or')}" if others else told


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
            return f"then it plays for {plain(duration.number)} cycles, {seconds(lasts)}"
    return f"then it plays for {plain(duration.number)} s"


# --- what happened ---


def _executions(executions: Sequence[Execution], expected: Estimate | None = None) -> Iterator[Tree]:
    for one in executions[:_MOST_EXECUTIONS]:
        taken = ", ".join(map(_taken, one.taken))
        text = f"lasted {one.lasted_s:.1f} s"
        if expected is not None:
            text = f"arrived after {one.arrived_s:.1f} s (expected {expected.mean:.1f})"
            text += f", cost {one.cost:.2f}" if one.cost else ""
        yield Tree(f"played at {one.begin_s:.1f} s", text + (f": {taken}" if taken else ""), _events(one), (GREEN,))
    more = executions[_MOST_EXECUTIONS:]
    if more:
        mean = sum(one.arrived_s for one in more) / len(more)
        yield Tree("", f"played {len(more)} times more, arrived after {mean:.1f} s on average", style=(GREEN,))


def _taken(taken: Taken) -> str:
    """Return what drives a graph, and how much of the time it is shown where that is not all the time."""
    all_the_time = taken.shown is None or taken.shown > _AS_GOOD_AS_ALWAYS
    return f"{taken.graph} {taken.motion}" + ("" if all_the_time else f" (shown {taken.shown:.0%} of the time)")


def _events(execution: Execution) -> tuple[Tree, ...]:
    rows = []
    for one in execution.events:
        target = "the graph above" if one.target is None else f"{one.target[0]}:{one.target[1]}"
        how = f"cost {one.cost:.2f}" if one.cost is not None else "a blend on the spot"
        rows.append((f"{one.begin_s:.1f} s", one.graph, f"{one.source[0]}:{one.source[1]} -> {target}", how))
    return tuple(Tree(line) for line in table(rows))
