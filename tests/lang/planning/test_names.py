from __future__ import annotations

import random
from collections.abc import Iterable
from typing import Any

import pytest

from mlmg_lang import spelling
from mlmg_lang.front_end import analyse
from mlmg_lang.planning import names as names_module
from mlmg_lang.planning.names import Kind, Names
from mlmg_lang.source import Source
from mlmg_lang.spelling import Vocabulary, nearest


@pytest.fixture
def deep(catalog: Any) -> Names:
    """Return a tree: Body over Trunk and Legs, Trunk over two hands."""
    graphs = {name: {"a": ()} for name in ("Body", "Trunk", "Legs", "Left", "Right")}
    above = {"Trunk": "Body", "Legs": "Body", "Left": "Trunk", "Right": "Trunk"}
    return Names(catalog(graphs, above, start="a"))


def test_the_graphs_below_come_level_by_level_in_configuration_order(deep: Names) -> None:
    assert deep.all_levels() == ("Body", "Trunk", "Legs", "Left", "Right")
    assert deep.below(("Trunk",)) == ("Left", "Right")
    assert deep.below(("Legs", "Trunk")) == ("Left", "Right")
    assert deep.below(("Left",)) == ()


def test_the_graphs_above_come_nearest_first(deep: Names) -> None:
    assert deep.ancestors("Right") == ("Trunk", "Body")
    assert deep.ancestors("Body") == ()


def test_graphs_are_found_by_inexact_spelling(deep: Names) -> None:
    assert (deep.graph("Trunk"), deep.graph("t-r_UNK"), deep.graph("Trunks")) == ("Trunk", "Trunk", None)


def test_of_graphs_spelt_alike_the_first_is_meant_by_another_spelling(catalog: Any) -> None:
    names = Names(catalog({"Body": {"a": ()}, "Hand": {"a": ()}, "HAND": {"a": ()}}, {}, start="a"))
    assert (names.graph("HAND"), names.graph("hand")) == ("HAND", "Hand")


def test_a_motion_goes_before_a_tag_and_exact_before_inexact(catalog: Any) -> None:
    names = Names(catalog({"Body": {"Walk": ("walk", "WALK"), "b": ("WALK",)}}, {}, start="b"))
    for written, name, kind, exact in [
        ("Walk", "Walk", Kind.MOTION, True),
        ("WALK", "WALK", Kind.TAG, True),
        ("walk", "walk", Kind.TAG, True),
        ("wALK", "Walk", Kind.MOTION, False),
    ]:
        match = names.find("Body", written)
        assert match is not None
        assert (match.entry.name, match.entry.kind, match.exact) == (name, kind, exact)


def test_a_spelling_of_several_names_tells_them_all(catalog: Any) -> None:
    names = Names(catalog({"Body": {"Walk_1": (), "WALK1": ()}}, {}, start="WALK1"))
    match = names.find("Body", "walk1")
    assert match is not None
    assert [entry.name for entry in (match.entry, *match.others)] == ["Walk_1", "WALK1"]


def test_a_name_of_signs_alone_is_not_like_every_other(catalog: Any) -> None:
    names = Names(catalog({"Body": {"_": (), "a": ()}}, {}, start="a"))
    assert names.find("Body", "-") is None


def test_the_motions_of_a_tag_stand_in_configuration_order(reference: Any) -> None:
    match = Names(reference).find("Full-Body", "IDLE")
    assert match is not None
    assert match.entry.motions == ("Idle_01", "Idle_02", "Music_01", "Talk_01")


def test_the_names_of_a_library_are_made_ready_once_however_many_are_unknown(
    catalog: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[list[str]] = []

    class Counted(Vocabulary):
        def __init__(self, known: Iterable[str]) -> None:
            made.append(list(known))
            super().__init__(made[-1])

    monkeypatch.setattr(spelling, "Vocabulary", Counted)
    monkeypatch.setattr(names_module, "Vocabulary", Counted)
    on = {f"Walk_{at:03}": ("WALK", f"TAG_{at}") for at in range(200)}
    library = catalog({"Body": on, "Top": dict.fromkeys(on, ())}, {"Top": "Body"}, start="Walk_000")
    analyse(Source("".join(f"unlike{at} bar{at}; Wolk_{at}; foo{at}(bar)\n" for at in range(50))), library)
    assert 0 < sum(len(known) >= 200 for known in made) <= 4


def test_own_names_and_the_nearest_of_a_library_have_the_nearest_of_all_among_them(catalog: Any) -> None:
    draw = random.Random(3)

    def words(n: int) -> list[str]:
        return ["".join(draw.choices("ABa_-", k=draw.randint(1, 5))) for _ in range(n)]

    for _ in range(300):
        motions = {one: tuple(words(2)) for one in dict.fromkeys(words(6))}
        names, own, written = Names(catalog({"Body": motions}, {}, start=next(iter(motions)))), words(3), words(1)[0]
        for _ in range(2):  # the second time it is kept
            found = nearest(written, (*own, *names.nearest(written, ("Body",))))
            assert found == nearest(written, (*own, *names.spellings_on("Body")))
