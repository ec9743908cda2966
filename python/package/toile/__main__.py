"""The command ``toile``, also as ``python -m toile``."""

import sys

from toile._batch import PROGRAM
from toile._toile import cli


def main() -> int:
    """Does what the arguments of the process say and gives its exit code."""
    return cli(["toile", *sys.argv[1:]], PROGRAM)


if __name__ == "__main__":
    sys.exit(main())
