"""A conversation with a character: every entry is compiled for what is playing, played on from there, and answered.

What a person enters never raises: an answer says what is wrong, and all stays as it was. Where a session stands is a
value, so that undoing gives back exactly what was.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace
from typing import Final

from mlmg_lang.analysis import Analysis, Question
from mlmg_lang.definitions.gather import Files, NoFiles
from mlmg_lang.diagnostics import Diagnostic, has_errors
from mlmg_lang.front_end import analyse_for
from mlmg_lang.parsing import syntax
from mlmg_lang.parsing.tokens import CONTINUES
from mlmg_lang.planning import flow
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolve import start_of
from mlmg_lang.session.answer import Answer, Deed, deeds
from mlmg_lang.source import Source
from mlmg_lang.staging import Executed, ScriptError, Stage, begin
from mlmg_runtime.library import Library

ENTRY: Final = "<entry>"
EARLIER: Final = "what was defined before"
_OF_WHOLE_SCRIPTS: Final = frozenset({"MS047", "MS054"})
"""What is said of scripts that are finished: in a conversation, more may follow."""


@dataclass(frozen=True, slots=True, eq=False)
class Turn:
    """An entry that was played; no two are equal.

    Attributes
    ----------
    text : as it was entered.
    name : of the file that it was read from; `ENTRY` if it was typed.
    done, deeds : the statements as they were executed, and what is to be told of them.
    stage : the character after it; None as long as nothing has been played. It is not to be changed.
    defined : the definitions of this entry and all before it, as they were entered, by the file that they are from:
        a file that one of them uses is found from there.
    """

    text: str
    name: str
    done: tuple[Executed, ...]
    deeds: tuple[Deed, ...]
    stage: Stage | None
    defined: tuple[Source, ...]


@dataclass(frozen=True, slots=True)
class Playing:
    """What a graph that runs on its own is doing: `frame` of its motion is shown next."""

    graph: str
    motion: str
    frame: int


@dataclass(slots=True, eq=False)
class Session:
    """A conversation about one library.

    Attributes
    ----------
    start : the motion of the whole body to start in; without it, the first command or the library says which.
    seed : of what `choose` draws.
    files : where the files are found that entries use.
    """

    library: Library
    start: str | None = None
    seed: int = 0
    files: Files = field(default_factory=NoFiles)
    names: Names = field(init=False)
    _turns: list[Turn] = field(default_factory=list, init=False)
    _undone: list[Turn] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        """Look up the library's names once.

        Raises
        ------
        ValueError
            If the library has no such start motion.
        """
        self.names = Names(self.library)
        if self.start is not None:
            motion, wrong = start_of((), self.names, self.library, self.start)
            if wrong:
                raise ValueError(wrong[0].message)
            self.start = motion

    # --- asking ---

    def analyse(self, text: str, name: str = ENTRY) -> Analysis:
        """Return what an entry would say now, and what is wrong with it, without playing it."""
        source = Source(text, name, self._defined)
        question = Question(self.library, self.names, self.start, self.files, self.state)
        return _of_entry(analyse_for(source, question), self._continued(text))

    def enter(self, text: str, name: str = ENTRY) -> Answer:
        """Play an entry on from where the character is, and say what came of it.

        If it is interrupted or cannot be played, all is as before it.

        Parameters
        ----------
        name : of the file that the text was read from; files that it uses are found from there.
        """
        analysis = self.analyse(text, name)
        plan = analysis.resolved
        if plan is None or not any(True for _ in analysis.script.items):
            return Answer(analysis.source, analysis.diagnostics)
        stage = self.stage_in(plan.start) if plan.statements else self._stage
        try:
            done = () if stage is None or not plan.statements else stage.play(plan)
        except ScriptError as error:
            return Answer(analysis.source, analysis.diagnostics, problem=str(error))
        told = () if stage is None else deeds(done, plan, self._stage, stage)
        self._turns.append(Turn(text, name, done, told, stage, self._defined_by(analysis)))
        self._undone.clear()
        return Answer(analysis.source, analysis.diagnostics, told, self.n_seconds)

    def undo(self) -> Turn | None:
        """Go back to before the last entry, and return it; None if there is none."""
        if not self._turns:
            return None
        self._undone.append(self._turns.pop())
        return self._undone[-1]

    def redo(self) -> Turn | None:
        """Take back an undo, and return the entry; None if nothing has been undone since the last entry."""
        if not self._undone:
            return None
        self._turns.append(self._undone.pop())
        return self._turns[-1]

    # --- where it stands ---

    @property
    def turns(self) -> tuple[Turn, ...]:
        """Return what was entered, without what has been undone."""
        return tuple(self._turns)

    @property
    def stage(self) -> Stage:
        """Return a character that can go on from here by itself."""
        return self.stage_in(self._start_without_command())

    def stage_in(self, start: str) -> Stage:
        """Return a character that can go on from here by itself; at first, in the first frame of `start`."""
        return begin(self.library, start, self.seed) if self._stage is None else self._stage.copy()

    @property
    def state(self) -> flow.State | None:
        """Return what is playing, as planning sees it; None before anything has been played."""
        stage = self._stage
        if stage is None:
            return None
        performer = stage.performer
        running = {graph: performer.motion(graph) for graph in self.names.graphs if performer.runs(graph)}
        nobody: frozenset[flow.Setter | None] = frozenset((None,))
        return flow.State({graph: flow.Part({motion: nobody}, True) for graph, motion in running.items()})

    @property
    def playing(self) -> tuple[Playing, ...]:
        """Return what the graphs that run are doing, the root first."""
        found = self.stage.performer.whereabouts()
        return tuple(Playing(graph, *found[graph]) for graph in self.names.graphs if graph in found)

    @property
    def n_seconds(self) -> float:
        """Return how much motion there is so far."""
        return 0.0 if self._stage is None else self._stage.performer.now / self.library.frame_rate

    @property
    def starts_in(self) -> str:
        """Return the motion that the character started in, or would if nothing is entered that names another."""
        return self.stage.performer.start

    @property
    def files_read(self) -> tuple[str, ...]:
        """Return the names of the files that entries were read from, and of those that they use."""
        loaded = [turn.name for turn in self._turns if turn.name != ENTRY]
        used = [one.name for one in self.analyse("").source.used if one.name != EARLIER]
        return tuple(dict.fromkeys((*loaded, *used)))

    # --- small questions ---

    @property
    def _stage(self) -> Stage | None:
        return self._turns[-1].stage if self._turns else None

    def _start_without_command(self) -> str:
        return start_of((), self.names, self.library, self.start)[0]

    @property
    def _defined(self) -> tuple[Source, ...]:
        return self._turns[-1].defined if self._turns else ()

    def _defined_by(self, analysis: Analysis) -> tuple[Source, ...]:
        """Return all definitions so far, with those of an entry."""
        own = [
            analysis.source.slice(one.span) for one in analysis.script.items if isinstance(one, syntax.Let | syntax.Use)
        ]
        if not own:
            return self._defined
        name = EARLIER if analysis.source.name == ENTRY else analysis.source.name
        texts = {one.name: one.text for one in self._defined}
        texts[name] = "\n".join([*([texts[name]] if name in texts else []), *own])
        return tuple(Source(text, name) for name, text in texts.items())

    def _continued(self, text: str) -> str | None:
        """Return the command that an entry would have to go on with, if it has been played already."""
        return self._turns[-1].text.strip().splitlines()[-1] if self._turns and self._turns[-1].deeds else None


def _of_entry(analysis: Analysis, before: str | None) -> Analysis:
    """Return the analysis of an entry without what is said of other texts, or of scripts that are finished."""
    first = next((token for token in analysis.tokens if token.type not in ("NEWLINE", "COMMENT")), None)
    if before is not None and first is not None and first.type in CONTINUES:
        message = f"`{first.text}` goes on with a command, but the one before has been played"
        whole = f"{before} {analysis.source.slice(first.span)} ..."
        told = Diagnostic("MS010", message, first.span, f"write the command again, whole: `{whole}`")
        others = tuple(one for one in analysis.diagnostics if one.span is not None and one.span.start > first.span.end)
        return replace(analysis, diagnostics=(told, *_own(others, analysis)))
    return replace(analysis, diagnostics=_own(analysis.diagnostics, analysis))


def _own(diagnostics: Collection[Diagnostic], analysis: Analysis) -> tuple[Diagnostic, ...]:
    """Leave out what has been said of earlier entries, but for those that a new definition makes wrong."""
    end = len(analysis.source.text)
    told = [one for one in diagnostics if one.code not in _OF_WHOLE_SCRIPTS]
    own = tuple(one for one in told if one.span is None or one.span.start <= end)
    return own if has_errors(own) else (*own, *(one for one in told if one.severity == "error"))
