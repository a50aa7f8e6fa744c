"""The part of an explanation that tells what happens on a graph, with which candidates -> a tree of text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from mlmg_lang.explaining.explanation import Candidate, Ending, Fit, Layer, Ranking
from mlmg_lang.explaining.tree import Tree, table
from mlmg_lang.explaining.wording import fit_number, listed, seconds, share
from mlmg_lang.rendering.colour import BLUE, DIM, GREEN

_MOST_CANDIDATES: Final = 20
_GOALS: Final = {
    "soonest": "whichever is reached soonest",
    "look ahead": "what was chosen for each round",
}


def ending_tree(one: Ending) -> Tree:
    """Return how a part is given back to the graph above."""
    way = "by a blend on the spot" if one.on_the_spot >= 1.0 else "by a path in its own graph"
    if 0 < one.on_the_spot < 1.0:
        way += f", in {share(one.on_the_spot)} by a blend on the spot"
    chance = "" if one.chance >= 1.0 else f"in {share(one.chance)}: "
    because = f", as {one.because}" if one.because else ""
    return Tree(f"ends {one.graph}", f"{chance}{seconds(one.takes)} {way}{because}", style=(BLUE,))


def layer_tree(layer: Layer) -> Tree:
    """Return what a command does on one graph: whether it moves, the candidates, and why others are left out."""
    told = [*_staying(layer)]
    rows: list[Tree] = []
    if layer.sources:
        sources = ", ".join(_source(layer, one.graph, one.motion, one.chance) for one in layer.sources)
        if len(layer.candidates) == 1 and not _outranked(layer):
            told.append(f"from {sources} to {_only(layer)}")
        else:
            told.append(f"from {sources} to {_GOALS.get(layer.rule, 'what fits best')}")
            rows = _candidates(layer)
    children = [*rows, *map(_ranking, _told_apart(layer)), *_left_out(layer)]
    text = "; else ".join(told) or "no way is known from where it will probably be"
    return Tree(layer.graph, text, tuple(children), (BLUE,))


def _staying(layer: Layer) -> Iterator[str]:
    """Yield what a layer does where it need not move."""
    kept = [one.motion for one in layer.candidates if one.chance > 0]
    others = [one.motion for one in layer.candidates if one.chance == 0]
    if layer.stays >= 1.0:
        instead = f"; {listed(others, 'or')} would do too" if others else ""
        yield f"stays in {listed(kept, 'or')}, which it is to play{instead}"
    elif layer.stays:
        yield f"stays as it is in {share(layer.stays)}, as it plays a candidate"
    if layer.follows:
        chance = "" if layer.follows >= 1.0 else f" in {share(layer.follows)}"
        yield f"follows the graph above{chance}, which plays what it is to do"


def _only(layer: Layer) -> str:
    """Return what there is to say of the only candidate."""
    one = layer.candidates[0]
    _, motion, oms, takes, cost, _, way = _row(0, one, _oms_of(layer).get(one.motion, ""))
    return ", ".join(part for part in (motion, takes, cost, oms, way) if part)


def _source(layer: Layer, graph: str, motion: str, chance: float) -> str:
    where = "" if graph == layer.graph else f" of {graph}"
    return f"{motion}{where}" + ("" if chance >= 1.0 else f" ({share(chance)})")


def _candidates(layer: Layer) -> list[Tree]:
    shown = layer.candidates[:_MOST_CANDIDATES]
    outranked = _outranked(layer)[: _MOST_CANDIDATES - len(shown)]
    oms = _oms_of(layer)
    rows = [_row(number, one, oms.get(one.motion, "")) for number, one in enumerate(shown, 1)]
    numbered = enumerate(outranked, len(shown) + 1)
    rows += [(f"{number}.", motion, oms.get(motion, ""), "", "", "outranked", "") for number, motion in numbered]
    styles = [(GREEN,) if one.chance > 0 else () for one in shown] + [(DIM,)] * len(outranked)
    trees = [Tree(line, style=style) for line, style in zip(table(rows), styles, strict=True)]
    more = layer.candidates[_MOST_CANDIDATES:]
    if more:
        chance = sum(one.chance for one in more)
        trees.append(Tree("", f"and {len(more)} more, one of which is taken in {share(chance)}"))
    return trees


def _oms_of(layer: Layer) -> dict[str, str]:
    """Return how candidates fit, if there is but one motion that they can be compared with."""
    return {fit.motion: _fit(fit) for fit in layer.rankings[0].fits} if len(layer.rankings) == 1 else {}


def _fit(fit: Fit) -> str:
    return f"OMS {fit_number(fit.oms)} ({fit.of_usual:.1f} of usual)"


def _row(number: int, one: Candidate, fits: str) -> tuple[str, ...]:
    takes = "" if one.takes is None else seconds(one.takes)
    cost = "" if one.cost is None else f"cost {one.cost:.2f}"
    taken = "taken" if one.chance >= 1.0 else f"taken in {share(one.chance)}" if one.chance > 0 else ""
    chance = "" if one.on_the_spot >= 1.0 else f"in {share(one.on_the_spot)} "
    way = f"{chance}by a blend on the spot" if one.on_the_spot else ""
    return f"{number}.", one.motion, fits, takes, cost, taken, way


def _told_apart(layer: Layer) -> Sequence[Ranking]:
    """Return the rankings of a layer where there are several, so that they are not told with the candidates."""
    return layer.rankings if len(layer.rankings) > 1 and len(layer.rankings[0].fits) > 1 else ()


def _ranking(one: Ranking) -> Tree:
    fits = " before ".join(f"{fit.motion} {_fit(fit)}" for fit in one.fits)
    return Tree(f"while the graph above plays {one.above} ({share(one.chance)})", fits, style=(DIM,))


def _left_out(layer: Layer) -> Iterator[Tree]:
    by: dict[tuple[str, str], list[str]] = {}
    for one in layer.left_out:
        if layer.sources and one.reason == "outranked":
            continue  # They stand with the candidates, which come before them.
        by.setdefault((one.reason, one.because), []).append(one.motion)
    for (reason, because), motions in by.items():
        yield Tree("left out", f"{listed(motions)} ({reason}): {because}", style=(DIM,))


def _outranked(layer: Layer) -> list[str]:
    """Return the motions that would come after the candidates by their fit, the best first."""
    out = [one.motion for one in layer.left_out if one.reason == "outranked"]
    order = [fit.motion for fit in layer.rankings[0].fits] if layer.rankings else out
    return sorted(out, key=order.index)
