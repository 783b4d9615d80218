"""`python -m exo_pin` is `exo-pin`."""

import signal


def run() -> int:
    """Run the command line as a program; its exit code.

    Until the command itself runs, Ctrl-C ends the program at once: there is nothing to clean up, and Python's
    own handler would print a traceback of its imports.
    """
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from exo_pin.cli import main

    return main()


if __name__ == "__main__":
    raise SystemExit(run())
