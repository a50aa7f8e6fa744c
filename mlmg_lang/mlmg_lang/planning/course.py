"""A command and what may be playing -> the courses that things may take, motion by motion.

It does what the performer does frame by frame, without knowing the frames.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import product
from math import prod

from mlmg_lang.planning.estimate import NO_TIME, Estimate, Moment, Playing, Travel, Trip, together
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Command, Once


@dataclass(frozen=True, slots=True)
class World:
    """What may be playing: each graph that runs on its own, the root first, parents before children."""

    running: tuple[tuple[str, Playing], ...]

    def get(self, graph: str) -> Playing | None:
        """Return what a graph plays on its own, if it does."""
        return next((playing for name, playing in self.running if name == graph), None)

    def held(self, time: Estimate) -> World:
        """Return the world when some time has passed."""
        return World(tuple((graph, playing.held(time)) for graph, playing in self.running))


class Kind(StrEnum):
    """What becomes of a graph in a command."""

    STAYS = "stays"
    MOVES = "moves"
    FOLLOWS = "follows"
    ENDS = "ends"


@dataclass(frozen=True, slots=True)
class Leg:
    """What one graph does in a command.

    Attributes
    ----------
    motion : that drives it afterwards.
    playing, driver : what it sets out from, and the graph that plays that.
    above : the motion of the graph above; None for the root.
    because : of a part that is ended, why.
    """

    graph: str
    kind: Kind
    motion: str
    playing: Playing
    driver: str
    above: str | None
    takes: Estimate = NO_TIME
    cost: float = 0.0
    on_the_spot: float = 0.0
    because: str = ""


@dataclass(frozen=True, slots=True)
class Course:
    """One of the ways in which something may go, with its chance: to which world, in what time, at what cost."""

    chance: float
    world: World
    takes: Estimate = NO_TIME
    cost: float = 0.0
    legs: tuple[Leg, ...] = ()


def driver(world: World, graph: str, names: Names) -> tuple[str, Playing]:
    """Return the graph that drives a body part, its own or the nearest above that runs, and what that plays."""
    found = ((above, world.get(above)) for above in (graph, *names.ancestors(graph)))
    return next((above, playing) for above, playing in found if playing is not None)


def bring(world: World, command: Command, names: Names, travel: Travel) -> tuple[Course, ...]:
    """Return the courses that a command may take; none if it cannot be obeyed in this world."""
    afresh = command.layers[0].graph if isinstance(command.duration, Once) else None
    named = {layer.graph: layer.candidates for layer in command.layers}
    return tuple(_Mover(names, travel, afresh).bring(world, named))


def end_part(world: World, graph: str, names: Names, travel: Travel) -> Course:
    """Return what happens when a part, and with it those below it, is given back to the graph above."""
    ended = [one for one in (graph, *names.below((graph,))) if world.get(one) is not None]
    return _Mover(names, travel, None).end(Course(1.0, world), dict.fromkeys(ended, ""))


@dataclass(frozen=True, slots=True)
class _Mover:
    """Moves graphs; `afresh` is the one that enters its motion where that begins, though it may play it already."""

    names: Names
    travel: Travel
    afresh: str | None

    def bring(self, world: World, named: Mapping[str, tuple[str, ...]]) -> list[Course]:
        """Lead graphs to one of their candidates each, the highest first."""
        gone = {graph: "the command does not name it" for graph in self._below(world, named) if graph not in named}
        courses = [self.end(Course(1.0, world), gone)]
        for depth in sorted({self._depth(graph) for graph in named}):
            level = {graph: candidates for graph, candidates in named.items() if self._depth(graph) == depth}
            courses = [after for course in courses for after in self._level(course, level)]
        return courses

    def end(self, course: Course, because: Mapping[str, str]) -> Course:
        """Give running parts back to those above them, the lowest first."""
        for depth in sorted({self._depth(graph) for graph in because}, reverse=True):
            ending = [graph for graph in because if self._depth(graph) == depth]
            legs = [self._ended(course.world, graph, because[graph]) for graph in ending]
            left = tuple(one for one in course.world.running if one[0] not in ending)
            course = self._passed(course, legs, World(left))
        return course

    def _level(self, course: Course, level: Mapping[str, tuple[str, ...]]) -> list[Course]:
        """Lead graphs beside each other to one of their candidates each, at the same time."""
        drivers = {graph: self._playing(course.world, graph).motion for graph in level}
        changing = {g: wanted for g, wanted in level.items() if g == self.afresh or drivers[g] not in wanted}
        stays = tuple(self._leg(course.world, graph, Kind.STAYS) for graph in level if graph not in changing)
        course = replace(course, legs=course.legs + stays)
        course = self.end(
            course, {graph: self._reason(graph, changing) for graph in self._below(course.world, changing)}
        )
        following = [graph for graph in changing if self._follows(course.world, graph, changing[graph])]
        course = self._follow(course, following)
        options = [self._options(course.world, graph, changing[graph]) for graph in changing if graph not in following]
        return [self._set_out(course, chosen) for chosen in product(*options)]

    def _follow(self, course: Course, graphs: Sequence[str]) -> Course:
        """Let parts follow the graph above, which plays what they are to do; those that run are ended."""
        running = [graph for graph in graphs if course.world.get(graph) is not None]
        course = self.end(course, dict.fromkeys(running, "the graph above plays what it is to do"))
        legs = tuple(self._leg(course.world, graph, Kind.FOLLOWS) for graph in graphs)
        return replace(course, legs=course.legs + legs)

    def _set_out(self, course: Course, chosen: Sequence[tuple[float, Leg]]) -> Course:
        """Let graphs go their ways, each with its chance."""
        legs = [leg for _, leg in chosen]
        arrived = {leg.graph: self._arrival(leg) for leg in legs}
        waiting = course.world.held(together(leg.takes for leg in legs))
        everything = {**dict(waiting.running), **arrived}
        world = World(tuple((graph, everything[graph]) for graph in self.names.graphs if graph in everything))
        course = replace(course, chance=course.chance * prod(chance for chance, _ in chosen))
        return replace(self._passed(course, legs, world), world=world)

    def _arrival(self, leg: Leg) -> Playing:
        if leg.graph == self.afresh:
            return Playing(leg.motion, Moment.BEGUN, held_s=0.0)
        return Playing(leg.motion, Moment.ARRIVED, leg.playing.motion, 0.0)

    def _passed(self, course: Course, legs: Sequence[Leg], world: World) -> Course:
        """Return a course after graphs have done something at the same time, and all others have waited for them."""
        takes, cost = together(leg.takes for leg in legs), sum(leg.cost for leg in legs)
        return replace(
            course,
            world=world.held(takes),
            takes=course.takes + takes,
            cost=course.cost + cost,
            legs=(*course.legs, *legs),
        )

    # --- one graph ---

    def _options(self, world: World, graph: str, candidates: tuple[str, ...]) -> list[tuple[float, Leg]]:
        """Return the ways into one of the candidates that may be taken; none if there is none."""
        leg = self._leg(world, graph, Kind.MOVES)
        return [
            (
                trip.chance,
                replace(leg, motion=trip.motion, takes=trip.takes, cost=trip.cost, on_the_spot=trip.on_the_spot),
            )
            for trip in self._trips(world, graph, self._choices(world, graph, candidates))
        ]

    def _trips(self, world: World, graph: str, choices: Sequence[tuple[str, ...]]) -> Sequence[Trip]:
        """Return the ways into the first of some choices that can be reached."""
        drives, playing = driver(world, graph, self.names)
        for choice in choices:
            trips = self.travel.soonest(graph, playing, choice, drives, graph == self.afresh)
            if trips:
                return trips
        if graph != self.afresh or not choices:
            return ()
        soonest = self.travel.soonest(graph, playing, choices[0], drives) or (Trip(choices[0][0], 1.0, NO_TIME, 0.0),)
        return [replace(self.travel.on_the_spot(graph, one.motion), chance=one.chance) for one in soonest]

    def _choices(self, world: World, graph: str, candidates: tuple[str, ...]) -> list[tuple[str, ...]]:
        """Return candidates in the order in which they are tried, together where the soonest is taken."""
        above = self._above(world, graph)
        if above is None:
            return [candidates]
        if above not in self.names.motion_set(graph):
            return []
        return [(motion,) for motion in by_similarity(graph, above, candidates, self.travel)]

    def _follows(self, world: World, graph: str, candidates: tuple[str, ...]) -> bool:
        """Return whether the graph above plays the candidate that would be taken."""
        above = self._above(world, graph)
        if above not in candidates or graph == self.afresh:
            return False
        drives, playing = driver(world, graph, self.names)
        for (motion,) in self._choices(world, graph, candidates):
            if motion == above:
                return True
            if self.travel.soonest(graph, playing, (motion,), drives):
                return False
        return False

    def _ended(self, world: World, graph: str, because: str) -> Leg:
        parent = self.names.parent(graph)
        assert parent is not None, "the whole body cannot be ended"
        drives, above = driver(world, parent, self.names)
        leg = self._leg(world, graph, Kind.ENDS)
        trip = self.travel.back(graph, leg.playing, drives, above)
        return replace(
            leg,
            motion=above.motion,
            takes=trip.takes,
            cost=trip.cost,
            on_the_spot=trip.on_the_spot,
            because=because,
        )

    def _leg(self, world: World, graph: str, kind: Kind) -> Leg:
        drives, playing = driver(world, graph, self.names)
        return Leg(graph, kind, playing.motion, playing, drives, self._above(world, graph))

    # --- small questions ---

    def _above(self, world: World, graph: str) -> str | None:
        parent = self.names.parent(graph)
        return None if parent is None else self._playing(world, parent).motion

    def _playing(self, world: World, graph: str) -> Playing:
        return driver(world, graph, self.names)[1]

    def _below(self, world: World, graphs: Collection[str]) -> list[str]:
        """Return the running graphs that lie below one of `graphs`."""
        below = set(self.names.below(graphs))
        return [graph for graph, _ in world.running if graph in below]

    def _reason(self, graph: str, changing: Iterable[str]) -> str:
        above = next(above for above in self.names.ancestors(graph) if above in changing)
        return f"`{above}` changes its motion"

    def _depth(self, graph: str) -> int:
        return len(self.names.ancestors(graph))


def by_similarity(graph: str, above: str, candidates: Iterable[str], travel: Travel) -> list[str]:
    """Return motions in the order in which they fit that of the graph above."""
    return sorted(candidates, key=lambda motion: travel.similarity(graph, above, motion))
