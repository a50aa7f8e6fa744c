import tomllib
from collections.abc import Iterator
from typing import Any

import pytest

from mlmg_runtime.building.toml_lines import key_lines

TEXT = """\
# a comment = 1
[library]
clips = [
  ["a.bvh", "b"], # ]
  "x = 3",
  [ "]" ]
]
"frame rate" = 30

[[graph]]
name = "Full-Body" # window = 3
[graph.weights]
Hand_L = 2.0
[[graph]]
  name = "Upper-Body"
window=20
[tags."Full-Body"]
'hand on hip' = ["X"]
"走路" = ["Y"]
[clips]
Boxing.frames = [1, 2]
note = \"\"\"
[graph]
"quoted" = 4 \\\\\"\"\"
told = '''
  up = "z'''
last = { a = [ 1 ] }
"""


def paths(value: Any, at: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Yield the path of every table and key of a parsed document."""
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in entries:
        if isinstance(value, dict) or isinstance(inner, dict):
            yield (*at, key)
            yield from paths(inner, (*at, key))


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("library",), 2),
        (("library", "clips"), 3),
        (("library", "frame rate"), 8),
        (("graph", 0), 10),
        (("graph", 0, "name"), 11),
        (("graph", 0, "weights"), 12),
        (("graph", 0, "weights", "Hand_L"), 13),
        (("graph", 1), 14),
        (("graph", 1, "name"), 15),
        (("graph", 1, "window"), 16),
        (("tags", "Full-Body"), 17),
        (("tags", "Full-Body", "hand on hip"), 18),
        (("tags", "Full-Body", "走路"), 19),
        (("clips",), 20),
        (("clips", "Boxing", "frames"), 21),
        (("clips", "note"), 22),
        (("clips", "told"), 25),
        (("clips", "last"), 27),
    ],
)
def test_every_key_is_found_on_its_line(path: tuple[str | int, ...], line: int) -> None:
    assert key_lines(TEXT)[path] == line


def test_no_path_is_made_up() -> None:
    assert set(key_lines(TEXT)) <= set(paths(tomllib.loads(TEXT)))
