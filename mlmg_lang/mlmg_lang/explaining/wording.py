"""Numbers and lists of an explanation, in words."""

from __future__ import annotations

from collections.abc import Sequence

from mlmg_lang.planning.estimate import Estimate
from mlmg_lang.spelling import joined


def seconds(estimate: Estimate) -> str:
    """Return an estimate in words: on average, and between what it lies."""
    mean = f"{estimate.mean:.1f} s"
    return mean if estimate.is_exact else f"about {mean} ({estimate.least:.1f} to {estimate.most:.1f})"


def share(chance: float) -> str:
    """Return a chance in per cent; what is not quite nothing or everything does not look like it."""
    per_cent = round(100 * chance)
    if per_cent == 0 and chance > 0:
        return "under 1%"
    return "over 99%" if per_cent == 100 and chance < 1.0 else f"{per_cent}%"


def fit_number(oms: float) -> str:
    """Return an overall motion similarity with as many digits as say something."""
    return f"{oms:,.0f}" if oms >= 1000 else f"{oms:.1f}"


def plain(number: float | None) -> str:
    """Return a number without digits that are zero."""
    return f"{number or 0.0:g}"


def listed(names: Sequence[str], last: str = "and") -> str:
    """Return names in a row of words."""
    return joined(names, last) if names else "nothing"
