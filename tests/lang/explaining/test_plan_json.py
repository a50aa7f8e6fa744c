"""Explanations as JSON: read back they are equal, and the schema in the package says what is in them."""

from __future__ import annotations

import json
from importlib.resources import files

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mlmg_lang.explaining.plan_json import VERSION, plan_from_json, plan_to_json
from mlmg_lang.explaining.plan_schema import plan_schema

jsonschema = pytest.importorskip("jsonschema")
SCRIPT = "IDLE for 1 sec\nrepeat 2 { WALK and TALK\nchoose { end Upper-Body | wait 1 cycles } }\nnot IDLE"


def schema() -> dict[str, object]:
    text = (files("mlmg_lang.explaining") / "plan.schema.json").read_text(encoding="utf-8")
    return json.loads(text)


@given(data=st.data())
def test_an_explanation_read_back_from_json_is_equal(data, explanations):
    told = data.draw(explanations)
    text = plan_to_json(told)
    assert plan_from_json(text) == told
    assert plan_to_json(plan_from_json(text)) == text


def test_the_explanation_of_a_script_read_back_from_json_is_equal(explained, demo_library):
    for told in (explained(SCRIPT), explained("WALK and TALK\nIDLE", demo_library, seed=1, look_ahead=True)):
        assert plan_from_json(plan_to_json(told)) == told


@given(data=st.data())
def test_the_schema_allows_every_explanation(data, explanations):
    jsonschema.validate(json.loads(plan_to_json(data.draw(explanations))), schema())


def test_the_schema_is_itself_in_order():
    jsonschema.validators.validator_for(schema()).check_schema(schema())


def test_the_schema_in_the_package_is_that_of_the_code(golden):
    path = files("mlmg_lang.explaining") / "plan.schema.json"
    golden(path, json.dumps(plan_schema(), indent=1) + "\n")


@pytest.mark.parametrize(
    "spoil",
    [
        lambda plan: plan.pop("start"),
        lambda plan: plan.update(extra=1),
        lambda plan: plan.update(version=VERSION + 1),
        lambda plan: plan["statements"][0].update(kind="let"),
        lambda plan: plan["statements"][0]["arrives"].append(1.0),
        lambda plan: plan["statements"][0]["place"].update(span=[1, 1, 1]),
        lambda plan: plan["statements"][0]["layers"][0]["candidates"][0].update(chance="much"),
    ],
)
def test_what_is_no_explanation_is_refused_by_the_schema_and_the_reader(spoil, explained):
    plan = json.loads(plan_to_json(explained(SCRIPT)))
    spoil(plan)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(plan, schema())
    if "extra" not in plan:
        with pytest.raises(ValueError, match=r"expected .*, found|missing"):
            plan_from_json(json.dumps(plan))


def test_what_is_missing_is_told_with_its_place(explained):
    plan = json.loads(plan_to_json(explained(SCRIPT)))
    del plan["statements"][1]["body"][0]["cost"]
    with pytest.raises(ValueError, match=r"plan\.statements\[1\]\.body\[0\]: cost missing"):
        plan_from_json(json.dumps(plan))


def test_every_part_of_the_schema_is_described():
    told = plan_schema()
    assert told["description"]
    assert all(part["description"] for part in told["$defs"].values())
    assert told["$defs"]["Candidate"]["properties"]["chance"]["description"] == "that it is taken"
    assert "own" in told["$defs"]["Part"]["properties"]["runs"]["description"]


def test_json_keeps_letters_of_any_script(explained):
    assert "走路" in plan_to_json(explained('let "走路" = WALK\n"走路" for 1 sec'))
