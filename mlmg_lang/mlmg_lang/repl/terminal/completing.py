"""What could be written at the cursor, as the prompt shows it in a menu."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Final

from prompt_toolkit.completion import CompleteEvent, Completer
from prompt_toolkit.completion import Completion as Shown
from prompt_toolkit.document import Document

from mlmg_lang.definitions.gather import Listing
from mlmg_lang.ide.completion import Surroundings
from mlmg_lang.ide.fuzzy import matching
from mlmg_lang.ide.matches import matches
from mlmg_lang.ide.offers import Completion, Offers, What
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.planning import flow
from mlmg_lang.repl.conversation import is_dotted
from mlmg_lang.repl.desk import Desk
from mlmg_lang.repl.dot_commands import DOT_COMMANDS, DotCommand, Takes
from mlmg_lang.session.fitness import StageFits
from mlmg_lang.session.session import Session, Turn
from mlmg_lang.source import Source

MOST_SHOWN: Final = 100
"""So many, the best, are put into the menu: what is further down, nobody looks through."""
_OPTIONS: Final = (
    "blend c1",
    "blend linear",
    "blend library",
    "fps 30",
    "fps 60",
    "fps library",
    "feet on",
    "feet off",
    "keys emacs",
    "keys vi",
)


@dataclass(slots=True)
class ScriptCompleter(Completer):
    """Offers what is valid at the cursor, what fits the present state best first.

    Attributes
    ----------
    uses : by name, how often it has been entered.
    """

    desk: Desk
    uses: Counter[str] = field(default_factory=Counter)
    _known: tuple[Session, tuple[Turn, ...], Surroundings] | None = None

    def get_completions(self, document: Document, _event: CompleteEvent) -> Iterator[Shown]:
        """Yield what could be written, the best first."""
        text, offset = document.text, document.cursor_position
        if is_dotted(text):
            yield from self._dotted(text[:offset].lstrip())
        else:
            yield from self._of_script(text, offset)

    def _of_script(self, text: str, offset: int) -> Iterator[Shown]:
        source = Source(text)
        meant = matches(source, tokenize(source), offset, self._surroundings(), MOST_SHOWN)
        offered = meant.offered
        for rank, one in enumerate(meant.found[:MOST_SHOWN], 1):
            meta = self._meta(one, rank, offered.fit(one))
            yield Shown(one.text, offered.span.start - offset, display=one.name, display_meta=meta)

    def _surroundings(self) -> Surroundings:
        """Return what is completed against; kept until something is played."""
        session = self.desk.session
        if self._known is None or self._known[:2] != (session, session.turns):
            self._known = (session, session.turns, surroundings_of(session, self.uses))
        return self._known[2]

    def _meta(self, one: Completion, rank: int, fit: float | None) -> str:
        if one.graph is None:
            return one.says
        library = self.desk.session.library
        seconds = sum(library.n_frames(motion) for motion in one.motions[:1000]) / library.frame_rate
        n = len(one.motions)
        what = f"{n} motion{'' if n == 1 else 's'}, {seconds:.0f} s" if one.what is What.TAG else f"{seconds:.0f} s"
        return f"{one.graph}  {what}  {rank}. {self._fit(one, fit)}"

    def _fit(self, one: Completion, fit: float | None) -> str:
        if fit is None:
            return ""
        session = self.desk.session
        if one.graph == session.names.root:
            if one.what is What.MOTION and session.state is None and session.start is None:
                return "starts in it"
            return "plays" if fit == 0 else f"in {fit:.1f} s"
        return f"OMS {fit:.2f}"

    # --- commands with a dot ---

    def _dotted(self, text: str) -> Iterator[Shown]:
        word, space, rest = text.partition(" ")
        if not space:
            for one in matching(word, DOT_COMMANDS, lambda one: f".{one.name}"):
                yield Shown(f".{one.name}", -len(word), display=one.usage, display_meta=one.says)
            return
        command = next((one for one in DOT_COMMANDS if f".{one.name}" == word), None)
        if command is not None:
            yield from self._arguments(command, rest.lstrip())

    def _arguments(self, command: DotCommand, rest: str) -> Iterator[Shown]:
        names = self.desk.session.names
        match command.takes:
            case Takes.STATEMENT:
                yield from self._of_script(rest, len(rest))
            case Takes.GRAPH:
                yield from _plain(rest, names.graphs)
            case Takes.MOTION:
                graphs = names.graphs if command.name != "start" else (names.root,)
                yield from _plain(rest, dict.fromkeys(motion for graph in graphs for motion in names.motions(graph)))
            case Takes.DOT_COMMAND:
                yield from _plain(rest, [one.name for one in DOT_COMMANDS])
            case Takes.SETTING:
                yield from _plain(rest, _OPTIONS)
            case Takes.SWITCH:
                yield from _plain(rest, ("on", "off"))
            case Takes.OUTPUT | Takes.SCRIPT | Takes.LIBRARY:
                endings = {Takes.OUTPUT: (".bvh", ".ms"), Takes.SCRIPT: (".ms",), Takes.LIBRARY: (".mlmg",)}
                yield from _files(rest, endings[command.takes])


def surroundings_of(session: Session, uses: Counter[str]) -> Surroundings:
    """Return what a session's entries are completed against."""
    stage = session.stage
    state = session.state or flow.begin(session.names, stage.performer.start)
    definitions = session.analyse("").definitions
    offers = Offers(session.names, StageFits(session.library, stage), uses)
    files = session.files
    paths = partial(files.paths, user="-") if isinstance(files, Listing) else lambda _: ()
    return Surroundings(session.names, definitions, state, offers, paths)


def _plain(word: str, offered: Iterable[str]) -> Iterator[Shown]:
    for one in matching(word, offered, str)[:MOST_SHOWN]:
        yield Shown(one, -len(word))


def _files(written: str, endings: tuple[str, ...]) -> Iterator[Shown]:
    """Yield folders, and files with some endings, that a path could go on with."""
    folder, _, begun = written.rpartition("/")
    place = Path(f"{folder}/" if written.startswith("/") or folder else ".").expanduser()
    try:
        found = sorted(place.iterdir(), key=lambda path: (path.is_file(), path.name))
    except OSError:
        return
    for path in found:
        if path.name.startswith(begun) and not path.name.startswith(".") and (path.is_dir() or path.suffix in endings):
            yield Shown(path.name + ("/" if path.is_dir() else ""), -len(begun))
