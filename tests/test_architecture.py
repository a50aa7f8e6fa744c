"""What the architecture page and the README say of the stages is so in the code."""

import ast
import re
import subprocess
import sys
from graphlib import TopologicalSorter
from importlib import import_module
from pathlib import Path

import pytest

import mlmg_lang.planning.finding.table as finding_table
from mlmg_lang.planning.rules.table import RULES

ROOT = Path(__file__).parents[1]
ROW = re.compile(r"^\| `(\w+)` \| `(\w+)` \| `([\w.]+)` \|$", re.MULTILINE)
STAGES = ROW.findall((ROOT / "docs" / "architecture.md").read_text(encoding="utf-8"))


def test_the_page_names_all_stages():
    assert [verb for verb, _, _ in STAGES] == [
        "tokenize", "parse", "gather", "Expander", "Planner", "resolve", "Performer", "synthesize", "bvh_from_poses",
    ]  # fmt: skip


@pytest.mark.parametrize(("verb", "representation", "module"), STAGES)
def test_a_stage_stands_where_the_page_says_and_speaks_of_what_it_gives(verb, representation, module):
    stage = import_module(module)
    assert callable(getattr(stage, verb))
    assert representation in Path(stage.__file__).read_text(encoding="utf-8")


def test_the_readme_has_the_same_table():
    assert ROW.findall((ROOT / "README.md").read_text(encoding="utf-8")) == STAGES


def test_the_page_has_the_table_of_rules():
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([\w ]+) \| (\w+) \| .+ \| `([\w.]+)` \|$", page, re.MULTILINE)
    assert rows == [(rule.name, rule.order.name.lower(), rule.judge.__module__) for rule in RULES]


def test_the_page_has_the_table_of_rules_that_find_expressions():
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([\w ]+) \| [^|]+ \| `(mlmg_lang\.planning\.finding\.\w+)` \|$", page, re.MULTILINE)
    assert rows == [(rule.name, rule.find.__module__) for rule in finding_table.RULES]


@pytest.mark.parametrize("module", ["mlmg_lang.front_end", "mlmg_lang.commands.mlmg", "mlmg_lang.commands.check"])
def test_what_needs_no_numbers_starts_without_them(module):
    code = f"import sys, {module}; sys.exit('numpy' in sys.modules or 'mlmg_runtime.library' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_installed_package_is_what_is_tested_where_that_is_asked_for():
    import os

    import mlmg_runtime

    if "MLMG_TEST_INSTALLED" in os.environ:
        assert "site-packages" in str(mlmg_runtime.__file__)


@pytest.mark.parametrize("package", ["mlmg_lang", "mlmg_grammar", "mlmg_runtime", "mlmg_lsp"])
def test_every_package_says_that_it_is_typed(package):
    assert (Path(import_module(package).__file__).parent / "py.typed").exists()


def test_no_module_imports_itself_by_way_of_others():
    modules = {
        ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__"): path
        for root in (ROOT / "grammar", ROOT / "mlmg_lang", ROOT / "runtime", ROOT / "lsp")
        for path in root.glob("mlmg_*/**/*.py")
    }
    assert len(modules) > 200
    TopologicalSorter({name: set(_imported(name, path, modules)) for name, path in modules.items()}).prepare()


def _imported(name, path, modules):
    """Yield what a module imports, be it late or for types alone."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            inside = [f"{node.module}.{alias.name}" for alias in node.names]
            found = [one if one in modules else node.module for one in inside]
        else:
            continue
        yield from (one for one in found if one in modules and one != name)
