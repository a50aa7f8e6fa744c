"""What could be written at a cursor -> what of it makes no mistake with what stands around it, on both sides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Final, NamedTuple

from mlmg_lang.definitions.gather import Definitions
from mlmg_lang.ide.arguments import open_parentheses, used_definition
from mlmg_lang.ide.completion import Surroundings
from mlmg_lang.ide.cursor import Cursor
from mlmg_lang.ide.offers import Completion, What
from mlmg_lang.ide.reach import Reach, Verdict, expression
from mlmg_lang.parsing.lexical import script_name
from mlmg_lang.parsing.tokens import NAMES, Token
from mlmg_lang.source import Span

_MOST_TRIED: Final = 200
"""So many names are tried in a place without an `and`, at about a sixth of a millisecond each."""
_FEWEST_TRIED: Final = 8
"""And so many where many are joined by `and`, at some milliseconds each."""
_MOST_AT_END: Final = 50
"""So many definitions, where nothing stands behind the cursor: others are offered untried; and so many of all that
could be written, where nothing that has been found is right."""
_TRIED: Final = frozenset({What.MOTION, What.TAG, What.GRAPH, What.DEFINITION})
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
        match one.what:
            case What.MOTION | What.TAG:
                return self.tries_library
            case What.GRAPH:
                return bool(self.behind) and self.behind[0].type in NAMES | {"LEFT"}
            case What.DEFINITION:
                return self.reach.definitions.lets[one.name].parameters is None
        return False

    @property
    def most(self) -> int:
        """Return how many names are tried: fewer where there is more to be shared out among graphs."""
        n_joined = 1 + sum(token.type == "AND" for token in (*self.own, *self.behind))
        return max(_MOST_TRIED // n_joined**2, _FEWEST_TRIED)

    def verdict(self, one: Completion) -> Verdict:
        """Return how wrong the command is with a completion in its place."""
        return self.reach.judged(self._with(_name(one.text)))

    def can_be_right(self, offered: Sequence[Completion], most: int) -> bool:
        """Return whether something leaves the command right, as far as that can be told by trying so many."""
        numbers = islice(self.in_turn(offered), most)
        return any(self.verdict(offered[at]) is Verdict.SOUND for at in numbers)

    def in_turn(self, found: Sequence[Completion]) -> list[int]:
        """Return the numbers of what can be tried; where that is too much, the likeliest first.

        That is what has motions that the command leaves of all on their graph.
        """
        numbers = [at for at, one in enumerate(found) if one.what in _TRIED and self.tries(one)]
        if not self.tries_library or len(numbers) <= self.most:
            return numbers
        some = {one.graph: one for one in map(found.__getitem__, numbers) if one.graph is not None}
        left = {graph: self.reach.left_on(graph, self._with(*self._all_on(one))) for graph, one in some.items()}

        def is_unlikely(at: int) -> bool:
            graph = found[at].graph
            return graph is not None and left[graph].isdisjoint(found[at].motions)

        return sorted(numbers, key=is_unlikely)

    def _all_on(self, one: Completion) -> Iterator[Token]:
        """Yield an expression for all motions on the graph of a name: it, or all but it."""
        if one.graph is not None and self.reach.qualifier(self.own) is None:
            yield _name(script_name(one.graph))
        name = _name(one.text)
        yield from (
            Token("LEFT", "(", _NOWHERE),
            name,
            Token("OR", "or", _NOWHERE),
            Token("NOT", "not", _NOWHERE),
            name,
        )
        yield Token("RIGHT", ")", _NOWHERE)

    def _with(self, *tokens: Token) -> tuple[Token, ...]:
        """Return the command with tokens at the cursor; parentheses that are open are closed."""
        command = (*self.own, *tokens, *self.behind)
        n_open = sum((token.type == "LEFT") - (token.type == "RIGHT") for token in command)
        return (*command, *[Token("RIGHT", ")", _NOWHERE)] * n_open)


def tried(trial: Trial, found: Sequence[Completion], offered: Sequence[Completion], most: int) -> Tried:
    """Return, of what is found, what leaves the command right; if nothing does, what leaves it least wrong.

    Parameters
    ----------
    offered : all that could be written, of which some has been found.
    most : when more than so many are found to be right, no more are tried.
    """
    numbers = trial.in_turn(found)
    most_tried = trial.most if trial.tries_library else _MOST_AT_END
    verdicts: dict[int, Verdict] = {}
    n_sound = 0
    for at in numbers[:most_tried]:
        verdicts[at] = trial.verdict(found[at])
        n_sound += verdicts[at] is Verdict.SOUND
        if n_sound > most:
            break
    if not trial.tries_library:
        left_out = {at for at, verdict in verdicts.items() if verdict is not Verdict.SOUND}
    else:
        best = min(verdicts.values(), default=Verdict.SOUND)
        if best is not Verdict.SOUND and trial.can_be_right(offered, min(trial.most, _MOST_AT_END)):
            best = Verdict.SOUND
        left_out = {at for at in numbers if at not in verdicts or verdicts[at] > best}
    kept = tuple([one for at, one in enumerate(found) if at not in left_out])
    return Tried(kept, is_all=len(verdicts) == len(numbers) or not trial.tries_library)


def trial_at(cursor: Cursor, around: Surroundings) -> Trial:
    """Return what tries names at a cursor."""
    own = expression(cursor.before)
    tries_library = bool(cursor.behind) or _is_argument(own, around.definitions)
    return Trial(Reach(around.names, around.definitions, around.state), own, cursor.behind, tries_library)


def _is_argument(own: Sequence[Token], definitions: Definitions) -> bool:
    """Return whether what comes next is of what a definition is given."""
    return any(used_definition(own[:opening], definitions) is not None for opening in open_parentheses(own))


def _name(text: str) -> Token:
    return Token("STRING" if text.startswith('"') else "NAME", text, _NOWHERE)
