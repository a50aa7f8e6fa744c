"""Diagnostics -> text: drawings for a person, one line each, and what other programs read."""

from mlmg_lang.rendering.colour import wants_colour
from mlmg_lang.rendering.concise import render_concise
from mlmg_lang.rendering.full import render_full
from mlmg_lang.rendering.github import render_github
from mlmg_lang.rendering.json_list import render_json
from mlmg_lang.rendering.sarif import render_sarif

__all__ = ["render_concise", "render_full", "render_github", "render_json", "render_sarif", "wants_colour"]
