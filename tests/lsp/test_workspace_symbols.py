"""Names of all that is open are found by their letters: `workspace/symbol`."""

import pytest

TAGS = '# 😀\n[tags.Full-Body]\nWalk_01 = ["WALK"]\nIdle_01 = ["IDLE"]\n'


@pytest.fixture
def client(start, tmp_path, demo_library):
    library = tmp_path / "my.mlmg"
    library.write_bytes(demo_library.path.read_bytes())
    (tmp_path / "my.toml").write_text(TAGS, encoding="utf-8")
    (tmp_path / "used.ms").write_text("# 走\nlet slow_walk = WALK\n", encoding="utf-8")
    client = start("--library", str(library))
    client.initialize()
    for name, text in (
        ("a.ms", 'use "used.ms"\nslow_walk\nlet walk_off = WALK\nwalk_off\n'),
        ("b.ms", 'use "used.ms"\n'),
    ):
        client.open((tmp_path / name).as_uri(), text)
    return client


def found(client, query: str) -> list[tuple[str, str, int]]:
    told = client.ask("workspace/symbol", {"query": query})
    places = [one["location"] for one in told]
    return [
        (one["name"], place["uri"].rpartition("/")[2], place["range"]["start"]["line"])
        for one, place in zip(told, places, strict=True)
    ]


def test_definitions_of_open_and_used_files_are_listed_once(client):
    assert sorted(found(client, "")) == [("slow_walk", "used.ms", 1), ("walk_off", "a.ms", 2)]


def test_the_likeliest_come_first_and_names_of_the_library_too_where_it_is_known_where_they_are(client):
    assert found(client, "walk") == [("WALK", "my.toml", 2), ("walk_off", "a.ms", 2), ("slow_walk", "used.ms", 1)]
    assert found(client, "idle") == [("IDLE", "my.toml", 3)]
    assert found(client, "swk") == [("slow_walk", "used.ms", 1)]
    assert found(client, "nothing") == []


def test_what_has_been_edited_is_found_as_it_stands(client, tmp_path):
    client.edit((tmp_path / "a.ms").as_uri(), 2, {"text": "\n\nlet walk_home = WALK\n"})
    assert found(client, "home") == [("walk_home", "a.ms", 2)]
    assert found(client, "off") == []


def test_without_an_open_text_there_is_nothing(start):
    client = start()
    client.initialize()
    assert client.ask("workspace/symbol", {"query": "walk"}) == []
