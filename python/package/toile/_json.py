"""What dicts and lists of a caller are as JSON, which is YAML."""

from __future__ import annotations

import json
import os
from typing import Any

from ._errors import InputError


def dumps(value: Any) -> str:
    """The value as JSON: NumPy's numbers and arrays as Python's, paths as texts."""
    try:
        text = json.dumps(value, default=_plain, ensure_ascii=False, allow_nan=False, indent=1)
        # A lone surrogate is no text.
        text.encode()
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"what is given holds a value that no file can hold: {error}") from error
    return text


def _plain(value: Any) -> Any:
    """What JSON has for a value that is none of its own."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    # A NumPy array or number, without importing NumPy.
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is neither text, number, list nor dict")
