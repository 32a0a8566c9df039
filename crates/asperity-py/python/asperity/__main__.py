"""The command ``asperity``, also as ``python -m asperity``."""

import signal
import sys

from ._core import command


def main() -> None:
    """Run the command line of this process, and end it with the exit code of the command."""
    # The command stops a run by itself at Ctrl-C. Where whoever started the process had Ctrl-C ignored, it stays so.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(command(["asperity", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
