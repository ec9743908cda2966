"""What the tests share."""

from __future__ import annotations

import subprocess
import sys
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
