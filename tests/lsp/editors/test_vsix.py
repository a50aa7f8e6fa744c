"""The extension for VS Code builds, and the editor's grammar reads scripts as it should."""

import os
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

VSCODE = Path(__file__).parents[3] / "lsp" / "editors" / "vscode"
needs_tools = pytest.mark.skipif(
    shutil.which("npm") is None or not (VSCODE / "node_modules").is_dir(),
    reason="the extension's tools are not installed: `make vsix` installs them",
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
    assert names == {"package.json", "readme.md", "LICENSE.txt", "dist/extension.js", *pages, *grammars, *wheels}
