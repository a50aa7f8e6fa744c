from pathlib import Path

import pytest

from mlmg_runtime.building.toml_files import did_you_mean, read_toml
from mlmg_runtime.errors import ConfigurationError


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "x.toml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


def test_a_file_is_read_with_the_lines_of_its_keys(tmp_path: Path) -> None:
    file = read_toml(written(tmp_path, "\ufeffa = 1\n[b]\nc = 2\n"))
    assert file.document == {"a": 1, "b": {"c": 2}}
    assert file.lines == {("a",): 1, ("b",): 2, ("b", "c"): 3}


@pytest.mark.parametrize(("text", "line"), [("a = ", 1), ("a = 1\na = 2", 2), (b"a = 1\n\xff", 2), ("\n[a", 2)])
def test_what_is_no_toml_is_told_with_its_line(tmp_path: Path, text: str | bytes, line: int) -> None:
    with pytest.raises(ConfigurationError) as caught:
        read_toml(written(tmp_path, text))
    assert caught.value.line == line


def test_a_mistake_stands_on_the_line_of_its_key_or_of_the_nearest_table(tmp_path: Path) -> None:
    file = read_toml(written(tmp_path, "[a]\nb = { c = 1 }\n[d.e]\n"))
    for at, line in ((("a", "b", "c"), 2), (("a", "z"), 1), (("z",), None), (("d",), 3)):
        with pytest.raises(ConfigurationError) as caught:
            file.fail(at, "no")
        assert caught.value.line == line


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        (["start"], "unknown key `Strat`; expected start; did you mean `start`?"),
        (["start", "up"], "unknown key `Strat`; expected one of start, up; did you mean `start`?"),
        (["clips", "up"], "unknown key `Strat`; expected one of clips, up"),
    ],
)
def test_a_key_that_is_not_known_is_told_with_those_that_are(tmp_path: Path, keys: list[str], message: str) -> None:
    file = read_toml(written(tmp_path, "\nStrat = 1\n"))
    with pytest.raises(ConfigurationError) as caught:
        file.check_keys(file.document, (), keys)
    assert (caught.value.line, caught.value.message) == (2, message)


@pytest.mark.parametrize(
    ("name", "known", "meant"),
    [
        ("spine", ["Hips", "Spine"], "Spine"),
        ("IDLE", ["idle"], "idle"),
        ("WLAK", ["WALK", "TALK"], "WALK"),
        ("walk", ["WALK", "Walk"], "WALK"),
        ("xyz", ["Hips"], None),
        ("xyz", [], None),
    ],
)
def test_the_likeliest_name_is_offered_whatever_its_case(name: str, known: list[str], meant: str | None) -> None:
    assert did_you_mean(name, known) == (f"; did you mean `{meant}`?" if meant else "")


def test_more_brackets_inside_each_other_than_can_be_read_are_an_error(tmp_path: Path) -> None:
    (tmp_path / "a.toml").write_text(f"x = {'[' * 5000}{']' * 5000}\n")
    with pytest.raises(ConfigurationError, match="too many brackets stand inside each other"):
        read_toml(tmp_path / "a.toml")
