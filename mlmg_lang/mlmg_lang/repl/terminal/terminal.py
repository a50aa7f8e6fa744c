"""The prompt on a terminal: reads entries, says them to the conversation, prints the replies."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from prompt_toolkit import PromptSession
from prompt_toolkit.application import get_app_session
from prompt_toolkit.auto_suggest import AutoSuggestFromHistory
from prompt_toolkit.completion import ThreadedCompleter
from prompt_toolkit.enums import EditingMode
from prompt_toolkit.filters import is_searching
from prompt_toolkit.formatted_text import ANSI
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.key_binding import KeyBindings
from prompt_toolkit.output.color_depth import ColorDepth
from prompt_toolkit.shortcuts import print_formatted_text
from prompt_toolkit.styles import Style

from mlmg_lang.ide.cursor import is_open
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.rendering.wording import safe
from mlmg_lang.repl.conversation import Conversation, is_dotted
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.reply import Reply
from mlmg_lang.repl.terminal.completing import ScriptCompleter
from mlmg_lang.repl.terminal.history import history_path, library_name, uses_of
from mlmg_lang.repl.terminal.marking import ScriptLexer
from mlmg_lang.repl.terminal.toolbar import toolbar
from mlmg_lang.repl.terminal.wrapping import wrapped
from mlmg_lang.source import Source

if TYPE_CHECKING:
    from prompt_toolkit.input import Input
    from prompt_toolkit.key_binding import KeyPressEvent
    from prompt_toolkit.output import Output

PROMPT = "Motion Script>>> "
_STYLE = Style.from_dict(
    {
        "prompt": "bold",
        "word": "ansiblue bold",
        "name": "",
        "graph": "ansicyan",
        "definition": "ansimagenta",
        "parameter": "ansimagenta",
        "number": "ansigreen",
        "unit": "ansigreen",
        "comment": "ansibrightblack italic",
        "dot": "ansiyellow",
        "wrong": "ansired",
        "error": "underline ansired",
        "warning": "underline ansiyellow",
        "hint": "underline",
        "bottom-toolbar": "noreverse ansibrightblack",
    }
)


@dataclass(slots=True)
class TerminalFace:
    """A conversation at a prompt.

    Attributes
    ----------
    input, output : the terminal, if it is not the process's own.
    """

    conversation: Conversation
    input: Input | None = None
    output: Output | None = None
    _prompt: PromptSession[str] | None = field(default=None, init=False)
    _library: Path | None = field(default=None, init=False)
    _uses: Counter[str] = field(default_factory=Counter, init=False)

    def run(self) -> None:
        """Read and reply until the person leaves."""
        self._print(_greeting(self._desk))
        while True:
            try:
                entry = self._read()
            except KeyboardInterrupt:
                continue
            except EOFError:
                if self._may_leave():
                    return
                continue
            if entry.strip() and self._say(entry).leaves and self._may_leave():
                return

    @property
    def _desk(self) -> Desk:
        return self.conversation.desk

    def _say(self, entry: str) -> Reply:
        """Say an entry and print the reply, or ask; Ctrl-C stops it, and then nothing has been done."""
        try:
            reply = self.conversation.say(entry)
        except KeyboardInterrupt:
            reply = Reply("stopped; all is as it was before\n", ok=False)
        if reply.question is None:
            self._print(reply.text)
            return reply
        if self._agrees(safe(reply.question.asked)):
            return self._say(reply.question.line)
        self._print(f"{safe(reply.question.left)}\n")
        return reply

    def _read(self) -> str:
        if self._desk.has_to_tell_of_change():
            name = self._desk.session.library.path.name
            self._print(f"{name} has changed on disk; `.library` reads it again and plays on it what was entered\n")
        library = self._desk.session.library.path
        if self._prompt is None or self._library != library:
            self._prompt, self._library = self._made(), library
        self._prompt.editing_mode = EditingMode.VI if self._desk.settings.keys == "vi" else EditingMode.EMACS
        entry = self._prompt.prompt()
        self._uses.update(uses_of([entry]))
        return entry

    def _may_leave(self) -> bool:
        """Return whether the person really wants to leave; asked only if something would be lost."""
        if not self._desk.unsaved:
            return True
        return self._agrees(f"{self._desk.session.n_seconds:.1f} s of motion are not saved. Leave?", ctrl_d=True)

    def _agrees(self, asked: str, *, ctrl_d: bool = False) -> bool:
        """Return whether the person says yes to a question; `ctrl_d` is what Ctrl-D means."""
        question: PromptSession[str] = PromptSession(input=self.input, output=self.output)
        try:
            answer = question.prompt(f"{asked} [y/N] ")
        except EOFError:
            return ctrl_d
        except KeyboardInterrupt:
            return False
        return answer.strip().lower() in ("y", "yes")

    def _made(self) -> PromptSession[str]:
        history = _history(self._desk)
        self._uses = uses_of(history.load_history_strings())
        completer = ScriptCompleter(self._desk, self._uses)
        return PromptSession(
            [("class:prompt", PROMPT)],
            multiline=True,
            key_bindings=_keys(),
            lexer=ScriptLexer(self._desk),
            completer=ThreadedCompleter(completer),
            complete_while_typing=True,
            auto_suggest=AutoSuggestFromHistory(),
            search_ignore_case=True,
            history=history,
            bottom_toolbar=lambda: toolbar(self._desk, self._n_columns()),
            prompt_continuation=lambda width, _line, _wrapped: " " * max(width - 4, 0) + "... ",
            style=_STYLE,
            color_depth=None if self._desk.colour else ColorDepth.DEPTH_1_BIT,
            reserve_space_for_menu=6,
            input=self.input,
            output=self.output,
        )

    def _n_columns(self) -> int:
        return (self.output or get_app_session().output).get_size().columns

    def _print(self, text: str) -> None:
        if text:
            print_formatted_text(ANSI(wrapped(text, self._n_columns())), end="", output=self.output)


def _greeting(desk: Desk) -> str:
    session = desk.session
    graphs = ", ".join(session.library.graphs)
    return f"{safe(library_name(session.library.path))}: {graphs}. `.help` tells what there is, Ctrl-D leaves.\n"


def _history(desk: Desk) -> History:
    """Return what was entered before for this library; where no file can be kept, only what is entered now."""
    path = history_path(desk.session.library.path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    except OSError:
        return InMemoryHistory()
    return FileHistory(str(path))


def _keys() -> KeyBindings:
    """Return what Enter does: an entry that is open goes on in another line, any other is played."""
    keys = KeyBindings()

    @keys.add("enter", filter=~is_searching)
    def _(event: KeyPressEvent) -> None:
        buffer = event.current_buffer
        text = buffer.document.text
        if buffer.complete_state is not None and buffer.complete_state.current_completion is not None:
            buffer.complete_state = None
        elif not is_dotted(text) and is_open(tokenize(Source(text))) and not text.endswith("\n\n"):
            buffer.insert_text("\n")
        else:
            buffer.validate_and_handle()

    @keys.add("escape", "enter")
    def _(event: KeyPressEvent) -> None:
        event.current_buffer.insert_text("\n")

    return keys
