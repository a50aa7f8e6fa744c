"""What could be written at a cursor -> what of it makes no mistake with what stands around it, on both sides."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final, NamedTuple

from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.ide.arguments import open_parentheses, used_definition
from mlmg_lang.ide.completion import Surroundings
from mlmg_lang.ide.cursor import Cursor
from mlmg_lang.ide.offers import Completion, What
from mlmg_lang.ide.reach import Reach, Verdict, expression
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.source import Span

_MOST_TRIED: Final = 200
"""So many names are tried in a place, at about a sixth of a millisecond each."""
_MOST_AT_END: Final = 50
"""So many definitions, where nothing stands behind the cursor: others are offered untried."""
_NOWHERE: Final = Span(0, 0)


class Tried(NamedTuple):
    """What is left of what could be written, and whether all of it has been tried that could be among that."""

    found: tuple[Completion, ...]
    is_all: bool


@dataclass(frozen=True, slots=True)
class Trial:
    """Puts names at a cursor, and looks how wrong the command is then.

    Attributes
    ----------
    own : the tokens of the motion expression before the word that is being written. behind : those behind it.
    tries_library : whether names of the library are tried too: without anything behind the cursor, and where no
        definition is used, they are right.
    """

    reach: Reach
    own: Sequence[Token]
    behind: Sequence[Token]
    tries_library: bool

    def tries(self, one: Completion) -> bool:
        """Return whether a completion can be tried: what goes on behind it, as a graph's name, is not known yet."""
        goes_on = bool(self.behind) and self.behind[0].type in NAMES | {"LEFT"}
        match one.what:
            case What.MOTION | What.TAG:
                return self.tries_library
            case What.GRAPH:
                return goes_on
            case What.DEFINITION:
                return self.reach.definitions.lets[one.name].parameters is None
        return False

    def verdict(self, one: Completion) -> Verdict:
        """Return how wrong the command is with a completion in its place; parentheses that are open are closed."""
        name = Token("STRING" if one.text.startswith('"') else "NAME", one.text, _NOWHERE)
        command = (*self.own, name, *self.behind)
        n_open = sum((token.type == "LEFT") - (token.type == "RIGHT") for token in command)
        return self.reach.judged((*command, *[Token("RIGHT", ")", _NOWHERE)] * n_open))


def tried(trial: Trial, found: Iterable[Completion], offered: Iterable[Completion], most: int) -> Tried:
    """Return, of what is found, what leaves the command right; if nothing does, what leaves it least wrong.

    Parameters
    ----------
    offered : all that could be written, of which some has been found.
    most : when more than so many are found to be right, the rest is left out.
    """
    most_tried = _MOST_TRIED if trial.tries_library else _MOST_AT_END
    kept: list[tuple[Completion, Verdict]] = []
    n_tried = n_kept = n_left = 0
    best = None if trial.tries_library else Verdict.SOUND
    for one in found:
        if n_kept > most:
            break
        verdict = Verdict.SOUND
        if trial.tries(one):
            if n_tried == most_tried and trial.tries_library:
                n_left += 1
                continue
            if n_tried < most_tried:
                n_tried += 1
                verdict = trial.verdict(one)
                best = verdict if best is None else min(best, verdict)
        kept.append((one, verdict))
        n_kept += verdict is Verdict.SOUND
    if best is not None and best is not Verdict.SOUND:
        others = islice(filter(trial.tries, offered), most_tried - n_tried)
        best = min(best, next((one for one in map(trial.verdict, others) if one is Verdict.SOUND), best))
    return Tried(tuple([one for one, verdict in kept if best is None or verdict <= best]), not n_left)


def trial_at(cursor: Cursor, around: Surroundings) -> Trial:
    """Return what tries names at a cursor."""
    own = expression(cursor.before)
    tries_library = bool(cursor.behind) or _is_argument(own, around.definitions)
    return Trial(Reach(around.names, around.definitions, around.state), own, cursor.behind, tries_library)


def _is_argument(own: Sequence[Token], definitions: Definitions) -> bool:
    """Return whether what comes next is of what a definition is given."""
    return any(used_definition(own[:opening], definitions) is not None for opening in open_parentheses(own))
