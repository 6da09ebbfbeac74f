"""Writes the tables beside it as other programs write Parquet, and what each of their rows is in a CSV file:

    python tests/data/parquet/make.py

with pyarrow, polars and duckdb. Row groups of five rows; texts in dictionaries; lists, dates, times, missing values and
numbers of single precision among the columns.
"""

import datetime
from pathlib import Path

import duckdb
import polars
import pyarrow
from pyarrow import parquet

HERE = Path(__file__).parent
ROWS = 23

devices = []
for at in range(ROWS):
    day = datetime.date(1969, 12, 30) + datetime.timedelta(days=997 * at)
    seconds = datetime.timedelta(hours=at % 3, microseconds=250 * (at % 3))
    devices.append(
        {
            "label": None if at == 4 else ["电阻", "007", 'a "b", c'][at % 3] + str(at),
            "V.repeatability.readings": [1.0 + at / 7, 1.1, 1.0 / 3.0][: 2 + at % 2],
            "R [kohm]": None if at == 6 else 0.1 + at / 3,
            "R.u": -1.0 if at == 8 else 0.001 * (1 + at % 4),
            "drift.u": 0.0 if at == 9 else 1e-4 + at * 1e-6,
            "type": "AB"[at % 2],
            "serial": 2**53 + at,
            "date": day,
            "time": datetime.datetime.combine(day, datetime.time()) + seconds,
            "good": at % 5 > 0,
        }
    )

schema = pyarrow.schema(
    {
        "label": pyarrow.string(),
        "V.repeatability.readings": pyarrow.list_(pyarrow.float64()),
        "R [kohm]": pyarrow.float64(),
        "R.u": pyarrow.float64(),
        "drift.u": pyarrow.float32(),
        "type": pyarrow.dictionary(pyarrow.int8(), pyarrow.string()),
        "serial": pyarrow.int64(),
        "date": pyarrow.date32(),
        "time": pyarrow.timestamp("us"),
        "good": pyarrow.bool_(),
    }
)
table = pyarrow.Table.from_pylist(devices, schema=schema)


def field(value):
    """What a CSV file has of a value."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return "[" + ", ".join(map(repr, value)) + "]"
    if isinstance(value, datetime.datetime):
        if value.time() == datetime.time():
            return value.date().isoformat()
        return value.isoformat(timespec="microseconds").rstrip("0") if value.microsecond else value.isoformat()
    return value.isoformat() if isinstance(value, datetime.date) else str(value)


def quoted(text):
    return '"' + text.replace('"', '""') + '"' if set(text) & set(',"') else text


lines = [table.column_names, *([field(value) for value in row.values()] for row in table.to_pylist())]
(HERE / "devices.csv").write_text("".join(",".join(map(quoted, line)) + "\n" for line in lines))

parquet.write_table(table, HERE / "pyarrow.parquet", row_group_size=5)
nanoseconds = table.set_column(8, "time", table["time"].cast(pyarrow.timestamp("ns")))
parquet.write_table(nanoseconds, HERE / "nanoseconds.parquet", row_group_size=5, data_page_version="2.0", compression="none")
polars.from_arrow(table).write_parquet(HERE / "polars.parquet", row_group_size=5)
connection = duckdb.connect()
connection.register("devices", table)
place = HERE / "duckdb.parquet"
connection.sql(f"copy devices to '{place}' (format parquet, row_group_size 5)")
empty = table.slice(0, 0)
parquet.write_table(empty, HERE / "empty.parquet")
parts = pyarrow.StructArray.from_arrays([table["R.u"].combine_chunks()], ["u"])
parquet.write_table(pyarrow.table({"R": parts}), HERE / "structure.parquet")
