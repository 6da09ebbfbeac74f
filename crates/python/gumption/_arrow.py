"""One function from a record batch to a record batch, for whatever engine has the table."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._batch import batch, is_text
from ._given import Given


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


def arrow_batch(budget: Given, rows: Any, **settings: Any) -> RecordBatch:
    """Evaluates a budget for every row of a record batch, or of a table, of Arrow; gives a record batch with as many rows in
    the same order.

    It is ``batch`` for engines: what has the PyCapsule interface goes in and comes out; ``U(y)`` is called ``expanded(y)``,
    since SQL does not tell it from ``u(y)``. A row depends on nothing but its own
    values, so that neither partitions nor workers nor their order change a bit; a faulty row has an ``error`` and stops
    nothing. There is a ``label`` where the rows have one. The columns do not depend on the rows: those of an empty batch are
    the schema.

    ``settings`` are those of ``batch``; ``threads`` is 1 unless stated, as engines have workers of their own. Needs the
    package ``nanoarrow``.
    """
    columns = _columns(rows)
    found = batch(budget, columns, **{"threads": 1, **settings})
    if "label" not in columns:
        # The number of a row in its batch means nothing outside of it.
        del found["label"]
    return _record_batch(found)


def _nanoarrow() -> Any:
    try:
        import nanoarrow
    except ImportError as missing:
        raise ImportError("record batches need the package nanoarrow: pip install 'gumption[arrow]'") from missing
    return nanoarrow


def _columns(rows: Any) -> dict[str, Any]:
    """The columns of a record batch or a table by their names, ``None`` where a field is null."""
    array = _nanoarrow().Array(rows)
    names = [field.name for field in array.schema.fields]
    return {name: list(column.iter_py()) for name, column in zip(names, array.iter_children())}


def _record_batch(found: dict[str, Any]) -> RecordBatch:
    nanoarrow = _nanoarrow()
    fields, arrays = {}, []
    length = max((len(column) for column in found.values()), default=0)
    for name, column in found.items():
        if is_text(name):
            kind = nanoarrow.string()
            values = [one or None for one in column]
        elif name == "seed":
            kind = nanoarrow.int64()
            values = [None if np.isnan(one) else int(one) for one in column]
        else:
            kind = nanoarrow.float64()
            values = [None if np.isnan(one) else float(one) for one in column]
        # SQL does not tell U(y) from u(y).
        fields[f"expanded{name[1:]}" if name.startswith("U(") else name] = kind
        arrays.append(nanoarrow.c_array(values, kind))
    schema = nanoarrow.struct(fields)
    return RecordBatch(nanoarrow.c_array_from_buffers(schema, length, [None], children=arrays))
