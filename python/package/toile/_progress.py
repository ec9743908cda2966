"""Progress on a bar."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def show_on(bar: Any) -> Callable[[str, float], None]:
    """What shows ``progress`` on a bar of tqdm: the stage as its description, the stage's share as its length.

    >>> with tqdm(total=1) as bar:
    ...     garment.make(progress=toile.show_on(bar))

    Args:
        bar: A ``tqdm.tqdm``, or what has its ``n``, ``total``, ``update`` and ``set_description``.
    """

    def tell(stage: str, share: float) -> None:
        bar.total = 1
        bar.set_description(stage, refresh=False)
        bar.update(share - bar.n)

    return tell
