"""Garments and what is made of them."""

from __future__ import annotations

import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import toile
from conftest import COARSE, REPOSITORY, command

ENDLESS = 2.0


@pytest.fixture(scope="module")
def made() -> toile.Result:
    return toile.Garment.load(REPOSITORY / "tests" / "data" / "skirt.yaml").make(spacing=COARSE, threads=2)


def test_bytes_are_those_of_the_command_line(made: toile.Result, skirt: Path, tmp_path: Path) -> None:
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    made.save(ours)
    run = command("make", skirt, "--spacing", COARSE, "--threads", 1, "-o", theirs)
    assert run.returncode == (0 if made.in_bounds else 1), run.stderr
    assert sorted(os.listdir(ours)) == sorted(os.listdir(theirs))
    for name in ["garment.obj", "sewn.obj", "pattern.svg", "garment.png", "garment.glb"]:
        assert (ours / name).read_bytes() == (theirs / name).read_bytes(), name


def test_arrays_are_those_of_the_obj(made: toile.Result, tmp_path: Path) -> None:
    made.save(tmp_path)
    rows: dict[str, list[list[str]]] = {"v": [], "vt": [], "f": []}
    for line in (tmp_path / "garment.obj").read_text().splitlines():
        word, *values = line.split()
        if word in rows:
            rows[word].append(values)
    vertices, texture = np.array(rows["v"], float), np.array(rows["vt"], float)
    corners = np.array([[corner.split("/") for corner in face] for face in rows["f"]], int) - 1
    n, m = len(vertices), len(corners)
    assert made.vertices.shape == (n, 3) and made.vertices.dtype == np.float64
    assert made.faces.dtype == np.uint32 and (made.faces == corners[:, :, 0]).all()
    assert np.abs(made.vertices - vertices).max() < 1e-6
    assert made.uv.shape == (m, 3, 2) and np.abs(made.uv - texture[corners[:, :, 1]]).max() < 1e-6
    assert made.pieces == ["front", "back"] and set(made.piece_of_face) == {0, 1}
    assert made.strain.shape == (m, 3, 2) and 0 < np.abs(made.strain).max() < 0.5
    assert made.ease.shape == made.pressure.shape == (n,)
    assert made.ease.min() > 0 and made.pressure.max() > 0
    assert made.report["garment"] == "skirt" and made.report["spacing"] == COARSE
    triangles = sum(piece["triangles"] for piece in made.report["pieces"])
    assert triangles == m


def obj(folder: Path) -> bytes:
    return (folder / "garment.obj").read_bytes()


def test_an_earlier_result_is_gone_on_from(made: toile.Result, skirt: Path, tmp_path: Path) -> None:
    garment = toile.Garment.load(skirt)
    again = garment.make(fabric="denim", spacing=COARSE, start=made)
    assert again.report["from"]["folder"] == "skirt" and not again.report["from"]["anew"]
    assert "sew" not in [stage["name"] for stage in again.report["stages"]]
    made.save(tmp_path / "made")
    from_folder = garment.make(fabric="denim", spacing=COARSE, start=tmp_path / "made", threads=1)
    assert np.array_equal(from_folder.vertices, again.vertices)
    command("make", skirt, "--fabric", "denim", "--spacing", COARSE, "--from", tmp_path / "made", "-o", tmp_path / "cli")
    again.save(tmp_path / "again")
    assert obj(tmp_path / "again") == obj(tmp_path / "cli")
    for wrong in [tmp_path / "nowhere", skirt]:
        with pytest.raises(toile.InputError, match="no folder of results"):
            garment.make(spacing=COARSE, start=wrong)
    (tmp_path / "empty").mkdir()
    with pytest.raises(toile.InputError, match="report.json"):
        garment.make(spacing=COARSE, start=tmp_path / "empty")


def test_altered_on_a_built_body_in_a_measured_fabric(skirt: Path, tmp_path: Path) -> None:
    garment = toile.Garment.load(skirt)
    longer = garment.alter({"lengthen": "front", "at": 200, "by": 20})
    assert "hem: L -290 300" in garment.text and "hem: L -290 320" in longer.text
    body = toile.Body.build("woman_92", {"waist": 740, "hip": "96 cm"})
    # The skirt is 800 mm at the waist, and its body's hip becomes wider.
    assert np.ptp(body.vertices[:, 0]) != np.ptp(toile.Body.load("woman_92").vertices[:, 0])
    readings = {"name": "mine", "values": {"weight": "115 g/m2", "bend": "0.05 gf.cm2/cm", "thickness": "0.3 mm"}}
    fabric = toile.Fabric.measure(readings)
    assert abs(fabric.areal_density - 0.115) < 1e-9 and "tensile" in fabric.assumed
    fabric.save(tmp_path / "mine.yaml")
    made = longer.make(body=body, fabric=fabric, spacing=COARSE)
    assert made.report["fabric"] == "mine"
    made.save(tmp_path / "ours")
    change, measures = "{lengthen: front, at: 200, by: 20}", "{waist: 740, hip: 960}"
    words = ["--alter", change, "--measures", measures, "--fabric", tmp_path / "mine.yaml", "--spacing", COARSE]
    run = command("make", skirt, *words, "-o", tmp_path / "theirs")
    assert run.returncode < 2, run.stderr
    assert obj(tmp_path / "ours") == obj(tmp_path / "theirs")
    # The same as a job of a batch.
    job = {"garment": skirt, "body": body, "spacing": COARSE, "alter": {"lengthen": "front", "at": 200, "by": 20}}
    with pytest.raises(toile.InputError, match="in no file; save it"):
        toile.batch([{**job, "fabric": fabric}], store=tmp_path / "store")
    [line] = toile.batch([{**job, "fabric": toile.Fabric.load(tmp_path / "mine.yaml")}], store=tmp_path / "store")
    assert obj(tmp_path / "store" / line["folder"]) == obj(tmp_path / "ours")


def test_wrong_alterations_measures_and_readings_are_told(skirt: Path, tmp_path: Path) -> None:
    garment = toile.Garment.load(skirt)
    with pytest.raises(toile.GarmentError, match="did you mean 'front'") as raised:
        garment.alter([{"lengthen": "frnt", "at": 200, "by": 20}])
    assert raised.value.diagnostics[0].line > 0
    with pytest.raises(toile.GarmentError, match="seam 'left'"):
        garment.alter("{let_out: front.left, at: {50 %: 60}}")
    with pytest.raises(toile.InputError, match="did you mean 'waist'"):
        toile.Body.build("woman_92", {"wais": 740})
    with pytest.raises(toile.InputError, match="7.4 mm"):
        toile.Body.build("woman_92", {"waist": 7.4})
    with pytest.raises(toile.InputError, match="weight"):
        toile.Fabric.measure({"values": {"bend": "0.05 gf.cm2/cm"}})
    with pytest.raises(toile.InputError, match="loaded, not measured"):
        toile.Fabric.load("denim").save(tmp_path / "denim.yaml")
    for wrong in [float("nan"), {1}, "\ud800"]:
        with pytest.raises(toile.InputError, match="no file can hold"):
            toile.Garment.from_dict({"garment": wrong})
    for none in [toile.Garment.load, toile.Garment.from_svg, toile.Garment.from_garmentcode]:
        with pytest.raises(toile.InputError, match="none.txt"):
            none(tmp_path / "none.txt")
    with pytest.raises(toile.InputError, match="at least one"):
        garment.make(spacing=COARSE, threads=0)
    with pytest.raises(toile.GarmentError, match="size '44' not found"):
        garment.make(spacing=COARSE, size="44")


def test_a_size_is_that_of_the_command_line(skirt: Path, tmp_path: Path) -> None:
    sized = tmp_path / "sized.yaml"
    sized.write_text(skirt.read_text() + "sizes: {long: [{lengthen: front, at: 200, by: 30}]}\n")
    garment = toile.Garment.load(sized)
    assert garment.sizes == ["long"] and garment.check(spacing=COARSE, size="long") == []
    made = garment.make(spacing=COARSE, size="long")
    assert made.name == "sized-long"
    made.save(tmp_path / "ours")
    command("make", sized, "--size", "long", "--spacing", COARSE, "-o", tmp_path / "theirs")
    narrow = garment.make(spacing=COARSE, size="long", pressure_bands=(0.001, 0.002))
    assert narrow.report["fit"]["bands"] != made.report["fit"]["bands"]
    assert obj(tmp_path / "ours") == obj(tmp_path / "theirs")


def test_garments_are_worn_over_one_another(skirt: Path, tmp_path: Path) -> None:
    wide = skirt.read_text().replace("200 0", "215 0").replace("290 300", "320 300")
    (tmp_path / "over.yaml").write_text(wide)
    inner, outer = toile.Garment.load(skirt), toile.Garment.load(tmp_path / "over.yaml")
    made = inner.make(over=[outer], spacing=COARSE)
    assert made.pieces == ["skirt/front", "skirt/back", "over/front", "over/back"]
    made.save(tmp_path / "ours")
    command("make", skirt, tmp_path / "over.yaml", "--spacing", COARSE, "-o", tmp_path / "theirs")
    assert obj(tmp_path / "ours") == obj(tmp_path / "theirs")
    # Every garment keeps its own alterations.
    longer = outer.alter({"lengthen": ["front", "back"], "at": 200, "by": 60})
    below = inner.make(over=[longer], spacing=COARSE)
    assert below.vertices[:, 1].min() < made.vertices[:, 1].min() - 30
    # The same as a job of a batch.
    store, job = tmp_path / "store", {"garment": [inner, outer], "spacing": COARSE}
    [line] = toile.batch([job], store=store)
    assert obj(store / line["folder"]) == obj(tmp_path / "ours")
    with pytest.raises(toile.InputError, match="is altered; save it"):
        toile.batch([{**job, "garment": [inner, longer]}], store=store)
    with pytest.raises(toile.InputError, match="^fabric does not say of which garment"):
        inner.make(over=[outer], fabric="denim", spacing=COARSE)


def test_progress_goes_on_a_bar(skirt: Path) -> None:
    tqdm = pytest.importorskip("tqdm", reason="tqdm is not installed")
    with open(os.devnull, "w") as nowhere, tqdm.tqdm(total=1, file=nowhere) as bar:
        stages: list[str] = []
        show = toile.show_on(bar)

        def tell(stage: str, share: float) -> None:
            show(stage, share)
            assert bar.n == pytest.approx(share) and stage in bar.desc
            stages.append(stage)

        toile.Garment.load(skirt).make(spacing=COARSE, progress=tell)
        assert {"sew", "drape", "flatten"} <= set(stages) and bar.n == 1


def test_a_dict_is_a_garment(made: toile.Result, skirt: Path) -> None:
    outline = [{"start": "-200 0"}, {"waist": "L 200 0"}]
    with pytest.raises(toile.GarmentError):
        toile.Garment.from_dict({"garment": 1, "pieces": {"front": {"outline": outline}}})
    edges = {"start": "-200 0", "waist": "L 200 0", "right": "L 290 300", "hem": "L -290 300", "left": "L -200 0"}
    garment = toile.Garment.from_dict(
        {
            "garment": 1,
            "body": "woman_92",
            "fabrics": {"shell": "cotton_poplin"},
            "pieces": {
                "front": {"place": "hip front", "grain": [[0, 50], [0, 250]], "outline": edges},
                "back": {"like": "front", "place": "hip back"},
            },
            "seams": {
                "left": {"sew": "front.right", "to": "back.left"},
                "right": {"sew": "front.left", "to": "back.right"},
            },
            "free": ["*.waist", "*.hem"],
        },
        name="skirt",
    )
    assert garment.check(spacing=COARSE) == []
    assert np.array_equal(garment.make(spacing=COARSE).vertices, made.vertices)


def test_progress_is_told_and_other_threads_run(skirt: Path) -> None:
    told: list[tuple[str, float]] = []
    ticks, over = [0], threading.Event()

    def tick() -> None:
        while not over.wait(0.01):
            ticks[0] += 1

    other = threading.Thread(target=tick)
    other.start()
    begin = time.monotonic()
    toile.Garment.load(skirt).make(spacing=COARSE, progress=lambda stage, share: told.append((stage, share)))
    seconds = time.monotonic() - begin
    over.set()
    other.join()
    assert {stage for stage, _ in told} >= {"sew", "drape", "flatten"}
    assert all(0 <= share <= 1 for _, share in told)
    assert ticks[0] > 0.3 * seconds / 0.01


def test_ctrl_c_and_what_progress_raises_end_the_work(skirt: Path) -> None:
    garment = toile.Garment.load(skirt)
    # A shell starts what runs behind it with Ctrl-C ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    begin = time.monotonic()
    threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        garment.make(spacing=ENDLESS)
    assert time.monotonic() - begin < 5

    class Enough(Exception):
        pass

    def stop(stage: str, share: float) -> None:
        raise Enough(stage)

    with pytest.raises(Enough, match="sew"):
        garment.make(spacing=ENDLESS, progress=stop)


def test_mistakes_have_a_place_and_a_hint(tmp_path: Path, skirt: Path) -> None:
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(skirt.read_text().replace("back.left}", "back.lift}"))
    with pytest.raises(toile.GarmentError) as raised:
        toile.Garment.load(wrong)
    found = [d for d in raised.value.diagnostics if d.severity == "error"]
    assert any(d.line == 19 and "lift" in d.message and "left" in f"{d.message} {d.hint}" for d in found), found
    assert str(wrong) in str(raised.value)
    garment = toile.Garment.load(skirt)
    with pytest.raises(toile.InputError, match="did you mean 'denim'|denim"):
        garment.make(fabric="denin", spacing=COARSE)
    with pytest.raises(toile.InputError, match="-3"):
        garment.make(spacing=-3)
    with pytest.raises(ValueError):
        garment.make(body="woman_92", body_units="mm", spacing=COARSE)


def test_what_cannot_be_sewn_leaves_its_state() -> None:
    narrow = toile.Garment.load(REPOSITORY / "tests" / "data" / "narrow_tube.yaml")
    with pytest.raises(toile.ComputationError) as raised:
        narrow.make(spacing=30)
    assert raised.value.files["garment.png"].startswith(b"\x89PNG")


def test_imports(tmp_path: Path) -> None:
    drawing = toile.Garment.from_svg(REPOSITORY / "tests" / "data" / "freesewing.svg", seams=False)
    assert "pieces:" in drawing.text and drawing.notes
    with pytest.raises(toile.InputError, match="nothing.json"):
        (tmp_path / "nothing.json").write_text("{}")
        toile.Garment.from_garmentcode(tmp_path / "nothing.json")


def test_bodies_and_fabrics_are_objects(skirt: Path, made: toile.Result) -> None:
    body, fabric = toile.Body.load("woman_92"), toile.Fabric.load("cotton_poplin")
    assert {"woman_92", "man_100", "child_110"} <= set(toile.Body.library())
    assert body.vertices.shape[1] == body.faces.shape[1] == 3
    # It has no head.
    assert 1400 < np.ptp(body.vertices[:, 1]) < 1900
    assert 0.05 < fabric.areal_density < 0.3 and 0.05 < fabric.thickness < 1
    again = toile.Garment.load(skirt).make(body=body, fabric=fabric, spacing=COARSE)
    assert np.array_equal(again.vertices, made.vertices)
