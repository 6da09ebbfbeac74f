"""One budget for every row of a table."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

from . import _arrow, _engine, _table
from ._commands import Progress, settings
from ._faults import typed
from ._given import Contents, Given, Whole, flag, several, source
from ._result import Language
from ._table import Table


def batch(
    budget: Given,
    table: _table.Given,
    *,
    output: str | os.PathLike[str] | None = None,
    replace: bool = False,
    files: Contents | None = None,
    profile: str | None = None,
    monte_carlo: bool = False,
    trials: Whole | Literal["adaptive"] | None = None,
    seed: Whole | None = None,
    quasi_random: bool = False,
    shares: bool = False,
    contributions: bool = False,
    keep: str | Sequence[str] = (),
    threads: Whole | None = None,
    progress: Progress = None,
    language: Language = "en",
) -> Any:
    """Evaluates a budget for every row of a table, whose columns replace values of the budget.

    A column is called like an input (``R``, ``R [kohm]``) or like the key that it sets (``R.u``, ``R.readings``,
    ``R.calibration.certificate.U``, ``r(R, V)``); ``label`` names the row. A row is evaluated as the budget would be with
    the row written into it; a faulty row has an ``error`` and stops nothing. With ``monte_carlo`` each row has a seed of its
    own, which follows from ``seed`` and its values. ``shares`` and ``contributions`` give the share of each input in u²(y), and
    c·u of each component, with sign: summed over the components that rows share, products of contributions are the
    covariance of two rows. The columns named in ``keep`` (type, laboratory, date …) go through to the results unchanged.

    Gives the results as columns: of a frame a frame with its index, of a table of pyarrow one of pyarrow, else a ``Table``, a ``dict``
    of arrays and lists. What is kept, and labels, have the types that they have in the table. With ``output`` they go into that file as they come, however long the table is, and what is given is the number of rows and of those without a result.
    ``progress`` is told the share that is done.

    Raises ``Refused`` where the budget has faults that no row mends, or a column is no place of it.
    """
    if output is not None and Path(output).suffix.lower() in _NO_CSV:
        raise ValueError(f"output: {os.fspath(output)} would hold CSV; name it .csv, or save the frame that is given without output")
    columns, rows, failed = evaluated(
        budget,
        _table.given(table),
        None if output is None else (Path(output), replace),
        source_files=files,
        wanted=settings(profile, monte_carlo, trials, seed, quasi_random, False, threads),
        more=(shares, contributions),
        keep=several("keep", keep),
        progress=progress,
        language=language,
    )
    if columns is None:
        return {"rows": rows, "failed": failed}
    labels = columns["label"] or [""] * rows
    columns["label"] = [label or str(at) for at, label in enumerate(labels, 1)]
    return _table.like(table, columns, rows, several("keep", keep))


_NO_CSV = {".parquet", ".xlsx", ".xls", ".json", ".feather", ".arrow"}
"""Endings of files of another kind than what is written."""


def arrow_batch(
    budget: Given,
    rows: Any,
    *,
    files: Contents | None = None,
    profile: str | None = None,
    monte_carlo: bool = False,
    trials: Whole | Literal["adaptive"] | None = None,
    seed: Whole | None = None,
    quasi_random: bool = False,
    shares: bool = False,
    contributions: bool = False,
    keep: str | Sequence[str] = (),
    threads: Whole = 1,
    language: Language = "en",
) -> _arrow.RecordBatch:
    """Evaluates a budget for every row of a record batch, or of a table, of Arrow; gives a record batch with as many rows in
    the same order.

    It is ``batch`` for engines: what has the PyCapsule interface goes in and comes out; ``U(y)`` is called ``expanded(y)``,
    since SQL does not tell it from ``u(y)``. A row depends on nothing but its own
    values, so that neither partitions nor workers nor their order change a bit; a faulty row has an ``error`` and stops
    nothing. There is a ``label`` where the rows have one. The columns do not depend on the rows: those of an empty batch are
    the schema.

    Columns of doubles are taken as they lie in memory; labels, and columns that are kept, are given as texts. What may be stated is that of ``batch``; ``threads`` is 1 unless stated,
    as engines have workers of their own. Needs the package ``nanoarrow``.
    """
    if not _arrow.is_of(rows):
        raise TypeError(f"rows: what has the interface of Arrow is needed, not {type(rows).__name__}; batch takes other tables, too")
    columns = _table.of_arrow(rows)
    found, count, _ = evaluated(
        budget,
        columns,
        source_files=files,
        wanted=settings(profile, monte_carlo, trials, seed, quasi_random, False, threads),
        more=(shares, contributions),
        keep=several("keep", keep),
        language=language,
    )
    assert found is not None
    if all(name != "label" for name, _ in columns):
        # The number of a row in its batch means nothing outside of it.
        del found["label"]
    # SQL does not tell U(y) from u(y).
    named = {f"expanded{name[1:]}" if name.startswith("U(") else name: column for name, column in found.items()}
    return _arrow.record_batch(named, count)


def evaluated(
    budget: Given,
    table: Any,
    place: tuple[Path, bool] | None = None,
    *,
    source_files: Contents | None = None,
    wanted: dict[str, Any],
    more: tuple[bool, bool] = (False, False),
    keep: Sequence[str] = (),
    progress: Progress = None,
    language: Language = "en",
) -> tuple[Table | None, int, int]:
    """The columns of results by their names, ``None`` for one whose texts are all empty, or ``None`` where they go into a
    file; how many rows there were, and how many of them have no result."""
    shares, contributions = more
    columns = (flag("shares", shares), flag("contributions", contributions))
    with typed():
        found, rows, failed = _engine.batch_of(
            source(budget, source_files), table, place, wanted, columns, list(keep), progress, language
        )
    return (None if found is None else Table(found)), rows, failed
