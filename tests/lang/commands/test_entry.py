"""How the commands begin: what Ctrl-C does before they have begun, and standard streams that are closed."""

import ast
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

# Ctrl-C while a module is imported: whoever looks for it is interrupted.
_INTERRUPTED_AT = """
import sys

class Interrupts:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            raise KeyboardInterrupt

sys.modules.pop({module!r}, None)
sys.meta_path.insert(0, Interrupts())
sys.argv[1:] = {arguments!r}
from mlmg_lang.commands.entry import {command}
sys.exit({command}())
"""


def interrupted_at(module: str, command: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    program = _INTERRUPTED_AT.format(module=module, command=command, arguments=list(arguments))
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    "module", ["mlmg_lang.commands.mlmgc", "argparse", "pathlib", "mlmg_lang.commands.console", "mlmg_runtime.errors"]
)
def test_mlmgc_that_is_interrupted_while_it_starts_leaves_quietly(module: str) -> None:
    ended = interrupted_at(module, "mlmgc", "scene.ms", "-o", "out.bvh")
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "", "mlmgc: interrupted\n")


@pytest.mark.parametrize("module", ["mlmg_lang.commands.mlmg", "argparse", "mlmg_lang.commands.check"])
def test_mlmg_that_is_interrupted_while_it_starts_leaves_quietly(module: str) -> None:
    ended = interrupted_at(module, "mlmg", "check", "scene.ms")
    assert (ended.returncode, ended.stdout, ended.stderr) == (130, "", "mlmg: interrupted\n")


def test_little_is_imported_before_an_interruption_is_caught() -> None:
    program = "import sys; before = set(sys.modules); import mlmg_lang.commands.entry; print(set(sys.modules) - before)"
    found = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert ast.literal_eval(found) == {"__future__", "mlmg_lang", "mlmg_lang.commands", "mlmg_lang.commands.entry"}


def test_the_commands_begin_there() -> None:
    scripts = tomllib.loads(Path(__file__).parents[3].joinpath("pyproject.toml").read_text())["project"]["scripts"]
    assert scripts == {"mlmgc": "mlmg_lang.commands.entry:mlmgc", "mlmg": "mlmg_lang.commands.entry:mlmg"}


@pytest.mark.parametrize(
    ("closed", "arguments", "code"),
    [
        (">&-", ["mlmg", "rule", "MS021"], 0),
        (">&-", ["mlmg", "check", "-"], 0),
        ("<&-", ["mlmgc", "-", "-o", "out.bvh"], 1),
        ("2>&-", ["mlmgc", "none.ms", "-o", "out.bvh"], 2),
    ],
)
def test_a_standard_stream_that_is_closed_is_as_if_empty(
    closed: str, arguments: list[str], code: int, tmp_path
) -> None:
    command = ["sh", "-c", f'exec "$@" {closed}', "sh", sys.executable, "-m", f"mlmg_lang.commands.{arguments[0]}"]
    ended = subprocess.run(
        [*command, *arguments[1:]], capture_output=True, stdin=subprocess.DEVNULL, cwd=tmp_path, check=False
    )
    assert ended.returncode == code
    assert b"Traceback" not in ended.stderr


_ENDED_WHILE_WRITING = """
import os, signal, sys
from mlmg_lang.commands import entry, mlmgc
from mlmg_runtime.files import atomic_output

def main():
    with atomic_output("out.bvh") as beside:
        beside.write_text("half")
        os.kill(os.getpid(), signal.{name})
        print("written")

mlmgc.main = main
sys.exit(entry.mlmgc())
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows ends processes without telling them")
@pytest.mark.parametrize(("name", "code"), [("SIGTERM", 143), ("SIGHUP", 129), ("SIGINT", 130)])
def test_a_command_that_is_ended_while_it_writes_leaves_nothing(name: str, code: int, tmp_path: Path) -> None:
    command = [sys.executable, "-c", _ENDED_WHILE_WRITING.format(name=name)]
    ended = subprocess.run(command, capture_output=True, cwd=tmp_path, check=False)
    assert (ended.returncode, ended.stdout) == (code, b"")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(shutil.which("nohup") is None, reason="no nohup here")
def test_a_command_under_nohup_outlives_its_terminal(tmp_path: Path) -> None:
    command = ["nohup", sys.executable, "-c", _ENDED_WHILE_WRITING.format(name="SIGHUP")]
    ended = subprocess.run(command, capture_output=True, cwd=tmp_path, check=False)
    assert b"written" in ended.stdout
    assert (tmp_path / "out.bvh").read_text() == "half"
