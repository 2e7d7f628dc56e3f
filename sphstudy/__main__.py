"""`python -m sphstudy` and the console script `sphstudy`."""

import sys

from sphstudy import __version__
from sphstudy.commands import process


def main(arguments: list[str] | None = None) -> int:
    """Runs the program with these arguments, or those of the process; returns the exit status."""
    return process.main(sys.argv[1:] if arguments is None else arguments, __version__)


if __name__ == "__main__":
    sys.exit(main())
