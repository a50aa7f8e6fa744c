"""The option --version."""

from __future__ import annotations

import argparse


class VersionAction(argparse.Action):
    """Says the version and leaves; it is looked up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        """Print the version."""
        from importlib.metadata import version

        parser.exit(message=f"{parser.prog.split()[0]} {version('mlmg')}\n")
