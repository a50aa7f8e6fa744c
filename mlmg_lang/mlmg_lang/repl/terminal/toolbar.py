"""What is playing, in one line under the prompt."""

from __future__ import annotations

from mlmg_lang.explaining.tree import n_columns
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.terminal.history import library_name


def toolbar(desk: Desk, width: int) -> str:
    """Return the library, what each graph plays, how long the motion is and whether it is saved, where there is room.

    Parameters
    ----------
    width : of the terminal, in columns.
    """
    session = desk.session
    playing = [f"{one.graph} {one.motion}:{one.frame}" for one in session.playing]
    ends = [f"{session.n_seconds:.1f} s", *(["unsaved"] if desk.unsaved else [])]
    changed = " (changed)" if desk.library_changed else ""
    parts = [library_name(session.library.path) + changed, *playing, *ends]
    while len(parts) > 1 and n_columns("  ".join(parts)) > width - 1:
        # What the lowest part does goes first, then the name of the library; how long it is stays.
        parts.pop(len(parts) - len(ends) - 1 if len(parts) > len(ends) + 1 else 0)
    return " " + "  ".join(parts)
