"""Tables: what a call is given, and what it gives."""

from __future__ import annotations

import csv
import html
import importlib
import io
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Union

import numpy as np

from . import _arrow
from ._given import sheet

Given = Union[str, "os.PathLike[str]", Mapping[str, Any], Any]
"""A CSV file, its text, columns by their names, a frame of pandas or polars, or a table of Arrow."""

SHOWN = 20
"""Rows that a notebook shows."""


class Table(dict[str, Any]):
    """Columns of equal length by their names: arrays of numbers, ``nan`` where there is none, and lists of texts."""

    def copy(self) -> Table:
        """The same columns, as a table."""
        return Table(self)

    def to_pandas(self) -> Any:
        """The columns as a frame of pandas."""
        pandas = importlib.import_module("pandas")
        return pandas.DataFrame(self._typed(lambda _: pandas.Series([], dtype=str)))

    def to_polars(self) -> Any:
        """The columns as a frame of polars."""
        polars = importlib.import_module("polars")
        return polars.DataFrame(self._typed(lambda name: polars.Series(name, [], polars.String)))

    def _typed(self, no_texts: Callable[[str], Any]) -> dict[str, Any]:
        """The columns, and one of texts for a list of nothing, of which no library can tell what it is of."""
        is_empty = {name: isinstance(column, list) and not column for name, column in self.items()}
        return {name: no_texts(name) if is_empty[name] else column for name, column in self.items()}

    def _repr_html_(self) -> str:
        rows = max((len(column) for column in self.values()), default=0)
        lines = [_line("th", self)]
        lines += [_line("td", [column[at] for column in self.values()]) for at in range(min(rows, SHOWN))]
        more = f"<p>{SHOWN} of {rows} rows</p>" if rows > SHOWN else ""
        return f"<table>{''.join(lines)}</table>{more}"


def _line(kind: str, cells: Sequence[Any] | Table) -> str:
    def cell(value: Any) -> str:
        # Notebooks align all cells right, which is good for numbers only.
        left = ' style="text-align:left"' if kind == "td" and isinstance(value, str) else ""
        return f"<{kind}{left}>{html.escape(_shown(value))}</{kind}>"

    return f"<tr>{''.join(map(cell, cells))}</tr>"


def _shown(cell: Any) -> str:
    if isinstance(cell, float):
        return "" if np.isnan(cell) else f"{cell:.7g}"
    return "" if cell is None else str(cell)


def like(given: Any, found: Table, rows: int, kept: Sequence[str]) -> Any:
    """What was found of a table: of a frame a frame with its index, of a table of pyarrow one of pyarrow, else columns. The columns
    that are kept, and labels, are those that were given, of whatever type."""
    library, own = _library(given), _carried(given, found, kept)
    if library == "pyarrow":
        arrow = importlib.import_module("pyarrow")
        table = arrow.table(_arrow.record_batch(found, rows))
        for name, column in own.items():
            table = table.set_column(table.column_names.index(name), name, column)
        return table
    for name, column in found.items():
        if column is None:
            found[name] = [""] * rows
    if library == "pandas":
        frame = found.to_pandas().set_axis(given.index, axis="index")
        # Series are put where their index is, which may have something twice.
        return frame.assign(**{name: column.array for name, column in own.items()})
    found.update(own)
    return found.to_polars() if library == "polars" else found


def _carried(given: Any, found: Table, kept: Sequence[str]) -> dict[str, Any]:
    """The columns of results that are columns of a table in memory: those that are kept, and labels, unless one is missing,
    in whose place is the number of its row."""
    # What can be gone through once is gone; Series in a dict would be put where their index is.
    attribute = {"pandas": "columns", "polars": "columns", "pyarrow": "column_names"}.get(_library(given), "")
    names = list(given) if isinstance(given, Mapping) else getattr(given, attribute, ())
    columns = {name: given[name] for name in names if not isinstance(given[name], Iterator)}
    labels = ["label"] if all(_field(one).strip() for one in columns.get("label", ())) else []
    # What is kept may be named without its unit.
    wanted = {*kept, *labels}
    is_wanted = {name: name in wanted or name.partition(" [")[0] in wanted for name in columns}
    carried = {name: column for name, column in columns.items() if is_wanted[name] and name in found}
    if not isinstance(given, Mapping):
        return carried
    return {name: one if isinstance(one, (list, np.ndarray)) else list(one) for name, one in carried.items()}


_FRAMES = ("pandas", "polars")
"""Libraries whose frames are taken by columns."""


def _library(given: Any) -> str:
    return type(given).__module__.partition(".")[0]


def read(text: str, texts: Sequence[str]) -> Table:
    """The columns of comma-separated values, of which those of these names are texts and the others numbers."""
    names, *rows = csv.reader(io.StringIO(text))
    columns = Table()
    for at, name in enumerate(names):
        cells = [row[at] for row in rows]
        columns[name] = cells if name in texts else np.array([float(cell or "nan") for cell in cells])
    return columns


def with_faulty(table: Table, names: Sequence[str], faulty: Mapping[str, str]) -> Table:
    """Rows of these names, of which some have nothing but an error and the others are in the table, in this order."""
    rows = {name: at for at, name in enumerate(name for name in names if name not in faulty)}
    places = [rows.get(name) for name in names]
    whole = Table()
    for column, cells in table.items():
        if isinstance(cells, np.ndarray):
            whole[column] = np.array([np.nan if at is None else cells[at] for at in places])
        else:
            whole[column] = ["" if at is None else cells[at] for at in places]
    errors = whole.get("error", [""] * len(names))
    return Table(whole | {"label": list(names), "error": [faulty.get(name, why) for name, why in zip(names, errors)]})


def written(table: Any) -> str:
    """The comma-separated values of a frame or of columns by their names."""
    columns = dict(given(table))
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(columns)
    # Every double as the shortest decimal that is read as the same.
    texts = [[_field(cell) for cell in column] for column in columns.values()]
    writer.writerows(zip(*texts, strict=True))
    return out.getvalue()


def given(table: Given) -> Any:
    """A table as the engine takes it."""
    if isinstance(table, (str, os.PathLike, bytes)):
        return sheet(table, "table.csv")
    return of_arrow(table) if _library(table) not in _FRAMES and _arrow.is_of(table) else _columns(table)


def of_arrow(table: Any) -> list[tuple[str, Any]]:
    """Whatever has the interface of Arrow, as the engine takes it."""
    if _library(table) == "polars":
        # Its texts are views, which nanoarrow does not read.
        return _columns(table)
    return [(name, cells(column)) for name, column in _arrow.columns(table)]


def _columns(table: Any) -> list[tuple[str, Any]]:
    """A frame or columns by their names."""
    if not isinstance(table, Mapping) and not (hasattr(table, "__len__") and hasattr(table, "columns")):
        raise TypeError(
            "a table is a CSV file, a dict of columns, a frame of pandas or polars, or a table of Arrow,"
            f" not {type(table).__name__}"
        )
    names = list(table.keys() if isinstance(table, Mapping) else table.columns)
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"the names of columns are texts, and {name!r} is none: rename it")
        if isinstance(table[name], (str, bytes)) or not hasattr(table[name], "__iter__"):
            raise TypeError(f"the column {name} is {table[name]!r}: a list or an array with a value for each row is needed")
    columns = [*_of_index(table, names), *((name, cells(table[name])) for name in names)]
    for name, column in columns:
        first, rows = columns[0][0], len(columns[0][1])
        if len(column) != rows:
            raise ValueError(f"the columns have different lengths: {rows} of {first}, {len(column)} of {name}")
    return columns


def _of_index(table: Any, names: list[Any]) -> list[tuple[str, Any]]:
    """Where a frame of pandas names its rows by its index, that is their label."""
    index = getattr(table, "index", None) if _library(table) == "pandas" else None
    if index is None or "label" in names or type(index).__name__ == "RangeIndex":
        return []
    # One of several levels has tuples.
    return [("label", [" ".join(map(_field, one)) if index.nlevels > 1 else _field(one) for one in index])]


def cells(column: Any) -> Any:
    """A column as the engine takes it: numbers where it is an array of doubles, else texts, every number with all of its
    digits."""
    array = column.to_numpy() if hasattr(column, "to_numpy") else column
    if isinstance(array, np.ndarray) and array.dtype == np.float64 and array.ndim == 1:
        # What is masked is missing, whatever stands below the mask.
        return np.ascontiguousarray(np.ma.filled(array, np.nan))
    return [_field(one) for one in column]


def _element(value: Any) -> str:
    """A number of a list; what is none is for the row to refuse."""
    if value is np.ma.masked:
        return "nan"
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        return _field(value) or "nan"


def _field(value: Any) -> str:
    if isinstance(value, str):
        return value
    if value is None or value is np.ma.masked:
        return ""
    if isinstance(value, (list, tuple, np.ndarray)) or hasattr(value, "to_list"):
        return f"[{', '.join(map(_element, value))}]"
    # What is missing beside these: nan, and what pandas calls NaT and NA.
    if str(value) in ("nan", "NaT", "<NA>"):
        return ""
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)
