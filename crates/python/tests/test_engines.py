"""Engines that hold a table in parts compute what one process computes, bit for bit, however they cut it.

What is run are the examples of docs/fleets.md; of an engine that is not installed they are skipped.
"""

import os
import re
import signal
import sys
from pathlib import Path

import gumption
import numpy as np
import pytest

pytest.importorskip("nanoarrow")
pa = pytest.importorskip("pyarrow")

PAGE = (Path(__file__).parents[3] / "docs" / "fleets.md").read_text(encoding="utf-8")
COUNT = 300


def example(heading: str) -> str:
    """The code of a chapter of the page."""
    text = PAGE.partition(f"\n## {heading}\n")[2].partition("\n## ")[0] if heading else PAGE.partition("\n## ")[0]
    (code,) = re.findall(r"```python\n(.*?)```", text, re.S)
    return code


def devices() -> pa.Table:
    """Devices of which some are faulty: an uncertainty that is negative, another that is infinite."""
    random = np.random.default_rng(27)
    u = random.uniform(1e-4, 1e-3, COUNT)
    u[::50] = -1
    missing = [None if at % 77 == 5 else one for at, one in enumerate(random.normal(0.1, 0.01, COUNT))]
    names = [f"device {at:04}" for at in range(COUNT)]
    return pa.table({"label": names, "R [kohm]": pa.array(missing, pa.float64()), "V.u": u})


def parts() -> list[pa.RecordBatch]:
    return devices().combine_chunks().to_batches(max_chunksize=60)


@pytest.fixture
def page():
    """Names as they are after the beginning of the page; functions travel to workers as those of a notebook do."""
    names = {"__name__": "__main__", "devices": devices()}
    exec(example(""), names)
    return names


@pytest.fixture
def expected(page) -> pa.Table:
    found = pa.Table.from_batches([page["evaluated"](devices())])
    failed = [error for error in found["error"].to_pylist() if error]
    assert len(found) == COUNT and len(failed) == 10
    return found


def run(heading: str, names: dict) -> object:
    exec(example(heading), names)
    return names["found"]


def assert_same(found: pa.Table, expected: pa.Table) -> None:
    """All bits: floats are compared by the shortest decimals that tell them apart."""
    found = found.sort_by("label")
    assert found.column_names == expected.column_names
    for name in expected.column_names:
        assert list(map(repr, found[name].to_pylist())) == list(map(repr, expected[name].to_pylist())), name


def from_pandas(frame, expected: pa.Table) -> pa.Table:
    return pa.Table.from_pandas(frame, expected.schema, preserve_index=False)


def test_the_schema_does_not_depend_on_rows(page, expected):
    evaluated = page["evaluated"]
    assert evaluated(devices().slice(0, 0)).schema == expected.schema
    faulty = evaluated(devices().slice(0, 1))
    assert faulty.schema == expected.schema and faulty["error"].to_pylist()[0]
    unnamed = evaluated(devices().drop_columns(["label"]))
    assert "label" not in unnamed.schema.names
    assert unnamed["I [mA]"].to_pylist() == expected["I [mA]"].to_pylist()


def test_parts_in_any_order(page, expected):
    parts = [page["evaluated"](devices().slice(at, 37)) for at in range(0, COUNT, 37)]
    assert_same(pa.Table.from_batches(reversed(parts)), expected)


def test_rows_are_those_of_a_batch(page, expected):
    found = gumption.batch(page["budget"], devices().to_pandas())
    assert list(map(repr, found["U(I) [mA]"].dropna().tolist())) == list(
        map(repr, expected["expanded(I) [mA]"].drop_null().to_pylist())
    )


def test_trials_are_those_of_the_row(page):
    trials = {"monte_carlo": True, "trials": 2000}
    whole = pa.record_batch(gumption.arrow_batch(page["budget"], devices().slice(1, 4), **trials))
    part = pa.record_batch(gumption.arrow_batch(page["budget"], devices().slice(3, 1), **trials))
    assert part.to_pylist() == whole.slice(2, 1).to_pylist() and part["seed"].type == pa.int64()


LONG = ["a label of more than twelve bytes", "b"]


def labels(table: object) -> list[str]:
    return pa.record_batch(gumption.arrow_batch(BUDGET, table))["label"].to_pylist()


BUDGET = {"measurand": {"y": {"model": "R"}}, "input": {"R": {"value": 1, "u": 0.1}}}


def test_texts_by_views():
    views = pa.array(LONG, pa.string_view())
    for table in (pa.table({"label": views, "R": [1.0, None]}), pa.record_batch({"label": views, "R": [1.0, None]})):
        assert labels(table) == LONG
        assert gumption.batch(BUDGET, table)["label"].to_pylist() == LONG
    assert labels(pa.table({"label": views, "R": [1.0, 2.0]}).to_reader()) == LONG
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame({"label": LONG, "R": [1.0, None]})
    assert labels(frame) == LONG and labels(frame.head(0)) == []
    assert gumption.batch(BUDGET, frame)["label"].to_list() == LONG


def test_columns_are_kept():
    table = pa.table({"R": [1.0, 2.0], "type": ["A", None], "n": [3, 4]})
    found = pa.record_batch(gumption.arrow_batch(BUDGET, table, keep=["type", "n"]))
    assert found["type"].to_pylist() == ["A", None] and found["n"].to_pylist() == ["3", "4"]


class Relation:
    """Of an engine that has the interface of Arrow and no frames."""

    def __init__(self, table: pa.Table) -> None:
        self.__arrow_c_stream__ = table.__arrow_c_stream__


def test_of_other_engines_there_are_columns():
    found = gumption.batch(BUDGET, Relation(pa.table({"label": LONG, "R": [1.0, 2.0]})))
    assert isinstance(found, gumption.Table) and found["label"] == LONG and list(found["y"]) == [1.0, 2.0]


def test_what_an_engine_gives_is_a_fleet():
    table = pa.table({"label": ["a", "b", "c"], "R": [1.0, 1.1, 1.2]})
    budget = {**BUDGET, "measurand": {"y": {"model": "R", "unit": "V"}}, "input": {"R": {"value": 1, "u": 0.1, "unit": "V"}}}
    found = pa.table(gumption.arrow_batch(budget, table))
    assert gumption.fleet(found).table()["values"][0] == 3


def test_polars(page, expected):
    pytest.importorskip("polars")
    assert_same(run("Polars", page).to_arrow().cast(expected.schema), expected)


def test_duckdb(page, expected):
    pytest.importorskip("duckdb")
    assert_same(run("DuckDB", page), expected)


def test_datafusion(page, expected):
    pytest.importorskip("datafusion")
    assert_same(run("DataFusion", page), expected)


def until_dead(whole, flag: Path):
    """`whole`, whose process is killed with the part in the middle, once."""

    def dying(rows):
        if "device 0150" in rows["label"].to_pylist() and not flag.exists():
            flag.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return whole(rows)

    # Travels to the workers with all that it needs, as a function of a notebook does.
    dying.__module__ = "__main__"
    return dying


def test_dask(page, expected, tmp_path):
    distributed = pytest.importorskip("distributed")
    pytest.importorskip("dask.dataframe")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        assert_same(from_pandas(run("Dask", page), expected), expected)
        # The worker that gets the part in the middle dies with it; the engine gives its work to another.
        flag = tmp_path / "died"
        dying = until_dead(page["evaluated"], flag)
        tables = client.gather(client.map(dying, parts()))
        assert_same(pa.Table.from_batches(tables), expected)
    assert flag.exists()


def test_ray(page, expected, tmp_path):
    """A head and a second node; a worker dies with the part in the middle, once."""
    ray = pytest.importorskip("ray")
    pytest.importorskip("ray.data")
    from ray.cluster_utils import Cluster

    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    try:
        cluster.add_node(num_cpus=1)
        ray.init(address=cluster.address, log_to_driver=False)
        assert len(ray.nodes()) == 2
        tables = ray.get(run("Ray", page).to_arrow_refs())
        assert_same(pa.concat_tables([table.cast(expected.schema) for table in tables]), expected)
        flag, whole = tmp_path / "died", page["evaluated"]
        dying = ray.remote(max_retries=2)(until_dead(whole, flag))
        found = ray.get([dying.remote(one) for one in parts()])
        assert_same(pa.Table.from_batches(found).cast(expected.schema), expected)
        assert flag.exists()
    finally:
        ray.shutdown()
        cluster.shutdown()


def test_spark(page, expected, tmp_path):
    """Two executors, processes of their own; one loses its Python in the middle."""
    pytest.importorskip("pyspark")
    from pyspark.sql import SparkSession

    os.environ.setdefault("PYSPARK_PYTHON", sys.executable)
    builder = SparkSession.builder.master("local-cluster[2,1,1024]").appName("gumption")
    builder = builder.config("spark.ui.enabled", "false").config("spark.sql.shuffle.partitions", "5")
    try:
        spark = builder.getOrCreate()
    except Exception as why:  # without Java there is no Spark
        pytest.skip(f"Spark does not start: {why}")
    flag = tmp_path / "died"
    try:
        assert_same(run("Spark", page).toArrow().cast(expected.schema), expected)
        page["evaluated"] = until_dead(page["evaluated"], flag)
        assert_same(run("Spark", page).toArrow().cast(expected.schema), expected)
    finally:
        spark.stop()
    assert flag.exists()
