"""Commands that change the session: going back and forth, another start, other draws, another library."""

from __future__ import annotations

from collections.abc import Callable

from mlmg_lang.rendering import render_full
from mlmg_lang.rendering.wording import safe
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.dot_commands.dot_command import path_of
from mlmg_lang.repl.reply import Refusal, Reply
from mlmg_lang.repl.telling import MOST_DEEDS, telling_of
from mlmg_lang.script_files import read_script
from mlmg_lang.session.replaying import Replayed, replay
from mlmg_lang.session.session import Turn
from mlmg_runtime.library import Library, open_library


def undo(desk: Desk, argument: str) -> Reply:
    """Take the last entry back, or what replaced the session after it; or several, one after the other."""
    wanted = _times("undo", argument)
    texts = _steps(wanted, lambda: desk.undo_replacement() or _text(desk.session.undo))
    if not texts:
        raise Refusal("there is nothing to take back")
    return _went(desk, "took back", texts, wanted)


def redo(desk: Desk, argument: str) -> Reply:
    """Play again what was taken back last; or several, one after the other."""
    wanted = _times("redo", argument)
    texts = _steps(wanted, lambda: _text(desk.session.redo) or desk.redo_replacement())
    if not texts:
        raise Refusal("there is nothing to play again; an entry after `.undo` drops what was taken back")
    return _went(desk, "played again", texts, wanted)


def _times(command: str, argument: str) -> int:
    """Return how often a command is to be done: as often as it says, else once."""
    if not argument:
        return 1
    try:
        number = int(argument)
    except ValueError:
        number = 0
    if number < 1:
        raise Refusal(f"expected a whole number from 1 on, as in `.{command} 3`, found `{argument}`")
    return number


def _steps(wanted: int, step: Callable[[], str | None]) -> list[str]:
    """Step so often, or as long as there is something; return what each step went over."""
    texts: list[str] = []
    while len(texts) < wanted and (text := step()) is not None:
        texts.append(text)
    return texts


def _text(step: Callable[[], Turn | None]) -> str | None:
    turn = step()
    return None if turn is None else turn.text


def _went(desk: Desk, what: str, texts: list[str], wanted: int) -> Reply:
    """Return the reply to steps: what they went over in order, and whether there were fewer than wanted."""
    seconds = desk.session.n_seconds
    lines = [f"{what}: {_line(text)}" for text in texts[:MOST_DEEDS]]
    lines += [f"  ... and {len(texts) - MOST_DEEDS} more"] if len(texts) > MOST_DEEDS else []
    lines += [f"  there were only {len(texts)}, not {wanted}"] if len(texts) < wanted else []
    lines.append(f"  {seconds:.1f} s of motion")
    data = {"text": texts[-1], "texts": texts, "seconds": round(seconds, 3)}
    return Reply("".join(f"{line}\n" for line in lines), data)


def _line(text: str) -> str:
    """Return an entry in one line."""
    return safe(" ".join(text.split()))


def start(desk: Desk, argument: str) -> Reply:
    """Play all that was entered from another start motion on."""
    if not argument:
        raise Refusal("name the motion of the whole body to start in, such as `.start Idle_01`")
    return _again(desk, argument.strip('"'), desk.session.seed, f".start {argument}")


def seed(desk: Desk, argument: str) -> Reply:
    """Play all that was entered with other draws of `choose`."""
    try:
        number = int(argument)
    except ValueError:
        raise Refusal(f"expected a whole number, as in `.seed 7`, found `{argument}`") from None
    return _again(desk, desk.session.start, number, f".seed {number}")


def _again(desk: Desk, motion: str | None, number: int, said: str) -> Reply:
    """Replace the session by one that plays the same anew; if that cannot play all of it, keep it as it is."""
    try:
        replayed = replay(desk.session, desk.session.library, motion, number)
    except ValueError as error:
        raise Refusal(str(error)) from None
    if replayed.lost:
        first = replayed.lost[0]
        raise Refusal(f"`{first.source.text.strip()}` could not be played then; nothing is changed")
    desk.replace_session(replayed.session, said)
    session = desk.session
    told = f"starts in {session.starts_in}, seed {session.seed}; {session.n_seconds:.1f} s of motion\n"
    return Reply(told, {"seconds": round(session.n_seconds, 3)})


def load(desk: Desk, argument: str) -> Reply:
    """Play a script on from here, as one entry."""
    if not argument:
        raise Refusal("name a script, as in `.load stroll.ms`")
    path = path_of(argument)
    source, unreadable = read_script(path)
    if unreadable:
        return Reply(render_full(unreadable, source, desk.colour), {"problem": unreadable[0].message}, ok=False)
    desk.allow_files_of(path)
    return telling_of(desk).reply(desk.session.enter(source.text, source.name))


def library(desk: Desk, argument: str) -> Reply:
    """Read the library again, or another, and play on it what was entered."""
    path = path_of(argument) if argument else desk.session.library.path
    return _moved(desk, open_library(path), f".library {argument}".rstrip())


def _moved(desk: Desk, other: Library, said: str) -> Reply:
    session = desk.session
    try:
        replayed = replay(session, other, session.start, session.seed)
    except ValueError:
        replayed = replay(session, other, None, session.seed)
    desk.replace_session(replayed.session, said)
    return _told_of(replayed, other, session.n_seconds)


def _told_of(replayed: Replayed, other: Library, seconds_before: float) -> Reply:
    lines = [f"{other.path.name}: {len(other.graphs)} graphs, {len(other.root.motions)} motions of the whole body"]
    if replayed.session.turns or replayed.lost:
        lines.append(f"  {replayed.session.n_seconds:.1f} s of motion, played anew; it was {seconds_before:.1f} s")
    lines += [f"  cannot be played on it: {_line(one.source.text)}" for one in replayed.lost]
    data = {
        "library": str(other.path),
        "seconds": round(replayed.session.n_seconds, 3),
        "lost": [one.source.text for one in replayed.lost],
    }
    return Reply("".join(f"{line}\n" for line in lines), data)
