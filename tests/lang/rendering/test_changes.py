from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from mlmg_lang.rendering.changes import render_changes
from mlmg_lang.source import Source


def test_a_difference_is_drawn_as_patch_reads_it() -> None:
    before, after = Source("A\nB\nC", "a.ms"), Source("A\nX\nC", "a.ms")
    assert render_changes(before, after) == (
        "--- a.ms\n+++ a.ms\n@@ -1,3 +1,3 @@\n A\n-B\n+X\n C\n\\ No newline at end of file\n"
    )


def test_the_same_text_has_no_difference() -> None:
    assert render_changes(Source("A"), Source("A")) == ""


@pytest.mark.skipif(shutil.which("patch") is None, reason="the program `patch` is absent")
@pytest.mark.parametrize(
    ("before", "after"), [("A\r\nB\r\n", "A\r\nX\r\n"), ("A\nB", "A\nX"), ("A\nB", "A\nB\n"), ("A\fx\n", "A\fy\n")]
)
def test_patch_makes_of_the_one_text_the_other(tmp_path: Path, before: str, after: str) -> None:
    (tmp_path / "a.ms").write_bytes(before.encode())
    difference = render_changes(Source(before, "a.ms"), Source(after, "a.ms"))
    subprocess.run(["patch", "--binary", "-p0"], cwd=tmp_path, input=difference.encode(), check=True)
    assert (tmp_path / "a.ms").read_bytes() == after.encode()
