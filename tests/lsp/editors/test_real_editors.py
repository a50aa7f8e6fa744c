"""The configurations in real editors, which start the real server: each is told of the mistake in a script."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

EDITORS = Path(__file__).parents[3] / "lsp" / "editors"
SCRIPT = "Idle_01\nIDLE # 😀走路\nWLAK for 10 sec\n"
TOLD = "no tag or motion `WLAK` in this library"

IN_NEOVIM = """
vim.cmd("edit script.ms")
for _ = 1, 100 do
  if vim.wait(200, function() return #vim.diagnostic.get(0) > 0 end, 20) then break end
  vim.api.nvim_buf_set_lines(0, -1, -1, false, { "" })
end
local told = vim.tbl_map(function(one)
  return (one.lnum + 1) .. ":" .. vim.split(one.message, "\\n")[1]
end, vim.diagnostic.get(0))
vim.fn.writefile(told, "told.txt")
vim.cmd("qall!")
"""
IN_VIM = """
edit script.ms
let tries = 0
while tries < 400 && empty(ale#engine#GetLoclist(bufnr('')))
  sleep 50m
  let tries += 1
endwhile
call writefile(map(copy(ale#engine#GetLoclist(bufnr(''))), 'v:val.lnum . ":" . v:val.text'), 'told.txt')
qall!
"""
IN_EGLOT = """
(require 'eglot)
(load "{configuration}")
(setq eglot-sync-connect 20)
(find-file "script.ms")
(eglot--maybe-activate-editing-mode)
(unless (eglot-current-server) (apply #'eglot (eglot--guess-contact)))
(let ((tries 0))
  (while (and (< tries 400) (null (flymake-diagnostics)))
    (accept-process-output nil 0.05)
    (flymake-start)
    (setq tries (1+ tries))))
(dolist (one (flymake-diagnostics))
  (princ (format "%s:%s\\n" (line-number-at-pos (flymake-diagnostic-beg one)) (flymake-diagnostic-text one))))
"""
IN_LSP_MODE = """
(require 'lsp-mode)
(load "{configuration}")
(setq lsp-auto-guess-root t lsp-restart 'ignore lsp-diagnostics-provider :flymake lsp-enable-snippet nil)
(find-file "script.ms")
(lsp)
(let ((tries 0))
  (while (and (< tries 400) (= 0 (hash-table-count (lsp-diagnostics))))
    (accept-process-output nil 0.05)
    (setq tries (1+ tries))))
(maphash
  (lambda (file told)
    (dolist (one told)
      (let ((at (gethash "line" (gethash "start" (gethash "range" one)))))
        (princ (format "%s:%s\\n" (1+ at) (gethash "message" one))))))
  (lsp-diagnostics))
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with a script, and the library that it is read against."""
    (tmp_path / "script.ms").write_text(SCRIPT, "utf-8")
    (tmp_path / "mlmg.toml").write_text('library = "demo"\n', "utf-8")
    return tmp_path


def run(folder: Path, *command: str) -> str:
    """Return what an editor says that finds `mlmg` on the search path, and has a home of its own."""
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    environment = {**os.environ, "PATH": path, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}
    done = subprocess.run(
        command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=120, check=False
    )
    return (done.stdout + done.stderr).decode("utf-8", "replace")


def needs(*programs: str) -> pytest.MarkDecorator:
    missing = [program for program in programs if shutil.which(program) is None and not Path(program).exists()]
    return pytest.mark.skipif(bool(missing), reason=f"not installed: {', '.join(missing)}")


@needs("nvim")
def test_neovim_is_told_of_a_mistake(folder: Path) -> None:
    (folder / "drive.lua").write_text(IN_NEOVIM, "utf-8")
    version = re.search(r"NVIM v0\.(\d+)", run(folder, "nvim", "--version"))
    recent = version is None or int(version[1]) >= 11
    configuration = EDITORS / "neovim" / f"motion_script_0_{11 if recent else 7}.lua"
    said = run(folder, "nvim", "--headless", "-i", "NONE", "-u", str(configuration), "-c", "luafile drive.lua")
    assert f"3:{TOLD}" in (folder / "told.txt").read_text("utf-8"), said


@needs("vim", "/usr/share/vim/vimfiles/pack/dist-bundle/opt/ale")
def test_vim_with_ale_is_told_of_a_mistake(folder: Path) -> None:
    configuration = (EDITORS / "vim" / "motion_script.vim").read_text("utf-8")
    (folder / "vimrc").write_text(f"set nocompatible\npackadd ale\nfiletype plugin on\n{configuration}", "utf-8")
    (folder / "drive.vim").write_text(IN_VIM, "utf-8")
    said = run(folder, "vim", "-u", "vimrc", "-es", "-i", "NONE", "-S", "drive.vim")
    assert f"3:{TOLD}" in (folder / "told.txt").read_text("utf-8"), said


@needs("emacs", "/usr/share/doc/elpa-eglot")
def test_emacs_with_eglot_is_told_of_a_mistake(folder: Path) -> None:
    configuration = EDITORS / "emacs" / "motion-script-eglot.el"
    (folder / "drive.el").write_text(IN_EGLOT.format(configuration=configuration), "utf-8")
    said = run(folder, "emacs", "--batch", "-l", "drive.el")
    assert f"3:mlmg [MS021]: {TOLD}" in said


@needs("emacs", "/usr/share/doc/elpa-lsp-mode")
def test_emacs_with_lsp_mode_is_told_of_a_mistake(folder: Path) -> None:
    configuration = EDITORS / "emacs" / "motion-script-lsp-mode.el"
    (folder / "drive.el").write_text(IN_LSP_MODE.format(configuration=configuration), "utf-8")
    said = run(folder, "emacs", "--batch", "-l", "drive.el")
    assert f"3:{TOLD}" in said
