"""A program that mypy checks against the stubs. It is not run."""

import numpy as np
import toile
from numpy.typing import NDArray
from typing_extensions import assert_type


def shrink(garment: toile.Garment) -> NDArray[np.float64]:
    result = garment.make(body=toile.Body.load("woman_92"), fabric="denim", progress=lambda stage, share: None)
    assert_type(result.faces, NDArray[np.uint32])
    try:
        garment.check(spacing=10)
    except toile.GarmentError as error:
        assert_type(error.diagnostics, list[toile.Diagnostic])
    flat = toile.flatten(result.vertices, result.faces, mode="woven", up=(0, 1, 0))
    lines = toile.batch([{"garment": "skirt.yaml"}], store="out/store")
    print(lines[0]["state"])
    return flat.uv
