"""The icon of the extension for VS Code: the figure of the tour as it walks.

    python docs/recording/icon.py STRIP.png ICON.png

The strip is of one moment, as `mlmg view --frames 250` writes it.
"""

from __future__ import annotations

import sys
from pathlib import Path

from PIL import Image

SIZE, TOP, HEIGHT = 256, 32, 300


def icon(strip: Image.Image) -> Image.Image:
    """Return the figure in a square, with the floor drawn on to both sides."""
    figure = strip.convert("RGB").crop((0, TOP, strip.width, TOP + HEIGHT))
    beside = (HEIGHT - figure.width) // 2
    square = Image.new("RGB", (HEIGHT, HEIGHT))
    for edge, at in ((0, 0), (figure.width - 1, beside + figure.width)):
        square.paste(figure.crop((edge, 0, edge + 1, HEIGHT)).resize((HEIGHT - beside - figure.width, HEIGHT)), (at, 0))
    square.paste(figure, (beside, 0))
    return square.resize((SIZE, SIZE), Image.Resampling.LANCZOS)


def main() -> None:
    """Write the icon."""
    with Image.open(sys.argv[1]) as strip:
        icon(strip).save(Path(sys.argv[2]), optimize=True)


if __name__ == "__main__":
    main()
