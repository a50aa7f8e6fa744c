"""Where the two commands begin: Ctrl-C ends them quietly from the first moment on, also while modules are imported.

Nothing is imported above the functions, since nothing catches an interruption there.
"""


def mlmgc() -> int:
    """Run `mlmgc` and return its exit code."""
    try:
        from mlmg_lang.commands.mlmgc import main

        return main()
    except KeyboardInterrupt:
        return _interrupted("mlmgc")
    finally:
        _go_quietly()


def mlmg() -> int:
    """Run `mlmg` and return its exit code."""
    try:
        from mlmg_lang.commands.mlmg import main

        return main()
    except KeyboardInterrupt:
        return _interrupted("mlmg")
    finally:
        _go_quietly()


def _interrupted(program: str) -> int:
    import sys

    sys.stderr.write(f"{program}: interrupted\n")
    return 130


def _go_quietly() -> None:
    """Let nothing interrupt the last moments of the process, in which all is done and Python takes itself apart."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
