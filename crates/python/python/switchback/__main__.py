"""The command line: ``python -m switchback``, the same program as ``switchback``."""

from __future__ import annotations

import sys

from ._native import run


def main() -> int:
    """Runs what the words of the command line ask for; returns the exit code."""
    return run(["switchback", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
