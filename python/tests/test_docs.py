"""The examples of docs/python.md run, one after another in one folder."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
import toile
from conftest import REPOSITORY


def test_the_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (REPOSITORY / "docs" / "python.md").read_text(encoding="utf-8")
    examples = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)
    assert len(examples) == 6
    pytest.importorskip("tqdm", reason="the second example needs tqdm")
    monkeypatch.chdir(tmp_path)
    for k, example in enumerate(examples):
        exec(compile(example, f"docs/python.md, example {k + 1}", "exec"), {})
    assert [line["state"] for line in toile.index(tmp_path / "store")] == ["done", "done", "failed"]
    assert (tmp_path / "out" / "skirt" / "garment.obj").is_file() and (tmp_path / "out" / "cap" / "flat.obj").is_file()
