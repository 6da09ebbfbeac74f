"""One budget for every row of a table."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, Union

import numpy as np

from . import _engine
from ._commands import Progress, settings
from ._faults import typed
from ._given import Contents, Given, sheet, source
from ._result import Language

Table = Union[str, os.PathLike, Mapping[str, Any], Any]
"""A CSV file, its text, columns by their names, or a frame of pandas or polars."""


def batch(
    budget: Given,
    table: Table,
    *,
    output: str | os.PathLike[str] | None = None,
    replace: bool = False,
    files: Contents | None = None,
    profile: str | None = None,
    monte_carlo: bool = False,
    trials: int | Literal["adaptive"] | None = None,
    seed: int | None = None,
    quasi_random: bool = False,
    shares: bool = False,
    threads: int | None = None,
    progress: Progress = None,
    language: Language = "en",
) -> Any:
    """Evaluates a budget for every row of a table, whose columns replace values of the budget.

    A column is called like an input (``R``, ``R [kohm]``) or like the key that it sets (``R.u``, ``R.readings``,
    ``R.calibration.certificate.U``, ``r(R, V)``); ``label`` names the row. A row is evaluated as the budget would be with
    the row written into it; a faulty row has an ``error`` and stops nothing. With ``monte_carlo`` each row has a seed of its
    own, which follows from ``seed`` and its values.

    Gives the results as columns: of a frame a frame, else a ``dict`` of arrays and lists. With ``output`` they go into that
    file as they come, however long the table is, and what is given is the number of rows and of those without a result.
    ``progress`` is told the share that is done.

    Raises ``Refused`` where the budget has faults that no row mends, or a column is no place of it.
    """
    wanted = settings(profile, monte_carlo, trials, seed, quasi_random, False, threads)
    given = sheet(table, "table.csv") if isinstance(table, (str, os.PathLike)) else sheet(_written(table), "table.csv")
    place = None if output is None else (Path(output), replace)
    with typed():
        text, rows, failed = _engine.batch_of(
            source(budget, files), given, place, wanted, shares, progress, language
        )
    if text is None:
        return {"rows": rows, "failed": failed}
    columns = _columns(text.decode())
    kind = type(table).__module__.partition(".")[0]
    if kind in ("pandas", "polars") and not isinstance(table, Mapping):
        import importlib

        return importlib.import_module(kind).DataFrame(columns)
    return columns


def _written(table: Any) -> bytes:
    """A frame or columns as CSV, every number with all of its digits."""
    names = list(table.keys() if isinstance(table, Mapping) else table.columns)
    columns = [list(table[name]) for name in names]
    if len({len(column) for column in columns}) > 1:
        raise ValueError("the columns have different lengths")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    for row in zip(*columns):
        writer.writerow([_field(one) for one in row])
    return text.getvalue().encode()


def _field(value: Any) -> str:
    if value is None or (isinstance(value, float) and np.isnan(value)):
        return ""
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (list, tuple, np.ndarray)) or hasattr(value, "to_list"):
        return "[" + ", ".join(repr(float(one)) for one in value) + "]"
    return str(value)


def _columns(text: str) -> dict[str, Any]:
    """The columns of results: numbers as arrays, NaN where there is none."""
    names, *rows = csv.reader(io.StringIO(text))
    columns = {name: [row[at] for row in rows] for at, name in enumerate(names)}
    return {name: column if is_text(name) else _numbers(column) for name, column in columns.items()}


def is_text(name: str) -> bool:
    """Whether a column of results is no number."""
    return name in ("label", "findings", "error") or name.startswith("verdict(")


def _numbers(column: list[str]) -> np.ndarray:
    return np.array([float(field) if field else np.nan for field in column])
