"""Clients that say of themselves what VS Code, Neovim and Emacs say, by pytest-lsp: it also warns where an answer is
what such a client has not said that it understands, and a warning is a failure here.
"""

from __future__ import annotations

import asyncio
import os
import re
import sys
from collections.abc import AsyncIterator, Sequence
from itertools import count
from typing import Any

import pytest
import pytest_asyncio
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.protocol import default_converter
from pytest_lsp import LanguageClient, client_capabilities
from pytest_lsp.client import DEFAULT_CLIENT_FEATURES, register_lsp_features

from mlmg_lang.formatting.format_script import format_source
from mlmg_lang.source import Source

pytestmark = pytest.mark.asyncio(loop_scope="module")
PROFILES = {
    "visual-studio-code@v1.65": "utf-16",
    "neovim@v0.11": "utf-8",
    "neovim@v0.10": "utf-16",
    "emacs@v29": "utf-32",
}
"""By profile, the encoding of positions that it leads to."""
BEFORE = {
    "nothing": "(IDLE or ",
    "an emoji": '("😀" or ',
    "Chinese": '("走路" or ',
    "tabs": '\t("a\tb"\tor\t',
    "CRLF": 'IDLE # 😀\r\n\r\n("a" or ',
    "CR": 'IDLE\rIDLE\r("é" or ',
    "U+2028": 'IDLE # a\u2028b\n("x\u2028y" or ',
    "all of them": '# 😀\u2028走路\r\nIDLE\r\t("😀走路\u2028\t" or ',
}
OPTIONS = types.FormattingOptions(tab_size=4, insert_spaces=True)
_NUMBERS = count(1)
_LINE = re.compile(r"[^\r\n]*(?:\r\n|\r|\n|\Z)")
_LINE_END = re.compile("\r\n|\r|\n")
_CODECS = {"utf-8": ("utf-8", 1), "utf-16": ("utf-16-le", 2), "utf-32": ("utf-32-le", 4)}


class Editor:
    """A client with a profile."""

    def __init__(self, profile: str) -> None:
        self.capabilities = client_capabilities(profile)
        self.encoding = PROFILES[profile]
        self.told: asyncio.Queue[types.PublishDiagnosticsParams] = asyncio.Queue()
        self.client = LanguageClient(converter_factory=default_converter)

        def publish(params: types.PublishDiagnosticsParams) -> None:
            self.told.put_nowait(params)

        register_lsp_features(self.client, DEFAULT_CLIENT_FEATURES | {types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS: publish})

    async def start(self, *words: str) -> types.InitializeResult:
        await self.client.start_io(sys.executable, "-m", "mlmg_lang.commands.mlmg", "lsp", *words)
        return await self.client.initialize_session(
            types.InitializeParams(capabilities=self.capabilities, process_id=os.getpid())
        )

    def open(self, text: str) -> types.TextDocumentIdentifier:
        uri = f"untitled:Untitled-{next(_NUMBERS)}"
        item = types.TextDocumentItem(uri=uri, language_id="motion-script", version=1, text=text)
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
        return types.TextDocumentIdentifier(uri)

    async def diagnostics(self, document: types.TextDocumentIdentifier) -> Sequence[types.Diagnostic]:
        """Return what is said of a text: asked for by those who ask."""
        assert self.capabilities.text_document is not None
        if self.capabilities.text_document.diagnostic is not None:
            report = await self.client.text_document_diagnostic_async(types.DocumentDiagnosticParams(document))
            assert isinstance(report, types.RelatedFullDocumentDiagnosticReport)
            return report.items
        while (told := await asyncio.wait_for(self.told.get(), 60)).uri != document.uri:
            pass
        return told.diagnostics

    def lines(self, text: str) -> list[bytes]:
        return [line.encode(_CODECS[self.encoding][0]) for line in _LINE.findall(text)]

    def place(self, text: str, word: str, later: int = 0) -> types.Position:
        """Return where a word begins, for the last time, or some code points later."""
        before = text[: text.rindex(word) + later]
        lines = _LINE_END.split(before)
        codec, n_bytes = _CODECS[self.encoding]
        return types.Position(len(lines) - 1, len(lines[-1].encode(codec)) // n_bytes)

    def range(self, text: str, word: str) -> types.Range:
        return types.Range(self.place(text, word), self.place(text, word, len(word)))

    def applied(self, text: str, edits: Sequence[Any]) -> str:
        """Return a text after edits, all of the text before them."""
        codec, n_bytes = _CODECS[self.encoding]
        lines = self.lines(text)
        whole = b"".join(lines)

        def at(position: types.Position) -> int:
            return sum(map(len, lines[: position.line])) + position.character * n_bytes

        for edit in sorted(edits, key=lambda one: at(one.range.start), reverse=True):
            whole = whole[: at(edit.range.start)] + edit.new_text.encode(codec) + whole[at(edit.range.end) :]
        return whole.decode(codec)


@pytest_asyncio.fixture(loop_scope="module", scope="module", params=PROFILES)
async def editor(request: pytest.FixtureRequest, demo_library: Any) -> AsyncIterator[Editor]:
    made = Editor(request.param)
    told = await made.start("--library", str(demo_library.path))
    assert told.capabilities.position_encoding == made.encoding
    yield made
    await made.client.shutdown_session()
    await made.client.stop()


def edits_in(edit: types.WorkspaceEdit | None) -> Sequence[Any]:
    """Return the edits of the one text that an edit is of."""
    assert edit is not None
    if edit.changes is not None:
        (edits,) = edit.changes.values()
        return edits
    (change,) = edit.document_changes or ()
    assert isinstance(change, types.TextDocumentEdit)
    return change.edits


ends = pytest.mark.parametrize("end", ["", "\n", "\r\n"], ids=["no newline at the end", "LF", "CRLF"])
befores = pytest.mark.parametrize("before", BEFORE.values(), ids=BEFORE)


@befores
@ends
async def test_a_mistake_is_shown_where_it_is_and_its_fix_mends_it(editor, before, end):
    text = f"{before}WLAK) for 3 sec{end}"
    document = editor.open(text)
    (wrong,) = [one for one in await editor.diagnostics(document) if "WLAK" in one.message]
    assert (wrong.code, wrong.range) == ("MS021", editor.range(text, "WLAK"))
    context = types.CodeActionContext(diagnostics=[wrong])
    actions = await editor.client.text_document_code_action_async(
        types.CodeActionParams(document, wrong.range, context)
    )
    fix = next(one for one in actions if one.title == "Write `WALK`")
    assert editor.applied(text, edits_in(fix.edit)) == text.replace("WLAK", "WALK")


@befores
async def test_what_is_completed_takes_the_place_of_the_word_at_the_cursor(editor, before):
    text = f"{before}WAL"
    document = editor.open(text)
    found = await editor.client.text_document_completion_async(
        types.CompletionParams(document, editor.place(text, "WAL", 3))
    )
    best = found.items[0]
    assert best.label == "WALK"
    assert best.text_edit.range == editor.range(text, "WAL")
    assert editor.applied(text, [best.text_edit]) == f"{before}WALK"
    read = await editor.client.completion_item_resolve_async(best)
    said = getattr(read.documentation, "value", read.documentation)
    assert "Walk_01" in said
    assert ("**" in said) != isinstance(read.documentation, str)


@befores
async def test_what_a_name_means_is_told_where_it_stands(editor, before):
    text = f"{before}Walk_01) for 3 sec"
    document = editor.open(text)
    for later in (0, 3):
        place = editor.place(text, "Walk_01", later)
        told = await editor.client.text_document_hover_async(types.HoverParams(document, place))
        assert "Walk_01" in told.contents.value
        assert told.range == editor.range(text, "Walk_01")


@befores
@ends
async def test_a_text_is_formatted_as_on_the_command_line(editor, before, end):
    text = f"{before}WALK)   for 3   sec   # {before.splitlines()[0]}{end}"
    document = editor.open(text)
    edits = await editor.client.text_document_formatting_async(types.DocumentFormattingParams(document, OPTIONS))
    after = editor.applied(text, edits)
    assert _LINE_END.sub("\n", after) == format_source(Source(text)) != text


@befores
async def test_a_definition_is_renamed_in_all_places(editor, before):
    text = f"let stroll = WALK\r\n{before}stroll) for 3 sec\nstroll"
    document = editor.open(text)
    place = editor.place(text, "stroll) for", 2)
    if editor.capabilities.text_document.rename.prepare_support:
        told = await editor.client.text_document_prepare_rename_async(types.PrepareRenameParams(document, place))
        found = getattr(told, "range", told)
        assert found == types.Range(editor.place(text, "stroll) for"), editor.place(text, ") for"))
    edit = await editor.client.text_document_rename_async(
        types.RenameParams(text_document=document, position=place, new_name="amble")
    )
    assert editor.applied(text, edits_in(edit)) == text.replace("stroll", "amble")


async def test_an_empty_file_has_nothing_wrong_and_offers_what_may_be_written(editor):
    document, start = editor.open(""), types.Position(0, 0)
    assert not await editor.diagnostics(document)
    found = await editor.client.text_document_completion_async(types.CompletionParams(document, start))
    assert {"WALK", "repeat"} <= {one.label for one in found.items}
    assert await editor.client.text_document_hover_async(types.HoverParams(document, start)) is None
    place, context = types.Range(start, start), types.CodeActionContext(diagnostics=[])
    assert not await editor.client.text_document_code_action_async(types.CodeActionParams(document, place, context))
    assert not await editor.client.text_document_formatting_async(types.DocumentFormattingParams(document, OPTIONS))
    with pytest.raises(JsonRpcException):
        await editor.client.text_document_rename_async(
            types.RenameParams(text_document=document, position=start, new_name="x")
        )
