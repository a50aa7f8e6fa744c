"""What completion is asked, on libraries of nothing but names."""

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

import pytest

from mlmg_lang.catalog import Catalog
from mlmg_lang.diagnostics import Diagnostic
from mlmg_lang.front_end import Analysis, analyse
from mlmg_lang.ide.completion import Surroundings, complete
from mlmg_lang.ide.cursor import cursor_at
from mlmg_lang.ide.occurrences import Place
from mlmg_lang.ide.offers import Completion, Offers
from mlmg_lang.ide.trying import trial_at, tried
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.planning import flow
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Edit, Source


@dataclass(frozen=True)
class InOrder:
    """What stands earlier in the configuration fits better."""

    names: Names

    def fits(self, graph: str, above: Collection[str]) -> Mapping[str, float]:
        return {motion: float(at) for at, motion in enumerate(self.names.motions(graph))}


@pytest.fixture
def in_order() -> Callable[[Names], InOrder]:
    """Return what tells how well the motions of a library fit, where what stands earlier fits better."""
    return InOrder


@pytest.fixture
def offers(reference: Catalog) -> Callable[..., list[Completion]]:
    """Return a function: a text with `|` for the cursor, a library, what plays -> what is offered there."""

    def ask(text: str, library: Catalog = reference, playing: str = "Idle_01", defined: str = "") -> list[Completion]:
        before, _, after = text.partition("¦")
        names = Names(library)
        definitions = analyse(Source(f"{defined}\n"), library).definitions
        around = Surroundings(names, definitions, flow.begin(names, playing), Offers(names, InOrder(names)))
        cursor = cursor_at(tokenize(Source(before + after)), len(before))
        found = complete(cursor, len(before), around).found
        return [] if cursor is None else list(tried(trial_at(cursor, around), found, found, len(found)).found)

    return ask


@pytest.fixture
def texts(offers: Callable[..., list[Completion]]) -> Callable[..., list[str]]:
    """Return the same, as texts to be written."""
    return lambda *asked, **how: [one.text for one in offers(*asked, **how)]


@dataclass(frozen=True)
class Folder:
    """Files that stand in no folder, by the path that names them."""

    texts: Mapping[str, str]

    def find(self, path: str, user: str) -> tuple[Source, tuple[Diagnostic, ...]] | str:
        return (Source(self.texts[path], path), ()) if path in self.texts else f"there is no file `{path}`"


@dataclass(frozen=True)
class Marked:
    """A script, what is known of it, and where its cursor `¦` is."""

    analysis: Analysis
    offset: int

    def written(self, place: Place) -> str:
        """Return what stands in a place."""
        source = self.analysis.source
        text = next(file.text for file in (source, *source.used) if file.name == place.file)
        return text[place.span.start : place.span.end]


@pytest.fixture
def marked(reference: Catalog) -> Callable[..., Marked]:
    """Return a function: a text with `¦` for the cursor, a library, files by name -> all that is known of it."""

    def ask(text: str, library: Catalog | None = reference, name: str = "main.ms", **files: str) -> Marked:
        before, _, after = text.partition("¦")
        folder = Folder({f"{path}.ms": said for path, said in files.items()})
        return Marked(analyse(Source(before + after, name), library, files=folder), len(before))

    return ask


@pytest.fixture
def edited() -> Callable[..., str]:
    """Return a function: a text and edits of it -> the text after them."""

    def ask(text: str, edits: Iterable[Edit]) -> str:
        for edit in sorted(edits, key=lambda edit: edit.span, reverse=True):
            text = text[: edit.span.start] + edit.replacement + text[edit.span.end :]
        return text

    return ask
