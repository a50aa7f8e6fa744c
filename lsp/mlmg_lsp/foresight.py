"""How the commands of open texts will go, worked out behind what is asked: it may take longer than a hint should."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from mlmg_lsp.work import off_loop

if TYPE_CHECKING:
    from mlmg_lang.analysis import Analysis
    from mlmg_lang.explaining.travel import MotionTravel
    from mlmg_lang.ide.foreseen import Foreseen, Remembered
    from mlmg_lang.ide.hints import Outlook
    from mlmg_lsp.libraries import Shelved
    from mlmg_lsp.open_text import Snapshot

_GRACE_S: Final = 0.1
"""So long it is waited for; what takes longer, the client is told of when it is there."""
_PATIENCE_S: Final = 0.5
"""So long it is waited for where a client cannot be told, but can be given what was known before."""
_QUIET_S: Final = 0.3
"""So long there is to be no edit before what takes long is begun again."""
_MOST_USES: Final = 200
"""So often ways between motions are kept for the next time; an editor stays open for weeks."""


@dataclass(slots=True)
class _Known:
    """What is known of a text, or is being found out.

    Attributes
    ----------
    last : the last that was found out.
    is_late : whether somebody has gone without.
    """

    analysis: Analysis
    task: asyncio.Task[Foreseen | None]
    last: Remembered | None
    is_late: bool = False


class Foresight:
    """What is foreseen of all texts of one client."""

    def __init__(
        self,
        get_ready: Callable[[Snapshot, Outlook], object],
        is_there: Callable[[], object],
        failed: Callable[[Exception], object],
    ) -> None:
        """Take what is to be told.

        Parameters
        ----------
        get_ready : called with what is known of a text that was asked for in vain, beside all else.
        is_there : called after that. failed : called with what went wrong.
        """
        self._get_ready = get_ready
        self._is_there = is_there
        self._failed = failed
        self._known: dict[str, _Known] = {}
        self._slow: set[str] = set()
        self._travel: tuple[Shelved, MotionTravel, int] | None = None
        self._hopeless: Shelved | None = None
        self._one_by_one = asyncio.Lock()

    async def of(self, snapshot: Snapshot) -> Outlook | None:
        """Return how the commands of a text will go, as far as that is known; None if it cannot be known.

        While it is not known yet, and as long as the text has mistakes, commands that edits have left alone are told of
        as before. A client that cannot be told to ask again waits longer; the first time, until it is known.
        """
        known = self._begun(snapshot)
        wait = None if known.last is None else _PATIENCE_S
        if "inlay_hint" in snapshot.client.refreshed:
            wait = 0.0 if snapshot.uri in self._slow else _GRACE_S
        await asyncio.wait({known.task}, timeout=wait)
        told = known.task.result() if known.task.done() and not known.task.cancelled() else None
        if told is not None:
            return told
        known.is_late = True
        return None if known.last is None else known.last.of(snapshot.analysis.made)

    def stop(self, uri: str) -> None:
        """Work no longer at what has been edited meanwhile."""
        if uri in self._known:
            self._known[uri].task.cancel()

    def forget(self, uri: str) -> None:
        """Let go of a text."""
        self.stop(uri)
        self._known.pop(uri, None)
        self._slow.discard(uri)

    def keep(self, shelved: Iterable[Shelved | None]) -> None:
        """Let go of what was worked out of other libraries than these, and with it of those."""
        kept = set(shelved)
        if self._travel is not None and self._travel[0] not in kept:
            self._travel = None
        if self._hopeless not in kept:
            self._hopeless = None

    def end(self) -> None:
        """Let go of all."""
        for uri in list(self._known):
            self.forget(uri)
        self.keep(())

    def _begun(self, snapshot: Snapshot) -> _Known:
        known = self._known.get(snapshot.uri)
        if known is None or known.analysis is not snapshot.analysis or known.task.cancelled():
            self.stop(snapshot.uri)
            task = asyncio.ensure_future(self._foresee(snapshot))
            known = _Known(snapshot.analysis, task, None if known is None else known.last)
            self._known[snapshot.uri] = known
        return known

    async def _foresee(self, snapshot: Snapshot) -> Foreseen | None:
        shelved = snapshot.shelved
        if shelved is None or shelved is self._hopeless or snapshot.analysis.found.wrong:
            return None
        if snapshot.uri in self._slow:
            await asyncio.sleep(_QUIET_S)
        async with self._one_by_one:
            begin = time.monotonic()
            try:
                told = await self._found_out(snapshot.analysis, shelved)
            except Exception as error:
                self._hopeless = shelved
                self._failed(error)
                return None
            finally:  # also where an edit has put an end to it
                is_slow = time.monotonic() - begin > _GRACE_S
                if is_slow and snapshot.uri in self._known:
                    self._slow.add(snapshot.uri)
        if not is_slow:
            self._slow.discard(snapshot.uri)
        known = self._known.get(snapshot.uri)
        if known is not None and known.analysis is snapshot.analysis:
            from mlmg_lang.ide.foreseen import Remembered

            known.last = Remembered(told, snapshot.analysis.made)
            if known.is_late:
                await off_loop(lambda: self._get_ready(snapshot, told))
                self._is_there()
        return told

    async def _found_out(self, analysis: Analysis, shelved: Shelved) -> Foreseen:
        travel = await self._travel_on(shelved)
        from mlmg_lang.ide.foreseen import foreseen
        from mlmg_lang.planning.forecast import forecast

        def work() -> Foreseen:
            plan = analysis.resolved
            assert plan is not None, "there is a library, and nothing is wrong"
            return foreseen(plan, forecast(plan, shelved.names, travel), shelved.names)

        return await off_loop(work)

    async def _travel_on(self, shelved: Shelved) -> MotionTravel:
        """Return what knows the ways between the motions of a library, and keeps what it has worked out of them."""
        if self._travel is None or self._travel[0] is not shelved or self._travel[2] >= _MOST_USES:
            # What is being imported must not be interrupted.
            self._travel = (shelved, await asyncio.shield(off_loop(lambda: _new_travel(shelved))), 0)
        _, travel, n_uses = self._travel
        self._travel = (shelved, travel, n_uses + 1)
        return travel


def _new_travel(shelved: Shelved) -> MotionTravel:
    from mlmg_lang.explaining.travel import MotionTravel
    from mlmg_lang.ide import foreseen
    from mlmg_lang.planning import forecast

    del foreseen, forecast  # they are there from now on
    return MotionTravel(shelved.library)
