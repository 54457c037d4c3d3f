"""How much of long work is done."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator
from contextlib import contextmanager

from palpate._palpate import OptionError


@contextmanager
def bar(progress: bool | None, total: int, unit: str) -> Generator[Callable[[int], None] | None]:
    """Something to call with how much is done: a bar of tqdm where that is there, and where somebody looks or has requested it."""
    if progress is False or (progress is None and not sys.stderr.isatty()):
        yield None
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        if progress:
            raise OptionError("progress: expected tqdm, found none; install it, or leave progress out") from None
        yield None
        return
    with tqdm(total=total, unit=unit, delay=0 if progress else 1.0) as shown:

        def tell(done: int) -> None:
            shown.update(done - shown.n)

        yield tell
