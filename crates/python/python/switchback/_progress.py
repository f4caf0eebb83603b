"""How far a call has come, shown by tqdm where that is installed and somebody looks."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Optional

#: Called every twentieth of a second with the stage, the pieces of it that are done, and those that are known.
Heard = Callable[[str, int, int], None]


@contextmanager
def shown(progress: bool | None) -> Iterator[Optional[Heard]]:
    """A listener that draws a bar: if asked to, or left to choose, where stderr is a terminal or a notebook."""
    bar_class = _tqdm() if (_is_watched() if progress is None else progress) else None
    if bar_class is None:
        yield None
        return
    bar = bar_class(total=None, leave=False, disable=False)

    def heard(stage: str, done: int, found: int) -> None:
        bar.set_description_str(stage or "computing", refresh=False)
        bar.total = found or None
        bar.n = done
        bar.refresh()

    try:
        yield heard
    finally:
        bar.close()


def _tqdm() -> Any:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm


def _is_watched() -> bool:
    stderr = sys.stderr
    is_notebook = "ipykernel" in sys.modules
    return is_notebook or (stderr is not None and hasattr(stderr, "isatty") and stderr.isatty())
