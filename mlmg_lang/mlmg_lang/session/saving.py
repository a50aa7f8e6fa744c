"""A session -> the script that plays it again from its first frame: as it was entered, or as it was played.

What was entered can mean something else when it is read as a whole: a later line may narrow an earlier one, and every
branch of a `choose` has to be possible. So the script is played, and where that is not what was played, each statement
is written with the motions that it came to.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from mlmg_lang.definitions.gather import Files
from mlmg_lang.front_end import Question, analyse_for
from mlmg_lang.parsing.amounts import spelled
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.planning.resolved import Command, Cycles, Duration, Once, ResolvedPlan, Seconds, Wait
from mlmg_lang.session.session import Session
from mlmg_lang.source import Source
from mlmg_lang.staging import Executed, ScriptError, begin
from mlmg_runtime.playing.timeline import Timeline


@dataclass(frozen=True, slots=True)
class SavedScript:
    """A script of a session, with its plan, which plays exactly what the session did.

    Attributes
    ----------
    as_entered : whether it is what was entered; else it has the motions that were taken in place of tags and draws.
    """

    text: str
    plan: ResolvedPlan
    as_entered: bool


def script_from_session(session: Session, name: str = "<session>", files: Files | None = None) -> SavedScript | None:
    """Return the script of what has been played, its last motion to the end; None if nothing has been.

    Parameters
    ----------
    name : of the file that it is to be written to. files : where those are found from there that it uses; if not
        given, where the session finds them.
    """
    if not has_played(session):
        return None
    wanted = session.stage.finish()
    entered = "\n".join(turn.text.rstrip() for turn in session.turns)
    played = "\n".join(line for turn in session.turns for line in map(_line, turn.done))
    for text, as_entered in ((entered, True), (played, False)):
        plan = _plan(Source(text, name), files or session.files, session, wanted)
        if plan is not None:
            return SavedScript(text + "\n", plan, as_entered)
    raise AssertionError("what was played command by command can be played again")


def has_played(session: Session) -> bool:
    """Return whether there is something to save."""
    return session.n_seconds > 0.0 or any(turn.deeds for turn in session.turns)


def _plan(source: Source, files: Files, session: Session, wanted: Timeline) -> ResolvedPlan | None:
    """Return the plan of a script; None if it does not play what is wanted."""
    question = Question(session.library, session.names, session.starts_in, files)
    plan = analyse_for(source, question).resolved
    if plan is None:
        return None
    stage = begin(session.library, plan.start, session.seed)
    try:
        stage.play(plan)
        return plan if stage.finish() == wanted else None
    except ScriptError:
        return None


def _line(one: Executed) -> str:
    """Return a statement as it was executed, with the motions that were taken."""
    match one.statement:
        case Command(layers=layers, duration=duration):
            named = (f"{script_name(layer.graph)} {script_name(one.motions[layer.graph])}" for layer in layers)
            return " ".join([" with ".join(named), *_duration(duration)])
        case Wait(duration=duration):
            return f"wait {' '.join(_amount(duration))}"
    return f"end {script_name(one.statement.graph)}"


def _duration(duration: Duration | None) -> Iterator[str]:
    if isinstance(duration, Once):
        yield "once"
    elif duration is not None:
        yield "for"
        yield from _amount(duration)


def _amount(duration: Seconds | Cycles) -> Iterator[str]:
    if isinstance(duration, Cycles):
        yield f"{spelled(duration.number)} cycles"
    else:
        yield f"{spelled(duration.number)} sec"
