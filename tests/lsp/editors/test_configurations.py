"""What editors are given: that it can be read, says the same as the grammar, and is what the documentation shows."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from mlmg_grammar import load, reserved_words

ROOT = Path(__file__).parents[3]
EDITORS = ROOT / "lsp" / "editors"
VSCODE = EDITORS / "vscode"
SNIPPETS = (
    *("neovim/motion_script_0_7.lua", "neovim/motion_script_0_11.lua", "emacs/motion-script-eglot.el"),
    *("emacs/motion-script-lsp-mode.el", "vim/motion_script.vim", "helix/languages.toml", "kate/settings.json"),
    "sublime/LSP.sublime-settings",
)


def package() -> dict[str, Any]:
    found: dict[str, Any] = json.loads((VSCODE / "package.json").read_text("utf-8"))
    return found


def source() -> str:
    return "".join(path.read_text("utf-8") for path in sorted((VSCODE / "src").glob("*.ts")))


@pytest.mark.parametrize("name", SNIPPETS)
def test_the_documentation_shows_each_configuration_as_it_is(name: str) -> None:
    page = (ROOT / "docs" / "editors.md").read_text("utf-8")
    assert (EDITORS / name).read_text("utf-8") in page


@pytest.mark.parametrize("name", SNIPPETS)
def test_each_configuration_starts_the_server_over_standard_input_and_output(name: str) -> None:
    text = (EDITORS / name).read_text("utf-8")
    assert re.search(r"mlmg\W+lsp\W+--stdio|mlmg[\s\S]*%e lsp --stdio|\"mlmg\"\s+args = \[\"lsp\", \"--stdio\"\]", text)


def test_the_configurations_that_are_data_can_be_read() -> None:
    helix = tomllib.loads((EDITORS / "helix/languages.toml").read_text("utf-8"))
    assert helix["language"][0]["language-servers"] == list(helix["language-server"])
    kate = json.loads((EDITORS / "kate/settings.json").read_text("utf-8"))
    mode = ElementTree.parse(EDITORS / "kate/motion-script.xml").getroot().attrib["name"]
    assert re.fullmatch(kate["servers"]["motion-script"]["highlightingModeRegex"], mode)
    sublime = json.loads((EDITORS / "sublime/LSP.sublime-settings").read_text("utf-8"))
    assert sublime["clients"]["mlmg"]["selector"] == "source.motion-script"


def test_editors_with_a_grammar_of_their_own_know_the_words_of_the_language() -> None:
    words = sorted(reserved_words(load()))
    kate = ElementTree.parse(EDITORS / "kate/motion-script.xml").getroot().iter("item")
    assert sorted(item.text or "" for item in kate) == words
    sublime = (EDITORS / "sublime/Motion Script.sublime-syntax").read_text("utf-8")
    listed = re.search(r"\(\?:(with\|[a-z|]+)\)", sublime)
    assert listed is not None
    assert sorted(listed[1].split("|")) == words


def test_the_extension_registers_each_command_that_it_offers() -> None:
    offered = {one["command"].removeprefix("motionScript.") for one in package()["contributes"]["commands"]}
    assert offered == set(re.findall(r'register\("(\w+)"', source()))


def test_the_extension_reads_each_setting_that_it_has_and_no_other() -> None:
    settings = {name.removeprefix("mlmg.") for name in package()["contributes"]["configuration"]["properties"]}
    # The client library reads the trace by the id of the client.
    assert settings == {*re.findall(r'kept\.get<[^(]+>\("([\w.]+)"\)', source()), "trace.server"}


def test_the_extension_copies_its_grammar_from_the_language() -> None:
    contributes = package()["contributes"]
    wanted = [contributes["grammars"][0]["path"], contributes["languages"][0]["configuration"]]
    copying = (VSCODE / "copy-grammar.mjs").read_text("utf-8")
    copied = {target: ROOT / origin for origin, target in re.findall(r'\["(.+?)", "(.+?)"\]', copying)}
    assert all(path.removeprefix("./") in copied for path in wanted)
    assert all(path.is_file() for path in copied.values())
    grammar = json.loads(copied[wanted[0].removeprefix("./")].read_text("utf-8"))
    assert grammar["scopeName"] == contributes["grammars"][0]["scopeName"]


def test_the_extension_has_the_pages_of_its_walkthrough_and_exact_versions() -> None:
    steps = package()["contributes"]["walkthroughs"][0]["steps"]
    assert all((VSCODE / step["media"]["markdown"]).is_file() for step in steps)
    assert all(re.fullmatch(r"\d+\.\d+\.\d+", version) for version in package()["devDependencies"].values())
