"""What was entered before, by library: a file in the user's folder for what programs remember."""

from __future__ import annotations

import hashlib
import os
import sys
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from mlmg_lang.libraries import DEMO, is_demo
from mlmg_lang.parsing.tokenize import tokenize
from mlmg_lang.parsing.tokens import NAMES
from mlmg_lang.source import Source


def history_path(library: Path) -> Path:
    """Return the file that keeps what was entered for a library; MLMG_HISTORY names another folder for such files."""
    folder = Path(os.environ.get("MLMG_HISTORY") or state_folder() / "history")
    name = library_name(library)
    place = "" if is_demo(library) else f"-{hashlib.sha256(os.fsencode(library.absolute())).hexdigest()[:8]}"
    return folder / f"{name}{place}.txt"


def state_folder() -> Path:
    """Return the user's folder for what programs remember from one run to the next."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "mlmg"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "mlmg"
    return Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state") / "mlmg"


def library_name(library: Path) -> str:
    """Return what a library is called: its file's stem, `demo` for the demo library."""
    return DEMO if is_demo(library) else library.stem


def uses_of(entries: Iterable[str]) -> Counter[str]:
    """Return how often each name has been entered."""
    return Counter(
        token.text.strip('"') for entry in entries for token in tokenize(Source(entry)) if token.type in NAMES
    )
