"""What is raised."""

from __future__ import annotations

from typing import NamedTuple


class Diagnostic(NamedTuple):
    """A finding in a garment file.

    Attributes:
        severity: ``"error"`` or ``"warning"``.
        file: The file's name.
        line: Line from 1; 0 is the file as a whole.
        column: Column from 1.
        message: What is wrong, with its numbers.
        hint: What to do, if that is known.
        text: All of it with the line of the file, as the command line shows it.
    """

    severity: str
    file: str
    line: int
    column: int
    message: str
    hint: str | None
    text: str

    def __str__(self) -> str:
        return self.text


class Error(Exception):
    """Every error of toile."""


class InputError(Error, ValueError):
    """An option, a body, a fabric or a file is wrong. The message says which and what to do."""


class GarmentError(InputError):
    """A garment file has mistakes.

    Attributes:
        diagnostics: All of them, each with its place and a hint.
    """

    diagnostics: list[Diagnostic] = []


class WriteError(Error, OSError):
    """A result cannot be written."""


class ComputationError(Error, RuntimeError):
    """It could not be computed.

    Attributes:
        files: The state that was reached, by file names, as ``garment.png`` and ``sewn.obj``; may be empty.
    """

    files: dict[str, bytes] = {}
