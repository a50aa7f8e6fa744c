"""What a name can mean where it stands, and a name that means nothing there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.parsing import syntax
from mlmg_lang.planning.names import Names
from mlmg_lang.spelling import normal


@dataclass(frozen=True, slots=True)
class Scope:
    """What a name can mean in a script.

    Attributes
    ----------
    definitions : the names that are defined where the expression stands; elsewhere they have been put in.
    open : whether a file that defines more could not be used.
    parameters : of the definition that the expression stands in.
    own : all definitions of the script, by name: what may have been meant.
    unread : the names of definitions that could not be read.
    explains : whether it is worked out what is wrong with a name, which takes far longer than to see that it is.
    """

    names: Names
    definitions: frozenset[str]
    open: bool
    parameters: frozenset[str] = frozenset()
    own: Mapping[str, syntax.Let] = field(default_factory=dict)
    unread: frozenset[str] = frozenset()
    explains: bool = True

    def defines(self, name: syntax.Name) -> bool:
        """Return whether a name is one of the script's own."""
        word = normal(name.text)
        return word in self.definitions or word in self.parameters or word in self.unread

    def kind_of_own(self, name: str) -> str | None:
        """Return what a name of the script's own stands for, in a word; None for other names."""
        if normal(name) in self.parameters:
            return "parameter"
        return "definition" if normal(name) in self.own else None


@dataclass(frozen=True, slots=True)
class Unbound:
    """A name that nothing can be played for; `diagnostic` is None where that is reported elsewhere, or nowhere."""

    diagnostic: Diagnostic | None
