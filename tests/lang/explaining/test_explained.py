"""What is told of the scripts in golden/explained, as text, JSON and a flowchart; rewritten with --update-golden.

Those whose names begin with `ahead` are planned over the whole script.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from mlmg_lang.explaining.explanation import Explanation
from mlmg_lang.explaining.mermaid import render_mermaid
from mlmg_lang.explaining.plan_json import plan_to_json
from mlmg_lang.explaining.text import render_text

FOLDER = Path(__file__).parents[2] / "golden" / "explained"
SCRIPTS = sorted(FOLDER.glob("*.ms"))


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
@pytest.mark.parametrize(
    ("ending", "render"),
    [("txt", render_text), ("json", plan_to_json), ("mmd", render_mermaid)],
    ids=["text", "json", "mermaid"],
)
def test_a_script_is_explained_as_before(
    path: Path,
    ending: str,
    render: Callable[[Explanation], str],
    explained: Callable[..., Explanation],
    golden: Callable[[Path, str], None],
) -> None:
    told = explained(path.read_text(encoding="utf-8"), look_ahead=path.stem.startswith("ahead"))
    golden(path.with_suffix(f".{ending}"), render(told))


def test_there_are_scripts() -> None:
    assert len(SCRIPTS) >= 3
