"""An explanation: what a script will do and why, as data. All that prints it takes this alone.

Chances are from 0 to 1, times in seconds, costs sums over transitions; all are rounded to thousandths.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from mlmg_lang.planning.estimate import Estimate


@dataclass(frozen=True, slots=True)
class Place:
    """A stretch of text.

    Attributes
    ----------
    span : line, column, end line, end column; from 1, in code points, end exclusive.
    """

    file: str
    span: tuple[int, int, int, int]

    @property
    def line(self) -> int:
        """Return the line that it begins in."""
        return self.span[0]


# --- motion expressions ---


@dataclass(frozen=True, slots=True)
class Named:
    """A name, with the motions that it stands for on a graph.

    Attributes
    ----------
    text : as written. name : as the library spells it. means : `motion` or `tag`.
    """

    text: str
    place: Place
    graph: str
    motions: tuple[str, ...]
    name: str
    means: str
    kind: Literal["name"] = field(default="name", init=False)


@dataclass(frozen=True, slots=True)
class SetOperator:
    """`and`, `or` or `not` of sets of motions on one graph."""

    word: str
    text: str
    place: Place
    graph: str
    motions: tuple[str, ...]
    operands: tuple[SetExpression, ...]
    kind: Literal["set operator"] = field(default="set operator", init=False)


SetExpression: TypeAlias = Named | SetOperator


@dataclass(frozen=True, slots=True)
class PassedOver:
    """A graph on which an expression was looked for first, and why it is not there."""

    graph: str
    because: str


@dataclass(frozen=True, slots=True)
class OnGraph:
    """A set of motions, and how it came to the graph that it is on.

    Attributes
    ----------
    text : as written, with the graph's name if it has one.
    graph_by : `name` (the script names it), `Sub`, `search` (the first that has a match) or `sharing`.
    """

    text: str
    place: Place
    expression: SetExpression
    graph_by: str
    passed_over: tuple[PassedOver, ...]
    kind: Literal["set"] = field(default="set", init=False)


@dataclass(frozen=True, slots=True)
class Assigned:
    """Motions for a graph, of an expression that assigns some to several."""

    graph: str
    motions: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class RefusedWay:
    """Graphs over which an `and` might have been shared out, and why it was not."""

    graphs: tuple[str, ...]
    because: str


@dataclass(frozen=True, slots=True)
class Shared:
    """An `and` that no motion fits, shared out over graphs that run at the same time."""

    text: str
    place: Place
    assigned: tuple[Assigned, ...]
    operands: tuple[OnGraph, ...]
    passed_over: tuple[PassedOver, ...]
    refused: tuple[RefusedWay, ...]
    kind: Literal["shared and"] = field(default="shared and", init=False)


@dataclass(frozen=True, slots=True)
class With:
    """`with`: each operand on graphs below those before it."""

    text: str
    place: Place
    assigned: tuple[Assigned, ...]
    operands: tuple[Expression, ...]
    kind: Literal["with"] = field(default="with", init=False)


Expression: TypeAlias = OnGraph | Shared | With


# --- what plays, and what is taken ---


@dataclass(frozen=True, slots=True)
class Likely:
    """A motion with the chance that it is the one."""

    motion: str
    chance: float


@dataclass(frozen=True, slots=True)
class Part:
    """What may be playing on a graph before a statement.

    Attributes
    ----------
    motions : with the chances that it plays them on its own; those without a chance are not impossible.
    runs : the chance that it runs on its own; else it follows the graph above.
    """

    graph: str
    motions: tuple[Likely, ...]
    runs: float


@dataclass(frozen=True, slots=True)
class Source:
    """What a graph sets out from: a motion, of its own or of the graph above that it follows."""

    graph: str
    motion: str
    chance: float


@dataclass(frozen=True, slots=True)
class Candidate:
    """A motion that may be taken.

    Attributes
    ----------
    chance : that it is taken.
    takes, cost : from the command's turn on this graph until it has been reached; None where the graph stays as it is,
        or no way leads there.
    on_the_spot : the chance that it is entered by a blend that is not in the graph.
    """

    motion: str
    chance: float
    takes: Estimate | None
    cost: float | None
    on_the_spot: float


@dataclass(frozen=True, slots=True)
class Fit:
    """A candidate with its overall motion similarity to what the graph above plays; the smaller, the better.

    Attributes
    ----------
    of_usual : the same over the usual one of the graph's motions.
    """

    motion: str
    oms: float
    of_usual: float


@dataclass(frozen=True, slots=True)
class Ranking:
    """The candidates in the order in which they are tried while the graph above plays a motion."""

    above: str
    chance: float
    fits: tuple[Fit, ...]


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A motion that a command finds, but cannot take; `reason` as in the resolved plan."""

    motion: str
    reason: str
    because: str


@dataclass(frozen=True, slots=True)
class Layer:
    """What a command does on one graph.

    Attributes
    ----------
    rule : `soonest` (the root: whichever is reached first), `best fit` (by OMS) or `look ahead` (the root: what was
        chosen over the whole script for each execution).
    stays, follows : the chances that it keeps its motion, and that it follows the graph above, which plays a candidate.
    sources : what it sets out from, where it moves.
    candidates : in the order in which they are likely to be tried.
    rankings : below the root, the order for each motion that the graph above may play then; what is `outranked` has its
        place in it too.
    """

    graph: str
    text: str
    place: Place
    rule: str
    stays: float
    follows: float
    sources: tuple[Source, ...]
    candidates: tuple[Candidate, ...]
    rankings: tuple[Ranking, ...]
    left_out: tuple[LeftOut, ...]


@dataclass(frozen=True, slots=True)
class Ending:
    """A part that is given back to the graph above (rule 2), with the chance that it has to be.

    Attributes
    ----------
    on_the_spot : of these, the share that finds no way back in time and is blended.
    """

    graph: str
    because: str
    chance: float
    takes: Estimate
    cost: float
    on_the_spot: float


@dataclass(frozen=True, slots=True)
class Use:
    """A definition that a statement uses, itself or by way of others."""

    name: str
    text: str
    place: Place


# --- what happened ---


@dataclass(frozen=True, slots=True)
class Event:
    """What was played on the way to a motion.

    Attributes
    ----------
    what : `transition` (of the graph), `blend` (made on the spot) or `return` (a blend onto the graph above).
    begin_s : from the beginning of the motion. source, target : motion and frame.
    cost : of a transition.
    """

    graph: str
    what: str
    begin_s: float
    source: tuple[str, int]
    target: tuple[str, int] | None
    cost: float | None


@dataclass(frozen=True, slots=True)
class Taken:
    """What drives a graph when a command has arrived.

    Attributes
    ----------
    shown : the share of the time from then to the next statement in which it is shown, from 0 to 1; the rest is a way
        round over other motions by which it is held. None if that time is none.
    """

    graph: str
    motion: str
    shown: float | None


@dataclass(frozen=True, slots=True)
class Execution:
    """How a statement went when it was executed.

    Attributes
    ----------
    begin_s : from the beginning of the motion.
    arrived_s : how long until all parts had arrived. lasted_s : from then to the next statement.
    cost : the sum over transitions until then.
    """

    begin_s: float
    arrived_s: float
    lasted_s: float
    cost: float
    taken: tuple[Taken, ...]
    events: tuple[Event, ...]


# --- statements ---


@dataclass(frozen=True, slots=True)
class Duration:
    """How long a command lasts once it has arrived.

    Attributes
    ----------
    unit : `seconds`, `cycles`, `once`, `to the end` (the script's last command) or `none`.
    """

    unit: str
    number: float | None


@dataclass(frozen=True, slots=True)
class Command:
    """Bring graphs to motions, then let time pass."""

    text: str
    place: Place
    uses: tuple[Use, ...]
    before: tuple[Part, ...]
    expression: Expression
    layers: tuple[Layer, ...]
    ends: tuple[Ending, ...]
    arrives: Estimate
    cost: float
    duration: Duration
    lasts: Estimate
    executions: tuple[Execution, ...] = ()
    kind: Literal["command"] = field(default="command", init=False)


@dataclass(frozen=True, slots=True)
class Wait:
    """Let time pass in what is playing."""

    text: str
    place: Place
    before: tuple[Part, ...]
    duration: Duration
    lasts: Estimate
    executions: tuple[Execution, ...] = ()
    kind: Literal["wait"] = field(default="wait", init=False)


@dataclass(frozen=True, slots=True)
class End:
    """Give a part back to the graph above."""

    text: str
    place: Place
    before: tuple[Part, ...]
    graph: str
    ends: tuple[Ending, ...]
    arrives: Estimate
    cost: float
    executions: tuple[Execution, ...] = ()
    kind: Literal["end"] = field(default="end", init=False)


@dataclass(frozen=True, slots=True)
class Repeat:
    """Statements that are executed several times; `once_through` is what one time takes."""

    count: int
    place: Place
    body: tuple[Statement, ...]
    once_through: Estimate
    kind: Literal["repeat"] = field(default="repeat", init=False)


@dataclass(frozen=True, slots=True)
class Branch:
    """Statements that are drawn, with the chance of that."""

    weight: int
    chance: float
    place: Place
    body: tuple[Statement, ...]
    takes: Estimate


@dataclass(frozen=True, slots=True)
class Choose:
    """One of several branches is drawn."""

    place: Place
    branches: tuple[Branch, ...]
    kind: Literal["choose"] = field(default="choose", init=False)


Statement: TypeAlias = Command | Wait | End | Repeat | Choose


# --- the whole ---


@dataclass(frozen=True, slots=True)
class Totals:
    """The sums over a script.

    Attributes
    ----------
    takes : the whole motion.
    under_way, cost : the seconds and the transitions until its commands have arrived, on average.
    """

    takes: Estimate
    under_way: float
    cost: float


@dataclass(frozen=True, slots=True)
class Played:
    """What came of playing a script; `under_way` and `cost` as in the totals."""

    seed: int
    seconds: float
    under_way: float
    cost: float


@dataclass(frozen=True, slots=True)
class Gain:
    """What planning over the whole script is expected to bring; `planned` is False where that cannot be done.

    Attributes
    ----------
    because : why it cannot.
    greedy : the totals of command by command. played : and what came of playing it so, with `--analyze`.
    """

    planned: bool
    because: str
    greedy: Totals
    played: Played | None = None


@dataclass(frozen=True, slots=True)
class Explanation:
    """What a script will do on a library, and why.

    Attributes
    ----------
    start : the motion that the character starts in. start_because : how it came to that.
    plan : `greedy` (command by command) or `global` (over the whole script; then `gain` tells of it).
    played : with `--analyze`.
    """

    script: str
    library: str
    frame_rate: float
    start: str
    start_because: str
    plan: str
    statements: tuple[Statement, ...]
    totals: Totals
    gain: Gain | None = None
    played: Played | None = None
