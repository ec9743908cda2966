"""Mistakes of callers are told as errors of toile, and nothing is lost or mixed up on the way."""

from __future__ import annotations

import copy
import json
import multiprocessing
import os
import pickle
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import toile
from conftest import COARSE, command, put_ball_and_sheet


def test_a_list_is_checked_before_anything_is_made(tmp_path: Path) -> None:
    sheet, store = put_ball_and_sheet(tmp_path), tmp_path / "store"
    good = {"garment": sheet, "spacing": 20}
    for wrong in [{**good, "colour": 1}, {"id": 3}, {}]:
        with pytest.raises(toile.InputError, match="^job 3: "):
            toile.batch([good, {**good, "id": "b"}, wrong], store=store)
    with pytest.raises(toile.InputError, match="job 2: the id 'a' is that of job 1"):
        toile.batch([{**good, "id": "a"}, {**good, "id": "a"}], store=store)
    assert not store.exists()


def test_default_ids_are_those_of_the_list_and_records_have_whole_paths(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sheet = put_ball_and_sheet(tmp_path)
    monkeypatch.chdir(tmp_path)
    listed = [{"garment": "sheet.yaml", "spacing": 20}, {"garment": "sheet.yaml", "spacing": 21}]
    Path("jobs.jsonl").write_text("\n".join(map(json.dumps, listed)))
    command("batch", "jobs.jsonl", "-o", "plain")
    stores = {"dicts": toile.batch(listed, store="dicts"), "list": toile.batch("jobs.jsonl", store="list")}
    for name, lines in {**stores, "plain": toile.index("plain")}.items():
        assert [line["id"] for line in lines] == ["sheet-1", "sheet-2"]
        records = [json.loads((Path(name) / line["folder"] / "job.json").read_text()) for line in lines]
        assert [record["job"]["garment"] for record in records] == [str(sheet)] * 2
        assert [record["job"]["id"] for record in records] == ["sheet-1", "sheet-2"]
    # A folder is a list of its garments.
    Path("all").mkdir()
    Path("all/sheet.yaml").write_text(sheet.read_text().replace("ball.obj", str(tmp_path / "ball.obj")))
    Path("all/cloth.yaml").write_text("weight: 100 g/m2\n")
    assert [line["id"] for line in toile.batch("all", store="folder")] == ["sheet"]


def test_objects_of_a_job_are_taken_for_what_they_are(skirt: Path, tmp_path: Path) -> None:
    body, store = toile.Body.build("woman_92", {"waist": 720}), tmp_path / "store"
    for wrong in [{"fabric": body}, {"size": body}, {"body": toile.Fabric.load("denim")}]:
        with pytest.raises(toile.InputError, match="of a job cannot be <toile"):
            toile.batch([{"garment": skirt, **wrong}], store=store)
    jobs = [{"garment": skirt, "body": body, "measures": {"hip": 960}, "spacing": COARSE}]
    [line] = toile.batch(jobs, store=store)
    record = json.loads((store / line["folder"] / "job.json").read_text())
    assert record["job"]["measures"] == {"waist": 720, "hip": 960}
    # A garment with its alterations is its file and these.
    changes = [{"lengthen": "front", "at": 200, "by": mm} for mm in [20, 5]]
    longer = toile.Garment.load(skirt).alter(changes[0])
    for job in [{"garment": longer, "alter": changes[1]}, {"garment": skirt, "alter": changes}]:
        toile.batch([{**job, "spacing": COARSE}], store=store)
    made = [(store / name / "garment.obj").read_bytes() for name in os.listdir(store) if len(name) == 32]
    assert len(made) == 3 and len(set(made)) == 2
    bare = toile.Garment.from_dict(BARE)
    with pytest.raises(toile.InputError, match="in no file as it is; save it"):
        toile.batch([{"garment": bare}], store=store)


def test_paths_are_those_of_the_moment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    one, two = tmp_path / "one", tmp_path / "two"
    for folder, size in [(one, 1), (two, 2)]:
        folder.mkdir()
        put_ball_and_sheet(folder)
        ball = (folder / "ball.obj").read_text().splitlines()
        points = [line[1:].split() for line in ball if line[0] == "v"]
        scaled = ["v " + " ".join(str(size * float(x)) for x in point) for point in points]
        (folder / "ball.obj").write_text("\n".join([*scaled, *(line for line in ball if line[0] == "f")]) + "\n")
    monkeypatch.chdir(one)
    sheet, body = toile.Garment.load("sheet.yaml"), toile.Body.load("ball.obj", "mm")
    Path("cloth.yaml").write_text("weight: 100 g/m2\nbend: 0.05 gf.cm2/cm\n")
    cloth = toile.Fabric.load("cloth.yaml")
    there = sheet.make(spacing=20)
    monkeypatch.chdir(two)
    assert np.array_equal(sheet.make(spacing=20).vertices, there.vertices)
    [line] = toile.batch([{"garment": one / "sheet.yaml", "body": body, "fabric": cloth, "spacing": 20}], store="store")
    job = json.loads((two / "store" / line["folder"] / "job.json").read_text())["job"]
    assert (job["body"], job["fabric"]) == (str(one / "ball.obj"), str(one / "cloth.yaml"))


def test_every_error_is_one_of_toile(skirt: Path, tmp_path: Path) -> None:
    garment = toile.Garment.load(skirt)
    (tmp_path / "file").write_text("")
    flat = toile.flatten([[0, 0, 0], [100, 0, 0], [0, 100, 0]], [[0, 1, 2]])
    for save in [flat.save, toile.Body.load("woman_92").save, garment.save]:
        with pytest.raises(toile.WriteError) as raised:
            save(tmp_path / "file" / "below")
        assert isinstance(raised.value, toile.Error) and isinstance(raised.value, OSError)
    (tmp_path / "index.jsonl").write_text('{"id": "a"}\nrubbish\n')
    with pytest.raises(toile.InputError, match="index.jsonl:2: "):
        toile.index(tmp_path)
    vast = 2**70
    for wrong in [
        lambda: garment.make(spacing=COARSE, threads=-vast),
        lambda: garment.fit(drapes=-vast),
        lambda: garment.fit(drapes=2),
        lambda: toile.flatten([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], darts=-1),
        lambda: garment.make(body=3),  # type: ignore[arg-type]
        lambda: garment.make(fabric=toile.Body.load("woman_92")),  # type: ignore[arg-type]
        lambda: garment.make(start=3),  # type: ignore[arg-type]
        lambda: garment.make(spacing=COARSE, pressure_bands=(4.0, 2.0)),
        lambda: garment.alter(None),  # type: ignore[arg-type]
        lambda: toile.Body.load(3),  # type: ignore[arg-type]
        lambda: toile.batch([{"garment": skirt}], store=tmp_path, memory=-vast),
    ]:
        with pytest.raises(toile.InputError) as told:
            wrong()
        assert "--" not in str(told.value) and "garment file starts" not in str(told.value), told.value
    assert toile.flatten([[0, 0, 0], [100, 0, 0], [0, 100, 0]], [[0, 1, 2]], threads=vast).pieces == flat.pieces
    with pytest.raises(toile.InputError, match="body: 'nobody' is neither"):
        toile.Garment.from_garmentcode(_pattern(tmp_path), body="nobody")
    with pytest.raises(toile.InputError, match="give body ") as bare:
        toile.Garment.from_dict(BARE).make(spacing=COARSE)
    assert "--body" not in str(bare.value)


# A piece that hangs on nobody.
BARE: dict[str, Any] = {
    "garment": 1,
    "fabrics": {"cloth": "denim"},
    "pieces": {
        "sheet": {
            "grain": [[10, 10], [10, 90]],
            "place": {"at": [0, 0, 0]},
            "outline": {"start": "0 0", "a": "L 100 0", "b": "L 100 100", "c": "L 0 100", "d": "L 0 0"},
        }
    },
    "free": ["sheet.*"],
}


def _pattern(folder: Path) -> Path:
    """A square of GarmentCode's."""
    edges = [{"endpoints": [k, (k + 1) % 4]} for k in range(4)]
    panel = {"translation": [0, 100, 20], "rotation": [0, 0, 0], "edges": edges}
    panel["vertices"] = [[-20, -30], [20, -30], [20, 0], [-20, 0]]
    properties = {"curvature_coords": "relative", "units_in_meter": 100}
    said = {"pattern": {"panels": {"front": panel}, "stitches": []}, "properties": properties}
    (folder / "square_specification.json").write_text(json.dumps(said))
    return folder / "square_specification.json"


def test_faces_without_an_area_are_an_error_of_the_input() -> None:
    line, point = [[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 0, 0], [1e-12, 0, 0], [0, 1e-12, 0]]
    for vertices, faces in [(line, [[0, 1, 2]]), (line, [[0, 0, 1]]), (point, [[0, 1, 2]])]:
        with pytest.raises(toile.InputError, match="faces has an area"):
            toile.flatten(vertices, faces)


def test_a_worker_finds_its_own_toile_and_pythons_own_modules(tmp_path: Path) -> None:
    """Started by its path, as batches start it."""
    program = Path(toile.__file__).with_name("__main__.py")
    # As Python begins with a script, whose folder is the first that it looks into.
    script = f"""
import runpy, sys
sys.argv = [{str(program)!r}, "--version"]
sys.path.insert(0, {str(program.parent)!r})
try:
    runpy.run_path(sys.argv[0], run_name="__main__")
except SystemExit as ended:
    assert ended.code == 0
import _json
assert hasattr(_json, "encode_basestring")
"""
    run = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0 and "toile" in run.stdout, run.stderr
    # Another toile on the path of the caller's Python is not the one that makes his garments.
    other = {**os.environ, "PYTHONPATH": str(tmp_path / "other")}
    (tmp_path / "other" / "toile").mkdir(parents=True)
    (tmp_path / "other" / "toile" / "__init__.py").write_text("raise SystemExit('another toile')")
    run = subprocess.run([sys.executable, program, "--version"], env=other, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def test_a_worker_that_cannot_run_stops_the_batch(
    skirt: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for words in ["import nothing_of_this_name", "raise SystemExit(2)"]:
        monkeypatch.setattr("toile._batch.PROGRAM", [sys.executable, "-c", words])
        with pytest.raises(toile.ComputationError, match="before it began"):
            toile.batch([{"garment": skirt, "spacing": COARSE}], store=tmp_path / "store")
    assert not any(len(name) == 32 for name in os.listdir(tmp_path / "store"))
    assert not (tmp_path / "store" / "failed").exists()


def test_garments_are_saved_and_pickled(skirt: Path, tmp_path: Path) -> None:
    garment = toile.Garment.load(skirt).alter({"lengthen": "front", "at": 200, "by": 20})
    garment.save(tmp_path / "longer.yaml")
    saved = toile.Garment.load(tmp_path / "longer.yaml")
    assert saved.text == garment.text and saved.name == "longer"
    sheet = put_ball_and_sheet(tmp_path)
    (tmp_path / "other").mkdir()
    with pytest.raises(toile.InputError, match="names ball.obj, which is in"):
        toile.Garment.load(sheet).save(tmp_path / "other" / "sheet.yaml")
    toile.Garment.load(sheet).save(tmp_path / "again.yaml")
    assert (tmp_path / "again.yaml").read_text() == sheet.read_text()

    measured = toile.Fabric.measure({"name": "mine", "values": {"weight": "115 g/m2", "bend": "0.05 gf.cm2/cm"}})
    body = toile.Body.build("woman_92", {"waist": 740})
    for other in [copy.copy, lambda value: pickle.loads(pickle.dumps(value))]:
        assert other(garment).text == garment.text and other(garment).name == "skirt"
        assert np.array_equal(other(body).vertices, body.vertices)
        assert other(measured).areal_density == measured.areal_density and other(measured).name == "mine"
        assert other(toile.Fabric.load("denim")).name == "denim"
        other(measured).save(tmp_path / "mine.yaml")


def test_results_are_pickled(skirt: Path, tmp_path: Path) -> None:
    """As a process of a pool hands them back."""
    garment = toile.Garment.load(skirt)
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        there = pool.submit(garment.make, spacing=COARSE).result()
    made = garment.make(spacing=COARSE)
    for name in ["vertices", "faces", "uv", "piece_of_face", "strain", "ease", "pressure"]:
        ours, theirs = getattr(made, name), getattr(there, name)
        assert np.array_equal(ours, theirs) and ours.dtype == theirs.dtype and ours.shape == theirs.shape, name
    assert (there.name, there.pieces, there.in_bounds, there.notes) == ("skirt", made.pieces, made.in_bounds, made.notes)
    for result in [made, there]:
        result.save(tmp_path / "out")
        on = garment.make(spacing=COARSE, start=result)
        assert np.array_equal(on.vertices, garment.make(spacing=COARSE, start=made).vertices)
    # The garment file stays an input that is not written over.
    put_ball_and_sheet(tmp_path)
    (tmp_path / "sheet.yaml").rename(tmp_path / "report.json")
    with pytest.raises(toile.InputError):
        pickle.loads(pickle.dumps(toile.Garment.load(tmp_path / "report.json").make(spacing=20))).save(tmp_path)

    flat = toile.flatten([[0, 0, 0], [100, 0, 0], [0, 100, 0]], [[0, 1, 2], [0, 0, 1]])
    other = pickle.loads(pickle.dumps(flat))
    assert np.array_equal(other.uv, flat.uv, equal_nan=True) and np.array_equal(other.piece_of_face, flat.piece_of_face)
    assert (other.pieces, other.notes, other.report) == (flat.pieces, flat.notes, flat.report)
    other.save(tmp_path / "flat")
    found = garment.fit({"hem": {"above_floor": "100..2000 mm"}}, spacing=COARSE)
    again = copy.deepcopy(found)
    assert again.garment is not None and found.garment is not None and again.garment.text == found.garment.text
    assert (again.report, again.in_bounds, repr(again)) == (found.report, found.in_bounds, repr(found))


def test_files_that_are_none_are_told(skirt: Path, tmp_path: Path) -> None:
    endless, pipe = Path("/dev/zero"), tmp_path / "pipe"
    if hasattr(os, "mkfifo"):
        os.mkfifo(pipe)
    for file in [endless, pipe, tmp_path]:
        if file.exists():
            for read in [toile.Garment.from_garmentcode, toile.Garment.from_svg, toile.Garment.load]:
                with pytest.raises(toile.InputError, match=file.name):
                    read(file)
    (tmp_path / "index.jsonl").write_bytes(b"\xff\n")
    for store in [tmp_path, "a\0b"]:
        with pytest.raises(toile.InputError, match="is this the store of a batch"):
            toile.index(store)
    with pytest.raises(toile.InputError, match="^body_units: 'ft' is no unit"):
        toile.Garment.load(skirt).make(body_units="ft")  # type: ignore[arg-type]
    with pytest.raises(toile.InputError, match="^readings has no measurements"):
        toile.Fabric.measure({})


def test_a_fit_is_that_of_the_command_line(skirt: Path, tmp_path: Path) -> None:
    garment = toile.Garment.load(skirt)
    knobs = {"length": {"lengthen": ["front", "back"], "at": 200, "by": "-60..90"}}
    hem = garment.make(spacing=COARSE).report["fit"]["lengths"]
    assert hem, "the skirt has a hem"
    plain = garment.fit({"hem": {"above_floor": "100..2000 mm"}}, spacing=COARSE)
    assert plain.in_bounds and plain.changes == [] and plain.garment is not None
    assert plain.garment.text == garment.text
    [row] = plain.report["wants"]
    wants = {"hem": {"above_floor": f"{row['before'] - 30:.0f} mm"}, "knobs": knobs}
    told: list[str] = []
    found = garment.fit(wants, spacing=COARSE, threads=1, progress=lambda stage, _: told.append(stage))
    assert found.in_bounds and found.garment is not None and told, found.problems
    assert len(found.changes) == 1 and found.garment.text != garment.text
    [row] = found.report["wants"]
    assert row["ok"] and abs(row["after"] - row["from"]) < 3

    (tmp_path / "wants.yaml").write_text(json.dumps(wants))
    words = ["--want", tmp_path / "wants.yaml", "-o", tmp_path / "new.yaml", "--spacing", COARSE, "--json"]
    run = command("fit", skirt, *words)
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout) == found.report
    assert (tmp_path / "new.yaml").read_text() == found.garment.text
    assert garment.fit(tmp_path / "wants.yaml", spacing=COARSE).report == found.report

    far = garment.fit({"hem": {"above_floor": "3000 mm"}, "knobs": knobs}, spacing=COARSE)
    assert not far.in_bounds and far.garment is None and far.problems
    with pytest.raises(toile.GarmentError, match="wants"):
        garment.fit({}, spacing=COARSE)
    with pytest.raises(toile.GarmentError, match="hemm"):
        garment.fit({"hemm": 3}, spacing=COARSE)
