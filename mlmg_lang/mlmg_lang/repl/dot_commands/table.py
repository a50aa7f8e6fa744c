"""All commands with a dot."""

from __future__ import annotations

from typing import Final

from mlmg_lang.explaining.tree import table
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.dot_commands import asking, changing, keeping, planning
from mlmg_lang.repl.dot_commands.dot_command import DotCommand, Takes
from mlmg_lang.repl.reply import Refusal, Reply
from mlmg_lang.spelling import listed, nearest


def find_dot_command(word: str) -> DotCommand:
    """Return the command that a word names, without its dot.

    Raises
    ------
    Refusal
        If there is none of that name.
    """
    for one in DOT_COMMANDS:
        if one.name == word:
            return one
    # Nobody is led to write over a file by a slip.
    near = nearest(word, [one.name for one in DOT_COMMANDS if not one.name.endswith("!")])
    meant = f"did you mean {listed([f'.{name}' for name in near], 'or')}?" if near else "`.help` tells of all"
    raise Refusal(f"there is no command `.{word}`; {meant}")


def _help(_desk: Desk, argument: str) -> Reply:
    """Tell of all commands with a dot, or more of one."""
    if argument:
        one = find_dot_command(argument.removeprefix("."))
        lines = (one.usage, f"  {one.says}", *(f"  {line}" for line in one.more.splitlines()))
        return Reply("".join(f"{line}\n" for line in lines), {"command": one.usage, "says": one.says, "more": one.more})
    rows = table((one.usage, one.says) for one in DOT_COMMANDS)
    told = [
        "Enter a command of Motion Script, such as `WALK with Upper-Body TALK for 3 sec`; it is played on from here.",
        *rows,
    ]
    return Reply("".join(f"{line}\n" for line in told), {"commands": {one.usage: one.says for one in DOT_COMMANDS}})


def _quit(_desk: Desk, _argument: str) -> Reply:
    """Leave."""
    return Reply(leaves=True)


DOT_COMMANDS: Final[tuple[DotCommand, ...]] = (
    DotCommand("help", Takes.DOT_COMMAND, "these commands, or more of one", ".help save", _help),
    DotCommand("graphs", Takes.NOTHING, "the graphs of the library", "", asking.graphs),
    DotCommand(
        "motions",
        Takes.GRAPH,
        "the motions of a graph",
        ".motions Upper-Body\nwithout a graph, those of the whole body",
        asking.motions,
    ),
    DotCommand("tags", Takes.GRAPH, "the tags of a graph", ".tags Upper-Body", asking.tags),
    DotCommand(
        "oms",
        Takes.MOTION,
        "which motions are most like one, on each graph",
        ".oms Walk_01\nthe smaller the number, the better the one can stand in for the other",
        asking.oms,
    ),
    DotCommand("state", Takes.NOTHING, "what is playing now", "", asking.state),
    DotCommand(
        "explain",
        Takes.STATEMENT,
        "what a command would do from here, and why",
        ".explain WALK with Upper-Body TALK\nnothing is played",
        planning.explain,
    ),
    DotCommand(
        "candidates",
        Takes.STATEMENT,
        "what a command could take, and what it would cost",
        ".candidates WALK\nnothing is played",
        planning.candidates,
    ),
    DotCommand(
        "undo",
        Takes.TIMES,
        "take the last entry back, or the last N",
        ".undo 3\nas often as there are entries; .start, .seed and .library are taken back too; .redo goes forward",
        changing.undo,
    ),
    DotCommand("redo", Takes.TIMES, "play again what was taken back", ".redo 3", changing.redo),
    DotCommand("timeline", Takes.NOTHING, "what has been played when", "", asking.timeline),
    DotCommand(
        "save",
        Takes.OUTPUT,
        "write the motion, or the script that plays it again",
        ".save stroll.bvh\n.save stroll.ms\na file that is there already is asked about; .save! replaces it",
        keeping.save,
    ),
    DotCommand("save!", Takes.OUTPUT, "the same, over a file that is there", ".save! stroll.ms", keeping.save_over),
    DotCommand("load", Takes.SCRIPT, "play a script on from here", ".load stroll.ms", changing.load),
    DotCommand("start", Takes.MOTION, "start in another motion, and play all anew", ".start Idle_01", changing.start),
    DotCommand("seed", Takes.NUMBER, "other draws for choose, and play all anew", ".seed 7", changing.seed),
    DotCommand(
        "set",
        Takes.SETTING,
        "how motion is written, which keys to use",
        ".set blend linear\n.set fps 60\n.set keys vi",
        keeping.set_option,
    ),
    DotCommand(
        "library",
        Takes.LIBRARY,
        "read the library again, or another, and play all anew",
        ".library my.mlmg",
        changing.library,
    ),
    DotCommand("view", Takes.NOTHING, "open the motion in the player", "", keeping.view),
    DotCommand("time", Takes.SWITCH, "say how long each line takes", ".time on", keeping.time),
    DotCommand("quit", Takes.NOTHING, "leave", "Ctrl-D does the same", _quit),
)
