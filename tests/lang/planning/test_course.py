"""What a command does in a known world: which graphs move, follow, stay or are ended, in what time."""

from __future__ import annotations

from typing import Any

import pytest

from mlmg_lang.front_end import analyse
from mlmg_lang.planning.course import Course, World, bring, driver, end_part
from mlmg_lang.planning.estimate import Moment, Playing
from mlmg_lang.planning.names import Names
from mlmg_lang.planning.resolved import Command
from mlmg_lang.source import Source


def world(*running: tuple[str, str]) -> World:
    return World(tuple((graph, Playing(motion)) for graph, motion in running))


def command(text: str, library: Any, start: str = "Idle_01") -> Command:
    """Return the last command of a script."""
    resolved = analyse(Source(text), library, start).resolved
    assert resolved is not None
    found = resolved.statements[-1]
    assert isinstance(found, Command)
    return found


def only(text: str, before: World, library: Any, travel: Any, start: str = "Idle_01") -> Course:
    (course,) = bring(before, command(text, library, start), Names(library), travel)
    return course


def legs(course: Course) -> list[tuple[str, str, str]]:
    return [(leg.graph, leg.kind.value, leg.motion) for leg in course.legs]


ROOT, UPPER, HAND = "Full-Body", "Upper-Body", "Left-Hand"


def test_the_root_goes_where_it_is_soonest(reference, said):
    travel = said({("Idle_01", "Walk_01"): 3.0, ("Idle_01", "Walk_02"): 2.0, ("Idle_01", "Walk_03"): 4.0})
    course = only("WALK", world((ROOT, "Idle_01")), reference, travel)
    assert legs(course) == [(ROOT, "moves", "Walk_02")]
    assert course.takes.mean == 2.0
    assert course.world.get(ROOT) == Playing("Walk_02", Moment.ARRIVED, "Idle_01", 0.0)


def test_what_plays_a_candidate_stays(reference, said):
    before = world((ROOT, "Walk_03"))
    course = only("WALK", before, reference, said())
    assert legs(course) == [(ROOT, "stays", "Walk_03")]
    assert (course.takes.mean, course.world) == (0.0, before)


def test_where_several_may_be_soonest_there_are_several_courses(reference, said):
    travel = said(chances={"Walk_01": 1.0, "Walk_03": 3.0})
    courses = bring(world((ROOT, "Idle_01")), command("Walk_01 or Walk_03", reference), Names(reference), travel)
    assert [(course.legs[0].motion, course.chance) for course in courses] == [("Walk_01", 0.25), ("Walk_03", 0.75)]


def test_a_part_takes_what_fits_best_not_what_is_soonest(reference, said):
    travel = said({("Walk_01", "Talk_01"): 9.0}, fits={("Walk_01", "Talk_01"): 1.0, ("Walk_01", "Talk_02"): 3.0})
    course = only("WALK with Upper-Body TALK", world((ROOT, "Walk_01")), reference, travel)
    assert legs(course) == [(ROOT, "stays", "Walk_01"), (UPPER, "moves", "Talk_01")]
    assert course.takes.mean == 9.0


def test_a_part_takes_the_next_best_where_no_way_leads_to_the_best(reference, said):
    travel = said({("Walk_01", "Talk_01"): None}, fits={("Walk_01", "Talk_01"): 1.0, ("Walk_01", "Talk_02"): 3.0})
    course = only("WALK with Upper-Body TALK", world((ROOT, "Walk_01")), reference, travel)
    assert legs(course)[-1] == (UPPER, "moves", "Talk_02")


def test_parts_set_out_when_the_graph_above_has_arrived(reference, said):
    travel = said({("Idle_01", "Walk_01"): 2.0, ("Walk_01", "Talk_01"): 3.0})
    course = only("Walk_01 with Upper-Body Talk_01", world((ROOT, "Idle_01")), reference, travel)
    assert course.takes.mean == 5.0
    arrived = Playing("Walk_01", Moment.ARRIVED, "Idle_01", 0.0)
    assert travel.asked[-1][1] == arrived, "it leaves what was just arrived in"
    assert course.world.get(ROOT) == Playing("Walk_01", Moment.ARRIVED, "Idle_01", held_s=3.0)


def test_parts_beside_each_other_set_out_together(hands, said):
    travel = said({("Idle_01", "Wave_01"): 2.0, ("Idle_01", "Point_01"): 3.0})
    before = world((ROOT, "Idle_01"))
    course = only("IDLE with Left-Hand WAVE with Right-Hand POINT", before, hands, travel)
    assert course.takes.mean == 3.0


def test_a_part_that_is_not_named_is_ended_first(reference, said):
    before = world((ROOT, "Walk_01"), (UPPER, "Talk_01"))
    course = only("WALK", before, reference, said())
    assert legs(course) == [(UPPER, "ends", "Walk_01"), (ROOT, "stays", "Walk_01")]
    assert course.legs[0].because == "the command does not name it"
    assert (course.takes.mean, course.cost, course.world.get(UPPER)) == (0.5, 0.25, None)


def test_a_part_is_ended_where_the_graph_above_changes_though_it_will_do_the_same_again(reference, said):
    before = world((ROOT, "Idle_01"), (UPPER, "Talk_01"))
    course = only("Walk_01 with Upper-Body Talk_01", before, reference, said())
    assert [leg[:2] for leg in legs(course)] == [(UPPER, "ends"), (ROOT, "moves"), (UPPER, "moves")]
    assert course.legs[0].because == "`Full-Body` changes its motion"
    assert course.takes.mean == 2.5


def test_a_part_that_is_satisfied_stays_where_the_graph_above_does(reference, said):
    before = world((ROOT, "Walk_01"), (UPPER, "Talk_01"))
    course = only("WALK with Upper-Body TALK", before, reference, said())
    assert (course.takes.mean, course.world) == (0.0, before)


def test_a_part_follows_where_the_graph_above_plays_the_candidate_taken(reference, said):
    before = world((ROOT, "Talk_01"), (UPPER, "Walk_01"))
    course = only("Talk_01 with Upper-Body (TALK and IDLE)", before, reference, said())
    assert legs(course) == [(ROOT, "stays", "Talk_01"), (UPPER, "ends", "Talk_01"), (UPPER, "follows", "Talk_01")]
    assert course.world.get(UPPER) is None


def test_the_lowest_parts_are_ended_first(left_hand, said):
    before = world((ROOT, "Walk_01"), (UPPER, "Talk_01"), (HAND, "Wave_01"))
    course = only("WALK", before, left_hand, said())
    assert [leg[0] for leg in legs(course)][:2] == [HAND, UPPER]
    assert course.legs[0].motion == "Talk_01", "it goes back to what the graph above it still plays"
    assert course.takes.mean == 1.0


def test_once_enters_a_motion_that_is_played_already(reference, said):
    travel = said()
    course = only("Walk_01 once", world((ROOT, "Walk_01")), reference, travel)
    assert travel.asked[0][-1] is True
    assert course.world.get(ROOT) == Playing("Walk_01", Moment.BEGUN, held_s=0.0)


def test_once_takes_a_candidate_to_whose_beginning_a_way_leads(reference, said):
    travel = said(without_begin=frozenset({"Talk_01"}), fits={("Walk_01", "Talk_01"): 1.0, ("Walk_01", "Talk_02"): 3.0})
    course = only("Upper-Body TALK once", world((ROOT, "Walk_01")), reference, travel)
    assert (legs(course), course.takes.mean) == ([(UPPER, "moves", "Talk_02")], 1.0)


def test_once_is_blended_on_the_spot_into_what_is_soonest_where_no_way_leads_to_a_beginning(reference, said):
    travel = said({("Idle_01", "Walk_01"): 3.0}, without_begin=frozenset({"Walk_01", "Walk_02", "Walk_03"}))
    course = only("WALK once", world((ROOT, "Idle_01")), reference, travel)
    (leg,) = course.legs
    assert (leg.motion, leg.on_the_spot, course.takes.mean) == ("Walk_02", 1.0, 0.75)


def test_a_part_that_follows_enters_a_motion_once_all_the_same(reference, said):
    course = only("Upper-Body Talk_01 once", world((ROOT, "Talk_01")), reference, said())
    assert legs(course) == [(UPPER, "moves", "Talk_01")]


def test_where_a_command_cannot_be_obeyed_there_is_no_course(reference, said):
    every = said({("Idle_01", motion): None for motion in reference.motions(ROOT)})
    assert bring(world((ROOT, "Idle_01")), command("WALK", reference), Names(reference), every) == ()
    talk = command("Idle_01\nUpper-Body TALK", reference)
    assert bring(world((ROOT, "Idle_02")), talk, Names(reference), said()) == (), "rule 1"


def test_a_part_is_given_back_with_those_below_it(left_hand, said):
    before = world((ROOT, "Walk_01"), (UPPER, "Talk_01"), (HAND, "Wave_01"))
    course = end_part(before, UPPER, Names(left_hand), said())
    assert [leg.graph for leg in course.legs] == [HAND, UPPER]
    assert [graph for graph, _ in course.world.running] == [ROOT]


def test_what_does_not_run_need_not_be_given_back(reference, said):
    before = world((ROOT, "Walk_01"))
    assert end_part(before, UPPER, Names(reference), said()) == Course(1.0, before)


@pytest.mark.parametrize(("graph", "expected"), [(HAND, UPPER), (UPPER, UPPER), (ROOT, ROOT)])
def test_a_part_is_driven_by_the_nearest_graph_above_that_runs(left_hand, graph, expected):
    before = world((ROOT, "Walk_01"), (UPPER, "Talk_01"))
    assert driver(before, graph, Names(left_hand))[0] == expected
