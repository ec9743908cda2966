"""Lists of jobs, here or on a Dask cluster."""

from __future__ import annotations

import importlib
import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from time import monotonic, sleep
from typing import Any

from . import _json, _toile
from ._errors import ComputationError, InputError
from ._index import index

# Starts toile's command line: each garment is made in a process of its own. Not by ``-m``, which would also look into
# the current folder.
PROGRAM = [sys.executable, str(Path(__file__).with_name("__main__.py"))]

# Objects that stand for a key of a job, each for the key that is named as its class.
OBJECTS = (_toile.Garment, _toile.Body, _toile.Fabric)

# What a worker must have, too, so that its results are those of this machine.
VERSION = f"{_toile.__version__} (build {_toile.__build__})"

# Time limit (s), memory limit (MiB), threads, and whether failures are tried again.
Options = tuple[float | None, int | None, int, bool]

# Rounds in which a cluster may lose everything, and how long it may be away in between (s): a scheduler that is started
# again takes seconds, and its workers follow.
ROUNDS = 3
PATIENCE = 120.0


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
        jobs: A list of jobs in a file (one JSON object a line), a folder whose garment files are made, or dicts with
            the keys of such lines: ``garment`` (a file, or several from the skin outwards), ``body``, ``body_units``,
            ``measures``, ``fabric``, ``spacing`` (mm), ``size``, ``alter``, ``pressure_bands`` (kPa), ``id``. Paths are
            relative to the file, or to the current folder. A dict may have a :class:`Garment` (or a list of them), a
            :class:`Body` and a :class:`Fabric` as its garment, body and fabric, if they have files. Measures of such a
            body and alterations of such a garment hold beside those that the job says.
        client: A ``distributed.Client``. Each job is then a task of its cluster, whose machines must see the garments
            and the store under the same paths. What a worker or the scheduler loses when it is killed is handed in
            again when it is back. Without a client the jobs run on this machine.
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
        InputError: The list is wrong, or ids are not unique. Nothing has been made.
        ComputationError: The store cannot be written, the cluster does not come back, or a worker has another toile.
    """
    texts = _texts(jobs)
    root = os.path.abspath(store)
    if client is not None:
        _on_cluster(client, texts, root, (time, memory, threads, retry), progress)
        # All are known now, so that this writes the index and makes nothing.
        retry = False
    _toile.run_batch(texts, root, PROGRAM, side_by_side, time, memory, threads, retry, progress)
    return index(root)


def _texts(jobs: str | os.PathLike[str] | Iterable[Mapping[str, Any]]) -> list[str]:
    """The jobs as JSON objects, all of them checked, with whole paths and an id each."""
    if isinstance(jobs, (str, os.PathLike)):
        return _toile.read_list(jobs)
    return _toile.check_list([_json.dumps(_plain(job)) for job in jobs])


def _plain(job: Mapping[str, Any]) -> dict[str, Any]:
    """A job with the names of its body and fabric in place of objects. What it says itself goes before theirs."""
    if not isinstance(job, Mapping):
        raise InputError(f"a job is a dict such as {{'garment': 'skirt.yaml'}}, not {job!r}")
    plain: dict[str, Any] = {}
    for key, value in job.items():
        if isinstance(value, OBJECTS):
            if key != type(value).__name__.lower():
                raise InputError(f"{key!r} of a job cannot be {value!r}")
            plain |= _of_garment(value) if isinstance(value, _toile.Garment) else value._job
    said = {key: value for key, value in job.items() if not isinstance(value, OBJECTS)}
    if isinstance(said.get("garment"), (list, tuple)):
        said["garment"] = [_of_outfit(worn) for worn in said["garment"]]
    if isinstance(said.get("measures"), Mapping):
        said["measures"] = {**plain.get("measures", {}), **said["measures"]}
    alter = said.get("alter")
    if isinstance(alter, (str, Mapping)):
        said["alter"] = [alter]
    if isinstance(said.get("alter"), list):
        said["alter"] = plain.get("alter", []) + said["alter"]
    return plain | said


def _of_garment(garment: _toile.Garment) -> dict[str, Any]:
    """The file and the alterations of a garment, as a job has them."""
    file, text, alter, _ = garment._state
    try:
        same = Path(file).read_text(encoding="utf-8") == text
    except (OSError, ValueError):
        same = False
    if not same:
        raise InputError(f"{garment!r} is in no file as it is; save it, and give the job the file's name")
    return {"garment": os.fspath(file), "alter": alter}


def _of_outfit(worn: Any) -> Any:
    """The file of one garment of several, which no alterations of its own can follow in a job."""
    if not isinstance(worn, _toile.Garment):
        return worn
    plain = _of_garment(worn)
    if plain["alter"]:
        raise InputError(f"{worn!r} is altered; save it, and give the job the file's name")
    return plain["garment"]


def _one(text: str, store: str, held: str, options: Options, version: str) -> dict[str, Any]:
    """A task: a function of the job's content, which may run again or twice. It ends when the batch has let go of its
    work folder."""
    if version != VERSION:
        import socket

        raise ComputationError(
            f"the worker {socket.gethostname()} has toile {VERSION}, the batch is of toile {version}; "
            "install the same on all machines"
        )
    time, memory, threads, retry = options
    return _toile.run_job(text, store, held, PROGRAM, time, memory, threads, retry)


def _content(text: str) -> str:
    """A job without its id."""
    return json.dumps({key: value for key, value in json.loads(text).items() if key != "id"})


def _on_cluster(
    client: Any,
    texts: list[str],
    store: str,
    options: Options,
    progress: Callable[[str, float], object] | None,
) -> None:
    """Makes the jobs as tasks of a cluster and waits for them. Jobs that the cluster loses are handed in again."""
    if client.status == "closed":
        raise InputError("client: it is closed; give one that is connected to its scheduler")
    # The same job twice in the list is one task.
    first: dict[str, str] = {}
    for text in texts:
        first.setdefault(_content(text), text)
    once = list(first.values())
    hold = _toile._Hold(store)
    try:
        _made(client, once, (store, str(hold.folder), options), progress)
    finally:
        # Ends the jobs that are under way, if this was ended early.
        hold.release()


def _made(
    client: Any,
    once: list[str],
    where: tuple[str, str, Options],
    progress: Callable[[str, float], object] | None,
) -> None:
    """Hands the jobs in until all have ended."""
    left = once
    lost_before = 0

    def tell(open_now: int) -> None:
        if progress is not None:
            progress("batch", 1 - open_now / len(once))

    while left:
        still = _round(client, left, where, tell)
        # As long as something gets done, the cluster is worth another try.
        lost_before = 0 if len(still) < len(left) else lost_before + 1
        if still and lost_before == ROUNDS:
            raise ComputationError(
                f"the cluster has lost {len(still)} jobs {ROUNDS} times in a row; what is done is kept: start again "
                "when it is well"
            )
        if still:
            _wait_for(client)
        left = still


def _round(
    client: Any, texts: list[str], where: tuple[str, str, Options], tell: Callable[[int], None]
) -> list[str]:
    """Hands jobs in and waits for them. Gives those that got lost with a worker or the scheduler."""
    distributed: Any = importlib.import_module("distributed")
    store, held, options = where
    # A task whose worker is killed runs again elsewhere; pure=False keeps an old result from being taken for a new
    # one after the store was cleared.
    try:
        futures = client.map(
            _one, texts, store=store, held=held, options=options, version=VERSION, pure=False, retries=2
        )
    except _losses():
        return texts
    text_of = {future.key: text for future, text in zip(futures, texts, strict=True)}
    lost: list[str] = []
    ended = 0
    try:
        for future in distributed.as_completed(futures):
            try:
                future.result()
            except _losses():
                lost.append(text_of[future.key])
            ended += 1
            tell(len(texts) - ended + len(lost))
    except BaseException:
        client.cancel(futures, force=True)
        raise
    return lost


def _losses() -> tuple[type[BaseException], ...]:
    """What is raised when a worker or the scheduler is gone, not the job wrong."""
    # These take longer to import than all of toile, and only a cluster needs them.
    import asyncio
    import concurrent.futures

    client: Any = importlib.import_module("distributed.client")
    comm: Any = importlib.import_module("distributed.comm")
    scheduler: Any = importlib.import_module("distributed.scheduler")
    return (asyncio.CancelledError, concurrent.futures.CancelledError, client.FutureCancelledError, comm.CommClosedError,
            scheduler.KilledWorker, TimeoutError, ConnectionError)


def _wait_for(client: Any) -> None:
    """Waits until the scheduler answers again and has a worker."""
    end = monotonic() + PATIENCE
    # A client that has given up does not come back.
    while monotonic() < end and client.status != "closed":
        try:
            if client.scheduler_info()["workers"]:
                client.wait_for_workers(1, timeout=1)
                return
        except Exception:
            # It is away, or on its way.
            pass
        sleep(0.2)
    why = "its scheduler is gone" if client.status == "closed" else f"it has had no worker for {PATIENCE:.0f} s"
    raise ComputationError(f"the cluster does not answer: {why}; what is done is kept: start again with another")
