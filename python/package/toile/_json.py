"""What dicts and lists of a caller are as JSON, which is YAML."""

from __future__ import annotations

import json
import os
from typing import Any


def dumps(value: Any) -> str:
    """The value as JSON: NumPy's numbers and arrays as Python's, paths as texts."""
    return json.dumps(value, default=_plain, ensure_ascii=False, allow_nan=False, indent=1)


def _plain(value: Any) -> Any:
    """What JSON has for a value that is none of its own."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    # A NumPy array or number, without importing NumPy.
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot stand in a garment, a list of measures or a job")
