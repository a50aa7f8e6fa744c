"""What the commands of workspace/executeCommand do: play, explain, tell candidates, tell what a diagnostic means."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Final, TypeAlias

from lsprotocol import types

from mlmg_lang.analysis import Analysis
from mlmg_lang.diagnostics import CODES, Severity
from mlmg_lang.explaining import explanation as told
from mlmg_lang.explaining.explain import explanation_from_analysis
from mlmg_lang.explaining.text import render_statements, render_text
from mlmg_lang.perform import perform, write_report
from mlmg_lang.planning.resolved import ResolvedPlan
from mlmg_lang.rules import read_rule
from mlmg_lsp.command_arguments import CommandArguments, Refused
from mlmg_lsp.convert import offset_of
from mlmg_lsp.open_text import Snapshot
from mlmg_runtime import bvh
from mlmg_runtime.errors import MlmgError
from mlmg_runtime.files import check_output
from mlmg_runtime.library import Library

Progress: TypeAlias = Callable[[str, int], object]
"""Told what is being done, and how many hundredths of all are done."""

_STATEMENTS: Final = 60
"""Hundredths of playing that go into deciding what is played when."""


@dataclass(frozen=True, slots=True)
class Done:
    """What came of a command.

    Attributes
    ----------
    said : a sentence for the person; empty if there is none.
    result : for the client.
    page : the name and the text of what is to be shown.
    """

    said: str
    result: dict[str, Any]
    page: tuple[str, str] | None = None


def play(snapshot: Snapshot, asked: CommandArguments, progress: Progress) -> Done:
    """Play a script, and write the motion.

    Raises
    ------
    Refused
        If it cannot be played or written.
    """
    plan, library = _playable(snapshot)
    if asked.to is None:
        raise Refused("the motion is written beside the script, which is no file yet: save it first")
    try:
        for path in (asked.to, asked.report):
            if path is not None:
                check_output(path)
        performance = perform(plan, library, progress=partial(_tell, progress))
        progress("writing", 90)
        bvh.write(performance.bvh, asked.to)
        if asked.report is not None:
            write_report(performance.report, asked.report)
    except OSError as error:
        raise Refused(f"{error.filename or asked.to}: {error.strerror or error}") from None
    except MlmgError as error:
        raise Refused(str(error)) from None
    report = performance.report
    facts = {name: report[name] for name in ("n_frames", "frame_rate")}
    return Done(f"{asked.to}: {performance.summary}", {"uri": asked.to.as_uri(), **facts})


def explain(snapshot: Snapshot, _asked: CommandArguments, _progress: Progress) -> Done:
    """Tell what a script will do, and why.

    Raises
    ------
    Refused
        If it cannot be played.
    """
    _, library = _playable(snapshot)
    text = render_text(explanation_from_analysis(snapshot.analysis, library))
    return Done("", {"text": text}, (f"{_stem(snapshot)}.explained.txt", text))


def candidates(snapshot: Snapshot, asked: CommandArguments, _progress: Progress) -> Done:
    """Tell which motions a command may play, in the order in which they are tried, and why others are left out.

    Of a script with mistakes it is said first that it has some; what a command may play is then told as if what cannot
    be understood were not there.

    Raises
    ------
    Refused
        If no library is known, or there is no command at the place that could be played.
    """
    library, wrong = _library(snapshot), _mistakes(snapshot.analysis)
    found = explanation_from_analysis(snapshot.analysis, library, despite_mistakes=True)
    source = snapshot.analysis.source
    position = asked.position or types.Position(0, 0)
    line, column = source.position(offset_of(source, position, snapshot.client.encoding))
    at = next((one for one in _commands(found.statements) if _holds(one.place, line, column)), None)
    if at is None:
        raise Refused(wrong or "there is no command at this place (any more)")
    text = render_statements(replace(found, statements=(at,)))
    if wrong:
        text = f"{wrong}\nWhat cannot be understood is left out of what is told here.\n\n{text}"
    return Done("", {"text": text}, (f"{_stem(snapshot)}.candidates.txt", text))


def rule(code: str) -> Done:
    """Tell what a diagnostic means.

    Raises
    ------
    Refused
        If there is no such code.
    """
    if code not in CODES:
        raise Refused(f"there is no diagnostic `{code}`")
    text = read_rule(code)
    parts = (f"# {code}: {CODES[code].title}", text.meaning, text.why)
    examples = (("Wrong", text.wrong.text), ("What is said of it", text.told), ("Right", text.right.text))
    shown = (f"## {title}\n\n```\n{example.rstrip()}\n```" for title, example in examples)
    page = "\n\n".join((*parts, *shown)) + "\n"
    return Done(f"{code}: {' '.join(text.meaning.split())}", {"text": page}, (f"{code}.md", page))


# --- what they share ---


def _tell(progress: Progress, stage: str, done: int, total: int) -> None:
    if stage == "statements":
        progress(f"{stage} {done}/{total}", _STATEMENTS * done // max(total, 1))
    else:
        progress(stage, _STATEMENTS)


def _playable(snapshot: Snapshot) -> tuple[ResolvedPlan, Library]:
    """Return what a script plays, and on what.

    Raises
    ------
    Refused
        That says why it cannot be played.
    """
    library, plan = _library(snapshot), snapshot.analysis.resolved
    if plan is None:
        raise Refused(_mistakes(snapshot.analysis))
    if not plan.statements:
        raise Refused("there is nothing to play; expected a command such as `WALK for 10 sec`")
    return plan, library


def _library(snapshot: Snapshot) -> Library:
    """Return what a script is played on.

    Raises
    ------
    Refused
        If that is not known.
    """
    if snapshot.shelved is None:
        raise Refused("no library is known for this script, so there is nothing that it could be played on")
    return snapshot.shelved.library


def _mistakes(analysis: Analysis) -> str:
    """Say how many mistakes a script has, and what the first is; nothing if it can be played."""
    if analysis.resolved is not None:
        return ""
    wrong = [one for one in analysis.diagnostics if one.severity is Severity.ERROR]
    first = f"; line {analysis.source.position(wrong[0].span.start)[0]}: " if wrong and wrong[0].span else ": "
    said = wrong[0].message if wrong else ""
    return f"the script has {len(wrong)} mistake{'' if len(wrong) == 1 else 's'}{first}{said}"


def _stem(snapshot: Snapshot) -> str:
    name = snapshot.analysis.source.name
    return "untitled" if name == snapshot.uri else Path(name).stem


def _commands(statements: tuple[told.Statement, ...]) -> Iterator[told.Command]:
    for one in statements:
        match one:
            case told.Command():
                yield one
            case told.Repeat(body=body):
                yield from _commands(body)
            case told.Choose(branches=branches):
                yield from (command for branch in branches for command in _commands(branch.body))


def _holds(place: told.Place, line: int, column: int) -> bool:
    return place.span[:2] <= (line, column) <= place.span[2:]
