"""Motion Script: from the text of a script to a plan, and to the motion played by it.

`compile(text, library)` gives a plan and diagnostics; `play(plan, library)` the motion and its report.
"""

from __future__ import annotations

# Not from typing: an interruption while that is imported, before a command has begun, would be a traceback.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Literal

    from mlmg_lang.catalog import Catalog
    from mlmg_lang.diagnostics import Diagnostic
    from mlmg_lang.perform import Performance
    from mlmg_lang.planning.resolved import ResolvedPlan
    from mlmg_runtime.library import Library

__all__ = ["compile", "play"]


def compile(
    text: str,
    library: Catalog,
    start: str | None = None,
    *,
    plan: Literal["greedy", "global"] = "greedy",
    seed: int = 0,
) -> tuple[ResolvedPlan | None, tuple[Diagnostic, ...]]:
    """Return the plan of a script and what is to be said of it; the plan is None if there are errors.

    Parameters
    ----------
    text : a script. library : what its names mean. start : the motion of the whole body to start in.
    plan : "greedy" chooses motions command by command; "global" over the whole script, for the least time and cost on
        the way. A script that is very long, or gains nothing by it, is planned greedily all the same (`ahead`).
    seed : of what is drawn by chance, for which "global" makes sure that it is no worse.

    Raises
    ------
    TypeError
        If `plan` is "global" and `library` has not been opened from a file.
    """
    from mlmg_lang.front_end import analyse
    from mlmg_lang.source import Source

    analysis = analyse(Source(text), library, start=start)
    if plan == "greedy" or analysis.resolved is None:
        return analysis.resolved, analysis.diagnostics
    from mlmg_lang.looking_ahead import look_ahead
    from mlmg_runtime.library import Library

    if not isinstance(library, Library):
        raise TypeError(f"planning over the whole script asks for an opened library, not for {type(library).__name__}")
    return look_ahead(analysis.resolved, library, seed).plan, analysis.diagnostics


def play(plan: ResolvedPlan | None, library: Library, seed: int = 0, feet: bool = True) -> Performance:
    """Play a plan on the library that it was compiled against; the same inputs always give the same frames.

    Parameters
    ----------
    plan : what `compile` returned; None, which it returns of a script with errors, cannot be played.
    seed : of what is drawn by chance. feet : whether planted feet are kept from sliding in transitions.

    Raises
    ------
    ValueError
        If there is no plan.
    mlmg_lang.staging.ScriptError
        If the library does not allow it.
    """
    if plan is None:
        raise ValueError("there is no plan: the script has errors, which the diagnostics that `compile` returned tell")
    from mlmg_lang.perform import perform

    return perform(plan, library, seed, feet=feet)
