"""A character is asked random things; what it then plays is held against the rules of the language, frame by frame."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from itertools import islice, pairwise, takewhile
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mlmg_runtime.errors import PlayError
from mlmg_runtime.library import Library
from mlmg_runtime.motion_graph import MotionGraph, Position
from mlmg_runtime.playing.holding import stay
from mlmg_runtime.playing.likeness import Likeness
from mlmg_runtime.playing.performer import Performer
from mlmg_runtime.playing.returning import find_return
from mlmg_runtime.playing.timeline import Blend, Clip, Segment, Timeline

SEEDS = st.integers(0, 2**32 - 1)

Run = list[Segment]
Layers = list[tuple[str, list[str]]]
Soonest = Callable[..., Any]


# What a timeline says


def runs(timeline: Timeline, graph: str) -> list[Run]:
    """Return the stretches of time in which a graph runs on its own."""
    found: list[Run] = []
    for segment in timeline.tracks.get(graph, ()):
        goes_on = found and found[-1][-1].end == segment.begin and found[-1][-1].after is not None
        if goes_on:
            found[-1].append(segment)
        else:
            found.append([segment])
    return found


def place(segment: Segment, time: int) -> tuple[int, Position]:
    """Return the first time from `time` on at which a segment's graph is at a frame of a clip, and the frame."""
    if isinstance(segment, Clip) and segment.begin <= time < segment.end:
        return time, Position(segment.first.motion, segment.first.frame + time - segment.begin)
    if isinstance(segment, Blend) and time == segment.begin:
        return time, segment.source
    return segment.end, segment.after


def track_at(library: Library, timeline: Timeline, graph: str, time: int) -> tuple[MotionGraph, Segment]:
    """Return what drives a graph at a time: its own segment, or that of the graph above."""
    for name in (graph, *library.ancestors(graph)):
        for segment in timeline.tracks.get(name, ()):
            if segment.begin <= time < segment.end:
                return library.by_name[name], segment
    raise AssertionError(f"nothing plays on {graph} at {time}")


def shown(library: Library, timeline: Timeline, graph: str, time: int) -> tuple[str, int] | None:
    """Return the motion and frame that a graph shows at a time, by whatever drives it; None inside a blend."""
    driver, segment = track_at(library, timeline, graph, time)
    when, at = place(segment, time)
    return (driver.motions[at.motion], at.frame) if when == time else None


# What every timeline must be


def check_timeline(library: Library, performer: Performer) -> None:
    timeline = performer.timeline()
    root = library.root.name
    assert list(timeline.tracks) == [graph for graph in library.graphs if graph in timeline.tracks]
    (whole,) = runs(timeline, root) or [[]]
    if timeline.n_frames:
        assert whole[0].begin == 0
        assert whole[-1].end >= timeline.n_frames
    for graph in timeline.tracks:
        for run in runs(timeline, graph):
            check_run(library.by_name[graph], run)
            if graph != root:
                check_part(library, performer, timeline, graph, run)


def check_run(graph: MotionGraph, run: Run) -> None:
    """Check that a run is one walk: no gap, clips go on where transitions arrive, transitions are the graph's."""
    for before, after in pairwise(run):
        assert before.end == after.begin
        assert before.after == (after.first if isinstance(after, Clip) else after.source)
    for segment in run:
        assert segment.begin < segment.end
        if isinstance(segment, Clip):
            assert segment.after.frame <= graph.n_frames[segment.first.motion]
            assert 0.8 <= segment.speed <= 1.2
        else:
            assert segment.end - segment.begin == graph.window
            if segment.transition is not None:
                assert segment.transition in graph.edges
                assert segment.source == segment.transition[:2]
                assert segment.target == segment.transition[2:4]
            elif segment.target is not None:
                assert segment.source.motion == segment.target.motion


def check_part(library: Library, performer: Performer, timeline: Timeline, graph: str, run: Run) -> None:
    """Check that a part leaves and meets its parent in the very frame, and that its parent's motions are on it."""
    own, parent = library.by_name[graph], library.parent(graph)
    begin, end = run[0].begin, run[-1].end
    first = run[0].first if isinstance(run[0], Clip) else run[0].source
    assert shown(library, timeline, parent, begin) == (own.motions[first.motion], first.frame)
    for time in range(begin, min(end, timeline.n_frames)):
        driver, segment = track_at(library, timeline, parent, time)
        for motion in motions_of(segment):
            assert driver.motions[motion] in own.index
    goes_on = performer.runs(graph) and run[-1] == timeline.tracks[graph][-1]
    if not goes_on and run[-1].after is not None and end < timeline.n_frames:
        motion, frame = run[-1].after
        assert shown(library, timeline, parent, end) == (own.motions[motion], frame)


def motions_of(segment: Segment) -> set[int]:
    places = (segment.first,) if isinstance(segment, Clip) else (segment.source, segment.target)
    return {at.motion for at in places if at is not None}


@settings(max_examples=4 * settings().max_examples)
@given(seed=SEEDS)
def test_whatever_is_asked_the_timeline_obeys_the_graphs_and_both_rules(
    seed: int, moves, ask, small_library: Library
) -> None:
    performer = Performer(small_library, small_library.root.motions[seed % 4])
    for move in moves(seed):
        before = performer.now
        call, what = ask(performer, move)
        if call == "hold":
            assert performer.now == before + what
        elif call == "bring":
            assert all(performer.motion(graph) in candidates for graph, candidates in what)
        else:
            assert not performer.runs(what)
    check_timeline(small_library, performer)
    performer.hold(100)
    check_timeline(small_library, performer)


# What a character should do, slowly


class Model:
    """What the rules say that a performer does: which motions it takes, and when each part arrives or comes back.

    Where a graph is at a time up to which all is as it should be, is read from what the performer played.
    """

    def __init__(self, performer: Performer, soonest: Soonest) -> None:
        """Remember how things are before something is asked."""
        self.performer, self.soonest = performer, soonest
        self.library = performer.library
        self.home = {graph: performer.motion(graph) for graph in self.library.graphs if performer.runs(graph)}
        self.now = performer.now
        self.back: list[tuple[str, int]] = []

    def check(self) -> None:
        """Compare with what the performer has done."""
        performer = self.performer
        assert performer.now == self.now
        for graph in self.library.graphs:
            assert performer.runs(graph) == (graph in self.home)
            assert performer.motion(graph) == self.home[self.driver(graph)]
        for graph, end in self.back:
            assert end in [run[-1].end for run in runs(performer.timeline(), graph)]

    def driver(self, graph: str) -> str:
        return next(g for g in (graph, *self.library.ancestors(graph)) if g in self.home)

    def below(self, graph: str) -> set[str]:
        return {g for g in self.home if graph in self.library.ancestors(g)}

    def where(self, graph: str, time: int) -> tuple[int, Position]:
        """Return where a graph's own track is, at or after a time, and when."""
        track = self.performer.timeline().tracks[graph]
        return place([segment for segment in track if segment.begin <= time][-1], time)

    def above(self, graph: str) -> str:
        """Return the motion that the graph above a part plays."""
        return self.home[self.driver(self.library.parent(graph))]

    def future(
        self, graph: str, setting_out: Collection[str] = (), since: tuple[int, Position] | None = None
    ) -> Iterator[tuple[int, Position]]:
        """Yield, frame by frame, when and where on `graph` the graph above it will be if it stays in its motion.

        It minds the parts that run below it, and those that are setting out. A way round that these cannot mind is
        ended first. `since` is where and from when on the graph above is, if it goes round another way before.
        """
        above = self.driver(self.library.parent(graph))
        own, driving = self.library.by_name[graph], self.library.by_name[above]
        home = driving.index[self.home[above]]
        running, joining = self.below(above), {g for g in setting_out if above in self.library.ancestors(g)}
        when, at = self.where(above, self.now) if since is None else since
        allowed = self.allowed(above, running | joining)
        if at.motion != home and self.soonest(driving, at, [home], allowed) is None:
            back = self.soonest(driving, at, [home], self.allowed(above, running))
            when, at = when + back.n_frames, back.transitions[-1].arrival
        for segment in stay(Likeness(self.library), driving, home, at, when, allowed):
            for moment in range(segment.begin, segment.end if isinstance(segment, Clip) else segment.begin + 1):
                _, there = place(segment, moment)
                name = driving.motions[there.motion]
                if name in own.index:
                    yield moment, Position(own.index[name], there.frame)

    def allowed(self, graph: str, parts: set[str]) -> list[int]:
        """Return the motions of a graph that some parts are on, too."""
        own = self.library.by_name[graph]
        on = [self.library.by_name[part].index for part in parts]
        return [own.index[motion] for motion in own.motions if all(motion in index for index in on)]

    # What can be asked

    def bring(self, layers: Layers) -> None:
        named = dict(layers)
        self.end({g for g in self.home if g not in named and not named.keys().isdisjoint(self.library.ancestors(g))})
        for depth in (0, 1, 2):
            level = [g for g in named if len(self.library.ancestors(g)) == depth]
            self.change({g: named[g] for g in level if self.home[self.driver(g)] not in named[g]})

    def end(self, graphs: set[str]) -> None:
        """End parts and those below them, lowest first, those of one level at the same time."""
        ended = {g for g in self.home if not graphs.isdisjoint({g, *self.library.ancestors(g)})}
        for depth in (2, 1):
            level = [g for g in ended if len(self.library.ancestors(g)) == depth]
            back = [(graph, self.comes_back(graph)) for graph in level]
            self.back += back
            self.now = max([self.now, *(end for _, end in back)])
            for graph in level:
                del self.home[graph]

    # How it is done

    def comes_back(self, graph: str) -> int:
        own = self.library.by_name[graph]
        deadline = self.now + round(2.0 * self.library.frame_rate)
        when, at = self.where(graph, self.now)
        future = takewhile(lambda moment: moment[0] <= deadline, self.future(graph))
        way = find_return(own, at, when, [Clip(time, time, there, 0) for time, there in future], deadline)
        if way is None:
            return self.released(graph, when, deadline)
        return way[-1].end if way else when

    def released(self, graph: str, when: int, deadline: int) -> int:
        """Return when a part has been blended onto the graph above; when that begins is for `test_releasing`."""
        run = next(run for run in runs(self.performer.timeline(), graph) if run[0].begin <= when <= run[-1].begin)
        assert isinstance(run[-1], Blend)
        assert run[-1].target is None
        assert when <= run[-1].begin <= deadline
        return run[-1].end

    def change(self, level: dict[str, list[str]]) -> None:
        """Bring siblings to their candidates: all return that have to, then all others set out in the same frame."""
        self.end({below for graph in level for below in self.below(graph)})
        targets = {graph: self.targets(graph, candidates) for graph, candidates in level.items()}
        returning = {g for g in level if self.library.parent(g) and targets[g] == [self.above(g)]}
        self.end(returning)
        setting_out = level.keys() - returning
        since = self.rounds({graph: targets[graph] for graph in setting_out})
        walks = {graph: self.walk(graph, targets[graph], setting_out, since.get(graph)) for graph in setting_out}
        for graph, walk in walks.items():
            own = self.library.by_name[graph]
            first = next(self.future(graph, setting_out, since.get(graph)))[0] if walk is None else 0
            # Where there is no walk, it is blended into the beginning.
            arrives, self.home[graph] = walk or (first + own.window, targets[graph][0])
            self.now = max(self.now, arrives)

    def rounds(self, targets: dict[str, list[str]]) -> dict[str, tuple[int, Position]]:
        """Return, by part, where and from when on a graph above is that first goes round another way.

        It does where one of the parts that leave it finds no walk. Of all frames of its motion that it could come to
        by a transition, the one is taken from which all of them have arrived soonest.
        """
        since: dict[str, tuple[int, Position]] = {}
        for above in {self.driver(graph) for graph in targets.keys() - self.home.keys()}:
            parts = [graph for graph in targets.keys() - self.home.keys() if self.driver(graph) == above]
            if all(self.walk(graph, targets[graph], set(targets)) for graph in parts):
                continue
            found = []
            for then in self.returns(above, set(targets)):
                walks = [self.walk(graph, targets[graph], set(targets), then) for graph in parts]
                if all(walks):
                    found.append((max(arrives for arrives, _ in walks), then))
            since |= dict.fromkeys(parts, min(found)[1]) if found else {}
        return since

    def returns(self, above: str, setting_out: set[str]) -> list[tuple[int, Position]]:
        """Return to which frames of its motion a graph can come by a transition, and when at the earliest."""
        own = self.library.by_name[above]
        home = own.index[self.home[above]]
        joining = {g for g in setting_out if above in self.library.ancestors(g)}
        allowed = {home, *self.allowed(above, self.below(above) | joining)}
        earliest: dict[Position, int] = {}
        waiting = [self.where(above, self.now)]
        while waiting:
            when, at = waiting.pop()
            for edge in own.edges:
                leaves = edge.src_motion == at.motion and edge.src_frame >= at.frame
                then = when + edge.src_frame - at.frame + own.window
                if leaves and edge.dst_motion in allowed and then < earliest.get(edge.arrival, then + 1):
                    earliest[edge.arrival] = then
                    waiting.append((then, edge.arrival))
        return [(when, at) for at, when in earliest.items() if at.motion == home]

    def targets(self, graph: str, candidates: list[str]) -> list[str]:
        """Return the candidates of the root, or that of a part that fits the rest of the body best."""
        if graph == self.library.root.name:
            return candidates
        own = self.library.by_name[graph]
        fits = [own.oms[own.index[self.above(graph)], own.index[motion]] for motion in candidates]
        return [candidates[fits.index(min(fits))]]

    def walk(
        self, graph: str, targets: list[str], setting_out: set[str], since: tuple[int, Position] | None = None
    ) -> tuple[int, str] | None:
        """Return when a graph arrives in which motion; None if it cannot."""
        own = self.library.by_name[graph]
        if graph in self.home:
            starts = dict([self.where(graph, self.now)])
        else:
            starts = dict(islice(self.future(graph, setting_out, since), 400))
        first = min(starts)
        later = {time - first: at for time, at in starts.items()}
        walk = self.soonest(own, starts[first], [own.index[motion] for motion in targets], later=later)
        return None if walk is None else (first + walk.n_frames, targets[walk.target])


@settings(max_examples=4 * settings().max_examples)
@given(seed=SEEDS)
def test_everything_asked_is_done_as_the_rules_say_and_as_soon_as_can_be(
    seed: int, moves, ask, soonest, small_library: Library
) -> None:
    performer = Performer(small_library, small_library.root.motions[seed % 4])
    for move in moves(seed):
        model = Model(performer, soonest)
        call, what = ask(performer, move)
        if call == "bring":
            model.bring(what)
        elif call == "end":
            model.end({what})
        else:
            model.now += what
        model.check()


@settings(max_examples=2 * settings().max_examples)
@given(seed=SEEDS)
def test_where_no_part_runs_levels_at_once_are_levels_one_after_the_other(
    seed: int, moves, ask, small_library: Library
) -> None:
    start = small_library.root.motions[seed % 4]
    at_once, one_by_one = Performer(small_library, start), Performer(small_library, start)
    call, what = ask(at_once, moves(seed)[0])
    if call == "bring":
        for depth in (0, 1, 2):
            one_by_one.bring([layer for layer in what if len(small_library.ancestors(layer[0])) == depth])
        assert at_once.timeline() == one_by_one.timeline()


@given(seed=SEEDS)
def test_the_same_things_asked_again_give_the_same_timeline(seed: int, moves, ask, small_library: Library) -> None:
    start = small_library.root.motions[seed % 4]
    first, second = Performer(small_library, start), Performer(small_library, start)
    for move in moves(seed):
        assert ask(first, move) == ask(second, move)
    assert first.timeline() == second.timeline()


# Single things, told


def test_before_anything_is_asked_nothing_has_been_played(small_library: Library) -> None:
    performer = Performer(small_library, "Sway")
    assert performer.timeline() == Timeline(0, {})
    assert performer.motion("Left-Arm") == "Sway"


def test_a_character_starts_in_the_first_frame_of_its_start(small_library: Library) -> None:
    performer = Performer(small_library, "Sway")
    performer.hold(1)
    (first,) = performer.timeline().tracks["Full-Body"]
    assert first == Clip(0, 1, Position(2, 0), 1)


def test_holding_twice_is_holding_for_the_sum(small_library: Library) -> None:
    once, twice = Performer(small_library, "Stroll"), Performer(small_library, "Stroll")
    once.hold(333)
    for n_frames in (100, 1, 32, 200):
        twice.hold(n_frames)
    assert once.timeline() == twice.timeline()


def test_a_motion_that_plays_already_is_satisfied_as_it_is(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.hold(40)
    before = performer.timeline()
    performer.bring([("Full-Body", ["Sway", "Stand"]), ("Upper-Body", ["Stand", "Stroll"]), ("Left-Arm", ["Stand"])])
    assert performer.timeline() == before


def test_a_part_that_its_parent_drives_with_a_candidate_is_satisfied_as_it_is(small_library: Library) -> None:
    performer = Performer(small_library, "Stroll")
    performer.hold(10)
    performer.bring([("Upper-Body", ["Stroll"])])
    assert not performer.runs("Upper-Body")
    assert performer.now == 10


def test_a_part_brought_to_what_its_parent_plays_is_ended(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Left-Arm", ["Wave"])])
    assert performer.runs("Left-Arm")
    performer.bring([("Left-Arm", ["Stand"])])
    assert not performer.runs("Left-Arm")
    assert performer.motion("Left-Arm") == "Stand"


def test_going_from_one_upper_motion_to_another_does_not_end_the_upper_body(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Full-Body", ["Stand"]), ("Upper-Body", ["Wave"])])
    performer.hold(20)
    performer.bring([("Full-Body", ["Stand"]), ("Upper-Body", ["Stroll"])])
    performer.hold(20)
    assert len(runs(performer.timeline(), "Upper-Body")) == 1


def test_siblings_run_at_the_same_time(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Left-Arm", ["Wave"]), ("Right-Arm", ["Reach"])])
    assert performer.runs("Left-Arm")
    assert performer.runs("Right-Arm")
    performer.bring([("Right-Arm", ["Wave"])])
    assert performer.motion("Left-Arm") == performer.motion("Right-Arm") == "Wave"


def test_siblings_set_out_in_the_same_frame_and_have_arrived_when_the_last_of_them_has(rewired) -> None:
    library = rewired(
        {
            "Full-Body": [("Stand", 110, "Stand", 20)],
            "Left-Arm": [("Stand", 10, "Wave", 20)],
            "Right-Arm": [("Stand", 12, "Reach", 30)],
        }
    )
    performer = Performer(library, "Stand")
    performer.bring([("Left-Arm", ["Wave"]), ("Right-Arm", ["Reach"])])
    tracks = performer.timeline().tracks
    assert [(s.begin, s.end) for s in tracks["Left-Arm"][:2]] == [(0, 10), (10, 16)]
    assert [(s.begin, s.end) for s in tracks["Right-Arm"]] == [(0, 12), (12, 18)]
    assert performer.now == 18


@pytest.mark.parametrize(
    ("layers", "passed"),
    [
        ([("Right-Arm", ["Reach"])], {"Stand", "Stroll"}),
        ([("Left-Arm", ["Wave"]), ("Right-Arm", ["Reach"])], {"Stand", "Reach"}),
        ([("Right-Arm", ["Reach"]), ("Left-Arm", ["Wave"])], {"Stand", "Reach"}),
    ],
)
def test_the_body_passes_only_motions_that_all_siblings_which_set_out_are_on(
    rewired, layers: Layers, passed: set[str]
) -> None:
    by_stroll = [("Stand", 90, "Stroll", 20), ("Stroll", 30, "Stand", 8)]
    by_reach = [("Stand", 90, "Reach", 20), ("Reach", 60, "Stand", 8)]
    library = rewired(
        {
            "Full-Body": by_stroll + by_reach,
            "Left-Arm": [("Stand", 20, "Wave", 20)],
            "Right-Arm": [("Stand", 20, "Reach", 20)],
        }
    )
    performer = Performer(library, "Stand")
    performer.hold(50)
    performer.bring(layers)
    root = library.root
    track = performer.timeline().tracks["Full-Body"]
    assert {root.motions[segment.first.motion] for segment in track if isinstance(segment, Clip)} == passed


def test_a_sibling_that_is_ended_has_come_back_before_the_others_set_out(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Left-Arm", ["Wave"])])
    performer.bring([("Right-Arm", ["Reach"]), ("Left-Arm", ["Stand"])])
    (left,), (right,) = (runs(performer.timeline(), graph) for graph in ("Left-Arm", "Right-Arm"))
    assert left[-1].end <= right[0].begin
    assert not performer.runs("Left-Arm")


def test_a_part_leaves_no_way_round_on_which_it_could_not_stay_before_it_has_ended(rewired) -> None:
    # Sway is not on Upper-Body, and the only way from Stroll back to Stand passes it.
    way_round = [("Stand", 60, "Stroll", 20), ("Stroll", 40, "Sway", 20), ("Sway", 40, "Stand", 8)]
    library = rewired({"Full-Body": way_round, "Upper-Body": [("Stand", 50, "Wave", 20)]})
    performer = Performer(library, "Stand")
    performer.hold(80)
    performer.bring([("Upper-Body", ["Wave"])])
    # From frame 33 of Stroll it is 7 frames to Sway, 19 in it, 41 in Stand, and three transitions.
    assert performer.now == 80 + 7 + 8 + 19 + 8 + 41 + 8
    assert performer.timeline().tracks["Upper-Body"][0].first == Position(0, 9)
    check_timeline(library, performer)


def test_a_part_leaves_on_a_way_round_that_it_can_stay_on(rewired) -> None:
    way_round = [("Stand", 60, "Stroll", 20), ("Stroll", 40, "Stand", 8)]
    library = rewired({"Full-Body": way_round, "Upper-Body": [("Stroll", 35, "Wave", 20)]})
    performer = Performer(library, "Stand")
    performer.hold(80)
    performer.bring([("Upper-Body", ["Wave"])])
    assert performer.now == 80 + 2 + 8


# The body loops from frame 100 of Stand to frame 10, where it is at 108; there the part can leave and be there at 116.
@pytest.mark.parametrize(("leaves", "sets_out", "arrives"), [(109, 108, 116), (108, 50, 116), (107, 50, 115)])
def test_a_part_sets_out_later_where_it_then_arrives_sooner(rewired, leaves: int, sets_out: int, arrives: int) -> None:
    library = rewired(
        {
            "Full-Body": [("Stand", 100, "Stand", 9)],
            "Upper-Body": [("Stand", 10, "Wave", 20), ("Stand", leaves, "Wave", 20)],
        }
    )
    performer = Performer(library, "Stand")
    performer.hold(50)
    performer.bring([("Upper-Body", ["Wave"])])
    assert performer.timeline().tracks["Upper-Body"][0].begin == sets_out
    assert performer.now == arrives


# Past frame 60 of Stand the upper body cannot leave it, and the body loops from 100 to 90.
LATE_LOOP = [("Stand", 100, "Stand", 90)]


@pytest.mark.parametrize(
    ("others", "arrives"),
    [
        # From frame 91, where it is at 108, it is 4 frames to 95; the part leaves from 60 after another 39.
        ([("Stand", 95, "Stand", 20)], 108 + 4 + 8 + 39 + 8),
        ([("Stand", 95, "Stand", 20), ("Stand", 97, "Stroll", 20), ("Stroll", 21, "Stand", 59)], 108 + 6 + 8 + 8 + 8),
        # Sway is not on the upper body.
        ([("Stand", 95, "Stand", 20), ("Stand", 97, "Sway", 20), ("Sway", 21, "Stand", 59)], 108 + 4 + 8 + 39 + 8),
        # The body would be back sooner, the part arrive later.
        ([("Stand", 95, "Stand", 20), ("Stand", 91, "Stand", 9)], 108 + 4 + 8 + 39 + 8),
        # Only after another loop can the body go that way.
        ([("Stand", 91, "Stand", 89), ("Stand", 90, "Stand", 20)], 108 + 8 + 8 + 39 + 8),
        # Where no way leads there, the part is blended into the beginning.
        ([], 108 + 8),
        ([("Stand", 90, "Stand", 20)], 108 + 8),
    ],
)
def test_where_a_part_could_nowhere_leave_the_body_goes_round_another_way(
    rewired, soonest, others: list[tuple[str, int, str, int]], arrives: int
) -> None:
    library = rewired({"Full-Body": LATE_LOOP + others, "Upper-Body": [("Stand", 60, "Wave", 20)]})
    performer = Performer(library, "Stand")
    performer.hold(104)
    model = Model(performer, soonest)
    performer.bring([("Upper-Body", ["Wave"])])
    model.bring([("Upper-Body", ["Wave"])])
    model.check()
    assert performer.now == arrives
    check_timeline_of_passes(library, performer)


def test_the_way_that_a_body_goes_round_is_one_that_all_who_set_out_can_leave(rewired) -> None:
    library = rewired(
        {
            "Full-Body": [*LATE_LOOP, ("Stand", 95, "Stand", 49), ("Stand", 97, "Stand", 20)],
            "Left-Arm": [("Stand", 60, "Wave", 20)],
            "Right-Arm": [("Stand", 40, "Reach", 20), ("Reach", 30, "Stand", 20)],
        }
    )
    alone, both = Performer(library, "Stand"), Performer(library, "Stand")
    for performer in (alone, both):
        performer.hold(104)
    alone.bring([("Left-Arm", ["Wave"])])
    assert alone.now == 108 + 4 + 8 + 10 + 8 - 2
    both.bring([("Left-Arm", ["Wave"]), ("Right-Arm", ["Reach"])])
    assert both.now == 108 + 6 + 8 + 39 + 6
    tracks = both.timeline().tracks
    assert tracks["Right-Arm"][0].begin == tracks["Left-Arm"][0].begin == 108 + 6 + 8


def test_a_command_ends_the_parts_below_it_that_it_does_not_name(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Left-Arm", ["Wave"]), ("Right-Arm", ["Reach"])])
    performer.bring([("Full-Body", ["Stand"]), ("Right-Arm", ["Reach"])])
    assert not performer.runs("Left-Arm")
    assert performer.runs("Right-Arm")
    performer.bring([("Left-Arm", ["Wave"])])
    assert performer.runs("Right-Arm")


def test_before_a_part_is_ended_those_below_it_are_though_they_are_named(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Upper-Body", ["Wave"]), ("Left-Arm", ["Reach"])])
    performer.bring([("Full-Body", ["Stand"]), ("Left-Arm", ["Reach"])])
    assert not performer.runs("Upper-Body")
    assert performer.motion("Left-Arm") == "Reach"
    arm, (upper,) = runs(performer.timeline(), "Left-Arm"), runs(performer.timeline(), "Upper-Body")
    assert arm[0][-1].end <= upper[-1].end <= arm[1][0].begin


# The part is brought to Wave in frame 18. On its way back it is ahead of the whole body, and plays as slowly as it may:
# clips of 18 and 24 frames in 22 and 30, which takes two seconds; or else of 19 and 24 frames in 23 and 30.
@pytest.mark.parametrize(("leaves", "enters", "ends", "on_the_spot"), [(39, 53, 78, False), (40, 54, 26, True)])
def test_a_part_comes_back_on_a_way_of_two_seconds_but_not_on_a_longer_one(
    rewired, leaves: int, enters: int, ends: int, on_the_spot: bool
) -> None:
    library = rewired(
        {
            "Full-Body": [("Stand", 110, "Stand", 20)],
            "Upper-Body": [("Stand", 10, "Wave", 20), ("Wave", leaves, "Stand", enters)],
        }
    )
    performer = Performer(library, "Stand")
    performer.bring([("Upper-Body", ["Wave"])])
    assert performer.now == 18
    performer.end("Upper-Body")
    assert performer.now == ends
    assert (performer.timeline().tracks["Upper-Body"][-1].after is None) == on_the_spot


def test_the_two_seconds_of_a_way_back_count_from_when_the_part_is_to_end(rewired) -> None:
    library = rewired(
        {
            "Full-Body": [("Stand", 110, "Stand", 20)],
            "Upper-Body": [
                ("Stand", 10, "Wave", 20),
                ("Wave", 24, "Wave", 20),
                ("Wave", 39, "Stand", 44),
            ],
        }
    )
    performer = Performer(library, "Stand")
    performer.bring([("Upper-Body", ["Wave"])])
    performer.hold(5)
    performer.end("Upper-Body")
    # From 29 on, when its loop has ended, it could be at 45 of Stand at 52, and meet the body at 87.
    assert performer.timeline().tracks["Upper-Body"][-1].after is None


def test_a_part_may_come_back_in_the_last_moment_to_a_clip_that_just_begins(rewired) -> None:
    library = rewired(
        {
            "Full-Body": [("Stand", 70, "Stand", 20)],
            "Upper-Body": [("Stand", 10, "Wave", 20), ("Wave", 60, "Stand", 15)],
        }
    )
    performer = Performer(library, "Stand")
    performer.bring([("Upper-Body", ["Wave"])])
    performer.end("Upper-Body")
    assert performer.now == 18 + 60
    assert performer.timeline().tracks["Upper-Body"][-1].after == Position(0, 21)


def test_each_time_that_a_part_ran_is_in_the_timeline(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    begins = []
    for _ in range(3):
        begins.append(performer.now)
        performer.bring([("Left-Arm", ["Wave"])])
        performer.end("Left-Arm")
        performer.hold(5)
    found = runs(performer.timeline(), "Left-Arm")
    assert [run[0].begin for run in found] == begins


def test_rule_1_forbids_a_part_to_leave_a_motion_that_is_not_on_it(small_library: Library) -> None:
    performer = Performer(small_library, "Sway")
    with pytest.raises(PlayError, match=r"^Upper-Body cannot leave Sway, which is not on it \(rule 1\)$"):
        performer.bring([("Upper-Body", ["Stroll"])])


def test_a_motion_that_no_walk_reaches_is_told_by_name(small_library: Library) -> None:
    root = small_library.root
    cut_off = root.transitions[root.transitions["dst_motion"] != root.index["Reach"]]
    hops = root.hops.copy()
    hops[:, root.index["Reach"]] = -1
    graphs = {**small_library.by_name, root.name: replace(root, transitions=cut_off, hops=hops)}
    performer = Performer(replace(small_library, by_name=graphs), "Stand")
    with pytest.raises(PlayError, match=r"^no walk on Full-Body leads from Stand to Reach; see `mlmg info`"):
        performer.bring([("Full-Body", ["Reach"])])


def test_a_part_that_cannot_reach_a_motion_from_wherever_it_leaves_is_told_so(rewired) -> None:
    library = rewired({"Upper-Body": [("Stand", 10, "Stroll", 20), ("Wave", 10, "Stand", 20)]})
    with pytest.raises(PlayError, match=r"^no walk on Upper-Body leads from Stand to Wave; see `mlmg info`"):
        Performer(library, "Stand").bring([("Upper-Body", ["Wave"])])


def test_what_was_refused_is_not_played(rewired) -> None:
    # When it is asked, the body is about to leave Stroll for Sway, which it has to pass before a part can leave it.
    way_round = [("Stand", 60, "Stroll", 20), ("Stroll", 40, "Sway", 20), ("Sway", 40, "Stand", 8)]
    library = rewired({"Full-Body": way_round, "Upper-Body": []})
    performer = Performer(library, "Stand")
    performer.hold(60 + 8 + 19)
    before = performer.timeline()
    with pytest.raises(PlayError):
        performer.bring([("Upper-Body", ["Wave"])])
    assert performer.timeline() == before


def test_a_motion_is_played_out_after_a_way_round_has_come_back_to_it(rewired) -> None:
    library = rewired({"Full-Body": [("Stand", 60, "Stroll", 20), ("Stroll", 40, "Stand", 8)]})
    performer = Performer(library, "Stand")
    performer.hold(80)
    performer.play_out("Full-Body")
    assert performer.now == 60 + 8 + 19 + 8 + 111
    assert performer.timeline().tracks["Full-Body"][-1].after == Position(0, 120)


@pytest.mark.parametrize("start", ["Stand", "Stroll", "Sway", "Reach"])
@pytest.mark.parametrize("n_frames", [0, 30, 200, 301])
def test_played_out_a_motion_ends_with_its_clips_last_frame(small_library: Library, start: str, n_frames: int) -> None:
    performer = Performer(small_library, start)
    performer.hold(n_frames)
    performer.play_out("Full-Body")
    last = performer.timeline().tracks["Full-Body"][-1]
    assert isinstance(last, Clip)
    assert last.end == performer.now
    assert small_library.root.motions[last.first.motion] == start
    assert last.after.frame == small_library.n_frames(start)
    check_timeline(small_library, performer)


def test_while_a_part_plays_out_everything_else_goes_on(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Upper-Body", ["Wave"]), ("Left-Arm", ["Reach"])])
    performer.play_out("Upper-Body")
    timeline = performer.timeline()
    assert timeline.tracks["Upper-Body"][-1].after == Position(3, small_library.n_frames("Wave"))
    for graph in ("Full-Body", "Left-Arm"):
        assert timeline.tracks[graph][-1].end >= performer.now


def test_what_drives_a_part_that_does_not_run_is_played_out(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.play_out("Left-Arm")
    assert performer.now == small_library.n_frames("Stand")


def last_exit(library: Library, graph: str, motion: str) -> int:
    own = library.by_name[graph]
    return max(edge.src_frame for edge in own.edges if edge.src_motion == own.index[motion])


@pytest.mark.parametrize("motion", ["Stand", "Stroll", "Sway", "Reach"])
@pytest.mark.parametrize("n_frames", [0, 7, 130])
def test_brought_to_its_start_a_motion_is_entered_at_its_first_frames(
    small_library: Library, motion: str, n_frames: int
) -> None:
    performer = Performer(small_library, "Stroll")
    performer.hold(n_frames)
    performer.bring([("Full-Body", [motion])], from_start=True)
    assert performer.motion("Full-Body") == motion
    if motion == "Stroll" and n_frames <= small_library.root.window:
        assert performer.now == n_frames
        return
    root = small_library.root
    last = performer.timeline().tracks["Full-Body"][-1]
    assert isinstance(last, Blend)
    assert last.target == Position(root.index[motion], root.window - 1)
    performer.play_pass("Full-Body")
    passed = performer.timeline().tracks["Full-Body"][-1]
    assert passed.after == Position(root.index[motion], last_exit(small_library, "Full-Body", motion))
    check_timeline_of_passes(small_library, performer)


def check_timeline_of_passes(library: Library, performer: Performer) -> None:
    """Check that what plays is one walk, but for blends on the spot into where a motion begins."""
    for graph in performer.timeline().tracks:
        for run in runs(performer.timeline(), graph):
            for before, after in pairwise(run):
                assert before.end == after.begin
                assert before.after == (after.first if isinstance(after, Clip) else after.source)


def test_where_a_path_leads_to_where_a_motion_begins_it_is_taken(small_library: Library) -> None:
    root, target = small_library.root, small_library.root.index["Reach"]
    entry = root.transitions[root.transitions["dst_motion"] == target][:1].copy()
    entry["dst_frame"] = root.window - 1
    transitions = np.sort(
        np.concatenate((root.transitions, entry)), order=["src_motion", "src_frame", "dst_motion", "dst_frame"]
    )
    graphs = {**small_library.by_name, root.name: replace(root, transitions=transitions)}
    performer = Performer(replace(small_library, by_name=graphs), "Stand")
    performer.bring([("Full-Body", ["Reach"])], from_start=True)
    last = performer.timeline().tracks["Full-Body"][-1]
    assert isinstance(last, Blend)
    assert last.transition is not None
    assert last.target == Position(target, root.window - 1)


def test_a_motion_that_plays_already_begins_again(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Full-Body", ["Stand"])], from_start=True)
    assert performer.now == 0
    performer.play_pass("Full-Body")
    first = performer.now
    performer.bring([("Full-Body", ["Stand"])], from_start=True)
    performer.play_pass("Full-Body")
    assert performer.now > first


def test_a_part_begins_its_motion_though_the_body_plays_that_too(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.hold(30)
    performer.bring([("Upper-Body", ["Stand"])], from_start=True)
    assert performer.runs("Upper-Body")
    performer.play_pass("Upper-Body")
    upper = small_library.by_name["Upper-Body"]
    passed = performer.timeline().tracks["Upper-Body"][-1]
    assert passed.after == Position(upper.index["Stand"], last_exit(small_library, "Upper-Body", "Stand"))


def begins_again(library: Library, performer: Performer, graph: str) -> bool:
    """Return whether a graph enters a motion at its first frames."""
    blends = [segment for segment in performer.timeline().tracks[graph] if isinstance(segment, Blend)]
    return any(blend.target.frame == library.by_name[graph].window - 1 for blend in blends)


def test_below_a_motion_that_begins_again_parts_are_brought_as_usual(small_library: Library) -> None:
    performer = Performer(small_library, "Stroll")
    performer.bring([("Full-Body", ["Stand"]), ("Upper-Body", ["Wave"])], from_start=True)
    assert begins_again(small_library, performer, "Full-Body")
    assert not begins_again(small_library, performer, "Upper-Body")
    performer.play_pass("Full-Body")
    assert (performer.motion("Full-Body"), performer.motion("Upper-Body")) == ("Stand", "Wave")


def test_a_part_begins_its_motion_though_a_sibling_has_to_come_back_first(small_library: Library) -> None:
    performer = Performer(small_library, "Stand")
    performer.bring([("Left-Arm", ["Wave"])])
    performer.bring([("Right-Arm", ["Reach"]), ("Left-Arm", ["Stand"])], from_start=True)
    assert not performer.runs("Left-Arm")
    assert begins_again(small_library, performer, "Right-Arm")


@pytest.mark.parametrize(
    ("transitions", "taken"),
    [
        ([("Stand", 40, "Stroll", 20), ("Stand", 30, "Reach", 20)], "Reach"),
        ([("Stand", 30, "Stroll", 20), ("Stand", 40, "Reach", 20)], "Stroll"),
        ([("Stand", 40, "Sway", 20)], "Reach"),
    ],
)
def test_of_motions_whose_beginning_no_walk_reaches_the_one_reached_soonest_or_the_first_begins(
    rewired, transitions: list[tuple[str, int, str, int]], taken: str
) -> None:
    library = rewired({"Full-Body": transitions})
    performer = Performer(library, "Stand")
    performer.hold(10)
    performer.bring([("Full-Body", ["Reach", "Stroll"])], from_start=True)
    assert performer.motion("Full-Body") == taken
    # It is begun on the spot.
    assert performer.now == 10 + 8
    assert begins_again(library, performer, "Full-Body")


def test_a_pass_of_a_motion_is_played_after_a_way_round_has_come_back_to_it(rewired) -> None:
    library = rewired({"Full-Body": [("Stand", 60, "Stroll", 20), ("Stroll", 40, "Stand", 8)]})
    performer = Performer(library, "Stand")
    performer.hold(80)
    performer.play_pass("Full-Body")
    assert performer.now == 60 + 8 + 19 + 8 + 51
    assert performer.timeline().tracks["Full-Body"][-1].after == Position(0, 60)
    # There it is already.
    performer.play_pass("Full-Body")
    assert performer.now == 60 + 8 + 19 + 8 + 51


@pytest.mark.parametrize(("n_frames", "begins_again"), [(0, False), (1, False), (60, True)])
def test_a_motion_that_has_just_begun_need_not_begin_again(
    small_library: Library, n_frames: int, begins_again: bool
) -> None:
    performer = Performer(small_library, "Stand")
    performer.hold(n_frames)
    performer.bring([("Full-Body", ["Stand"])], from_start=True)
    assert (performer.now > n_frames) == begins_again
