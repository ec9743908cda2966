"""What the tests share."""

from __future__ import annotations

import subprocess
import sys
from math import cos, pi, sin
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]
# A skirt of two pieces, and a spacing (mm) at which it takes a second.
SKIRT = REPOSITORY / "tests" / "data" / "skirt.yaml"
COARSE = 60.0


@pytest.fixture
def skirt() -> Path:
    return SKIRT


def command(*words: object) -> subprocess.CompletedProcess[str]:
    """Runs the command line of the installed package."""
    return subprocess.run([sys.executable, "-m", "toile", *map(str, words)], capture_output=True, text=True)


# A sheet of 100 mm that falls on a ball of 50 mm: nothing is sewn, and its picture takes longer than its drape.
SHEET = """\
garment: 1
body: ball.obj
body_units: mm
fabrics: {cloth: cotton_poplin}
pieces:
  sheet:
    grain: [[10, 10], [10, 90]]
    place: {at: [-50, 60, 50], turn: [90, 0, 0]}
    outline: {start: 0 0, north: L 100 0, east: L 100 100, south: L 0 100, west: L 0 0}
free: [sheet.*]
"""


def put_ball_and_sheet(folder: Path, around: int = 12, up: int = 6) -> Path:
    """Writes the sheet and its ball, with so many triangles round it and along it, and gives the garment file."""
    at = [(pi * row / up, 2 * pi * k / around) for row in range(1, up) for k in range(around)]
    ring = [(50 * sin(t) * cos(p), 50 * cos(t), -50 * sin(t) * sin(p)) for t, p in at]
    points = [(0.0, 50.0, 0.0), *ring, (0.0, -50.0, 0.0)]
    faces: list[tuple[int, int, int]] = []
    for k in range(around):
        a, b = k + 2, (k + 1) % around + 2
        faces.append((1, a, b))
        for row in range(up - 2):
            low = (row + 1) * around
            faces += [(a + row * around, a + low, b + row * around), (b + row * around, a + low, b + low)]
        last = (up - 2) * around
        faces.append((a + last, len(points), b + last))
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points] + [f"f {a} {b} {c}" for a, b, c in faces]
    (folder / "ball.obj").write_text("\n".join(lines) + "\n")
    (folder / "sheet.yaml").write_text(SHEET)
    return folder / "sheet.yaml"
