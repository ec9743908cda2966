"""Surfaces from memory laid flat."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import toile
from conftest import command

# A half cylinder: radius and height (mm), cells around and along.
RADIUS, HEIGHT, AROUND, ALONG = 50.0, 120.0, 24, 12


def half_cylinder() -> tuple[np.ndarray, np.ndarray]:
    turn, up = np.meshgrid(np.linspace(0, np.pi, AROUND + 1), np.linspace(0, HEIGHT, ALONG + 1))
    vertices = np.stack([RADIUS * np.cos(turn), up, -RADIUS * np.sin(turn)], -1).reshape(-1, 3)
    row, column = (k.ravel() for k in np.meshgrid(range(ALONG), range(AROUND), indexing="ij"))
    first = row * (AROUND + 1) + column
    below, above = first, first + AROUND + 1
    faces = np.concatenate([np.stack([below, below + 1, above], -1), np.stack([below + 1, above + 1, above], -1)])
    return vertices, faces.astype(np.uint32)


def test_a_half_cylinder_is_a_rectangle() -> None:
    vertices, faces = half_cylinder()
    flat = toile.flatten(vertices, faces)
    assert flat.uv.shape == (len(faces), 3, 2) and (flat.piece_of_face == 0).all()
    width, height = np.ptp(flat.uv.reshape(-1, 2), axis=0)
    chord = 2 * RADIUS * np.sin(np.pi / AROUND / 2) * AROUND
    assert abs(width - chord) < 0.05 and abs(height - HEIGHT) < 0.05
    edges = np.linalg.norm(vertices[faces] - vertices[np.roll(faces, 1, 1)], axis=2)
    assert np.abs(np.linalg.norm(flat.uv - np.roll(flat.uv, 1, 1), axis=2) - edges).max() < 0.05


def test_the_file_gives_the_same(tmp_path: Path) -> None:
    vertices, faces = half_cylinder()
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    (tmp_path / "surface.obj").write_text("\n".join(lines) + "\n")
    run = command("flatten", tmp_path / "surface.obj", "--units", "mm", "--mode", "woven", "-o", tmp_path / "out")
    assert run.returncode == 0, run.stderr
    toile.flatten(vertices, faces, mode="woven").save(tmp_path / "ours")
    for name in ["flat.obj", "pattern.svg"]:
        ours = (tmp_path / "ours" / name).read_text().splitlines()
        theirs = (tmp_path / "out" / name).read_text().splitlines()
        # Names of groups differ: a file's part without one is named after the file.
        assert [line for line in ours if line[0] in "vf"] == [line for line in theirs if line[0] in "vf"], name


def test_lists_are_taken_and_nonsense_is_told() -> None:
    vertices, faces = half_cylinder()
    assert toile.flatten(vertices.tolist(), faces.tolist()).pieces
    with pytest.raises(toile.InputError, match="vertex 5000"):
        toile.flatten(vertices, [[0, 1, 5000]])
    with pytest.raises(toile.InputError, match=r"vertices: the shape is to be \(n, 3\), not \(325, 2\)"):
        toile.flatten(vertices[:, :2], faces)
    with pytest.raises(toile.InputError, match="faces: there are none"):
        toile.flatten(vertices, [])
    for wrong in [faces + 0.5, faces.astype(bool), faces.astype(complex), faces.astype(str)]:
        with pytest.raises(toile.InputError, match="faces: whole numbers are expected"):
            toile.flatten(vertices, wrong)
    with pytest.raises(toile.InputError, match="vertices: .*inhomogeneous"):
        toile.flatten([[0, 0, 0], [1, 2]], faces)
    for far in [np.nan, np.inf, 1e300]:
        with pytest.raises(toile.InputError, match="vertex 0"):
            toile.flatten(vertices + far, faces)
    with pytest.raises(toile.InputError, match="known are balanced"):
        toile.flatten(vertices, faces, mode="smooth")


def test_triangles_that_share_no_vertices_are_joined() -> None:
    vertices, faces = half_cylinder()
    # As an STL has it: every triangle with corners of its own.
    loose, own = vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)
    flat = toile.flatten(loose, own, weld=0.01)
    assert len(flat.pieces) == 1 and np.abs(flat.uv - toile.flatten(vertices, faces).uv).max() < 1e-6
    # Two triangles of one cell.
    cell = vertices[faces[[0, AROUND * ALONG]]].reshape(-1, 3)
    assert len(toile.flatten(cell, own[:2], weld=0.01).pieces) == 1
    apart = toile.flatten(cell, own[:2], weld=0)
    assert len(apart.pieces) == 2
    [advice] = [note for note in apart.notes if "joins them" in note]
    assert "; weld=0.01 joins them" in advice
    with pytest.raises(toile.InputError, match="weld: -1 is no distance"):
        toile.flatten(vertices, faces, weld=-1)
    with pytest.raises(toile.InputError, match="cut=True would cut") as raised:
        toile.flatten(*BALL)
    assert "--" not in str(raised.value)


BALL = ([[0, 0, 0], [100, 0, 0], [0, 100, 0], [0, 0, 100]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def test_vertices_and_faces_have_the_numbers_of_the_arrays() -> None:
    square = [[0, 0, 0], [100, 0, 0], [0, 100, 0], [100, 100, 0], [50, 50, 50]]
    with pytest.raises(toile.InputError, match="in the edge of vertices 1 and 2$"):
        toile.flatten(square, [[0, 1, 2], [1, 3, 2], [1, 2, 4]])
    flat = toile.flatten(square[:4], [[0, 1, 2], [0, 1, 2], [1, 3, 2], [0, 0, 1]])
    assert flat.piece_of_face.tolist() == [0, -1, 0, -1]
    assert [note for note in flat.notes if "the same corners" in note][0].endswith("the first is face 1")
    # On so few faces the straight line between the ends of the cut would be an edge, which opens nothing.
    cut = toile.flatten(*BALL, cut=True)
    [made] = cut.report["cuts_made"]
    [chain] = cut.report["cuts"]
    assert (made["from"], made["to"]) == (chain[0], chain[-1]) and len(chain) == 3 and set(chain) <= {0, 1, 2, 3}
    assert any(f"from vertex {made['from']} to vertex {made['to']}" in note for note in cut.notes)


def test_what_arrays_hide_is_told() -> None:
    vertices, faces = half_cylinder()
    masked = np.ma.masked_array(vertices, mask=vertices > HEIGHT - 1)
    with pytest.raises(toile.InputError, match="vertices: some are masked"):
        toile.flatten(masked, faces)
    whole = np.ma.masked_array(vertices)
    assert np.array_equal(toile.flatten(whole, faces).uv, toile.flatten(vertices, faces).uv)
    with pytest.raises(toile.InputError, match=f"faces: {2**64 - 1} is too large"):
        toile.flatten(vertices, np.array([[0, 1, 2**64 - 1]], dtype=np.uint64))
    with pytest.raises(toile.InputError, match=r"the shape is to be \(n, 3\), not \(9,\)"):
        toile.flatten(np.zeros(9), faces)
