"""The colours of every picture, red, green and blue from 0 to 255."""

from __future__ import annotations

BACKGROUND = (21, 23, 27)
FLOOR = (58, 62, 69)
GRID = (104, 110, 120)
BODY = (222, 219, 212)
TEXT = (236, 237, 239)
FAINT_TEXT = (150, 156, 166)

# One for each graph that runs, in the order of the tracks: the root graph is pale, those below it glow.
ACCENTS = (
    (138, 180, 216),
    (240, 168, 92),
    (140, 205, 148),
    (206, 150, 226),
    (240, 128, 128),
    (110, 208, 214),
)


def accent(index: int) -> tuple[int, int, int]:
    """Return the colour of the graph at `index` in the tracks."""
    return ACCENTS[index % len(ACCENTS)]
