"""An open text -> its analysis: by the one before it, or after ever longer beginnings where it is long and new."""

from __future__ import annotations

import os
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from mlmg_lang.source import Source
from mlmg_lsp.memory import clear_out, settle, undisturbed
from mlmg_lsp.open_text import Document
from mlmg_lsp.work import off_loop

if TYPE_CHECKING:
    from mlmg_lang.definitions.gather import Files
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.front_end import Analysis
    from mlmg_lang.script_files import UsedFiles


@dataclass(frozen=True, slots=True)
class Reader:
    """Reads open texts.

    Attributes
    ----------
    files : says where a text finds the files that it uses; takes also what has the texts of files that are open.
    text_of : returns the text of a file that is open, by its path.
    tell_beginning : is called with a text that is read for the first time, the analysis of its first lines, and how
        many these are, if no line behind them may define what they name.
    """

    files: Callable[[Document, Callable[[str], str | None]], Files]
    text_of: Callable[[str], str | None]
    tell_beginning: Callable[[Document, Analysis, int], Awaitable[None]]

    async def read(self, document: Document) -> Analysis:
        """Return the analysis of a text, in which no file is other than it is open; the text keeps it too."""
        before, analysis = document.analysis, await self._read(document)
        # Where a file changes, who has used it is read again; but not who is reading it for the first time.
        if document.changed or before is None or before.source.used != analysis.source.used:
            while self._is_outdated(document, analysis):
                document.stale = True
                analysis = await self._read(document)
            document.changed.clear()
        return analysis

    async def _read(self, document: Document) -> Analysis:
        from mlmg_lang.beginnings import beginnings

        lines, n_read = document.lines, document.n_read
        if document.stale or document.analysis is None:
            n_read = 0
            document.changed.clear()
        ends = [(len(lines), True)] if n_read is None else await off_loop(lambda: list(beginnings(lines, n_read)))
        for n_lines, is_sure in ends[:-1]:
            analysis = await off_loop(self._work(document, n_lines))
            _take(document, analysis, n_lines)
            if is_sure and not document.revision:
                await self.tell_beginning(document, analysis, n_lines)
        analysis = await off_loop(self._work(document, len(lines)))
        _take(document, analysis, None)
        return analysis

    def _work(self, document: Document, n_lines: int) -> Callable[[], Analysis]:
        """Return what is to be done of some lines, with all that it needs: what it would ask may change meanwhile."""
        from mlmg_lang.front_end import Question, analyse_again, analyse_for

        source = Source("".join(document.lines[:n_lines]), document.name)
        shelved, before = document.shelved, document.analysis
        catalog, names = (None, None) if shelved is None else (shelved.library, shelved.names)
        if document.stale or before is None or before.question.catalog is not catalog:
            question = Question(catalog, names, None, self.files(document, self.text_of))
            return undisturbed()(partial(analyse_for, source, question))
        again = partial(analyse_again, before, source)
        return again if document.n_read is None else undisturbed()(again)

    def _is_outdated(self, document: Document, analysis: Analysis) -> bool:
        """Return whether a text may have read another text of a file than there is now, or have missed one."""
        if document.changed and not analysis.made.gathered.used.complete:
            return True
        used = analysis.source.used
        return any(
            os.path.realpath(file.name) in document.changed or self.text_of(file.name) not in (None, file.text)
            for file in used
        )


def _take(document: Document, analysis: Analysis, n_read: int | None) -> None:
    """Keep an analysis in the place of the one before; `n_read`: see `Document`."""
    if document.analysis is not None and document.analysis.question.catalog is not analysis.question.catalog:
        document.analysis = None
        clear_out()
    is_grown = n_read is not None or document.n_read is not None
    document.analysis, document.stale, document.n_read = analysis, False, n_read
    if is_grown or analysis.made.serial == 0:  # made afresh, so that nearly all of it will stay
        settle()


@dataclass(frozen=True, slots=True)
class OpenFiles:
    """Finds the files that a text uses, as they stand in the client where they are open there."""

    files: UsedFiles
    text_of: Callable[[str], str | None]

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        """Return a file and what is wrong with its bytes; or, in words, why it cannot be used."""
        found = self.files.find(path, user)
        if isinstance(found, str):
            return found
        text = self.text_of(found[0].name)
        return found if text is None else (Source(text, found[0].name), ())

    def paths(self, begun: str, user: str) -> Sequence[str]:
        """Return the paths that the beginning of one could become."""
        return self.files.paths(begun, user)
