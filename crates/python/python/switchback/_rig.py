"""Rigs: the records of one measuring dataset."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from numbers import Real
from typing import Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ._arrays import Column, Floats, column, columns_of, finite, floats
from ._native import Records, SwitchbackError
from ._result import PathLike
from ._options import Resample, between, number, pair, real, whole, texts

#: What drove the input of a record.
Role = Literal["free", "descendant", "ascendant", "step_high", "step_low"]

#: A single record is cut, and its last third is what models are judged on, where nothing else is said.
HELD_OUT = 1.0 / 3.0


@dataclass(frozen=True, eq=False)
class Record:
    """One record of a rig: ``samples`` values of the input ``v`` and of the output ``y``, evenly spaced."""

    name: str
    #: What drove the input.
    role: Role
    #: ``fit``: models are identified from it; ``holdout``: they are judged on it.
    use: Literal["fit", "holdout"]
    #: The input, input units, shape ``(samples,)``.
    v: Floats = field(repr=False)
    #: The output, output units, shape ``(samples,)``.
    y: Floats = field(repr=False)
    #: Another simulator's prediction of ``y``, where there is one.
    y_sim: Optional[Floats] = field(repr=False)

    def __len__(self) -> int:
        return len(self.v)


class Rig:
    """The records of one measuring dataset and what is known about them.

    Made by :meth:`read` from files or by :meth:`from_frame` from what is in memory. It does not change; it can be pickled,
    copied, and used from several threads.
    """

    def __init__(self, records: Records) -> None:
        if not isinstance(records, Records):
            raise TypeError("a rig is made by Rig.read(FILE) or Rig.from_frame(FRAME, input=…, output=…)")
        self._records = records
        self._outline: dict[str, Any] = json.loads(records.outline)

    @classmethod
    def read(
        cls,
        *files: PathLike,
        input: Union[str, int, None] = None,
        output: Union[str, int, None] = None,
        time: Union[str, int, None] = None,
        sample_time: Optional[float] = None,
        rate: Optional[float] = None,
        holdout: Union[float, PathLike, None] = None,
        resample: Resample = False,
    ) -> Rig:
        """Reads files of measurements, one a record, or one rig file.

        Parameters
        ----------
        files
            CSV in any dialect, ``.mat``, ``.mcap``, ``.mf4`` or ``.parquet``, one a record; or one ``rig.toml``, which says for itself what the other arguments would.
        input, output, time
            Columns by name, the unit may be left out, or by number from 1; else guessed from the header. ``time="none"`` for rows
            that are even whatever the time column says.
        sample_time, rate
            Seconds between samples, or samples a second; else reported by the time column.
        holdout
            What models are judged on: a share of every record, at its end, or a file; else the last third of a single file, or the
            last of several.
        resample
            Bring uneven rows to even ones, and slow signals to the rows of others: ``"linear"`` (or ``True``) on straight lines, ``"hold"`` with the
            last value. Else a slow signal gets whichever predicts the output better, and uneven rows are refused.

        Raises
        ------
        SwitchbackError
            With all that is wrong, in the words of ``switchback gap``: file, place, remedy.
        """
        options = texts(
            input=_named(input),
            output=_named(output),
            time=_named(time),
            sample_time=sample_time,
            rate=rate,
            holdout=holdout,
            resample=between(resample),
        )
        return cls(Records.read([os.fspath(file) for file in files], options))

    @classmethod
    def from_frame(
        cls,
        frame: Any,
        *,
        input: Union[str, int, None] = None,
        output: Union[str, int, None] = None,
        time: Union[str, int, None] = None,
        record: Optional[str] = None,
        y_sim: Optional[str] = None,
        sample_time: Optional[float] = None,
        holdout: Union[float, str, Sequence[str], None] = None,
        resample: Resample = False,
        order: Optional[int] = None,
        interval: Optional[tuple[float, float]] = None,
        roles: Optional[Mapping[str, Role]] = None,
        name: str = "frame",
    ) -> Rig:
        """Takes records that are in memory.

        Cells are judged as those of a file are: NaN, None and empty texts are missing, texts may be numbers or ISO 8601 times.

        Parameters
        ----------
        frame
            A data frame of pandas or polars, a mapping of labels to columns, a structured array, or an array of two dimensions, one
            row a sample. Labels may hold units, as ``force [N]``.
        input, output, time
            Columns by label, the unit may be left out, or by number from 1; else guessed from the labels. Times are seconds, in the
            unit of their label, or ``datetime64``; ``time="none"`` for rows that are even whatever such a column says.
        record
            The column that shows which record a row belongs to; without it, all rows are one record.
        y_sim
            The column with another simulator's prediction of the output; a column of that name is found without being reported.
        sample_time
            Seconds between samples; else reported by the time column.
        holdout
            What models are judged on: a share of every record, at its end, or the names of records; else the last third of a single
            record, or the last of several, or nothing where ``roles`` report designed experiments.
        resample
            Bring uneven rows to even ones, and slow signals to the rows of others: ``"linear"`` (or ``True``) on straight lines, ``"hold"`` with the
            last value. Else a slow signal gets whichever predicts the output better, and uneven rows are refused.
        order
            Order of the linear part, where it is known.
        interval
            Working interval of the input, input units, where it is known.
        roles
            What drove the input of records, by their names: ``descendant``, ``ascendant``, ``step_high``, ``step_low``, or ``free``,
            which they are else.
        name
            The rig's name, and what messages call a single record.

        Raises
        ------
        SwitchbackError
            With all that is wrong: record, row from 1, remedy.
        """
        columns = columns_of(frame)
        if y_sim is not None:
            columns = {"y_sim" if label == _known(y_sim, columns) else label: cells for label, cells in columns.items()}
        taken = [column(label, cells) for label, cells in columns.items() if label != record]
        pieces = [(name, taken)] if record is None else _pieces(columns, _known(record, columns), taken)
        names = [piece for piece, _ in pieces]
        roles = dict(roles or {})
        for unknown in sorted(set(roles) - set(names)):
            raise SwitchbackError(f"there is no record `{unknown}`; the records are {', '.join(names)}")
        share, held_out = _held_out(holdout, names, is_designed=any(role != "free" for role in roles.values()))
        ends = pair(interval, "interval")
        described = {
            "name": name,
            "order": whole(order, "order"),
            "interval": None if ends is None else [float(end) for end in ends.split(",")],
            "input": _named(input),
            "output": _named(output),
            "time": _named(time),
            "sample_time": real(sample_time, "sample_time"),
            "resample": between(resample),
            "share": share,
            "held_out": held_out,
            "records": [[piece, roles.get(piece, "free")] for piece in names],
        }
        return cls(Records.from_frames(json.dumps(described), [columns for _, columns in pieces]))

    @property
    def name(self) -> str:
        """The rig's name."""
        return str(self._outline["name"])

    @property
    def sample_time(self) -> float:
        """Seconds between samples."""
        return float(self._outline["sample_time"])

    @property
    def order(self) -> Optional[int]:
        """Order of the linear part, where it is known."""
        order: Optional[int] = self._outline["order"]
        return order

    @property
    def interval(self) -> Optional[tuple[float, float]]:
        """Working interval of the input, input units, where it is known."""
        interval = self._outline["interval"]
        return None if interval is None else (interval[0], interval[1])

    @property
    def input(self) -> str:
        """Label and unit of the input."""
        return str(self._outline["input"])

    @property
    def output(self) -> str:
        """Label and unit of the output."""
        return str(self._outline["output"])

    @property
    def records(self) -> list[Record]:
        """The records, cut where they are partly held out and where rows are missing; copies."""
        return [
            Record(name, role, use, floats(v or b""), floats(y or b""), None if y_sim is None else floats(y_sim))
            for (name, role, use), (v, y, y_sim) in zip(self._outline["records"], self._records.arrays())
        ]

    @property
    def reported(self) -> str:
        """What was inferred rather than said: columns, sample time, what is held out, and what looks odd."""
        return self._records.reported

    def to_toml(self) -> str:
        """The rig file that gives this rig again, where it was read from files."""
        return self._records.manifest

    def with_y_sim(self, y_sim: Union[ArrayLike, Mapping[str, ArrayLike]]) -> Rig:
        """The same records with another simulator's predictions of the output, to be diagnosed.

        Either one array, for all records one after the other, shape ``(total samples,)``, or arrays by the records' names; the
        records are those of :attr:`records`.
        """
        records = self.records
        found: dict[str, Floats] = {}
        if isinstance(y_sim, Mapping):
            found = {str(name): finite(values, f"y_sim[{name!r}]") for name, values in y_sim.items()}
            for unknown in sorted(set(found) - {record.name for record in records}):
                raise SwitchbackError(
                    f"there is no record `{unknown}`; the records are {', '.join(record.name for record in records)}"
                )
        else:
            whole, total = finite(y_sim, "y_sim"), sum(map(len, records))
            if len(whole) != total:
                parts = ", ".join(f"{record.name} {len(record)}" for record in records)
                raise SwitchbackError(f"`y_sim` has {len(whole)} values, but the records have {total} samples: {parts}")
            cuts = np.cumsum([len(record) for record in records])[:-1]
            found = {record.name: part for record, part in zip(records, np.split(whole, cuts))}
        for record in records:
            if record.name in found and len(found[record.name]) != len(record):
                raise SwitchbackError(
                    f"`y_sim[{record.name!r}]` has {len(found[record.name])} values, but the record has {len(record)} samples"
                )
        predictions = [found[record.name].tobytes() if record.name in found else None for record in records]
        return Rig(self._records.with_predictions(predictions))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Rig):
            return NotImplemented
        return self._outline == other._outline and self._records.arrays() == other._records.arrays()

    def __hash__(self) -> int:
        return hash(self._records.outline)

    def __repr__(self) -> str:
        records = ", ".join(f"{name} ({use})" for name, _, use in self._outline["records"])
        return f"Rig({self.name!r}, {number(self.sample_time)} s, {self.input} → {self.output}: {records})"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(repr(self))}\n{escape(self.reported)}</pre>"

    def __getstate__(self) -> dict[str, Any]:
        return {"_records": self._records}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(state["_records"])  # type: ignore[misc]


def rig_of(rig: Union[Rig, PathLike]) -> Rig:
    """A rig, read where a file is named."""
    if isinstance(rig, Rig):
        return rig
    if isinstance(rig, (str, os.PathLike)):
        return Rig.read(rig)
    raise SwitchbackError(
        f"a {type(rig).__name__} is no rig; make one by Rig.from_frame(FRAME, input=…, output=…) or Rig.read(FILE)"
    )


def records_of(rig: Rig) -> Records:
    """What the native part takes."""
    return rig._records


def _named(column: Union[str, int, None]) -> Optional[str]:
    return None if column is None else str(column)


def _known(label: str, columns: Mapping[str, Any]) -> str:
    if label not in columns:
        raise SwitchbackError(f"there is no column `{label}`; the columns are {', '.join(columns)}")
    return label


def _pieces(columns: Mapping[str, Any], record: str, taken: list[Column]) -> list[tuple[str, list[Column]]]:
    """The rows of each record, records in the order in which they begin."""
    values = np.asarray(columns[record])
    if any(value is None or value != value for value in values.tolist()):
        raise SwitchbackError(f"the column `{record}` does not show for every row which record it belongs to; fill it in")
    keys = [str(value) for value in values.tolist()]
    names = list(dict.fromkeys(keys))
    if not names:
        return [(record, taken)]
    marks = np.asarray(keys)
    return [(name, [_rows(part, np.flatnonzero(marks == name)) for part in taken]) for name in names]


def _rows(part: Column, rows: Any) -> Column:
    label, numbers, texts = part
    if numbers is not None:
        return label, np.frombuffer(numbers, dtype=np.float64)[rows].tobytes(), None
    return label, None, [texts[row] for row in rows] if texts is not None else None


def _held_out(
    holdout: Union[float, str, Sequence[str], None], names: list[str], *, is_designed: bool
) -> tuple[Optional[float], list[str]]:
    """The share that is held out of every record, and the records that are held out whole."""
    if holdout is None:
        if is_designed:
            return None, []
        return (HELD_OUT, []) if len(names) == 1 else (None, names[-1:])
    if isinstance(holdout, (float, Real)):
        return real(float(holdout), "holdout"), []
    held_out = [holdout] if isinstance(holdout, str) else [str(one) for one in holdout]
    for unknown in sorted(set(held_out) - set(names)):
        raise SwitchbackError(f"holdout={unknown!r}: there is no such record; the records are {', '.join(names)}")
    return None, held_out
