import sys
from pathlib import Path

import pytest

from mlmg_runtime.demo import library
from mlmg_runtime.demo.library import cache_folder, demo_library


def refused(monkeypatch: pytest.MonkeyPatch) -> OSError:
    """Return the error of a demo library that cannot be kept, and that nothing was built for in vain."""
    monkeypatch.setattr(library, "_build", lambda *_: pytest.fail("built all the same"))
    with pytest.raises(OSError, match="the demo library is kept here") as caught:
        demo_library()
    return caught.value


@pytest.mark.parametrize("below", ["", "deeper/still"])
def test_a_cache_that_cannot_be_used_is_told_with_the_variable_that_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, below: str
) -> None:
    (tmp_path / "taken").write_text("a file")
    folder = tmp_path / "taken" / below
    monkeypatch.setenv("MLMG_CACHE", str(folder))
    error = refused(monkeypatch)
    assert (type(error), error.filename) == (NotADirectoryError, str(folder))
    assert error.strerror.endswith("; the demo library is kept here because MLMG_CACHE says so")


@pytest.mark.skipif(sys.platform == "win32", reason="the cache is elsewhere")
def test_where_the_usual_cache_cannot_be_used_the_way_out_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "taken").write_text("a file")
    monkeypatch.delenv("MLMG_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "taken"))
    monkeypatch.setenv("HOME", str(tmp_path / "taken"))
    error = refused(monkeypatch)
    assert error.filename == str(cache_folder())
    assert error.strerror.endswith("; the demo library is kept here unless MLMG_CACHE names another folder")


def test_a_library_that_is_there_is_not_built_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MLMG_CACHE", str(tmp_path))
    monkeypatch.setattr(library, "_build", lambda path, _: path.write_text("built"))
    path = demo_library()
    assert (path.parent, path.read_text()) == (tmp_path, "built")
    monkeypatch.setattr(library, "_build", lambda *_: pytest.fail("built again"))
    assert demo_library() == path
