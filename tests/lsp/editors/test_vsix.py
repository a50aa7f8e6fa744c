"""The extension for VS Code builds, and the editor's grammar reads scripts as it should."""

import os
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

VSCODE = Path(__file__).parents[3] / "lsp" / "editors" / "vscode"
PACKAGED = VSCODE.parents[2] / "dist" / "motion-script.vsix"
VSCODE_NEEDS = {"CODE_SERVER": "code-server", "CHROMIUM": "chromium"}
needs_tools = pytest.mark.skipif(
    shutil.which("npm") is None or not (VSCODE / "node_modules").is_dir(),
    reason="the extension's tools are not installed: `make vsix` installs them",
)
needs_vscode = pytest.mark.skipif(
    not all(os.environ.get(name) or shutil.which(command) for name, command in VSCODE_NEEDS.items())
    or not PACKAGED.is_file(),
    reason="a real VS Code is tried by `make test-vscode` where code-server and Chromium are installed",
)


def npm(*arguments: str) -> None:
    environment = {**os.environ, "npm_config_update_notifier": "false"}
    done = subprocess.run(["npm", *arguments], cwd=VSCODE, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@needs_tools
def test_the_tests_of_the_extension_itself_pass() -> None:
    npm("test")


@needs_tools
def test_the_extension_is_packaged_with_all_that_it_needs_and_nothing_else(tmp_path: Path) -> None:
    packed = tmp_path / "motion-script.vsix"
    npm("exec", "--", "vsce", "package", "--no-dependencies", "--allow-missing-repository", "--out", str(packed))
    with zipfile.ZipFile(packed) as archive:
        names = {name.removeprefix("extension/") for name in archive.namelist() if name.startswith("extension/")}
    pages = {f"walkthrough/{page.name}" for page in (VSCODE / "walkthrough").glob("*.md")}
    grammars = {"syntaxes/motion-script.tmLanguage.json", "syntaxes/language-configuration.json"}
    wheels = {f"wheel/{wheel.name}" for wheel in (VSCODE / "wheel").glob("*.whl")}
    assert names == {
        "package.json",
        "readme.md",
        "LICENSE.txt",
        "icon.png",
        "dist/extension.js",
        *pages,
        *grammars,
        *wheels,
    }


@needs_tools
@needs_vscode
def test_in_a_real_vs_code_a_mistake_is_told_and_mended_names_are_offered_and_the_motion_is_shown() -> None:
    npm("run", "test:vscode")
