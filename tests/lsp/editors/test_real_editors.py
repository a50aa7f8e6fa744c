"""The configurations in real editors, which start the real server, and do in each of many texts what a user does."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from mlmg_runtime.library import Library

HERE = Path(__file__).parent
EDITORS = HERE.parents[2] / "lsp" / "editors"
ALE = "/usr/share/vim/vimfiles/pack/dist-bundle/opt/ale"
LIMIT_S = 600


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What stands before that which is done, on its line and above it.

    Attributes
    ----------
    canonical : the same as the formatter writes it. end : a line's end. ended : whether the last line has one, as after
        formatting it always has.
    """

    name: str
    before: str
    canonical: str
    end: str = "\n"
    ended: bool = True


@dataclass(frozen=True, slots=True)
class Deed:
    """What is done: in a text with `‸` where the cursor is.

    Attributes
    ----------
    chosen : what is chosen, or the new name. after : the text that comes of it.
    told : what the text is told to have, as what is underlined and the message, before it.
    said : what is shown of what is under the cursor. beside : what comes of the file that is used.
    beyond : the editors that cannot do it; docs/editors.md says why.
    """

    name: str
    does: str
    text: str
    chosen: str = ""
    after: str | None = None
    told: tuple[tuple[str, str], ...] = ()
    said: str | None = None
    beside: str | None = None
    beyond: tuple[str, ...] = ()


PLAIN = "Idle_01 with Upper-Body "
SURROUNDINGS = (
    Surroundings("plain", PLAIN, PLAIN),
    Surroundings("emoji", 'let "😀" = WALK\n"😀" with Upper-Body ', 'let "😀" = WALK\n"😀" with Upper-Body '),
    Surroundings("chinese", "let 走路 = WALK\n走路 with Upper-Body ", "let 走路 = WALK\n走路 with Upper-Body "),
    Surroundings("tabs", "Idle_01\twith\tUpper-Body\t", PLAIN),
    Surroundings("crlf", f"# 😀\n{PLAIN}", f"# 😀\n{PLAIN}", end="\r\n"),
    Surroundings("separator", "# a\u2028b\nIdle_01\u2028with Upper-Body ", f"# a\u2028b\n{PLAIN}"),
    Surroundings("unended", PLAIN, PLAIN, ended=False),
    Surroundings(
        "all",
        'let "😀 走路" = WALK # a\u2028b\n"😀 走路"\twith\u2028Upper-Body ',
        'let "😀 走路" = WALK  # a\u2028b\n"😀 走路" with Upper-Body ',
        end="\r\n",
        ended=False,
    ),
)
UNKNOWN = "no tag or motion `{}` in this library"
DEEDS = (
    Deed("diagnose", "diagnose", "TLAK for 2 sec\n", told=(("TLAK", UNKNOWN.format("TLAK")),)),
    Deed("complete", "complete", "TAL‸ for 2 sec\n", "TALK", "TALK for 2 sec\n", (("TAL", UNKNOWN.format("TAL")),)),
    Deed("hover", "hover", "TA‸LK for 2 sec\n", said="TALK"),
    Deed("fix", "fix", "TL‸AK for 2 sec\n", "Write `TALK`", "TALK for 2 sec\n", (("TLAK", UNKNOWN.format("TLAK")),)),
    Deed("format", "format", "TALK  for 2   sec\n", after="TALK for 2 sec\n"),
    Deed(
        "rename",
        "rename",
        "gr‸eet for 2 sec\nlet greet = TALK\n",
        "wave",
        "wave for 2 sec\nlet wave = TALK\n",
    ),
)


ALONE = Surroundings("alone", "", "")
IN_CHINESE = "let 走路 = WALK\nIdle_01\n"
USED = "used-😀.ms"
USED_TEXT = '# 😀\r\nlet "😀" = greet; let {} = TALK # 走路\u2028\r\n'
ALONE_DEEDS = (
    Deed(
        "complete-quoted",
        "complete",
        'let "😀走" = WALK\nIdle_01\n"😀走"\n"😀‸\n',
        '"😀走"',
        'let "😀走" = WALK\nIdle_01\n"😀走"\n"😀走"\n',
        (('"😀', 'this name in quotes has no closing `"`'),),
        beyond=("eglot",),
    ),
    Deed(
        "rename-used",
        "rename",
        f'use "{USED}"\nIdle_01 with Upper-Body gr‸eet\n',
        "wave",
        f'use "{USED}"\nIdle_01 with Upper-Body wave\n',
        beside=USED_TEXT.format("wave").replace("greet", "wave"),
    ),
    Deed("empty", "diagnose", ""),
    Deed("complete-empty", "complete", "‸", "IDLE", "IDLE"),
    Deed("format-empty", "format", "", after=""),
    Deed(
        "complete-hyphen",
        "complete",
        "IDLE with Upper-Bo‸ TALK\n",
        "Upper-Body",
        "IDLE with Upper-Body TALK\n",
        (("Upper-Bo", "no graph `Upper-Bo` in this library"),),
    ),
    Deed(
        "complete-chinese",
        "complete",
        IN_CHINESE + "走‸ for 2 sec\n",
        "走路",
        IN_CHINESE + "走路 for 2 sec\n",
        (("走", UNKNOWN.format("走")),),
    ),
    Deed(
        "rename-chinese",
        "rename",
        IN_CHINESE + "走‸路 for 2 sec\n",
        "行走",
        "let 行走 = WALK\nIdle_01\n行走 for 2 sec\n",
    ),
)


@dataclass(frozen=True, slots=True)
class Task:
    """A deed in its surroundings.

    Attributes
    ----------
    text, after : as they are on disk.
    """

    file: str
    deed: Deed
    text: str
    after: str

    @property
    def asked(self) -> dict[str, Any]:
        """Return it as the editor has it: lines from 1, columns from 0 in characters."""
        above, _, _ = self.text.partition("‸")
        lines = above.replace("\r\n", "\n").split("\n")
        return {
            "file": self.file,
            "do": self.deed.does,
            "line": len(lines),
            "column": len(lines[-1]),
            "with": self.deed.chosen,
            "told": len(self.deed.told),
            "left": len(self.deed.told) if self.deed.after is None else 0,
        }

    @property
    def answered(self) -> dict[str, Any]:
        """Return what is to come of it."""
        told = [list(one) for one in self.deed.told]
        beside = {} if self.deed.beside is None else {"beside": self.deed.beside}
        return {"told": told, "said": self.deed.said, "saved": self.after, **beside}


def tasks() -> Iterator[Task]:
    for place, deed in (*product(SURROUNDINGS, DEEDS), *((ALONE, deed) for deed in ALONE_DEEDS)):
        text = place.before + deed.text
        after = text.replace("‸", "") if deed.after is None else place.before + deed.after
        if not place.ended:
            text, after = text.removesuffix("\n"), after.removesuffix("\n")
        if deed.does == "format":
            after = place.canonical + (deed.after or "")
        on_disk = (one.replace("\n", place.end) for one in (text, after))
        yield Task(f"{place.name}-{deed.name}.ms", deed, *on_disk)


@pytest.fixture
def folder(tmp_path: Path, demo_library: Library) -> Path:
    """Return a folder with all texts, and the library that they are read against."""
    for task in tasks():
        (tmp_path / task.file).write_text(task.text.replace("‸", ""), "utf-8", newline="")
    (tmp_path / USED).write_text(USED_TEXT.format("greet"), "utf-8", newline="")
    (tmp_path / "mlmg.toml").write_text(f'library = "{demo_library.path}"\n', "utf-8")
    (tmp_path / "tasks.json").write_text(json.dumps([task.asked for task in tasks()]), "utf-8")
    return tmp_path


def run(folder: Path, *command: str) -> str:
    """Return what an editor says that finds `mlmg` on the search path, and has a home of its own."""
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    environment = {**os.environ, "PATH": path, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}
    done = subprocess.run(
        command,
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=LIMIT_S,
        check=False,
    )
    return (done.stdout + done.stderr).decode("utf-8", "replace")


def check(folder: Path, said: str, editor: str = "") -> None:
    """Compare what an editor has done with what it should have; what is beyond it does not count."""
    answers = folder / "answers.json"
    assert answers.exists(), said
    found = json.loads(answers.read_text("utf-8"))
    wanted = [task for task in tasks() if editor not in task.deed.beyond]
    seen = {task.file: _seen(folder, task, found.get(task.file, {"error": "no answer"})) for task in wanted}
    wrong = [f"{task.file}: {seen[task.file]}\n" for task in wanted if seen[task.file] != task.answered]
    assert not wrong, "".join(wrong)


def _seen(folder: Path, task: Task, answer: Mapping[str, Any]) -> dict[str, Any]:
    """Return an answer, with what was saved; of what is shown, only whether it has what it is to have."""
    said, wanted = answer.get("said"), task.deed.said
    shown = {} if wanted is None or wanted not in (said or "") else {"said": wanted}
    beside = {} if task.deed.beside is None else {"beside": _text_of(folder / USED)}
    return {"said": None, **answer, **shown, "saved": _text_of(folder / task.file), **beside}


def _text_of(path: Path) -> str:
    return path.read_bytes().decode("utf-8")


def needs(*programs: str) -> pytest.MarkDecorator:
    missing = [program for program in programs if shutil.which(program) is None and not Path(program).exists()]
    return pytest.mark.skipif(bool(missing), reason=f"not installed: {', '.join(missing)}")


def neovim(recent: bool) -> str | None:
    """Return a Neovim that is, or is not, of 0.11 or newer: that of the tests' environment, or any on the path."""
    beside = str(Path(sys.executable).with_name("nvim"))
    for program in filter(None, (shutil.which(beside), shutil.which("nvim"))):
        told = subprocess.run((program, "--version"), capture_output=True, text=True, check=False).stdout
        version = re.search(r"NVIM v(\d+)\.(\d+)", told)
        if version is not None and (tuple(map(int, version.groups())) >= (0, 11)) == recent:
            return program
    return None


@pytest.mark.parametrize(
    ("recent", "configuration"), [(False, "motion_script_0_7.lua"), (True, "motion_script_0_11.lua")]
)
def test_neovim_does_all_in_each_text(folder: Path, recent: bool, configuration: str) -> None:
    program = neovim(recent)
    if program is None:
        pytest.skip(f"not installed: Neovim {'from' if recent else 'before'} 0.11")
    options = ("--headless", "-i", "NONE", "-u", str(EDITORS / "neovim" / configuration))
    said = run(folder, program, *options, "-c", f"luafile {HERE / 'drive_neovim.lua'}")
    check(folder, said)


@needs("vim", ALE)
def test_vim_with_ale_does_all_in_each_text(folder: Path) -> None:
    configuration = (EDITORS / "vim" / "motion_script.vim").read_text("utf-8")
    (folder / "vimrc").write_text(f"set nocompatible\npackadd ale\nfiletype plugin on\n{configuration}", "utf-8")
    said = run(folder, "vim", "-u", "vimrc", "-es", "-i", "NONE", "-S", str(HERE / "drive_vim.vim"))
    check(folder, said)


@pytest.mark.parametrize("client", ["eglot", "lsp-mode"])
def test_emacs_takes_the_folder_of_mlmg_toml_for_the_project(folder: Path, client: str) -> None:
    if shutil.which("emacs") is None or not Path(f"/usr/share/doc/elpa-{client}").exists():
        pytest.skip(f"not installed: Emacs with {client}")
    (folder / "sub").mkdir()
    (folder / "sub" / "gestures.ms").write_text("let greet = TALK\n", "utf-8")
    root = {"eglot": "(project-root (eglot--current-project))", "lsp-mode": "(lsp--suggest-project-root)"}[client]
    configuration = str(EDITORS / "emacs" / f"motion-script-{client}.el")
    told = f'(princ (format "root: %s;" (expand-file-name {root})))'
    asked = f'(progn (setq motion-script-mode-hook nil) (find-file "sub/gestures.ms") {told})'
    said = run(folder, "emacs", "--batch", "-l", client, "-l", configuration, "--eval", asked)
    assert f"root: {folder}/;" in said, said


@pytest.mark.parametrize("client", ["eglot", "lsp-mode"])
def test_emacs_does_does_all_in_each_text(folder: Path, client: str) -> None:
    if shutil.which("emacs") is None or not Path(f"/usr/share/doc/elpa-{client}").exists():
        pytest.skip(f"not installed: Emacs with {client}")
    files = (EDITORS / "emacs" / f"motion-script-{client}.el", HERE / "drive_emacs.el", HERE / f"drive_{client}.el")
    said = run(folder, "emacs", "--batch", *(word for file in files for word in ("-l", str(file))), "-f", "drive")
    check(folder, said, client)
