"""What editors are told of a library beyond its names is so in the library and in its configuration."""

from dataclasses import replace
from pathlib import Path

import pytest

from mlmg_lang.ide.occurrences import Place
from mlmg_lang.source import Span
from mlmg_lsp.library_facts import LibraryFacts, configuration_of
from mlmg_runtime.library import Library

CONFIGURATION = (
    '\ufeff# 走路 😀\r\n[library]\r\nclips = ["*.bvh"]\r\n[[graph]]\r\nname = "Full-Body"\r\n[[graph]]\r\n'
    'name = "Upper-Body"\r\njoints = ["Spine"]\r\n[tags.Full-Body]\r\nWalk = ["WALK"]\r\n"走" = [\r\n  "WALK"]\r\n'
    '[tags.Upper-Body]\r\nWalk = ["SWING", "WALK"]'
)


@pytest.fixture
def facts(demo_library: Library, tmp_path: Path) -> LibraryFacts:
    """Return the demo library's facts, with a configuration that is not its own."""
    path = tmp_path / "library.toml"
    path.write_bytes(CONFIGURATION.encode("utf-8"))
    return LibraryFacts(demo_library, path)


def written(places: tuple[Place | None, ...]) -> list[str]:
    """Return what stands in places of the configuration, counted from behind its byte order mark."""
    return [CONFIGURATION[1:][place.span.start : place.span.end] for place in places if place is not None]


def test_a_tag_is_given_on_each_line_whose_list_holds_it(facts):
    assert written(facts.tag("WALK")) == ['Walk = ["WALK"]', '"走" = [', 'Walk = ["SWING", "WALK"]']
    assert written(facts.tag("WALK", "Upper-Body")) == ['Walk = ["SWING", "WALK"]', 'Walk = ["WALK"]', '"走" = [']
    assert facts.tag("RUN") == ()


def test_a_graph_is_described_where_its_name_stands(facts):
    assert written((facts.graph("Upper-Body"),)) == ['name = "Upper-Body"']
    assert facts.graph("Left-Hand") is None


def test_the_file_of_a_clip_is_found_from_the_configuration_if_it_is_there(facts, demo_library, tmp_path):
    motion = demo_library.root.motions[0]
    source = demo_library.source(motion)
    assert source is not None
    assert facts.motion(motion) is None
    path = tmp_path / "clips" / "library.toml"
    (path.parent / source).parent.mkdir(parents=True, exist_ok=True)
    (path.parent / source).write_text("HIERARCHY", encoding="utf-8")
    found = LibraryFacts(demo_library, path).motion(motion)
    assert found == Place(str((path.parent / source).resolve()), Span(0, 0))
    assert facts.motion("Nothing") is None


@pytest.mark.parametrize("text", [None, b"[tags", b"\xff", b"tags = 3\ngraph = [1]", b"tags.A = 3"])
def test_without_a_sound_configuration_nothing_leads_anywhere(demo_library, tmp_path, text):
    path = tmp_path / "library.toml"
    if text is not None:
        path.write_bytes(text)
    for facts in (LibraryFacts(demo_library, path), LibraryFacts(demo_library, None)):
        assert facts.tag("WALK") == ()
        assert facts.graph("Full-Body") is None
        assert facts.motion(demo_library.root.motions[0]) is None


def test_joints_and_transitions_are_those_of_the_graph(demo_library):
    facts = LibraryFacts(demo_library, None)
    for name, graph in demo_library.by_name.items():
        assert list(facts.joints(name)) == [demo_library.skeleton.names[joint] for joint in graph.joints]
        for motion in graph.motions:
            numbers = facts.transitions(name, motion)
            expected = dict.fromkeys(graph.motions, 0)
            for edge in graph.edges:
                if graph.motions[edge.src_motion] == motion:
                    expected[graph.motions[edge.dst_motion]] += 1
            assert numbers == expected


def test_the_configuration_is_the_one_that_the_library_knows_and_no_other(demo_library, tmp_path):
    own = replace(demo_library, path=tmp_path / "dance.mlmg", configuration=tmp_path / "clips" / "library.toml")
    (tmp_path / "library.toml").touch()
    assert configuration_of(own) is None
    (tmp_path / "clips").mkdir()
    (tmp_path / "clips" / "library.toml").touch()
    assert configuration_of(own) == tmp_path / "clips" / "library.toml"


def test_of_a_library_that_does_not_know_the_configuration_is_looked_for_beside_it(demo_library, tmp_path):
    library = replace(demo_library, path=tmp_path / "dance.mlmg")
    assert configuration_of(library) is None
    for name in ("library.toml", "dance.toml"):
        (tmp_path / name).touch()
        assert configuration_of(library) == tmp_path / name
