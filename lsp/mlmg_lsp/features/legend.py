"""What semantic tokens can be, as the client is told before anything is read."""

from __future__ import annotations

from typing import Final

from lsprotocol import types

TOKEN_TYPES: Final = (
    "motion",
    "tag",
    "name",
    "graph",
    "definition",
    "parameter",
    "keyword",
    "number",
    "unit",
    "string",
    "comment",
)
"""By `ide.semantics.Kind`, in the order of the legend."""
_SHOWN_AS: Final = {
    "motion": "enumMember",
    "tag": "type",
    "name": "variable",
    "graph": "namespace",
    "definition": "function",
    "unit": "keyword",
}
"""What themes of editors know them by, where that is another name."""
DECLARATION: Final = 1
LEGEND: Final = types.SemanticTokensLegend([_SHOWN_AS.get(one, one) for one in TOKEN_TYPES], ["declaration"])
