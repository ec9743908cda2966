"""The index of a store, as a list and as Parquet."""

from __future__ import annotations

import importlib
import json
import os
from pathlib import Path
from typing import Any

from ._errors import InputError

INDEX = "index.jsonl"


def index(store: str | os.PathLike[str], name: str = INDEX) -> list[dict[str, Any]]:
    """The lines of a store's index, also while a batch is at it.

    Args:
        store: The folder of the results.
        name: The index, as ``index.3-of-100.jsonl`` of a part.

    Returns:
        A dict a job: ``id``, ``state`` ("done" or "failed"), ``exit``, ``seconds``, ``folder`` (from the store) and
        ``error``.

    Raises:
        InputError: There is no such index, or a line of it is none.
    """
    path = Path(store) / name
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        # A text that is none, or a name that none can have, is a ValueError.
        why = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{path}: {why}; is this the store of a batch?") from error
    # The end of a line that is just being written is left for the next time.
    *whole, _ = text.split("\n")
    return [_line(path, number, line) for number, line in enumerate(whole, 1)]


def _line(path: Path, number: int, text: str) -> dict[str, Any]:
    """A line of an index."""
    try:
        line = json.loads(text)
    except ValueError as error:
        raise InputError(f"{path}:{number}: this is no line of an index: {error}; run the batch again") from error
    if not isinstance(line, dict):
        raise InputError(f"{path}:{number}: this is no line of an index; run the batch again")
    return line


def to_parquet(store: str | os.PathLike[str], file: str | os.PathLike[str] | None = None, name: str = INDEX) -> Path:
    """Writes a store's index as Parquet, whole or not at all. It needs pyarrow.

    The columns are those of :func:`index`, and those of the jobs: ``garment`` (a list of files), ``body``, ``fabric``,
    ``spacing`` (mm), ``size``, ``measures`` and ``alter`` as JSON, ``body_units`` and ``pressure_bands`` (kPa). A job
    has what it was asked for; null is left to the garment file.

    Args:
        store: The folder of the results.
        file: The file to write, by default ``index.parquet`` in the store.
        name: The index that is read.

    Returns:
        The file.

    Raises:
        InputError: There is no such index.
        ImportError: pyarrow is not installed.
    """
    import tempfile

    try:
        arrow: Any = importlib.import_module("pyarrow")
        parquet: Any = importlib.import_module("pyarrow.parquet")
    except ImportError as error:
        raise ImportError("Parquet needs pyarrow: pip install pyarrow") from error
    text, number = arrow.string(), arrow.float64()
    columns = [("id", text), ("state", text), ("exit", arrow.int32()), ("seconds", number), ("folder", text)]
    columns += [("error", text), ("garment", arrow.list_(text)), ("body", text), ("fabric", text)]
    columns += [("spacing", number), ("size", text), ("measures", text), ("alter", text)]
    columns += [("body_units", text), ("pressure_bands", arrow.list_(number))]
    rows = [line | _job(Path(store), line) for line in index(store, name)]
    table = arrow.Table.from_pylist(rows, schema=arrow.schema(columns))
    target = Path(store) / f"{Path(name).stem}.parquet" if file is None else Path(file)
    handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=".toile-", suffix=".parquet")
    os.close(handle)
    try:
        parquet.write_table(table, temporary)
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise
    return target


def _job(store: Path, line: dict[str, Any]) -> dict[str, Any]:
    """What a job was asked for, from its folder."""
    try:
        job = json.loads((store / line["folder"] / "job.json").read_text(encoding="utf-8"))["job"]
    except (OSError, TypeError, ValueError, KeyError):
        # Nothing could be kept of it.
        return {}
    garment = job.get("garment")
    out = {key: job.get(key) for key in ["body", "fabric", "spacing", "size", "body_units", "pressure_bands"]}
    out["garment"] = [garment] if isinstance(garment, str) else garment
    for key in ["measures", "alter"]:
        out[key] = json.dumps(job[key], ensure_ascii=False) if key in job else None
    return out
