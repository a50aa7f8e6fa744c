from __future__ import annotations

from mlmg_lang.formatting.page import Page
from mlmg_lang.formatting.wrapping import Row


def test_a_comment_stands_behind_the_last_row_or_in_its_own() -> None:
    page = Page()
    page.comment(0, "# first", trails=True)
    page.add([Row(0, "WALK"), Row(4, "with TALK")])
    page.comment(0, "# behind", trails=True)
    page.comment(4, "# below", trails=False)
    assert page.text() == "# first\nWALK\n    with TALK  # behind\n    # below\n"


def test_empty_lines_stand_between_rows_alone() -> None:
    page = Page()
    page.blank()
    page.open(Row(0, "repeat 2 {"))
    page.blank()
    page.add([Row(4, "WALK")])
    page.blank()
    page.blank()
    page.add([Row(4, "IDLE")])
    page.blank()
    page.close(0)
    page.blank()
    assert page.text() == "repeat 2 {\n    WALK\n\n    IDLE\n}\n"


def test_what_leads_a_statement_stands_before_it_or_alone() -> None:
    page = Page()
    page.open(Row(0, "choose {"))
    page.lead_with(4, "3:")
    page.add([Row(4, "WALK")])
    page.blank()
    page.lead_with(2, "|")
    page.lead_with(4, "1:")
    page.comment(4, "# beside", trails=True)
    page.add([Row(4, "IDLE")])
    page.lead_with(2, "|")
    page.close(0)
    assert page.text() == "choose {\n    3: WALK\n  | 1:  # beside\n    IDLE\n  |\n}\n"


def test_a_semicolon_stands_behind_the_last_statement_before_its_comment() -> None:
    page = Page()
    page.add([Row(0, "(A"), Row(0, "  with")])
    page.comment(0, "# beside", trails=True)
    page.comment(0, "# below", trails=False)
    page.separate()
    assert page.text() == "(A\n  with;  # beside\n# below\n"


def test_a_page_without_rows_is_empty() -> None:
    assert Page().text() == ""
