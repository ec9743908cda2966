"""Batches, here and on a Dask cluster."""

from __future__ import annotations

import json
import os
import shutil
import signal
import threading
from pathlib import Path
from typing import Any

import pytest
import toile
from conftest import COARSE, command

JOBS = 8


def jobs(skirt: Path) -> list[dict[str, Any]]:
    """Skirts that are all different, one of them twice, and two failures."""
    made = [{"id": f"skirt {k}", "garment": skirt, "spacing": COARSE + k} for k in range(JOBS)]
    again = {**made[0], "id": "again"}
    wrong = [{"id": "fabric", "garment": skirt, "fabric": "denin"}, {"id": "missing", "garment": "missing.yaml"}]
    return [*made, again, *wrong]


def without_times(lines: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [{key: value for key, value in line.items() if key != "seconds"} for line in lines]


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store that the command line has made."""
    folder = tmp_path_factory.mktemp("plain")
    from conftest import SKIRT

    listed = [json.dumps(job, default=str) for job in jobs(SKIRT)]
    (folder / "jobs.jsonl").write_text("\n".join(listed))
    run = command("batch", folder / "jobs.jsonl", "-o", folder / "store")
    assert run.returncode == 3, run.stderr
    return folder / "store"


def check_same(store: Path, lines: list[dict[str, Any]], plain: Path) -> None:
    theirs = [json.loads(line) for line in (plain / "index.jsonl").read_text().splitlines()]
    named = [line for line in without_times(lines) if line["id"] != "missing"]
    assert named == [line for line in without_times(theirs) if line["id"] != "missing"]
    states = [line["state"] for line in lines]
    assert (states.count("done"), states.count("failed")) == (JOBS + 1, 2)
    results = [name for name in os.listdir(store) if len(name) == 32]
    assert len(results) == JOBS
    for name in results:
        assert (store / name / "garment.obj").read_bytes() == (plain / name / "garment.obj").read_bytes()
    assert os.listdir(store / ".work") == ["lock"]


def test_bytes_are_those_of_python_and_the_command_line_for_any_threads(
    skirt: Path, plain: Path, tmp_path: Path
) -> None:
    [folder] = [line["folder"] for line in toile.index(plain) if line["id"] == "skirt 0"]
    batch = (plain / folder / "garment.obj").read_bytes()
    for threads in [1, 3]:
        toile.Garment.load(skirt).make(spacing=COARSE, threads=threads).save(tmp_path / "ours")
        assert (tmp_path / "ours" / "garment.obj").read_bytes() == batch
    command("make", skirt, "--spacing", COARSE, "--threads", 2, "-o", tmp_path / "theirs")
    assert (tmp_path / "theirs" / "garment.obj").read_bytes() == batch


def test_the_index_as_parquet(plain: Path, tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    file = toile.to_parquet(plain, tmp_path / "index.parquet")
    table = arrow.read_table(file)
    rows, lines = table.to_pylist(), toile.index(plain)
    assert [{key: row[key] for key in lines[0]} for row in rows] == lines
    assert rows[1]["spacing"] == COARSE + 1 and rows[1]["garment"][0].endswith("skirt.yaml")
    assert rows[-2]["fabric"] == "denin" and rows[-2]["exit"] == 2
    assert os.listdir(tmp_path) == ["index.parquet"]
    with pytest.raises(toile.InputError, match="is this the store"):
        toile.to_parquet(tmp_path)


def test_two_batches_at_once_make_nothing_twice(skirt: Path, plain: Path, tmp_path: Path) -> None:
    store = tmp_path / "store"
    both = [threading.Thread(target=toile.batch, args=(jobs(skirt),), kwargs={"store": store}) for _ in range(2)]
    for one in both:
        one.start()
    for one in both:
        one.join()
    check_same(store, toile.batch(jobs(skirt), store=store), plain)


def test_here(skirt: Path, plain: Path, tmp_path: Path) -> None:
    store = tmp_path / "store"
    # Some are there already.
    kept = sorted(name for name in os.listdir(plain) if len(name) == 32)[: JOBS // 2]
    for name in kept:
        shutil.copytree(plain / name, store / name)
    told: list[float] = []
    lines = toile.batch(jobs(skirt), store=store, progress=lambda _, share: told.append(share))
    check_same(store, lines, plain)
    assert told[0] >= len(kept) / (JOBS + 3) and told[-1] == 1
    for wrong in [{"time": 0}, {"time": float("nan")}, {"memory": 0}, {"side_by_side": 0}, {"threads": -1}]:
        with pytest.raises(toile.InputError, match=next(iter(wrong))):
            toile.batch(jobs(skirt), store=store, **wrong)
    with pytest.raises(toile.InputError, match="a job is a dict"):
        toile.batch([3], store=store)  # type: ignore[list-item]
    with pytest.raises(toile.InputError, match="unknown field `colour`"):
        toile.batch([{"garment": skirt, "colour": 1}], store=store)
    with pytest.raises(toile.InputError, match="'a'"):
        toile.batch([{"garment": skirt, "id": "a"}, {"garment": skirt, "id": "a"}], store=store)


def test_on_a_cluster_one_of_whose_workers_is_killed(skirt: Path, plain: Path, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed", reason="dask.distributed is not installed")
    store = tmp_path / "store"
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        workers = list(client.run(os.getpid).values())

        def kill() -> None:
            os.kill(workers[0], signal.SIGKILL)

        # Midway: once the first result is there.
        over = threading.Event()

        def watch() -> None:
            while not over.wait(0.05):
                if store.is_dir() and any(len(name) == 32 for name in os.listdir(store)):
                    kill()
                    return

        watcher = threading.Thread(target=watch)
        watcher.start()
        lines = toile.batch(jobs(skirt), client, store=store)
        over.set()
        watcher.join()
        with pytest.raises(ProcessLookupError):
            os.kill(workers[0], 0)
    check_same(store, lines, plain)
