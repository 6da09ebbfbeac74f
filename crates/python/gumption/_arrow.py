"""Tables in the memory layout of Arrow."""

from __future__ import annotations

from typing import Any, cast

import numpy as np


class RecordBatch:
    """Columns in the memory layout of Arrow, which every engine takes over without a copy (its PyCapsule interface):
    ``pyarrow.record_batch(x)``, ``polars.DataFrame(x)``, ``duckdb.arrow(x)`` …"""

    def __init__(self, array: Any) -> None:
        self._array: Any = array

    def __arrow_c_schema__(self) -> object:
        return cast(object, self._array.schema.__arrow_c_schema__())

    def __arrow_c_array__(self, requested_schema: object | None = None) -> tuple[object, object]:
        return cast(tuple[object, object], self._array.__arrow_c_array__(requested_schema))

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        from nanoarrow.c_array_stream import CArrayStream  # type: ignore[import-untyped]

        stream = CArrayStream.from_c_arrays([self._array], self._array.schema, validate=False)
        return cast(object, stream.__arrow_c_stream__(requested_schema))

    def __len__(self) -> int:
        return len(self._array)


def _nanoarrow() -> Any:
    try:
        import nanoarrow  # type: ignore[import-untyped]
    except ImportError as missing:
        raise ImportError("record batches need the package nanoarrow: pip install 'gumption[arrow]'") from missing
    return nanoarrow


def is_of(table: Any) -> bool:
    """Whether something has the PyCapsule interface of Arrow."""
    return hasattr(table, "__arrow_c_array__") or hasattr(table, "__arrow_c_stream__")


def columns(rows: Any) -> list[tuple[str, Any]]:
    """The columns of a record batch or a table: arrays where they are doubles, else lists."""
    nanoarrow = _nanoarrow()
    stream = nanoarrow.c_array_stream(rows)
    if unread := [field.name for field in stream.get_schema().children if _is_unread(field)]:
        return _read_by_pyarrow(stream, unread)
    array = nanoarrow.Array(stream)
    missing = nanoarrow.nulls_as_sentinel()

    def column(field: Any, child: Any) -> Any:
        doubles = field.type == nanoarrow.Type.DOUBLE
        return child.to_pysequence(handle_nulls=missing) if doubles else list(child.iter_py())

    children = zip(array.schema.fields, array.iter_children())
    return [(field.name, column(field, child)) for field, child in children]


def _is_unread(schema: Any) -> bool:
    """Whether there are texts by views, which nanoarrow takes and does not read (the process ends), or values by the length of
    their runs."""
    inner = [*schema.children, *([schema.dictionary] if schema.dictionary else [])]
    return schema.format in ("vu", "vz", "+r") or any(map(_is_unread, inner))


def _read_by_pyarrow(stream: Any, unread: list[str]) -> list[tuple[str, Any]]:
    try:
        import pyarrow  # type: ignore[import-untyped]
    except ImportError as missing:
        raise TypeError(
            f"the column {unread[0]} has texts by views (string_view) or values by runs (run_end_encoded), which take the package pyarrow: "
            "pip install pyarrow, or make it a plain column"
        ) from missing
    table = pyarrow.RecordBatchReader.from_stream(stream).read_all()

    def column(values: Any) -> Any:
        return values.to_numpy() if values.type == pyarrow.float64() else values.to_pylist()

    return [(name, column(table[at])) for at, name in enumerate(table.column_names)]


def record_batch(found: dict[str, Any], length: int) -> RecordBatch:
    """Columns of results as a record batch: nothing for what is not there."""
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
        fields[name] = kind
        arrays.append(array)
    schema = nanoarrow.struct(fields)
    return RecordBatch(nanoarrow.c_array_from_buffers(schema, length, [None], children=arrays))


def _known(known: np.ndarray) -> np.ndarray | None:
    """The bitmap that tells which fields of a column are there; none where all are."""
    return None if known.all() else np.packbits(known, bitorder="little")
