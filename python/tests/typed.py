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
    longer = garment.alter({"lengthen": ["front"], "at": 200, "by": 20}).alter([{"take_in": "side", "at": {"50 %": 8}}])
    body = toile.Body.build("woman_92", {"bust": 1040, "height": "170 cm"})
    fabric = toile.Fabric.measure({"values": {"weight": "115 g/m2", "bend": "0.05 gf.cm2/cm"}})
    assert_type(longer.make(body=body, fabric=fabric, start=result, size="44"), toile.Result)
    flat = toile.flatten(result.vertices, result.faces, mode="woven", up=(0, 1, 0))
    lines = toile.batch([{"garment": "skirt.yaml"}], store="out/store")
    print(lines[0]["state"], toile.index("out/store"), toile.to_parquet("out/store").name)
    return flat.uv
