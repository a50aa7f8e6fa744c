"""Which of the known names someone may have meant."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property


def normal(name: str) -> str:
    """Return a name in the form in which names are compared: NFC."""
    return unicodedata.normalize("NFC", name)


def folded(name: str) -> str:
    """Return a name without what an inexact spelling may differ in: case, `_` and `-`."""
    plain = unicodedata.normalize("NFC", normal(name).casefold())
    return plain.replace("_", "").replace("-", "") or plain


class Vocabulary:
    """Known names, made ready once to be compared with one unknown name after the other."""

    def __init__(self, known: Iterable[str]) -> None:
        """Look at all names; of those that are given twice, the first counts."""
        self.names = tuple(dict.fromkeys(known))
        self._seen = list(map(_seen, self.names))

    def nearest(self, name: str, limit: int = 3) -> tuple[str, ...]:
        """Return the names that look most like `name`, the most like first; none if none looks like it."""
        from rapidfuzz import fuzz, process

        wanted = _seen(name)
        found = process.extract(wanted, self._seen, scorer=fuzz.ratio, limit=limit, score_cutoff=65)
        return tuple(self.names[at] for _, _, at in found) or self._of_letters.get(_letters(wanted), ())[:limit]

    @cached_property
    def _of_letters(self) -> Mapping[str, tuple[str, ...]]:
        """The names by their letters, for short words with two of them swapped."""
        found: dict[str, list[str]] = {}
        for name in self.names:
            found.setdefault(_letters(folded(name)), []).append(name)
        return {letters: tuple(names) for letters, names in found.items()}


def nearest(name: str, known: Iterable[str], limit: int = 3) -> tuple[str, ...]:
    """Return the known names that look most like `name`, the most like first; none if none looks like it."""
    return Vocabulary(known).nearest(name, limit)


def _seen(name: str) -> str:
    """Return a name as it looks: without what is ignored in names, and wide letters like others."""
    return folded(unicodedata.normalize("NFKC", name))


def _letters(word: str) -> str:
    return "".join(sorted(word))


def is_slip_of(word: str, meant: str) -> bool:
    """Return whether a word is one slip away: a letter more, less or other, or the same in another order."""
    from rapidfuzz.distance import OSA

    if word == meant:
        return False
    return sorted(word) == sorted(meant) or OSA.distance(word, meant, score_cutoff=1) <= 1


def counted(number: int, what: str) -> str:
    """Return how many there are of something, in words: 1 clip, 2 clips."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def listed(names: Iterable[str], last: str = "and") -> str:
    """Return names in backquotes as a sentence has them: `A`, `B` and `C`."""
    return joined((f"`{name}`" for name in names), last)


def some(names: Sequence[str], limit: int = 6) -> str:
    """Return names as `listed` does, but only the first of many."""
    if len(names) <= limit:
        return listed(names)
    return joined([f"`{name}`" for name in names[:limit]] + [f"{len(names) - limit} more"])


def joined(parts: Iterable[str], last: str = "and") -> str:
    """Return parts as a sentence has them: A, B and C."""
    *most, final = parts
    return f"{', '.join(most)} {last} {final}" if most else final
