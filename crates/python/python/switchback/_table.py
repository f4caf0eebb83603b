"""Rows of one kind: a sequence of typed objects that is a data frame where one is wanted."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, Generic, Optional, TypeVar, Union, overload

if TYPE_CHECKING:
    import pandas
    import polars

T = TypeVar("T")
R = TypeVar("R", bound="Row")


@dataclasses.dataclass(frozen=True)
class Row:
    """A row with typed fields."""

    @classmethod
    def of(cls: type[R], found: Mapping[str, Any]) -> R:
        """The row of an object in the program's JSON; keys that are not known here are left out."""
        names = [field.name for field in dataclasses.fields(cls)]
        return cls(**{name: found.get(name.rstrip("_")) for name in names})

    def cells(self) -> dict[str, Any]:
        """The row as cells of a data frame, by column."""
        cells: dict[str, Any] = {}
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            if isinstance(value, Estimate):
                cells.update({field.name: value.estimate, f"{field.name}_low": value.low, f"{field.name}_high": value.high})
            else:
                cells[field.name] = value
        return cells


@dataclasses.dataclass(frozen=True)
class Estimate:
    """A number with its interval, of the probability that is reported where it stands."""

    estimate: Optional[float]
    low: Optional[float]
    high: Optional[float]

    @classmethod
    def of(cls, found: Optional[Mapping[str, Any]], key: str = "estimate", interval: str = "ci90") -> Estimate:
        """That of an object in the program's JSON."""
        found = found or {}
        low, high = found.get(interval) or (None, None)
        return cls(found.get(key), low, high)

    def __float__(self) -> float:
        return float("nan") if self.estimate is None else float(self.estimate)

    def __str__(self) -> str:
        def reported(x: Optional[float]) -> str:
            return "–" if x is None else f"{x:.4g}"

        return f"{reported(self.estimate)} [{reported(self.low)}, {reported(self.high)}]"


class Table(Sequence[T], Generic[T]):
    """Rows of one kind.

    A sequence of typed objects; ``to_pandas()``, ``to_polars()`` and ``to_dict()`` make a data frame of them, one row each.
    """

    def __init__(self, rows: Iterable[T]) -> None:
        self._rows = tuple(rows)

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> Table[T]: ...
    def __getitem__(self, index: Union[int, slice]) -> Union[T, Table[T]]:
        return Table(self._rows[index]) if isinstance(index, slice) else self._rows[index]

    def __len__(self) -> int:
        return len(self._rows)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self._rows == other._rows

    def __hash__(self) -> int:
        return hash(len(self._rows))

    def __repr__(self) -> str:
        return f"Table({len(self)} × {type(self._rows[0]).__name__})" if self._rows else "Table(empty)"

    def to_dict(self) -> dict[str, list[Any]]:
        """Columns by their names."""
        rows = [_cells(row) for row in self._rows]
        names = list(dict.fromkeys(name for row in rows for name in row))
        return {name: [row.get(name) for row in rows] for name in names}

    def to_pandas(self) -> pandas.DataFrame:
        """A frame of pandas, which must be installed."""
        import pandas

        return pandas.DataFrame(self.to_dict())

    def to_polars(self) -> polars.DataFrame:
        """A frame of polars, which must be installed."""
        import polars

        return polars.DataFrame(self.to_dict(), strict=False)

    def _repr_html_(self) -> str:
        columns = self.to_dict()
        head = "".join(f"<th>{escape(name)}</th>" for name in columns)
        rows = zip(*columns.values())
        body = "".join("<tr>" + "".join(f"<td>{escape(_shown(cell))}</td>" for cell in row) + "</tr>" for row in rows)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cells(row: Any) -> dict[str, Any]:
    return row.cells() if isinstance(row, Row) else dict(row)


def _shown(cell: Any) -> str:
    if cell is None:
        return "–"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)
