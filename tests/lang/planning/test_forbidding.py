"""Which forbidden transitions keep a motion from being reached, said in words."""

from __future__ import annotations

from typing import Any

import pytest

from mlmg_lang.planning.forbidding import why_forbidden

MOTIONS = ("Stand", "Sit", "Walk", "Lie")


def why(catalog: Any, forbidden: list[tuple[str, str]], ways: list[tuple[str, str]], to: tuple[str, ...]) -> str | None:
    """Say why no way leads from Sit to some motions of a library with these ways and no others."""
    cut = {("Body", a, b) for a in MOTIONS for b in MOTIONS if a != b and (a, b) not in ways}
    pairs = frozenset(("Body", *pair) for pair in forbidden)
    library = catalog({"Body": dict.fromkeys(MOTIONS, ())}, {}, cut=frozenset(cut), forbidden=pairs)
    return why_forbidden("Body", ("Sit",), to, library)


def test_the_forbidden_pair_is_named_with_all_that_it_keeps_away(catalog: Any) -> None:
    told = why(catalog, [("Sit", "Walk"), ("Sit", "Lie")], [], ("Walk", "Lie"))
    assert told == "library.toml forbids going from `Sit` to `Walk` and `Lie` on `Body`, and no way round leads there"


@pytest.mark.parametrize(
    ("forbidden", "ways"),
    [(("Sit", "Stand"), [("Stand", "Walk")]), (("Stand", "Walk"), [("Sit", "Stand")])],
)
def test_a_way_round_that_is_forbidden_is_why_too(catalog: Any, forbidden: tuple[str, str], ways: Any) -> None:
    source, target = forbidden
    told = why(catalog, [forbidden], ways, ("Walk",))
    assert told == f"library.toml forbids going from `{source}` to `{target}` on `Body`, where the way would lead"


def test_so_is_a_forbidden_way_back_as_no_graph_holds_what_cannot_be_left(catalog: Any) -> None:
    told = why(catalog, [("Walk", "Sit")], [], ("Walk",))
    assert told == "library.toml forbids going from `Walk` to `Sit` on `Body`, and what cannot be left is not entered"


@pytest.mark.parametrize("forbidden", [[], [("Lie", "Stand")], [("Stand", "Sit")], [("Sit", "Lie")]])
def test_what_leads_elsewhere_is_not_why(catalog: Any, forbidden: list[tuple[str, str]]) -> None:
    assert why(catalog, forbidden, [], ("Walk",)) is None
