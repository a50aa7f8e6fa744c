from __future__ import annotations

from pathlib import Path

import pytest

from mlmg_lang.libraries import find_library
from mlmg_runtime.errors import ConfigurationError
from mlmg_runtime.library import Library


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with a setting of its own and a script two folders below."""
    monkeypatch.delenv("MLMG_LIBRARY", raising=False)
    (tmp_path / "scenes" / "one").mkdir(parents=True)
    (tmp_path / "mlmg.toml").write_text('library = "lib/my.mlmg"\n', encoding="utf-8")
    return tmp_path


def test_the_option_goes_before_all(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MLMG_LIBRARY", "from_environment.mlmg")
    assert find_library(project / "a.ms", "option.mlmg") == Path("option.mlmg")


def test_the_environment_goes_before_settings(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MLMG_LIBRARY", "from_environment.mlmg")
    assert find_library(project / "a.ms") == Path("from_environment.mlmg")


def test_an_empty_variable_says_nothing(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MLMG_LIBRARY", "")
    assert find_library(project / "a.ms") == project / "lib" / "my.mlmg"


def test_the_nearest_settings_above_the_script_count(project: Path) -> None:
    script = project / "scenes" / "one" / "a.ms"
    assert find_library(script) == project / "lib" / "my.mlmg"
    (project / "scenes" / "mlmg.toml").write_text('library = "other.mlmg"', encoding="utf-8")
    assert find_library(script) == project / "scenes" / "other.mlmg"


def test_standard_input_stands_in_the_current_folder(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(project / "scenes")
    assert find_library("-") == project / "lib" / "my.mlmg"


def test_settings_need_not_name_a_library(project: Path) -> None:
    (project / "mlmg.toml").write_text("", encoding="utf-8")
    assert find_library(project / "a.ms") is None


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("library = 3", 1, "`library` should be the path of a library, as text; found 3"),
        ('\nlibrary = ""', 2, "`library` should be the path of a library, as text; found ''"),
        ("\nlibrary = ", 2, "not valid TOML: expected a value: a text stands in double quotes, a list in [ ]"),
        ('libary = "x"', 1, "unknown key `libary`; expected library; did you mean `library`?"),
        ('library = "x"\n[view]\nup = "z"', 2, "unknown key `view`; expected library"),
    ],
)
def test_settings_that_are_wrong_are_one_error_with_file_and_line(
    project: Path, text: str, line: int, message: str
) -> None:
    (project / "mlmg.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ConfigurationError) as caught:
        find_library(project / "a.ms")
    assert str(caught.value) == f"{project / 'mlmg.toml'}:{line}: {message}"


def test_demo_is_the_demo_library_wherever_a_library_is_named(
    project: Path, monkeypatch: pytest.MonkeyPatch, demo_library: Library
) -> None:
    monkeypatch.setenv("MLMG_CACHE", str(demo_library.path.parent))
    assert find_library(project / "a.ms", "demo") == demo_library.path
    (project / "mlmg.toml").write_text('library = "demo"\n', encoding="utf-8")
    assert find_library(project / "a.ms") == demo_library.path
    monkeypatch.setenv("MLMG_LIBRARY", "demo")
    assert find_library("-") == demo_library.path


def test_a_file_called_demo_is_meant_before_the_demo_library(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(project)
    (project / "demo").write_bytes(b"")
    assert find_library(project / "a.ms", "demo") == Path("demo")
    (project / "mlmg.toml").write_text('library = "demo"\n', encoding="utf-8")
    assert find_library(project / "a.ms") == project / "demo"


def test_a_path_to_demo_is_never_the_demo_library(project: Path) -> None:
    assert find_library(project / "a.ms", "./demo") == Path("demo")
