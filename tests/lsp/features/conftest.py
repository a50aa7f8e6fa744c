"""Texts as editors change them, and what is known of each, as the server has it."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.planning.names import Names
from mlmg_lang.source import Source
from mlmg_lsp.client import Client
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.positions import Encoding
from mlmg_runtime.library import Library

BITS = (
    *("WALK for 3 sec\n", "WLAK\n", "let x = WALK with Upper-Body TALK\n", "x\n", "let y(a, b = 2 sec) = a for b\n"),
    *("repeat 2 {\n  WALK\n", "}\n", "choose {\n| 2: IDLE\n| WALK\n}\n", "with Upper-Body TALK", "( ", ")"),
    *("\r", "\n", "\n\n\n", "\r\n", "😀", "走路", "\t", "\u2028", "\x0c", "# c 😀 \n", "# one\n# two\n", '"', " "),
    *("; IDLE", "y(b = 1 sec, a = WALK)\n", "IDLE  for 1 sec\n", "IDLE; end Upper-Body\n"),
)
BEGINNING = "let x = WALK\r\n# 😀\nIDLE\r\n\nWALK for 2 sec\nx; x\nrepeat 2 {\n\tTALK\n}\n" * 3


def edited(draw: random.Random, text: str) -> str:
    """Return a text after an edit: something is typed, taken out or pasted, or all line ends become others."""
    start = draw.randint(0, len(text))
    match draw.randrange(12):
        case 0 | 1 | 2 | 3 | 4 | 5:
            return text[:start] + draw.choice(BITS) + text[start:]
        case 6 | 7 | 8 | 9:
            return text[:start] + draw.choice(("", *BITS)) + text[start + draw.randint(1, 12) :]
        case 10:
            return text[:start] + "".join(draw.choices(BITS, k=6)) + text[start:]
    return text.replace("\r\n", "\n").replace("\r", "\n").replace("\n", draw.choice(("\n", "\r\n", "\r")))[:1500]


@pytest.fixture
def snapshots(demo_library: Library) -> Callable[[Encoding, int], Iterator[Snapshot]]:
    """Return a function: how a client counts, and how many edits -> what is known of the text after each of them."""

    def found(encoding: Encoding, n_edits: int) -> Iterator[Snapshot]:
        draw, text = random.Random(encoding), BEGINNING
        analysis, kept = analyse(Source(text), demo_library), dict[str, Any]()
        for version in range(n_edits):
            yield Snapshot("untitled:x", version, analysis, None, Client(encoding), {}, (), kept, version + 1)
            text = edited(draw, text)
            analysis = analyse_again(analysis, Source(text))

    return found


@pytest.fixture
def known(demo_library: Library) -> Callable[[str], Snapshot]:
    """Return a function: a text -> what is known of it."""

    def found(text: str) -> Snapshot:
        return Snapshot("untitled:x", 0, analyse(Source(text), demo_library), None, Client("utf-16"))

    return found


@pytest.fixture
def afresh() -> Callable[[Snapshot], Snapshot]:
    """Return a function: what is known of a text -> the same, with nothing kept from the texts before it."""

    def found(snapshot: Snapshot) -> Snapshot:
        known = snapshot.analysis
        assert isinstance(known.question.names, Names)
        again = analyse(Source(known.source.text), known.question.catalog)
        return Snapshot(snapshot.uri, snapshot.version, again, None, snapshot.client)

    return found


@pytest.fixture
def position() -> Callable[[str, int, str], dict[str, int]]:
    """Return a function: a text, an offset and an encoding -> where that is, worked out in the plainest way."""

    def found(text: str, offset: int, encoding: str) -> dict[str, int]:
        before = text[:offset]
        if before.endswith("\r") and text[offset : offset + 1] == "\n":
            before = before[:-1]
        lines = before.replace("\r\n", "\n").replace("\r", "\n").split("\n")
        if before != text[:offset]:
            lines[-1] += "\r"
        size = {"utf-8": 1, "utf-16": 2, "utf-32": 4}[encoding]
        name = encoding if size == 1 else f"{encoding}-le"
        return {"line": len(lines) - 1, "character": len(lines[-1].encode(name)) // size}

    return found
