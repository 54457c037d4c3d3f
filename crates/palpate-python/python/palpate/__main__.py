"""The command ``palpate``."""

from __future__ import annotations

import signal
import sys

from palpate._palpate import command


def main() -> int:
    """Run the command line with the arguments of this process."""
    # The command ends at Ctrl-C as the binary does, not when the interpreter looks for signals next.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["palpate", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
