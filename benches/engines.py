"""Measures what a row costs on the engines that hold a table in parts, on one, two and four workers, for engines.sh.

CPU seconds of all processes of the engine, from the time that its workers stand ready until the sums of all results are
there; each worker makes its parts of the table itself, so that what is counted is the engine's and gumption's own work. In
turns, and medians of them. What one process takes for the same parts stands beside it.
"""

from __future__ import annotations

import contextlib
import importlib.metadata
import os
import platform
import statistics
import sys
import time

import gumption
import numpy as np
import psutil
import pyarrow as pa

TURNS = 3
PARTS = 16
ROWS = 125_000
WORKERS = (1, 2, 4)
BUDGET = """
[measurand.y]
model = "a * b / c + d * e - f / g + h * i * j"
""" + "".join(f"[input.{name}]\nvalue = 1.5\nu = 0.01\ndof = {5 + at}\n" for at, name in enumerate("abcdefghij"))


def part(seed: int) -> pa.RecordBatch:
    """Devices of one part: values and standard uncertainties of ten inputs."""
    draw = np.random.default_rng(seed)
    columns = {}
    for name in "abcdefghij":
        columns[name] = draw.uniform(1, 10, ROWS)
        columns[f"{name}.u"] = draw.uniform(0.001, 0.01, ROWS)
    return pa.record_batch(columns)


def total(seed: int) -> float:
    """The sum of U over a part."""
    found = pa.record_batch(gumption.arrow_batch(BUDGET, part(seed)))
    return float(np.sum(found["expanded(y)"].to_numpy()))


def spent(process: psutil.Process) -> float:
    """CPU seconds of a process and all that it started."""
    seconds = 0.0
    for one in [process, *process.children(recursive=True)]:
        with contextlib.suppress(psutil.NoSuchProcess):
            times = one.cpu_times()
            seconds += times.user + times.system + times.children_user + times.children_system
    return seconds


def measured(task) -> tuple[float, float, list[float]]:
    """CPU seconds of everything, seconds on the clock, and what the task gives."""
    own = psutil.Process()
    before, start = spent(own), time.perf_counter()
    found = task()
    clock = time.perf_counter() - start
    return spent(own) - before, clock, found


@contextlib.contextmanager
def alone(_: int):
    yield lambda: [total(seed) for seed in range(PARTS)]


@contextlib.contextmanager
def dask(workers: int):
    import distributed

    with (
        distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        turn = iter(range(1000))

        def task():
            # A name of its own each time: results of the turn before are not taken again.
            return client.gather(client.map(total, range(PARTS), key=f"turn-{next(turn)}"))

        yield task


@contextlib.contextmanager
def ray(workers: int):
    import ray

    ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False)
    remote = ray.remote(total)
    try:
        yield lambda: ray.get([remote.remote(seed) for seed in range(PARTS)])
    finally:
        ray.shutdown()


@contextlib.contextmanager
def spark(workers: int):
    from pyspark.sql import SparkSession

    os.environ.setdefault("PYSPARK_PYTHON", sys.executable)
    builder = SparkSession.builder.master(f"local-cluster[{workers},1,1024]").appName("gumption")
    session = builder.config("spark.ui.enabled", "false").getOrCreate()
    session.sparkContext.setLogLevel("ERROR")

    def totals(batches):
        for rows in batches:
            found = [total(seed) for seed in rows["id"].to_pylist()]
            yield pa.record_batch({"id": rows["id"], "total": pa.array(found)})

    def task():
        seeds = session.range(0, PARTS, 1, PARTS)
        found = seeds.mapInArrow(totals, "id long, total double").toPandas()
        return found.sort_values("id")["total"].tolist()

    totals.__module__ = "__main__"
    try:
        yield task
    finally:
        session.stop()


def version(package: str) -> str:
    return importlib.metadata.version(package)


def main() -> None:
    rows = PARTS * ROWS
    engines = {
        "one process": (alone, (1,)),
        f"Dask {version('distributed')}": (dask, WORKERS),
        f"Ray {version('ray')}": (ray, WORKERS),
        f"Spark {version('pyspark')}": (spark, WORKERS),
    }
    expected = None
    lines = []
    costs = {}
    for name, (engine, counts) in engines.items():
        for workers in counts:
            with engine(workers) as task:
                task()
                turns = [measured(task) for _ in range(TURNS)]
            for _, _, found in turns:
                expected = expected or found
                # Bit for bit, whoever had which part.
                assert list(map(repr, found)) == list(map(repr, expected)), name
            cost = statistics.median(cpu for cpu, _, _ in turns) / rows
            clock = rows / statistics.median(seconds for _, seconds, _ in turns)
            costs[name, workers] = cost
            ratio = cost / costs["one process", 1]
            lines.append(f"| {name} | {workers} | {1e6 * cost:.2f} | {ratio:.2f} | {clock / 1e6:.2f} |")
    worst = max(costs.values())
    there = part(0).nbytes / ROWS
    back = pa.record_batch(gumption.arrow_batch(BUDGET, part(0))).nbytes / ROWS
    print(
        f"""# Engines

Written by `benches/engines.sh` on {platform.system()}, {platform.machine()}, {os.cpu_count()} cores; Python {platform.python_version()}. A row has ten inputs with value
and u; the model is that of [Fleets](fleet.md). {rows:,} rows in {PARTS} parts, medians of {TURNS} turns. Results were compared bit for bit. More
workers than cores add their own cost and no speed. Ratios hold for other machines, rates do not.

| | workers | CPU time of a row / µs | over one process | million rows per second on the clock |
|---|--:|--:|--:|--:|
"""
        + "\n".join(lines)
        + f"""

A billion devices, at the dearest of these: {1e9 * worst / 3600:.2f} core hours, {1e9 * there / 1e9:,.0f} GB of Arrow in and {1e9 * back / 1e9:,.0f} GB out ({there:.0f} and {back:.0f} bytes a row,
before compression); in parts of {ROWS:,} rows, {1e9 / ROWS:,.0f} tasks. On 100 cores that is {1e9 * worst / 100:.0f} s of calculation; reading and
writing the table takes longer."""
    )


if __name__ == "__main__":
    main()
