"""What is offered above the commands of a text."""

from __future__ import annotations

import json

import pytest
from lsprotocol import types

from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.ide.lenses import lenses
from mlmg_lang.source import Source
from mlmg_lsp.client import Client
from mlmg_lsp.features.code_lens import code_lens
from mlmg_lsp.open_text import Snapshot

PARAMS = types.CodeLensParams(types.TextDocumentIdentifier("untitled:x"))
TEXT = "let x = WALK\r\n# 😀\nIDLE; x\r\n\nWALK for 2 sec\nrepeat 2 {\n\tTALK\n\n  x; IDLE\n}\nWALK # 😀\n"
REST = "IDLE\nwait 1 sec\n"
"""With `SWING_HAND` behind it, what `IDLE` can be is less."""


def told(snapshot: Snapshot) -> list[tuple[dict[str, int], str, str, list[object]]]:
    found = json.loads(code_lens(snapshot, PARAMS).text)
    assert all(one["range"]["start"] == one["range"]["end"] for one in found)
    commands = [(one["range"]["start"], one["command"]) for one in found]
    return [(at, command["title"], command["command"], command["arguments"]) for at, command in commands]


def wanted(snapshot: Snapshot, place) -> list[tuple[dict[str, int], str, str, list[object]]]:
    text, encoding = snapshot.analysis.source.text, snapshot.client.encoding
    found = []
    for one in lenses(snapshot.analysis):
        at = place(text, one.span.start, encoding)
        about = {"uri": "untitled:x", **({} if one.about is None else {"position": at})}
        found.append((at, one.title, f"mlmg.{one.deed.value}", [about]))
    return found


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
def test_after_any_edits_they_are_those_of_a_fresh_server(snapshots, afresh, position, encoding):
    for snapshot in snapshots(encoding, 40):
        found = told(snapshot)
        assert found == wanted(afresh(snapshot), position), snapshot.analysis.source.text


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
def test_after_edits_before_and_in_what_is_sound_they_are_those_of_a_fresh_server(
    afresh, position, demo_library, encoding
):
    kept: dict[str, object] = {}
    analysis = analyse(Source(TEXT), demo_library)
    texts = (
        TEXT,
        f"\n\n{TEXT}",
        TEXT.replace("let x = WALK", "let x = IDLE"),
        TEXT.replace("repeat 2 {", "repeat 3 {\n"),
        TEXT.replace("\tTALK", "\t\tWALK"),
        TEXT.replace("WALK for", "WLAK for"),
        TEXT,
        TEXT.replace("IDLE; x", "Idle_01; x"),
    )
    for version, text in enumerate((*texts, f"{TEXT}{REST}", f"{TEXT}{REST}SWING_HAND\n")):
        analysis = analyse_again(analysis, Source(text))
        snapshot = Snapshot("untitled:x", version, analysis, None, Client(encoding), {}, (), kept)
        found = told(snapshot)
        assert found == wanted(afresh(snapshot), position)
        assert len(found) == 9 + ("IDLE\nwait" in text) + ("SWING_HAND" in text) - ("WLAK" in text)
