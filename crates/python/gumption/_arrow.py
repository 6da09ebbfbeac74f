"""One function from a record batch to a record batch, for whatever engine has the table."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from ._batch import evaluated
from ._commands import settings
from ._given import Contents, Given
from ._result import Language
from ._table import cells


class RecordBatch:
    """Columns in the memory layout of Arrow, which every engine takes over without a copy (its PyCapsule interface):
    ``pyarrow.record_batch(x)``, ``polars.DataFrame(x)``, ``duckdb.arrow(x)`` …"""

    def __init__(self, array: Any) -> None:
        self._array = array

    def __arrow_c_schema__(self) -> object:
        return self._array.schema.__arrow_c_schema__()

    def __arrow_c_array__(self, requested_schema: object | None = None) -> tuple[object, object]:
        return self._array.__arrow_c_array__(requested_schema)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        from nanoarrow.c_array_stream import CArrayStream

        stream = CArrayStream.from_c_arrays([self._array], self._array.schema, validate=False)
        return stream.__arrow_c_stream__(requested_schema)

    def __len__(self) -> int:
        return len(self._array)


def arrow_batch(
    budget: Given,
    rows: Any,
    *,
    files: Contents | None = None,
    profile: str | None = None,
    monte_carlo: bool = False,
    trials: int | Literal["adaptive"] | None = None,
    seed: int | None = None,
    quasi_random: bool = False,
    shares: bool = False,
    contributions: bool = False,
    threads: int = 1,
    language: Language = "en",
) -> RecordBatch:
    """Evaluates a budget for every row of a record batch, or of a table, of Arrow; gives a record batch with as many rows in
    the same order.

    It is ``batch`` for engines: what has the PyCapsule interface goes in and comes out; ``U(y)`` is called ``expanded(y)``,
    since SQL does not tell it from ``u(y)``. A row depends on nothing but its own
    values, so that neither partitions nor workers nor their order change a bit; a faulty row has an ``error`` and stops
    nothing. There is a ``label`` where the rows have one. The columns do not depend on the rows: those of an empty batch are
    the schema.

    Columns of doubles are taken as they lie in memory. What may be stated is that of ``batch``; ``threads`` is 1 unless stated,
    as engines have workers of their own. Needs the package ``nanoarrow``.
    """
    columns = _columns(rows)
    found, count, _ = evaluated(
        budget,
        columns,
        source_files=files,
        wanted=settings(profile, monte_carlo, trials, seed, quasi_random, False, threads),
        more=(shares, contributions),
        language=language,
    )
    assert found is not None
    if all(name != "label" for name, _ in columns):
        # The number of a row in its batch means nothing outside of it.
        del found["label"]
    return _record_batch(found, count)


def _nanoarrow() -> Any:
    try:
        import nanoarrow
    except ImportError as missing:
        raise ImportError("record batches need the package nanoarrow: pip install 'gumption[arrow]'") from missing
    return nanoarrow


def _columns(rows: Any) -> list[tuple[str, Any]]:
    """The columns of a record batch or a table, as the engine takes them."""
    nanoarrow = _nanoarrow()
    array = nanoarrow.Array(rows)
    missing = nanoarrow.nulls_as_sentinel()

    def column(field: Any, child: Any) -> Any:
        doubles = field.type == nanoarrow.Type.DOUBLE
        return child.to_pysequence(handle_nulls=missing) if doubles else list(child.iter_py())

    children = zip(array.schema.fields, array.iter_children())
    return [(field.name, cells(column(field, child))) for field, child in children]


def _record_batch(found: dict[str, Any], length: int) -> RecordBatch:
    nanoarrow = _nanoarrow()
    fields, arrays = {}, []
    for name, column in found.items():
        if name == "seed":
            kind, column = nanoarrow.int64(), [None if np.isnan(one) else int(one) for one in column]
            array = nanoarrow.c_array(column, kind)
        elif isinstance(column, np.ndarray):
            kind = nanoarrow.float64()
            array = nanoarrow.c_array_from_buffers(kind, length, [_known(~np.isnan(column)), column])
        else:
            kind = nanoarrow.string()
            if column is None:
                nothing = np.zeros(length, bool)
                buffers = [_known(nothing), np.zeros(length + 1, np.int32), b""]
                array = nanoarrow.c_array_from_buffers(kind, length, buffers)
            else:
                array = nanoarrow.c_array([one or None for one in column], kind)
        # SQL does not tell U(y) from u(y).
        fields[f"expanded{name[1:]}" if name.startswith("U(") else name] = kind
        arrays.append(array)
    schema = nanoarrow.struct(fields)
    return RecordBatch(nanoarrow.c_array_from_buffers(schema, length, [None], children=arrays))


def _known(known: np.ndarray) -> np.ndarray | None:
    """The bitmap that tells which fields of a column are there; none where all are."""
    return None if known.all() else np.packbits(known, bitorder="little")
