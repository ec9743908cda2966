"""The command ``toile``, also as ``python -m toile``."""

import sys

from ._toile import cli


def main() -> int:
    """Does what the arguments of the process say and gives its exit code."""
    # A batch makes each garment in a process of its own, started by these words.
    return cli(["toile", *sys.argv[1:]], [sys.executable, "-m", "toile"])


if __name__ == "__main__":
    sys.exit(main())
