"""Lists of jobs, here or on a Dask cluster."""

from __future__ import annotations

import importlib
import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from . import _toile

# Starts toile's command line: each garment is made in a process of its own. Not by ``-m``, which would also look into
# the current folder.
PROGRAM = [sys.executable, str(Path(__file__).with_name("__main__.py"))]


def batch(
    jobs: str | os.PathLike[str] | Iterable[Mapping[str, Any]],
    client: Any = None,
    *,
    store: str | os.PathLike[str],
    side_by_side: int | None = None,
    time: float | None = 3600.0,
    memory: int | None = None,
    threads: int = 1,
    retry: bool = False,
    progress: Callable[[str, float], object] | None = None,
) -> list[dict[str, Any]]:
    """Makes many garments into a store, each in a process of its own.

    A job that the store has already is not made again, so that a batch that was ended anywhere is gone on with by the
    same call. The result is the same whoever makes it: ``toile batch``, this process, or a cluster.

    Args:
        jobs: A list of jobs in a file (one JSON object a line), or dicts with the keys of such lines: ``garment`` (a
            file, or several from the skin outwards), ``body``, ``body_units``, ``fabric``, ``spacing`` (mm), ``size``,
            ``pressure_bands`` (kPa), ``id``. Paths are relative to the file, or to the current folder.
        client: A ``distributed.Client``. Each job is then a task of its cluster, whose machines must see the garments
            and the store under the same paths. Without one the jobs run on this machine.
        store: The folder of the results.
        side_by_side: Jobs that run at the same time without a client, by default one a processor.
        time: Longest time of a job, s.
        memory: Most memory of a job, MiB (address space; not on Windows).
        threads: Threads of a job.
        retry: Make jobs anew that failed before.
        progress: Called with ``"batch"`` and the share of the jobs that have ended.

    Returns:
        The lines of ``index.jsonl``, in the order of the jobs: ``id``, ``state`` ("done" or "failed"), ``exit``,
        ``seconds``, ``folder`` (from the store) and ``error``.

    Raises:
        InputError: The list is wrong, or ids are not unique.
        ComputationError: The store cannot be written.
    """
    texts = _texts(jobs)
    folder, root = os.getcwd(), os.path.abspath(store)
    if client is not None:
        _on_cluster(client, texts, folder, root, (time, memory, threads, retry), progress)
        # All are known now, so that this writes the index and makes nothing.
        retry = False
    _toile.run_batch(texts, folder, root, PROGRAM, side_by_side, time, memory, threads, retry, progress)
    with open(Path(root) / "index.jsonl", encoding="utf-8") as index:
        return [json.loads(line) for line in index]


def _texts(jobs: str | os.PathLike[str] | Iterable[Mapping[str, Any]]) -> list[str]:
    """The jobs as JSON objects."""
    if isinstance(jobs, (str, os.PathLike)):
        return _toile.read_list(jobs)
    return [json.dumps(dict(job), default=os.fspath, ensure_ascii=False) for job in jobs]


def _one(text: str, folder: str, store: str, options: tuple[float | None, int | None, int, bool]) -> dict[str, Any]:
    """A task: a function of the job's content, which may run again or twice."""
    time, memory, threads, retry = options
    return _toile.run_job(text, folder, store, PROGRAM, time, memory, threads, retry)


def _on_cluster(
    client: Any,
    texts: list[str],
    folder: str,
    store: str,
    options: tuple[float | None, int | None, int, bool],
    progress: Callable[[str, float], object] | None,
) -> None:
    """Makes the jobs as tasks of a cluster and waits for them."""
    distributed: Any = importlib.import_module("distributed")
    # The same job twice in the list is one task.
    once = list(dict.fromkeys(texts))
    # A task whose worker is killed runs again elsewhere; pure=False keeps an old result from being taken for a new
    # one after the store was cleared.
    futures = client.map(_one, once, folder=folder, store=store, options=options, pure=False, retries=2)
    try:
        for count, future in enumerate(distributed.as_completed(futures), 1):
            future.result()
            if progress is not None:
                progress("batch", count / len(once))
    except BaseException:
        client.cancel(futures)
        raise
