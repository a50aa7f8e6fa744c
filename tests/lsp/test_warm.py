"""What may be interrupted imports nothing: a module that is half imported would stay so."""

import subprocess
import sys
from pathlib import Path

INVALID = Path(__file__).parents[1] / "invalid"
PROGRAM = """
import sys
from pathlib import Path

from lsprotocol import types

from mlmg_lang.front_end import analyse, analyse_again
from mlmg_lang.source import Source
from mlmg_lsp.client import Client
from mlmg_lsp.convert import diagnostics_of
from mlmg_lsp.open_text import Snapshot
from mlmg_lsp.features import answer_named, get_ahead, warm
from mlmg_runtime.library_names import open_names

warm()
catalog = open_names(Path(sys.argv[1]))
there = set(sys.modules)
document = types.TextDocumentIdentifier("untitled:x")
whole = types.Range(types.Position(0, 0), types.Position(999, 0))
for path in sorted(Path(sys.argv[2]).glob("*.ms")):
    for library in (None, catalog):
        analysis = analyse(Source(path.read_bytes().decode("utf-8")), library)
        analysis = analyse_again(analysis, Source(analysis.source.text + "WALK\\n"))
        snapshot = Snapshot("untitled:x", 1, analysis, None, Client("utf-16"))
        diagnostics_of(snapshot)
        get_ahead(snapshot)
        context = types.CodeActionContext([])
        answer_named("code_action.code_action")(snapshot, types.CodeActionParams(document, whole, context))
print(*sorted(name for name in set(sys.modules) - there if name.startswith(("mlmg_", "lark", "rapidfuzz"))))
"""


def test_nothing_is_imported_when_a_text_is_analysed_whatever_is_wrong_with_it(demo_library):
    assert len(list(INVALID.glob("*.ms"))) > 100
    program = [sys.executable, "-c", PROGRAM, str(demo_library.path), str(INVALID)]
    told = subprocess.run(program, capture_output=True, text=True, check=True)
    assert told.stdout.split() == []
