"""Options as texts by their names, for the library to parse: they are understood, and refused, as on the command line."""

from __future__ import annotations

import math
import operator
import os
from collections.abc import Iterable
from typing import Literal, SupportsIndex, Union

from ._native import SwitchbackError

#: Whether uneven rows are brought to even ones, and how.
Resample = Union[bool, Literal["linear", "hold"], None]

#: What an option may be: absent, a switch, a value, or several values of one option.
Option = Union[None, bool, str, int, float, "os.PathLike[str]", Iterable[str]]


def texts(**options: Option) -> dict[str, list[str]]:
    """``sample_time=0.01`` becomes ``{"sample_time": ["0.01"]}``; a switch has no text; ``None``, ``False`` and no values are left out."""
    found: dict[str, list[str]] = {}
    for name, value in options.items():
        if value is None or value is False:
            continue
        if value is True:
            found[name] = []
        elif isinstance(value, (str, os.PathLike)):
            found[name] = [os.fspath(value)]
        elif not isinstance(value, Iterable):
            found[name] = [number(value)]
        elif several := [str(one) for one in value]:
            found[name] = several
    return found


def number(value: float) -> str:
    """The shortest decimals that are read back as the same number."""
    if isinstance(value, SupportsIndex):
        return str(operator.index(value))
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def pair(value: tuple[float, float] | None, name: str) -> str | None:
    """Two numbers with a comma between them."""
    if value is None:
        return None
    try:
        low, high = value
    except (TypeError, ValueError):
        raise SwitchbackError(f"{name}={value!r}: give two numbers, as in (-40, 40)") from None
    ends = (real(end, name) for end in (low, high))
    return ",".join(number(end) for end in ends if end is not None)


def real(value: float | None, name: str) -> float | None:
    """A finite number, if anything."""
    if value is None:
        return None
    try:
        found = float(value)
    except (TypeError, ValueError):
        found = math.nan
    if not math.isfinite(found):
        raise SwitchbackError(f"{name}={value!r}: give a finite number")
    return found


def whole(value: int | None, name: str) -> int | None:
    """A whole number, if anything."""
    if value is None:
        return None
    try:
        return operator.index(value)
    except TypeError:
        raise SwitchbackError(f"{name}={value!r}: give a whole number") from None


def between(value: Resample) -> str | None:
    """``linear``, which ``True`` stands for, or ``hold``, if anything."""
    if value is None or value is False:
        return None
    if value is True:
        return "linear"
    if value not in ("linear", "hold"):
        raise SwitchbackError(f'resample={value!r}: give "linear", "hold" or True, which is linear')
    return value


def several(value: str | Iterable[str] | None) -> list[str]:
    """One name, or some."""
    if value is None:
        return []
    return [value] if isinstance(value, str) else list(value)
