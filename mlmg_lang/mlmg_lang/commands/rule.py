"""Tell what a diagnostic means: why there is one, a script that gets it, and what to write instead.

Without a code, all codes are listed.

examples:
  mlmg rule MS021
  mlmg rule ms040 ms041
  mlmg rule --format json
"""

from __future__ import annotations

import argparse
import re
import sys
from typing import TYPE_CHECKING, Any

from mlmg_lang.commands.console import DONE, UsageError

if TYPE_CHECKING:
    from mlmg_lang.rules import RuleText


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Say what the command takes."""
    parser.add_argument("codes", nargs="*", metavar="CODE", help="a code: MS021, ms021 or 21")
    parser.add_argument("--format", choices=("text", "json"), default="text", help="how it is told (text)")
    parser.add_argument("--json", dest="format", action="store_const", const="json", help="the same as --format json")


def run(arguments: argparse.Namespace) -> int:
    """Tell of some codes, or list all."""
    from mlmg_lang.diagnostics import CODES

    codes = [_known(code) for code in arguments.codes]
    if arguments.format == "json":
        import json

        entries = [_entry(code) for code in codes or CODES]
        sys.stdout.write(json.dumps(entries, ensure_ascii=False, indent=1) + "\n")
    elif codes:
        sys.stdout.write("\n\n".join(_told(code) for code in codes))
    else:
        sys.stdout.writelines(f"{code}  {rule.severity:<7}  {rule.title}\n" for code, rule in CODES.items())
    return DONE


def _known(code: str) -> str:
    """Return a code of the table.

    Raises
    ------
    UsageError
        That names those most like it.
    """
    from mlmg_lang.diagnostics import CODES
    from mlmg_lang.spelling import joined, nearest

    number = re.fullmatch(r"0*([0-9]{1,3})|MS([0-9]{1,3})", code.upper())
    meant = f"MS{int(number[1] or number[2]):03}" if number else code.upper()
    if meant in CODES:
        return meant
    near = nearest(meant, CODES)
    advice = f"did you mean {joined(near, 'or')}?" if near else "`mlmg rule` lists all"
    raise UsageError(f"there is no code `{code}`; {advice}")


def _told(code: str) -> str:
    """Return all that is told of a code, for a person."""
    from mlmg_lang.diagnostics import CODES
    from mlmg_lang.rendering.colour import BOLD, SEVERITIES, Painter, wants_colour

    paint = Painter(wants_colour(sys.stdout))
    rule, text = CODES[code], _read(code)
    head = f"{paint(f'{rule.severity}[{code}]', BOLD, SEVERITIES[rule.severity])}{paint(f': {rule.title}', BOLD)}"
    parts = [head, text.meaning, text.why]
    for title, example in (
        ("Wrong:", text.wrong.text),
        ("What is said of it:", text.told),
        ("Right:", text.right.text),
    ):
        parts.append(f"{paint(title, BOLD)}\n\n{_indented(example)}")
    return "\n\n".join(parts) + "\n"


def _indented(text: str) -> str:
    return "\n".join(f"    {line}".rstrip() for line in text.rstrip("\n").split("\n"))


def _entry(code: str) -> dict[str, Any]:
    from mlmg_lang.diagnostics import CODES

    rule, text = CODES[code], _read(code)
    return {
        "code": code,
        "severity": rule.severity.value,
        "title": rule.title,
        "meaning": text.meaning,
        "why": text.why,
        "wrong": text.wrong.text,
        "told": text.told,
        "right": text.right.text,
    }


def _read(code: str) -> RuleText:
    from mlmg_lang.rules import read_rule

    return read_rule(code)
