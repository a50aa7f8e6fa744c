"""Which library a client has set, and what is said of libraries."""

import pytest

URI = "untitled:one"
PULLED = {"workspace": {"configuration": True}}
NONE, BROKEN = "No library is named", "The library cannot be used"


def is_checked(client, version: int) -> bool:
    """Return whether names are those of a library."""
    client.edit(URI, version, {"text": "WLAK\n"})
    return any(one["code"] == "MS021" for one in client.diagnostics(URI, version))


@pytest.mark.parametrize("told", [{}, {"inlayHints": {"units": False}}, None], ids=["nothing", "hints", "null"])
def test_a_library_that_is_set_stays_until_another_is_named(start, told, demo_library):
    client = start("--stdio")
    client.answer_with("workspace/configuration", [told])
    client.initialize(PULLED, initializationOptions={"library": str(demo_library.path)})
    client.open(URI, "WALK\n")
    client.wait_for("workspace/configuration")
    assert is_checked(client, 2)
    client.answer_with("workspace/configuration", [{"library": ""}])
    client.notify("workspace/didChangeConfiguration", {"settings": None})
    assert NONE in client.wait_for("window/showMessage")["message"]
    assert not is_checked(client, 3)


def test_what_is_wrong_with_a_library_is_said_once_though_other_folders_have_sound_ones(start, tmp_path, demo_library):
    for name, line in (("sound", f'library = "{demo_library.path.as_posix()}"'), ("broken", 'library = "x.mlmg"')):
        (tmp_path / name).mkdir()
        (tmp_path / name / "mlmg.toml").write_text(line, encoding="utf-8")
        (tmp_path / name / "x.mlmg").write_text("no library", encoding="utf-8")
    sound, broken = ((tmp_path / name / "s.ms").as_uri() for name in ("sound", "broken"))
    client = start("--stdio")
    client.initialize()
    client.open(broken, "WLAK\n")
    assert BROKEN in client.wait_for("window/showMessage")["message"]
    client.open(sound, "WLAK\n")
    for uri in (sound, broken) * 2:
        client.notify("textDocument/didSave", {"textDocument": {"uri": uri}})
        client.ask_at("hover", uri, 0, 0)
    assert client.leave() == 0
    assert [one for one in client.rest() if one.get("method") == "window/showMessage"] == []
