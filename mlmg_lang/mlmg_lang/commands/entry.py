"""Where the two commands begin, and how they end when they are told to, however early: quietly, and tidied up.

Nothing is imported above the functions, since nothing catches an interruption there.
"""


def mlmgc() -> int:
    """Run `mlmgc` and return its exit code."""
    try:
        _tidy_up_when_told_to_end()
        from mlmg_lang.commands.mlmgc import main

        return main()
    except KeyboardInterrupt:
        return _interrupted("mlmgc")
    finally:
        _go_quietly()


def mlmg() -> int:
    """Run `mlmg` and return its exit code."""
    try:
        _tidy_up_when_told_to_end()
        from mlmg_lang.commands.mlmg import main

        return main()
    except KeyboardInterrupt:
        return _interrupted("mlmg")
    finally:
        _go_quietly()


def _tidy_up_when_told_to_end() -> None:
    """Let a process that is ended, or whose terminal is closed, take away what it has half written.

    What is ignored stays so: `nohup` does that.
    """
    import signal
    import sys

    def leave(number: int, _: object) -> None:
        sys.exit(128 + number)

    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, leave)


def _interrupted(program: str) -> int:
    import sys

    sys.stderr.write(f"{program}: interrupted\n")
    return 130


def _go_quietly() -> None:
    """Let nothing interrupt the last moments of the process, in which all is done and Python takes itself apart."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
