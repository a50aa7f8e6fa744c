"""What completion is asked, on libraries of nothing but names."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass

import pytest

from mlmg_lang.catalog import Catalog
from mlmg_lang.front_end import analyse
from mlmg_lang.ide.completion import Completion, Offers, Surroundings, complete
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.planning import flow
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source


@dataclass(frozen=True)
class InOrder:
    """What stands earlier in the configuration fits better."""

    names: Names

    def fits(self, graph: str, above: Collection[str]) -> Mapping[str, float]:
        return {motion: float(at) for at, motion in enumerate(self.names.motions(graph))}


@pytest.fixture
def offers(reference: Catalog) -> Callable[..., list[Completion]]:
    """Return a function: a text with `|` for the cursor, a library, what plays -> what is offered there."""

    def ask(text: str, library: Catalog = reference, playing: str = "Idle_01", defined: str = "") -> list[Completion]:
        before, _, after = text.partition("¦")
        names = Names(library)
        definitions = analyse(Source(f"{defined}\n"), library).definitions
        around = Surroundings(names, definitions, flow.begin(names, playing), Offers(names, InOrder(names)))
        return list(complete(tokenize(Source(before + after)), len(before), around)[1])

    return ask


@pytest.fixture
def texts(offers: Callable[..., list[Completion]]) -> Callable[..., list[str]]:
    """Return the same, as texts to be written."""
    return lambda *asked, **how: [one.text for one in offers(*asked, **how)]
