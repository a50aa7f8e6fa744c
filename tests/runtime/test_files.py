import errno
import os
import stat
import threading
from pathlib import Path

import pytest

from mlmg_runtime.files import atomic_output, check_output


def test_what_was_written_beside_takes_the_place_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "out.txt"
    path.write_text("old")
    with atomic_output(path) as beside:
        assert beside.parent == tmp_path
        beside.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def write_half(path: Path, error: type[BaseException]) -> None:
    with atomic_output(path) as beside:
        beside.write_text("half")
        raise error


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt, SystemExit])
def test_after_an_error_nothing_has_happened(error: type[BaseException], tmp_path: Path) -> None:
    path = tmp_path / "out.txt"
    path.write_text("old")
    for target in (path, tmp_path / "new.txt"):
        with pytest.raises(error):
            write_half(target, error)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_an_error_while_it_is_written_names_the_file_that_was_asked_for(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="No space") as caught, atomic_output(tmp_path / "out.txt"):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert caught.value.filename == str(tmp_path / "out.txt")


def test_a_new_file_gets_the_permissions_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "usual").touch()
    with atomic_output(tmp_path / "new"):
        pass
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "usual").stat().st_mode


def test_an_existing_file_keeps_its_permissions(tmp_path: Path) -> None:
    path = tmp_path / "out.sh"
    path.touch()
    path.chmod(0o751)
    with atomic_output(path):
        pass
    assert stat.S_IMODE(path.stat().st_mode) == 0o751


@pytest.mark.parametrize("exists", [True, False])
def test_a_link_goes_on_pointing_at_what_was_written(exists: bool, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    if exists:
        (elsewhere / "out.txt").write_text("old")
    link = tmp_path / "link"
    link.symlink_to(elsewhere / "out.txt")
    with atomic_output(link) as beside:
        assert beside.parent == elsewhere
        beside.write_text("new")
    assert link.is_symlink()
    assert (elsewhere / "out.txt").read_text() == "new"
    assert [path.name for path in elsewhere.iterdir()] == ["out.txt"]


def test_a_folder_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError, match="folder"), atomic_output(tmp_path / "folder" / ".."):
        pass


def test_an_error_names_the_file_that_was_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "missing" / "out.txt"
    with pytest.raises(FileNotFoundError) as caught, atomic_output(path):
        pass
    assert caught.value.filename == str(path)


def test_a_file_that_may_not_be_written_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Asked, not tried with permissions: root may write every file.
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    path = tmp_path / "out.txt"
    path.write_text("old")
    with pytest.raises(PermissionError), atomic_output(path):
        pass
    assert path.read_text() == "old"


def test_a_pipe_is_written_itself(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    received: list[str] = []
    reader = threading.Thread(target=lambda: received.append(pipe.read_text()), daemon=True)
    reader.start()
    with atomic_output(pipe) as beside:
        assert beside == pipe
        beside.write_text("new")
    reader.join()
    assert received == ["new"]
    assert list(tmp_path.iterdir()) == [pipe]


def test_the_null_device_is_not_replaced() -> None:
    with atomic_output("/dev/null") as beside:
        assert beside == Path("/dev/null")


def test_checking_an_output_leaves_everything_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "old").write_text("old")
    check_output(tmp_path / "old")
    check_output(tmp_path / "new")
    assert [path.name for path in tmp_path.iterdir()] == ["old"]
    assert (tmp_path / "old").read_text() == "old"
    with pytest.raises(FileNotFoundError, match="no/new"):
        check_output(tmp_path / "no" / "new")
