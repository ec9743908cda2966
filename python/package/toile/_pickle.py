"""Garments, bodies, fabrics and results in other processes: what ``pickle`` and ``copy`` keep of them."""

from __future__ import annotations

import copyreg
from typing import Any

from ._toile import Body, Fabric, Fit, Flat, Garment, Result


def _garment(*state: Any) -> Garment:
    return Garment._restored(*state)


def _body(job: dict[str, Any]) -> Body:
    """A body that is loaded, or built, anew."""
    measures = job.get("measures")
    if measures is None:
        return Body.load(job["body"], job.get("body_units"))
    return Body.build(job["body"], measures)


def _fabric(name: str | None, text: str | None, notes: list[str]) -> Fabric:
    return Fabric._restored(name, text, notes)


def _result(*state: Any) -> Result:
    return Result._restored(*state)


def _fit(*state: Any) -> Fit:
    return Fit._restored(*state)


def _flat(*state: Any) -> Flat:
    return Flat._restored(*state)


def _reduce_result(result: Result) -> tuple[Any, ...]:
    return _result, result._state


def _reduce_fit(fit: Fit) -> tuple[Any, ...]:
    return _fit, fit._state


def _reduce_flat(flat: Flat) -> tuple[Any, ...]:
    return _flat, flat._state


def _reduce_garment(garment: Garment) -> tuple[Any, ...]:
    return _garment, garment._state


def _reduce_body(body: Body) -> tuple[Any, ...]:
    return _body, (body._job,)


def _reduce_fabric(fabric: Fabric) -> tuple[Any, ...]:
    return _fabric, fabric._state


copyreg.pickle(Result, _reduce_result)
copyreg.pickle(Fit, _reduce_fit)
copyreg.pickle(Flat, _reduce_flat)
copyreg.pickle(Garment, _reduce_garment)
copyreg.pickle(Body, _reduce_body)
copyreg.pickle(Fabric, _reduce_fabric)
