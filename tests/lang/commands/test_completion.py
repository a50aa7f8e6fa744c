"""What a shell completes."""

import os
import shutil
import subprocess

import pytest

from mlmg_lang.commands import mlmg
from mlmg_lang.commands.completion import SHELLS

_ASKED = """
eval "$SCRIPT"
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
"_shtab_$1" "$1"
printf '%s\\n' "${COMPREPLY[@]}"
"""


def completed_in_bash(script: str, *words: str) -> set[str]:
    """Return what bash offers for the last of some words."""
    environment = {**os.environ, "SCRIPT": script}
    asked = subprocess.run(
        ["bash", "-c", _ASKED, "bash", *words], env=environment, capture_output=True, text=True, check=True
    )
    return set(asked.stdout.split())


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash is installed")
@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("mlmg", "bu"), {"build"}),
        (("mlmg", "info", "--t"), {"--transitions"}),
        (("mlmg", "check", "--format", "j"), {"json"}),
        (("mlmgc", "--blend", ""), {"c1", "linear"}),
        (("mlmgc", "w"), {"walk.ms", "walks"}),
        (("mlmgc", "--library", "walk.m"), {"walk.ms"}),
        (("mlmgc", "--allow-use", "w"), {"walks"}),
    ],
)
def test_commands_options_choices_files_and_folders_are_completed(words, expected, folder, capsys) -> None:
    (folder / "walk.ms").write_text("Stand\n")
    (folder / "walks").mkdir()
    assert mlmg.main(["completion", "bash"]) == 0
    assert completed_in_bash(capsys.readouterr().out, *words) == expected


@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_is_told_of_both_commands(shell: str, capsys) -> None:
    assert mlmg.main(["completion", shell]) == 0
    text = capsys.readouterr().out
    assert all(word in text for word in ("mlmgc", "transitions", "explain", "allow-use"))
