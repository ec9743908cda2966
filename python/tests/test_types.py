"""The type stubs say what the package has, and mypy accepts them."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest
import toile

HERE = Path(__file__).parents[1]
SOURCES = HERE.parent / "src"
# Sources whose messages Python never says: the command line and the studio, printing, DXF, `check --mesh`. Those of
# batches stand in the index, which the command line shares.
UNSAID = ["cli", "studio", "cutting", "batch", "io/pdf_write", "io/dxf_text.rs", "io/dxf_sizes.rs", "pipeline/judged.rs"]
# Options that Python's arrays and defaults never come to: they have no texture.
NEVER_MEANT = {"--no-texture-seams"}


def test_the_stubs_name_what_there_is() -> None:
    tree = ast.parse((HERE / "package" / "toile" / "_toile.pyi").read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            methods = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
            said = {name for name in methods if not name.startswith("_")}
            there = {name for name in vars(getattr(toile._toile, node.name)) if not name.startswith("_")}
            assert said == there, node.name
        elif isinstance(node, ast.FunctionDef):
            assert hasattr(toile._toile, node.name)


def test_help_says_what_the_stubs_say() -> None:
    tree = ast.parse((HERE / "package" / "toile" / "_toile.pyi").read_text(encoding="utf-8"))
    count = 0
    for kind in [node for node in tree.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")]:
        for member in [node for node in kind.body if isinstance(node, ast.FunctionDef)]:
            if member.name.startswith("_"):
                continue
            there = getattr(getattr(toile, kind.name), member.name).__doc__
            assert there == ast.get_docstring(member), f"{kind.name}.{member.name}"
            count += 1
    assert count > 40


def test_mypy_accepts_the_stubs() -> None:
    pytest.importorskip("mypy", reason="mypy is not installed")
    run = subprocess.run([sys.executable, "-m", "mypy"], cwd=HERE, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout


def test_messages_name_no_option_that_python_does_not_have() -> None:
    table = (HERE / "src" / "errors.rs").read_text(encoding="utf-8")
    known = set(re.findall(r'"[^"]*?(--[a-z][a-z-]*)', table))
    named: set[str] = set()
    for file in sorted(SOURCES.rglob("*.rs")):
        if any(file.is_relative_to(SOURCES / unsaid) for unsaid in UNSAID):
            continue
        own = file.read_text(encoding="utf-8").partition("#[cfg(test)]")[0]
        lines = [line for line in own.splitlines() if not line.lstrip().startswith("//")]
        named |= set(re.findall(r"--[a-z][a-z-]*", "\n".join(lines)))
    assert "--spacing" in named and named - known - NEVER_MEANT == set()
