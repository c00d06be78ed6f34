"""The command ``peristalsis``, the same program as that of Rust, in Python's process."""

from __future__ import annotations

import signal
import sys
from typing import NoReturn

from . import _core


def main() -> NoReturn:
    """Do what the command line asks for, and exit with its code."""
    # The program sees to Ctrl-C itself; where it does not, Ctrl-C ends it at once.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_core.command(["peristalsis", *sys.argv[1:]]))
