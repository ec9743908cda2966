"""Batches on this machine; test_cluster has those on a Dask cluster."""

from __future__ import annotations

import json
import os
import shutil
import threading
from pathlib import Path
from typing import Any

import pytest
import toile
from conftest import command, put_ball_and_sheet

JOBS = 8
# Of the first sheet, mm; the others are coarser.
SPACING = 20.0


@pytest.fixture(scope="module")
def sheet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return put_ball_and_sheet(tmp_path_factory.mktemp("garment"))


def jobs(sheet: Path) -> list[dict[str, Any]]:
    """Sheets on a ball that are all different, one of them twice, and two failures."""
    made: list[dict[str, Any]] = [{"id": f"sheet {k}", "garment": sheet, "spacing": SPACING + k} for k in range(JOBS)]
    made[1]["pressure_bands"] = [2.0, 4.0]
    again = {**made[0], "id": "again"}
    wrong = [{"id": "fabric", "garment": sheet, "fabric": "denin"}, {"id": "missing", "garment": "missing.yaml"}]
    return [*made, again, *wrong]


def without_times(lines: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [{key: value for key, value in line.items() if key != "seconds"} for line in lines]


@pytest.fixture(scope="module")
def plain(sheet: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A store that the command line has made."""
    folder = tmp_path_factory.mktemp("plain")
    listed = [json.dumps(job, default=str) for job in jobs(sheet)]
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
    sheet: Path, plain: Path, tmp_path: Path
) -> None:
    [folder] = [line["folder"] for line in toile.index(plain) if line["id"] == "sheet 0"]
    batch = (plain / folder / "garment.obj").read_bytes()
    for threads in [1, 3]:
        toile.Garment.load(sheet).make(spacing=SPACING, threads=threads).save(tmp_path / "ours")
        assert (tmp_path / "ours" / "garment.obj").read_bytes() == batch
    command("make", sheet, "--spacing", SPACING, "--threads", 2, "-o", tmp_path / "theirs")
    assert (tmp_path / "theirs" / "garment.obj").read_bytes() == batch


def test_the_index_as_parquet(plain: Path, tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    file = toile.to_parquet(plain, tmp_path / "index.parquet")
    table = arrow.read_table(file)
    rows, lines = table.to_pylist(), toile.index(plain)
    assert [{key: row[key] for key in lines[0]} for row in rows] == lines
    assert rows[1]["spacing"] == SPACING + 1 and rows[1]["garment"][0].endswith("sheet.yaml")
    assert rows[1]["pressure_bands"] == [2.0, 4.0] and rows[0]["pressure_bands"] is rows[0]["body_units"] is None
    assert rows[-2]["fabric"] == "denin" and rows[-2]["exit"] == 2
    assert os.listdir(tmp_path) == ["index.parquet"]
    with pytest.raises(toile.InputError, match="is this the store"):
        toile.to_parquet(tmp_path)


def test_two_batches_at_once_leave_nothing_twice(sheet: Path, plain: Path, tmp_path: Path) -> None:
    store = tmp_path / "store"
    both = [threading.Thread(target=toile.batch, args=(jobs(sheet),), kwargs={"store": store}) for _ in range(2)]
    for one in both:
        one.start()
    for one in both:
        one.join()
    check_same(store, toile.batch(jobs(sheet), store=store), plain)


def test_here(sheet: Path, plain: Path, tmp_path: Path) -> None:
    store = tmp_path / "store"
    # Some are there already.
    kept = sorted(name for name in os.listdir(plain) if len(name) == 32)[: JOBS // 2]
    for name in kept:
        shutil.copytree(plain / name, store / name)
    told: list[float] = []
    lines = toile.batch(jobs(sheet), store=store, progress=lambda _, share: told.append(share))
    check_same(store, lines, plain)
    assert told[0] >= len(kept) / (JOBS + 3) and told[-1] == 1
    for wrong in [{"time": 0}, {"time": float("nan")}, {"memory": 0}, {"side_by_side": 0}, {"threads": -1}]:
        with pytest.raises(toile.InputError, match=next(iter(wrong))):
            toile.batch(jobs(sheet), store=store, **wrong)
    with pytest.raises(toile.InputError, match="a job is a dict"):
        toile.batch([3], store=store)  # type: ignore[list-item]
    with pytest.raises(toile.InputError, match="unknown field `colour`"):
        toile.batch([{"garment": sheet, "colour": 1}], store=store)
    with pytest.raises(toile.InputError, match="'a'"):
        toile.batch([{"garment": sheet, "id": "a"}, {"garment": sheet, "id": "a"}], store=store)
