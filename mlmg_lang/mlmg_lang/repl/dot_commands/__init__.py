"""The commands with a dot: what each is called, what it takes, and what it does."""

from __future__ import annotations

from mlmg_lang.repl.dot_commands.dot_command import DotCommand, Takes
from mlmg_lang.repl.dot_commands.other_words import dotted
from mlmg_lang.repl.dot_commands.table import DOT_COMMANDS, find_dot_command

__all__ = ["DOT_COMMANDS", "DotCommand", "Takes", "dotted", "find_dot_command"]
