"""What a command does on each graph, gathered from all the courses that it may take."""

from __future__ import annotations

from collections.abc import Sequence

from mlmg_lang.explaining import explanation as told
from mlmg_lang.explaining.expressions import place_of, text_of
from mlmg_lang.planning import resolved
from mlmg_lang.planning.course import Kind, Leg, by_similarity
from mlmg_lang.planning.estimate import Estimate, Travel, Trip, mixed
from mlmg_lang.planning.forecast import Outcome
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source

_Legs = Sequence[tuple[float, Leg]]
"""With the chances of their courses."""


def layer_of(
    layer: resolved.Layer,
    command: resolved.Command,
    outcome: Outcome,
    known: tuple[Names, Travel],
    source: Source,
    is_ahead: bool = False,
) -> told.Layer:
    """Return what a command does on one graph; `is_ahead`: the root's motion was chosen over the whole script."""
    names, travel = known
    graph = layer.graph
    legs = [
        (course.chance, leg)
        for course in outcome.courses
        for leg in course.legs
        if leg.graph == graph and leg.kind is not Kind.ENDS
    ]
    to_begin = isinstance(command.duration, resolved.Once) and graph == command.layers[0].graph
    rankings = tuple(_rankings(layer, legs, travel))
    candidates = [_candidate(motion, graph, legs, travel, to_begin) for motion in layer.candidates]
    if rankings:
        order = [fit.motion for fit in rankings[0].fits]
        candidates.sort(key=lambda one: order.index(one.motion))
    else:
        candidates.sort(key=_soonness)
    return told.Layer(
        graph,
        text_of(source, layer.span),
        place_of(source, layer.span),
        "best fit" if graph != names.root else "look ahead" if is_ahead else "soonest",
        _chance(legs, Kind.STAYS),
        _chance(legs, Kind.FOLLOWS),
        tuple(_sources(legs)),
        tuple(candidates),
        rankings,
        tuple(told.LeftOut(one.motion, one.reason, one.because) for one in layer.left_out),
    )


def _soonness(one: told.Candidate) -> tuple[float, float, float]:
    """Return what sorts candidates of the root: those first that are likely to be reached before the others."""
    takes = float("inf") if one.takes is None else one.takes.mean
    return -one.chance, takes, one.cost or 0.0


def endings(outcome: Outcome) -> tuple[told.Ending, ...]:
    """Return the parts that a statement gives back to the graphs above them."""
    by: dict[tuple[str, str], list[tuple[float, Leg]]] = {}
    for course in outcome.courses:
        for leg in course.legs:
            if leg.kind is Kind.ENDS:
                by.setdefault((leg.graph, leg.because), []).append((course.chance, leg))
    return tuple(_ending(graph, because, legs) for (graph, because), legs in by.items())


def _ending(graph: str, because: str, legs: _Legs) -> told.Ending:
    chance = sum(chance for chance, _ in legs)
    takes = mixed((chance, leg.takes) for chance, leg in legs)
    cost = sum(chance * leg.cost for chance, leg in legs) / chance
    on_the_spot = sum(chance * leg.on_the_spot for chance, leg in legs) / chance
    return told.Ending(
        graph, because, _thousandths(chance), _rounded(takes), _thousandths(cost), _thousandths(on_the_spot)
    )


def _sources(legs: _Legs) -> list[told.Source]:
    chances: dict[tuple[str, str], float] = {}
    for chance, leg in legs:
        if leg.kind is Kind.MOVES:
            key = (leg.driver, leg.playing.motion)
            chances[key] = chances.get(key, 0.0) + chance
    order = sorted(chances.items(), key=lambda one: -one[1])
    return [told.Source(graph, motion, _thousandths(chance)) for (graph, motion), chance in order]


def _rankings(layer: resolved.Layer, legs: _Legs, travel: Travel) -> list[told.Ranking]:
    chances: dict[str, float] = {}
    for chance, leg in legs:
        if leg.above is not None and leg.kind is not Kind.STAYS:
            chances[leg.above] = chances.get(leg.above, 0.0) + chance
    rankings = []
    for above, chance in sorted(chances.items(), key=lambda one: -one[1]):
        ranked = (*layer.candidates, *(one.motion for one in layer.left_out if one.reason == "outranked"))
        order = by_similarity(layer.graph, above, ranked, travel)
        fits = (_fit(layer.graph, above, motion, travel) for motion in order)
        rankings.append(told.Ranking(above, _thousandths(chance), tuple(fits)))
    return rankings


def _fit(graph: str, above: str, motion: str, travel: Travel) -> told.Fit:
    oms, of_usual = travel.similarity(graph, above, motion), travel.unlikeness(graph, above, motion)
    return told.Fit(motion, _thousandths(oms), _thousandths(of_usual))


def _candidate(motion: str, graph: str, legs: _Legs, travel: Travel, to_begin: bool) -> told.Candidate:
    """Return what is known of a candidate: how likely it is taken, and how long it would take to reach it."""
    taken = sum(chance for chance, leg in legs if leg.motion == motion)
    ways: list[tuple[float, Trip]] = []
    for chance, leg in legs:
        if leg.kind is Kind.MOVES:
            found = travel.soonest(graph, leg.playing, (motion,), leg.driver, to_begin)
            blended = (travel.on_the_spot(graph, motion),) if to_begin else ()
            ways += [(chance, trip) for trip in found or blended]
    total = sum(chance for chance, _ in ways)
    if not total:
        return told.Candidate(motion, _thousandths(taken), None, None, 0.0)
    takes = mixed((chance, trip.takes) for chance, trip in ways)
    cost = sum(chance * trip.cost for chance, trip in ways) / total
    on_the_spot = sum(chance * trip.on_the_spot for chance, trip in ways) / total
    return told.Candidate(motion, _thousandths(taken), _rounded(takes), _thousandths(cost), _thousandths(on_the_spot))


def _chance(legs: _Legs, kind: Kind) -> float:
    return _thousandths(sum(chance for chance, leg in legs if leg.kind is kind))


def _thousandths(number: float) -> float:
    return round(number, 3)


def _rounded(one: Estimate) -> Estimate:
    return Estimate(round(one.mean, 3), round(one.least, 3), round(one.most, 3))
