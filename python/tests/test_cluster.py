"""Many jobs on a Dask cluster whose worker is killed and whose scheduler is started again.

There are a hundred jobs, or as many as the environment variable TOILE_CLUSTER_JOBS says.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import toile
from conftest import command, put_ball_and_sheet

distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")

JOBS = int(os.environ.get("TOILE_CLUSTER_JOBS", "100"))
# One job in fifty fails on purpose. The others are sheets that fall on a ball, all different.
FAILING = JOBS // 50
SHEETS = JOBS - FAILING
# Results after which the worker is killed, and the scheduler.
WORKER_AFTER, SCHEDULER_AFTER = JOBS // 4, JOBS * 3 // 5


def jobs(folder: Path) -> list[dict[str, Any]]:
    garment = put_ball_and_sheet(folder)
    step = 10 / SHEETS
    sheets = [{"id": f"sheet {k}", "garment": str(garment), "spacing": 20 + step * k} for k in range(SHEETS)]
    half = FAILING // 2
    fabrics = [{"id": f"fabric {k}", "garment": str(garment), "fabric": f"denin {k}"} for k in range(half)]
    missing = [{"id": f"missing {k}", "garment": str(folder / f"missing {k}.yaml")} for k in range(half, FAILING)]
    return [*sheets[: SHEETS // 2], *fabrics, *sheets[SHEETS // 2 :], *missing]


class Cluster:
    """A scheduler and workers in processes that can be killed one by one."""

    def __init__(self, folder: Path) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port: int = free.getsockname()[1]
        self.folder = folder
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.workers: list[subprocess.Popen[bytes]] = []
        self.start_scheduler()

    def start(self, part: str, *words: str) -> subprocess.Popen[bytes]:
        line = [sys.executable, "-m", f"distributed.cli.dask_{part}", *words, "--no-dashboard"]
        with (self.folder / f"{part}.log").open("ab") as log:
            return subprocess.Popen(line, cwd=self.folder, stdout=log, stderr=log)

    def start_scheduler(self) -> None:
        self.scheduler = self.start("scheduler", "--host", "127.0.0.1", "--port", str(self.port))

    def start_worker(self) -> None:
        self.workers.append(self.start("worker", self.address, "--nthreads", "1", "--no-nanny"))

    def end(self) -> None:
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    made = Cluster(tmp_path)
    made.start_worker()
    made.start_worker()
    yield made
    made.end()


def workers_of(store: Path) -> list[int]:
    """Processes that make a garment into this store."""
    psutil = pytest.importorskip("psutil")
    lines = {process.pid: process.info["cmdline"] or [] for process in psutil.process_iter(["cmdline"])}
    ours = f"--output={store}{os.sep}"
    return [pid for pid, words in lines.items() if any(word.startswith(ours) for word in words)]


def results(store: Path) -> list[str]:
    return sorted(name for name in os.listdir(store) if len(name) == 32) if store.is_dir() else []


def strike(cluster: Cluster, store: Path, over: threading.Event, struck: list[str]) -> None:
    """Kills a worker and later the scheduler, midway, and starts others in their places."""

    def wait_for(count: int) -> bool:
        while len(results(store)) < count and not over.is_set():
            time.sleep(0.05)
        return not over.is_set()

    if wait_for(WORKER_AFTER):
        cluster.workers[0].kill()
        struck.append("worker")
        cluster.start_worker()
    if wait_for(SCHEDULER_AFTER):
        cluster.scheduler.kill()
        cluster.scheduler.wait()
        struck.append("scheduler")
        cluster.start_scheduler()
        # Workers end with their scheduler. Their process manager starts them again.
        for worker in cluster.workers:
            worker.kill()
        cluster.start_worker()
        cluster.start_worker()


def test_a_worker_killed_and_a_scheduler_started_again_lose_nothing(cluster: Cluster, tmp_path: Path) -> None:
    listed, store = jobs(tmp_path), tmp_path / "store"
    over, struck = threading.Event(), list[str]()
    with distributed.Client(cluster.address, timeout="60s") as client:
        striker = threading.Thread(target=strike, args=(cluster, store, over, struck))
        striker.start()
        try:
            lines = toile.batch(listed, client, store=store)
        finally:
            over.set()
            striker.join()
    assert struck == ["worker", "scheduler"]
    assert Counter(line["state"] for line in lines) == {"done": SHEETS, "failed": FAILING}
    assert [line["id"] for line in lines] == [job["id"] for job in listed]
    assert len(results(store)) == SHEETS and len(os.listdir(store / "failed")) == FAILING

    (tmp_path / "jobs.jsonl").write_text("".join(json.dumps(job) + "\n" for job in listed))
    run = command("batch", tmp_path / "jobs.jsonl", "-o", tmp_path / "plain", "--quiet")
    assert run.returncode == 3, run.stderr
    plain = toile.index(tmp_path / "plain")
    for ours, theirs in zip(lines, plain, strict=True):
        assert {**ours, "seconds": 0} == {**theirs, "seconds": 0}
    assert results(store) == results(tmp_path / "plain")
    for name in results(store):
        ours, theirs = ((folder / name / "garment.obj").read_bytes() for folder in [store, tmp_path / "plain"])
        assert ours == theirs
    # A worker that was killed may have left its folder, which the next batch removes.
    assert toile.batch(listed, store=store) == lines
    assert os.listdir(store / ".work") == ["lock"]


def test_what_ends_the_call_ends_its_tasks(cluster: Cluster, skirt: Path, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    store, garment = tmp_path / "store", put_ball_and_sheet(tmp_path)
    endless = {"id": "endless", "garment": skirt, "spacing": 2.0}

    def stop(stage: str, share: float) -> None:
        while not workers_of(store):
            time.sleep(0.05)
        raise Enough

    with distributed.Client(cluster.address, timeout="60s") as client:
        with pytest.raises(Enough):
            toile.batch([endless, {"garment": garment, "spacing": 20}], client, store=store, progress=stop)
        begin = time.monotonic()
        while workers_of(store):
            assert time.monotonic() - begin < 20, "the job goes on"
            time.sleep(0.05)
        # The worker is free again, and numbers its jobs as a plain run does.
        lines = toile.batch([{"garment": garment, "spacing": mm} for mm in [20, 21]], client, store=store)
        assert [line["id"] for line in lines] == ["sheet-1", "sheet-2"]
        records = [json.loads((store / line["folder"] / "job.json").read_text()) for line in lines]
        assert records[1]["job"]["id"] == "sheet-2"
        with pytest.raises(toile.InputError, match="job 3: unknown field"):
            job = {"garment": garment, "spacing": 22}
            toile.batch([job, {**job, "id": "b"}, {**job, "colour": 1}], client, store=store)
        assert len(results(store)) == 2
    with pytest.raises(toile.InputError, match="client: it is closed"):
        toile.batch([{"garment": garment}], client, store=store)


def test_a_worker_with_another_toile_is_refused(tmp_path: Path) -> None:
    options = (None, None, 1, False)
    with pytest.raises(toile.ComputationError, match="the batch is of toile 0.0.1; install the same"):
        toile._batch._one("{}", str(tmp_path), str(tmp_path), options, "0.0.1")
