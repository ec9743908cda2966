"""The compiled part of toile."""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._errors import Diagnostic

__version__: str
__build__: str

_Path = str | os.PathLike[str]
_Units = Literal["mm", "cm", "dm", "m", "in"]
_Mode = Literal["balanced", "isometric", "boundary", "woven", "spring"]

class Garment:
    """A garment: its pieces, seams, fabrics and body, as a garment file says them."""

    @staticmethod
    def load(path: _Path) -> Garment:
        """Reads a garment file (YAML). Its mistakes raise :class:`GarmentError`."""

    @staticmethod
    def from_dict(data: dict[str, Any], name: str = "garment", folder: _Path = "") -> Garment:
        """A garment from what a garment file says, as nested dicts and lists.

        Files that it names, as fabrics and bodies, are looked for in ``folder``.
        """

    @staticmethod
    def from_garmentcode(path: _Path, body: _Path | Body | None = None) -> Garment:
        """A garment from GarmentCode's pattern specification (JSON), worn by ``body``."""

    @staticmethod
    def from_svg(
        path: _Path, seams: bool = True, units: float | None = None, size: str | None = None
    ) -> Garment:
        """A garment from a drawing (SVG).

        Args:
            seams: Sew the seams that are suggested; otherwise all edges are free.
            units: Length of the drawing's unit, mm.
            size: The size to read of a drawing in several.
        """

    @property
    def name(self) -> str:
        """The short name, which is that of the file."""

    @property
    def text(self) -> str:
        """The text of the garment file, with its alterations carried out if there are any of :meth:`alter`."""

    @property
    def sizes(self) -> list[str]:
        """Names of the sizes that the garment file has."""

    @property
    def notes(self) -> list[str]:
        """What was said when it was imported."""

    def alter(self, changes: dict[str, Any] | Sequence[dict[str, Any]] | str) -> Garment:
        """The garment with its pattern altered, as ``toile alter``; this one stays as it is.

        Args:
            changes: Alterations as a garment file has them under ``alter``: a dict
                (``{"lengthen": ["front", "back"], "at": 200, "by": 20}``), a list of them, or a text (YAML).

        Raises:
            GarmentError: An alteration cannot be done, or seams no longer match.
        """

    def check(self, spacing: float | None = None, size: str | None = None) -> list[Diagnostic]:
        """Finds everything that is wrong before cloth moves; mistakes raise :class:`GarmentError`.

        Args:
            spacing: Distance of neighbouring particles that it will be made with, mm (10 by default).
            size: A size of the garment.

        Returns:
            What its author may not have meant so.
        """

    def make(
        self,
        body: _Path | Body | None = None,
        fabric: _Path | Fabric | None = None,
        spacing: float | None = None,
        threads: int | None = None,
        start: Result | _Path | None = None,
        progress: Callable[[str, float], object] | None = None,
        body_units: _Units | None = None,
        size: str | None = None,
        pressure_bands: tuple[float, float] | None = None,
        over: Sequence[Garment] = (),
    ) -> Result:
        """Sews, drapes and flattens the garment, as the command ``toile make``.

        Args:
            body: Library name or file in place of the garment's own body.
            fabric: Library name or file in place of its main fabric.
            spacing: Distance of neighbouring particles, mm (10 by default).
            threads: Number of threads (all processors by default). Results do not depend on it.
            start: An earlier result to go on from, or its folder: of this garment, or of what it was before its pieces,
                fabrics, body or spacing were changed. The cloth starts where that one hangs.
            progress: Called with the stage and the share of it that is done, from 0 to 1. What it raises ends the work.
            body_units: Unit of the body's OBJ file.
            size: A size of the garment.
            pressure_bands: Pressures in kPa from which cloth is tight, and above which it is too tight.
            over: Garments that are worn over this one, from the skin outwards. All must be made for the same body,
                unless ``body`` is given. A size holds for all of them. ``fabric`` does not say of which garment.

        Raises:
            GarmentError: The garment file has mistakes.
            InputError: The body, the fabric, the spacing or the earlier result is wrong.
            ComputationError: It cannot be sewn, draped or flattened.
        """

    def fit(
        self,
        wants: Mapping[str, Any] | _Path | None = None,
        body: _Path | Body | None = None,
        fabric: _Path | Fabric | None = None,
        spacing: float | None = None,
        threads: int | None = None,
        drapes: int | None = None,
        progress: Callable[[str, float], object] | None = None,
        body_units: _Units | None = None,
    ) -> Fit:
        """Finds the alterations that give the garment a fit, as ``toile fit``; this one stays as it is.

        Args:
            wants: What is wanted, and alterations that may be made, as a file of wants says them: nested dicts, or a
                file. By default the garment's own tests of ease, pressure and hem, or else that no girth is tight.
            body: Library name or file in place of the garment's own body.
            fabric: Library name or file in place of its main fabric.
            spacing: Distance of neighbouring particles, mm (20 by default).
            threads: Number of threads (all processors by default). Results do not depend on it.
            drapes: Most drapes (12 by default).
            progress: Called with the work under way and the share of it that is done. What it raises ends the work.
            body_units: Unit of the body's OBJ file.

        Raises:
            GarmentError: The garment file or the wants have mistakes.
            InputError: The body, the fabric or a number is wrong.
            ComputationError: The garment cannot be made.
        """

    def save(self, path: _Path) -> None:
        """Writes the garment file (YAML), with its alterations carried out, whole or not at all.

        Args:
            path: The file. Bodies and fabrics that the garment names by files must be found from its folder, too.

        Raises:
            InputError: A file that the garment names is not found from there.
            WriteError: The file cannot be written.
        """

    @property
    def _state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def _restored(file: _Path, text: str, alter: list[str], notes: list[str]) -> Garment: ...

class Fit:
    """The alterations that were found to give a garment the fit that is wanted."""

    @property
    def garment(self) -> Garment | None:
        """The garment with the alterations, or as it was if it fits already; None if the wants cannot be had."""

    @property
    def changes(self) -> list[str]:
        """The changes in words."""

    @property
    def alterations(self) -> list[str]:
        """The alterations as they stand in a garment file, a text each, as :meth:`Garment.alter` takes them."""

    @property
    def problems(self) -> list[str]:
        """Why the wants cannot be had, and problems that the altered garment has and the one before had not."""

    @property
    def report(self) -> dict[str, Any]:
        """The figures, as of ``toile fit --json``: the wants before and after, the alterations and their amounts."""

    @property
    def in_bounds(self) -> bool:
        """Whether the garment fits as it is wanted (exit code 0 of ``toile fit``, otherwise 1)."""

    @property
    def _state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def _restored(*state: Any) -> Fit: ...

class Result:
    """A garment as it was sewn, draped and laid flat: n vertices, m triangles. Every array is a copy."""

    @property
    def name(self) -> str:
        """The garment's name."""

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Shape (n, 3): positions, mm, y up. Particles that a seam joins are one vertex."""

    @property
    def faces(self) -> NDArray[np.uint32]:
        """Shape (m, 3): vertices of every triangle, counter-clockwise seen from the right side of the cloth."""

    @property
    def uv(self) -> NDArray[np.float64]:
        """Shape (m, 3, 2): flat position (x, −y) at every corner of every triangle, mm."""

    @property
    def pieces(self) -> list[str]:
        """Names of the pieces."""

    @property
    def piece_of_face(self) -> NDArray[np.uint32]:
        """Shape (m,): the piece of every triangle, an index into ``pieces``."""

    @property
    def strain(self) -> NDArray[np.float64]:
        """Shape (m, 3, 2): strain of warp and of weft at every corner of every triangle, as fractions."""

    @property
    def ease(self) -> NDArray[np.float64]:
        """Shape (n,): distance of every vertex from the body, mm."""

    @property
    def pressure(self) -> NDArray[np.float64]:
        """Shape (n,): pressure on the body, kPa."""

    @property
    def report(self) -> dict[str, Any]:
        """The figures, as in ``report.json``."""

    @property
    def in_bounds(self) -> bool:
        """Whether it keeps its own bounds (exit code 0 of ``toile make``, otherwise 1)."""

    @property
    def notes(self) -> list[str]:
        """What its author may not have meant so."""

    def save(self, folder: _Path) -> None:
        """Writes the files of ``toile make``, whole or not at all: the same bytes, but for times in the report."""

    @property
    def _state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def _restored(*state: Any) -> Result: ...

class Body:
    """A mannequin, or a body of one's own: n vertices, m triangles."""

    @staticmethod
    def load(name: _Path, units: _Units | None = None) -> Body:
        """A mannequin by its library name, a file of sections (YAML) or a closed OBJ in ``units``."""

    @staticmethod
    def build(like: _Path, measures: Mapping[str, float | str] | _Path) -> Body:
        """A mannequin with the measures of a person, as ``toile mannequin build``.

        Args:
            like: The mannequin that has what is not measured, by its library name or its file of sections (YAML).
            measures: Names and lengths, mm or texts with a unit (``{"bust": 1040, "height": "170 cm"}``), or a file of
                them: ours, FreeSewing's, or a body of GarmentCode.

        Raises:
            InputError: A name is no measure, or the measures contradict one another or are far from the mannequin's.
        """

    @staticmethod
    def library() -> list[str]:
        """Names of the mannequins that toile brings."""

    def save(self, path: _Path) -> None:
        """Writes its surface (OBJ): millimetres, y up, feet at y = 0."""

    @property
    def _job(self) -> dict[str, Any]: ...

    @property
    def name(self) -> str:
        """The short name."""

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Shape (n, 3): positions, mm, y up, where the body's own file has it."""

    @property
    def faces(self) -> NDArray[np.uint32]:
        """Shape (m, 3): vertices of every triangle, counter-clockwise seen from outside."""

    @property
    def notes(self) -> list[str]:
        """What was guessed or done when it was read: its unit, its stance, crossings."""

class Fabric:
    """A fabric with every value."""

    @staticmethod
    def load(name: _Path) -> Fabric:
        """A fabric by its library name or its file (YAML)."""

    @staticmethod
    def measure(readings: Mapping[str, Any] | _Path, name: str | None = None, folder: _Path = "") -> Fabric:
        """A fabric from readings, as ``toile fabric measure``.

        Args:
            readings: A file of readings, a table or a laboratory's sheet; or what such a file (YAML) says as nested
                dicts and lists.
            name: The fabric's name where the readings say none, by default that of the file.
            folder: Where files that a dict names are looked for.

        Raises:
            InputError: Too few or impossible readings, or values of no cloth.
        """

    @staticmethod
    def library() -> list[str]:
        """Names of the fabrics that toile brings."""

    def save(self, path: _Path) -> None:
        """Writes the fabric file (YAML) of a fabric that was measured here."""

    @property
    def _job(self) -> dict[str, Any]: ...
    @property
    def _state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def _restored(name: str | None, text: str | None, notes: list[str]) -> Fabric: ...

    @property
    def notes(self) -> list[str]:
        """What its user should know: doubtful readings, values that hardly any cloth has."""

    @property
    def name(self) -> str:
        """The short name."""

    @property
    def areal_density(self) -> float:
        """Mass per area, kg/m²."""

    @property
    def thickness(self) -> float:
        """Thickness, mm."""

    @property
    def bending(self) -> tuple[float, float]:
        """Bending rigidity along warp and weft, N·m (per metre of width)."""

    @property
    def extension(self) -> tuple[float, float]:
        """Extension of warp and weft under 500 gf/cm (KES EMT), as fractions."""

    @property
    def shear(self) -> float:
        """Shear stiffness, N/m per radian."""

    @property
    def friction(self) -> float:
        """Coulomb friction against the body and against cloth."""

    @property
    def source(self) -> str:
        """Source of the values."""

    @property
    def assumed(self) -> list[str]:
        """Values that were not measured but assumed."""

class Flat:
    """A surface laid flat: m triangles."""

    @property
    def uv(self) -> NDArray[np.float64]:
        """Shape (m, 3, 2): flat position (x, −y) at every corner of every face that was given, mm.

        NaN for a face that was left out (doubled, without area), is split by a cut, or cannot be laid flat.
        """

    @property
    def piece_of_face(self) -> NDArray[np.int32]:
        """Shape (m,): the piece of every face, an index into ``pieces``; −1 for a face without."""

    @property
    def pieces(self) -> list[str]:
        """Names of the pieces."""

    @property
    def notes(self) -> list[str]:
        """What was done or guessed on the way."""

    @property
    def report(self) -> dict[str, Any]:
        """The figures, as in ``report.json`` of ``toile flatten``."""

    def save(self, folder: _Path) -> None:
        """Writes the files of ``toile flatten``, whole or not at all."""

    @property
    def _state(self) -> tuple[Any, ...]: ...
    @staticmethod
    def _restored(*state: Any) -> Flat: ...

def flatten(
    vertices: NDArray[np.floating[Any]] | Sequence[Sequence[float]],
    faces: NDArray[np.integer[Any]] | Sequence[Sequence[int]],
    mode: _Mode = "balanced",
    units: _Units | None = "mm",
    up: tuple[float, float, float] | None = None,
    cut: bool = False,
    darts: int = 0,
    weld: float | None = None,
    threads: int | None = None,
    name: str = "surface",
) -> Flat:
    """Lays a surface flat, as the command ``toile flatten``.

    Args:
        vertices: Shape (n, 3): positions.
        faces: Shape (m, 3): vertices of every triangle, counter-clockwise seen from outside. Messages, notes and the
            report number vertices and faces as these arrays do, from 0; the command ``toile flatten`` does from 1.
        mode: What to keep where not everything can be kept.
        units: Unit of the positions; None guesses it from the size.
        up: Direction that lies along the grain (y, or z where the surface runs along z).
        cut: Cut the surface open where it is needed.
        darts: Number of darts at most that are cut where the strain passes 10 %; into a round piece as many even ones.
        weld: Join vertices within so many millimetres of each other, none with 0. By default those of different parts
            within 0.01 mm are joined.
        threads: Number of threads (all processors by default). Results do not depend on it.
        name: Its name in the report.

    Raises:
        InputError: The surface cannot be laid flat as it is.
        ComputationError: It could not be computed.
    """

class _Hold:
    """A work folder of the store, which is there as long as this is held."""

    def __init__(self, store: _Path) -> None: ...
    @property
    def folder(self) -> str | None: ...
    def release(self) -> None: ...

def run_batch(
    texts: list[str],
    store: str,
    program: list[str],
    side_by_side: int | None,
    time: float | None,
    memory: int | None,
    threads: int,
    retry: bool,
    progress: Callable[[str, float], object] | None,
) -> dict[str, int]: ...
def run_job(
    text: str,
    store: str,
    held: str,
    program: list[str],
    time: float | None,
    memory: int | None,
    threads: int,
    retry: bool,
) -> dict[str, Any]: ...
def read_list(list: _Path) -> list[str]: ...
def check_list(texts: list[str]) -> list[str]: ...
def cli(arguments: list[str], itself: list[str]) -> int: ...
