"""Garments from flat patterns: sewn onto a mannequin, draped in a measured fabric and laid flat again.

>>> import toile
>>> shirt = toile.Garment.load("tshirt.yaml")
>>> result = shirt.make(body="man_100", fabric="jersey", spacing=15)
>>> result.vertices.shape, result.report["stages"][-1]["name"]
>>> result.save("out/tshirt")

Lengths are millimetres, y is up. Arrays are NumPy's. Long work runs without the interpreter's lock and ends with
Ctrl-C. The same input gives the same bytes as the command ``toile make`` writes, for any number of threads.
"""

from . import _pickle as _pickle
from ._batch import batch
from ._errors import ComputationError, Diagnostic, Error, GarmentError, InputError, WriteError
from ._index import index, to_parquet
from ._progress import show_on
from ._toile import Body, Fabric, Fit, Flat, Garment, Result, __version__, flatten

__all__ = [
    "Body",
    "ComputationError",
    "Diagnostic",
    "Error",
    "Fabric",
    "Fit",
    "Flat",
    "Garment",
    "GarmentError",
    "InputError",
    "Result",
    "WriteError",
    "__version__",
    "batch",
    "flatten",
    "index",
    "show_on",
    "to_parquet",
]
