from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mlmg_lang.diagnostics import CODES, Diagnostic, Fix, Label
from mlmg_lang.rendering import render_sarif
from mlmg_lang.source import Source, Span

SOURCE = Source("IDLE\n走 WLAK", "my scripts/stroll.ms", (Source("let X = WALK", "b.ms"),))
ONE = Diagnostic(
    "MS021",
    "no `WLAK`",
    Span(7, 11),
    "there is `WALK`",
    fixes=(Fix(Span(7, 11), "WALK", safe=False),),
    labels=(Label(Span(20, 24), "it is here"),),
)
REQUIRED = {
    "runs": {"tool"},
    "driver": {"name"},
    "rules": {"id"},
    "results": {"message"},
    "relatedLocations": {"physicalLocation"},
    "fixes": {"artifactChanges"},
    "artifactChanges": {"artifactLocation", "replacements"},
    "replacements": {"deletedRegion"},
    "shortDescription": {"text"},
    "fullDescription": {"text"},
    "help": {"text"},
    "message": {"text"},
    "physicalLocation": {"artifactLocation"},
    "insertedContent": {"text"},
}
"""What the schema of SARIF 2.1.0 asks of the objects that a property of this name holds, here."""


def log(*checked: tuple[Source, list[Diagnostic]]) -> Any:
    return json.loads(render_sarif(checked))


def results(*checked: tuple[Source, list[Diagnostic]]) -> Any:
    return log(*checked)["runs"][0]["results"]


def objects(value: Any, name: str = "") -> list[tuple[str, Any]]:
    """Return every object in a JSON value, with the name of the property that it is in."""
    if isinstance(value, list):
        return [found for part in value for found in objects(part, name)]
    if not isinstance(value, dict):
        return []
    return [(name, value), *(found for key, part in value.items() for found in objects(part, key))]


def test_every_object_has_what_the_schema_requires() -> None:
    found = objects(log((SOURCE, [ONE, Diagnostic("MS044", "no", None), Diagnostic("MS047", "x", Span(0, 4))])))
    assert {name for name, _ in found} >= set(REQUIRED)
    for name, value in found:
        assert set(value) >= REQUIRED.get(name, set()), (name, value)
        assert None not in value.values(), (name, value)


def test_the_log_says_its_version_its_tool_and_how_columns_count() -> None:
    told = log((SOURCE, [ONE]))
    assert told["version"] == "2.1.0"
    assert told["$schema"].endswith("sarif-2.1.0.json")
    (run,) = told["runs"]
    assert run["columnKind"] == "unicodeCodePoints"
    assert run["tool"]["driver"]["name"] == "mlmg"


def test_a_result_has_its_rule_its_place_and_its_message() -> None:
    (result,) = results((SOURCE, [ONE]))
    assert (result["ruleId"], result["ruleIndex"], result["level"]) == ("MS021", 0, "error")
    assert result["message"] == {"text": "no `WLAK`\nhelp: there is `WALK`"}
    assert result["locations"] == [
        {
            "physicalLocation": {
                "artifactLocation": {"uri": "my%20scripts/stroll.ms", "uriBaseId": "%SRCROOT%"},
                "region": {"startLine": 2, "startColumn": 3, "endLine": 2, "endColumn": 7},
            }
        }
    ]


def test_a_label_is_a_related_place_in_its_own_file() -> None:
    (result,) = results((SOURCE, [ONE]))
    (related,) = result["relatedLocations"]
    assert related["message"] == {"text": "it is here"}
    assert related["physicalLocation"]["artifactLocation"]["uri"] == "b.ms"
    assert related["physicalLocation"]["region"]["startColumn"] == 9


def test_an_edit_is_a_change_of_its_file() -> None:
    (result,) = results((SOURCE, [ONE]))
    (fix,) = result["fixes"]
    assert fix["description"] == {"text": "write `WALK`"}
    assert fix["properties"] == {"applicability": "unsafe"}
    assert fix["artifactChanges"][0]["replacements"] == [
        {
            "deletedRegion": {"startLine": 2, "startColumn": 3, "endLine": 2, "endColumn": 7},
            "insertedContent": {"text": "WALK"},
        }
    ]


def test_each_result_points_to_the_rule_of_its_code() -> None:
    told = log((SOURCE, [ONE, Diagnostic("MS020", "x", Span(0, 1)), ONE]))["runs"][0]
    rules = told["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == ["MS020", "MS021"]
    assert [rules[result["ruleIndex"]]["id"] for result in told["results"]] == ["MS021", "MS020", "MS021"]


def test_every_code_has_a_level_and_a_text() -> None:
    told = log((SOURCE, [Diagnostic(code, "m", None) for code in CODES]))["runs"][0]
    for rule in told["tool"]["driver"]["rules"]:
        assert rule["defaultConfiguration"]["level"] in ("error", "warning", "note")
        assert rule["fullDescription"]["text"]


def test_a_file_elsewhere_has_an_absolute_address(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "in").mkdir()
    monkeypatch.chdir(tmp_path / "in")
    (result,) = results((Source("A", str(tmp_path / "a b.ms")), [Diagnostic("MS044", "m", None)]))
    assert result["locations"] == [{"physicalLocation": {"artifactLocation": {"uri": (tmp_path / "a b.ms").as_uri()}}}]


def test_nothing_wrong_is_a_log_without_results() -> None:
    assert results((SOURCE, [])) == []
