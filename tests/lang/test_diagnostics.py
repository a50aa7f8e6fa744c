from __future__ import annotations

import pytest

from mlmg_lang.diagnostics import CODES, Diagnostic, Fix, Label, Note, Severity
from mlmg_lang.source import Span

HERE = Span(3, 4)


def test_every_code_has_a_title_and_a_severity() -> None:
    assert all(rule.title and isinstance(rule.severity, Severity) for rule in CODES.values())
    assert list(CODES) == sorted(CODES)


@pytest.mark.parametrize(
    ("fix", "title"),
    [
        (Fix(HERE, "WALK", safe=True), "write `WALK`"),
        (Fix(HERE, "", safe=True), "take it out"),
        (Fix(HERE, " ", safe=True), "take it out"),
        (Fix(Span(3, 3), " sec", safe=False), "add `sec`"),
        (Fix(HERE, "", safe=True, name="take the comment out"), "take the comment out"),
    ],
)
def test_an_edit_has_a_title_for_a_menu(fix: Fix, title: str) -> None:
    assert fix.title == title


def test_the_other_places_of_a_diagnostic_are_its_labels_and_its_notes_with_a_place() -> None:
    label, note = Label(HERE, "a"), Note("b", HERE)
    one = Diagnostic("MS021", "no", HERE, notes=(note, Note("c")), labels=(label,))
    assert one.places == (label, Label(HERE, "b"))
