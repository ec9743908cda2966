"""The command ``toile``, also as ``python -m toile``.

Batches start this file by its path for every garment. Python then looks for modules in the folder of this file first,
where ours would hide some of Python's own, and would not find toile where the caller has put it on ``sys.path``. So
this file takes its folder away, and loads the toile that it belongs to.
"""

import sys


def main() -> int:
    """Does what the arguments of the process say and gives its exit code."""
    from toile._batch import PROGRAM
    from toile._toile import cli

    return cli(["toile", *sys.argv[1:]], PROGRAM)


def _load() -> None:
    """Loads the package in whose folder this file is."""
    import os

    folder = os.path.dirname(os.path.abspath(__file__))
    sys.path[:] = [path for path in sys.path if os.path.abspath(path) != folder]
    from importlib.util import module_from_spec, spec_from_file_location

    spec = spec_from_file_location("toile", os.path.join(folder, "__init__.py"), submodule_search_locations=[folder])
    assert spec is not None and spec.loader is not None
    sys.modules["toile"] = module_from_spec(spec)
    spec.loader.exec_module(sys.modules["toile"])


if __name__ == "__main__":
    if not __package__:
        _load()
    sys.exit(main())
