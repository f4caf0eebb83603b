"""Arrays and data frames on their way into the program."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._native import SwitchbackError

Floats = NDArray[np.float64]

#: A column as the program takes it: its label, and its numbers as bytes or else its cells as texts.
Column = tuple[str, Optional[bytes], Optional[list[str]]]


def floats(data: bytes) -> Floats:
    """The numbers in some bytes; they belong to nobody else, so that they may be changed."""
    return np.frombuffer(data, dtype=np.float64).copy()


def series(values: ArrayLike, name: str) -> Floats:
    """One series of numbers: an array of one dimension, or of two with one column.

    Raises ``SwitchbackError`` for any other shape, for what is no number, and where there is nothing.
    """
    array = np.asarray(values)
    if array.dtype == object or array.dtype.kind in "SU":
        try:
            array = array.astype(np.float64)
        except (TypeError, ValueError) as error:
            raise SwitchbackError(f"`{name}` holds something else than numbers: {error}") from None
    if array.dtype.kind not in "biuf":
        raise SwitchbackError(f"`{name}` holds {array.dtype} and no real numbers; give float64")
    if array.ndim == 2 and array.shape[1] == 1:
        array = array[:, 0]
    if array.ndim != 1:
        raise SwitchbackError(f"`{name}` has the shape {array.shape}; give one value a sample, shape (samples,)")
    if array.size == 0:
        raise SwitchbackError(f"`{name}` is empty; give one value a sample")
    return np.ascontiguousarray(array, dtype=np.float64)


def finite(values: ArrayLike, name: str) -> Floats:
    """The same where every value must be a number."""
    array = series(values, name)
    bad = np.flatnonzero(~np.isfinite(array))
    if bad.size:
        raise SwitchbackError(
            f"`{name}` is {array[bad[0]]} at sample {bad[0] + 1}"
            + (f" and at {bad.size - 1} more" if bad.size > 1 else "")
            + "; fill in what is missing, or leave these samples out"
        )
    return array


def columns_of(data: Any) -> dict[str, Any]:
    """The columns of a data frame by their labels: pandas, polars, a mapping, a structured array, an array of two dimensions.

    Raises ``SwitchbackError`` for anything else, and where two columns have one label.
    """
    if isinstance(data, Mapping):
        return _unique([(str(name), column) for name, column in data.items()])
    if isinstance(data, np.ndarray):
        return _of_array(data)
    if hasattr(data, "iloc") and hasattr(data, "columns"):  # pandas
        return _unique([(str(name), data.iloc[:, k]) for k, name in enumerate(data.columns)])
    if hasattr(data, "get_columns"):  # polars
        return _unique([(column.name, column) for column in data.get_columns()])
    if hasattr(data, "collect_schema"):
        raise SwitchbackError("this is a lazy frame; give what its `collect()` returns")
    raise SwitchbackError(
        f"a {type(data).__name__} is no data frame; give one of pandas or polars, a mapping of names to columns, or an array"
    )


def column(label: str, values: Any) -> Column:
    """One column as the program takes it."""
    array = _array_of(values)
    if array.ndim != 1:
        raise SwitchbackError(f"the column `{label}` has the shape {array.shape}; give one value a row")
    kind = array.dtype.kind
    if kind in "biuf":
        return label, np.ascontiguousarray(array, dtype=np.float64).tobytes(), None
    if kind == "m":
        seconds = array / np.timedelta64(1, "s")
        return label if "[" in label else f"{label} [s]", seconds.astype(np.float64).tobytes(), None
    if kind == "M":
        stamps = np.datetime_as_string(array.astype("datetime64[ns]"))
        return label, None, ["" if stamp == "NaT" else str(stamp) for stamp in stamps]
    if kind == "c":
        raise SwitchbackError(f"the column `{label}` holds complex numbers; give real ones")
    return label, None, [_cell(value) for value in array.tolist()]


def _array_of(values: Any) -> NDArray[Any]:
    dtype = getattr(values, "dtype", None)
    if hasattr(values, "to_numpy"):
        if getattr(dtype, "tz", None) is not None and hasattr(values, "dt"):  # pandas, with a time zone
            values = values.dt.tz_convert("UTC").dt.tz_localize(None)
        is_pandas_extension = hasattr(values, "iloc") and not isinstance(dtype, np.dtype)
        if is_pandas_extension and getattr(dtype, "kind", "O") in "biuf":
            return np.asarray(values.to_numpy(dtype=np.float64, na_value=np.nan))
        return np.asarray(values.to_numpy())
    array = np.asarray(values)
    if np.ma.isMaskedArray(values) and array.dtype.kind in "biuf":
        return np.asarray(np.ma.filled(values.astype(np.float64), np.nan))
    return array


def _cell(value: Any) -> str:
    """A cell as it would stand in a file."""
    if value is None or value != value or type(value).__name__ in ("NAType", "NaTType"):
        return ""
    if isinstance(value, bytes):
        return value.decode(errors="replace").strip()
    if isinstance(value, (bool, int, float)):
        return repr(float(value))
    return str(value).strip()


def _of_array(data: NDArray[Any]) -> dict[str, Any]:
    if data.dtype.names:
        return {name: data[name] for name in data.dtype.names}
    if data.ndim != 2:
        raise SwitchbackError(
            f"the array has the shape {data.shape}; give one row a sample and one column a quantity, as in np.column_stack([t, v, y])"
        )
    return {f"column {k + 1}": data[:, k] for k in range(data.shape[1])}


def _unique(columns: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(columns)
    if len(found) < len(columns):
        labels = [label for label, _ in columns]
        twice = next(label for label in labels if labels.count(label) > 1)
        raise SwitchbackError(f"the column `{twice}` stands {labels.count(twice)} times in the frame; rename one of them")
    return found
