"""A text that goes on with what is playing -> the explanation of what it would do from there."""

from __future__ import annotations

from mlmg_lang.analysis import Analysis
from mlmg_lang.explaining.explain import explanation_from_analysis
from mlmg_lang.explaining.explanation import Explanation
from mlmg_lang.planning.course import World
from mlmg_lang.planning.estimate import Moment
from mlmg_lang.planning.estimate import Playing as Foreseen
from mlmg_lang.session.session import Session


def explanation_from_session(session: Session, analysis: Analysis) -> Explanation:
    """Return what a text without mistakes would do, and why; nothing is played.

    Parameters
    ----------
    analysis : of the text, by the session as it is.
    """
    now = None if session.state is None else _now(session)
    return explanation_from_analysis(analysis, session.library, session.start, now=now)


def _now(session: Session) -> World:
    performer = session.stage.performer
    foreseen = []
    for one in session.playing:
        home = performer.motion(one.graph)
        # On a way round, a graph shows another motion than the one that it stays in.
        moment = Moment.AT if one.motion == home else Moment.BEGUN
        foreseen.append((one.graph, Foreseen(home, moment, held_s=0.0, frame=one.frame)))
    return World(tuple(foreseen))
