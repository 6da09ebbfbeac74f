"""Measures `gumption batch` beside NumPy and the package uncertainties, for fleet.sh.

    python benches/fleet.py GUMPTION

CPU seconds (user and system) of whole programs on one thread, and of the calculation alone for what runs in this
process; all in turns, and medians of them. Prints reports/fleet.md.
"""

from __future__ import annotations

import math
import os
import platform
import random
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

NAMES = "abcdefghij"
TURNS = 5
ROWS = 100_000
MODEL = "a * b / c + d * e - f / g + h * i * j"


def budget() -> str:
    inputs = "".join(f"[input.{name}]\nvalue = 1.5\nu = 0.01\ndof = {5 + at}\n" for at, name in enumerate(NAMES))
    return f'[measurand.y]\nmodel = "{MODEL}"\n{inputs}'


def table(rows: int) -> tuple[str, list[list[float]]]:
    numbers = random.Random(1)
    lines = [",".join(f"{name},{name}.u" for name in NAMES)]
    values = []
    for _ in range(rows):
        row = []
        for _ in NAMES:
            row += [round(numbers.uniform(1, 10), 6), round(numbers.uniform(0.001, 0.01), 6)]
        values.append(row)
        lines.append(",".join(map(repr, row)))
    return "\n".join(lines) + "\n", values


def program(arguments: list[str]) -> float:
    """CPU seconds of a program."""
    process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{arguments} failed")
    return used.ru_utime + used.ru_stime


def memory_of(arguments: list[str]) -> int:
    """The largest memory of a program, in kB, from the system's own count: that of `wait4` includes this process."""
    largest = 0
    with subprocess.Popen(arguments, stdout=subprocess.DEVNULL) as process:
        while process.poll() is None:
            status = Path(f"/proc/{process.pid}/status").read_text()
            peak = [line for line in status.splitlines() if line.startswith("VmHWM")]
            largest = max([largest, *(int(line.split()[1]) for line in peak)])
            time.sleep(0.01)
    return largest


def by_numpy(np, stats, values):
    """y, u, ν_eff, k and U of all rows at once, with derivatives by hand; arrays in memory before and after."""
    x = {name: values[:, 2 * at] for at, name in enumerate(NAMES)}
    u = {name: values[:, 2 * at + 1] for at, name in enumerate(NAMES)}
    a, b, c, d, e, f, g, h, i, j = (x[name] for name in NAMES)
    y = a * b / c + d * e - f / g + h * i * j
    slopes = {
        "a": b / c, "b": a / c, "c": -a * b / c**2, "d": e, "e": d,
        "f": -1 / g, "g": f / g**2, "h": i * j, "i": h * j, "j": h * i,
    }
    parts = [(slopes[name] * u[name]) ** 2 for name in NAMES]
    square = sum(parts)
    freedom = square**2 / sum(part**2 / (5 + at) for at, part in enumerate(parts))
    whole, back = np.unique(np.floor(np.round(freedom, 2)), return_inverse=True)
    k = stats.t.ppf(0.975, whole)[back]
    uncertainty = np.sqrt(square)
    return y, uncertainty, freedom, k, k * uncertainty


def by_uncertainties(ufloat, values):
    """y and u, row by row; the package knows neither ν_eff nor k."""
    found = []
    for row in values:
        a, b, c, d, e, f, g, h, i, j = (ufloat(row[2 * at], row[2 * at + 1]) for at in range(len(NAMES)))
        y = a * b / c + d * e - f / g + h * i * j
        found.append((y.nominal_value, y.std_dev))
    return found


def cpu(task) -> float:
    start = time.process_time()
    task()
    return time.process_time() - start


def main() -> None:
    [gumption] = sys.argv[1:]
    import numpy as np
    import uncertainties
    from scipy import __version__ as scipy_version
    from scipy import stats

    few = 2_000
    rows, trials = 500, 10_000
    seconds: dict[str, list[float]] = {}
    memory: dict[int, int] = {}
    with tempfile.TemporaryDirectory() as folder:
        files = Path(folder)
        (files / "budget.toml").write_text(budget())
        text, values = table(ROWS)
        (files / "rows.csv").write_text(text)
        head, *lines = text.splitlines()
        (files / "few.csv").write_text("\n".join([head, *lines[:rows]]) + "\n")
        with open(files / "many.csv", "w") as many:
            many.write(head + "\n")
            for _ in range(10):
                many.write("\n".join(lines) + "\n")
        array = np.array(values)
        batch = [gumption, "batch", str(files / "budget.toml")]
        one = ["--threads", "1"]
        monte_carlo = ["--monte-carlo", "--trials", str(trials)]
        ways = {
            "batch": lambda: program([*batch, str(files / "rows.csv"), *one]),
            "numpy": lambda: cpu(lambda: by_numpy(np, stats, array)),
            "uncertainties": lambda: cpu(lambda: by_uncertainties(uncertainties.ufloat, values[:few])),
            "trials": lambda: program([*batch, str(files / "few.csv"), *monte_carlo, *one]),
            "whole": lambda: program(
                [gumption, "eval", str(files / "budget.toml"), "--trials", str(rows * trials), *one]
            ),
        }
        for _ in range(TURNS):
            for name, way in ways.items():
                seconds.setdefault(name, []).append(way())
        for name, count in (("rows.csv", ROWS), ("many.csv", 10 * ROWS)):
            memory[count] = memory_of([*batch, str(files / name), *one])
        # The same figures, or nothing is compared.
        out = subprocess.run([*batch, str(files / "few.csv")], capture_output=True, text=True, check=True).stdout
        ours = [[float(cell) for cell in line.split(",")[1:6]] for line in out.splitlines()[1:]]
        theirs = np.array(by_numpy(np, stats, array[:rows])).T
        assert np.allclose(np.array(ours)[:, [0, 1, 3, 4]], theirs[:, [0, 1, 3, 4]], rtol=1e-9)
    median = {name: statistics.median(found) for name, found in seconds.items()}
    rate = {
        "batch": ROWS / median["batch"],
        "numpy": ROWS / median["numpy"],
        "uncertainties": few / median["uncertainties"],
    }

    def rounded(number: float) -> str:
        digits = 1 - math.floor(math.log10(number))
        return f"{round(number, digits):,.{max(digits, 0)}f}".replace(",", " ")

    per_row = rows * trials / median["trials"]
    of_one = rows * trials / median["whole"]
    print(f"""# Fleets

Written by `benches/fleet.sh` on {platform.system()}, {platform.machine()}; Python {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy_version},
uncertainties {uncertainties.__version__}. CPU time on one thread, medians of {TURNS} turns. A row has ten inputs with value and u; the model is
`{MODEL}`. Ratios hold for other machines, rates do not.

| | a row gets | rows per second and core | `gumption batch` is so many times as fast |
|---|---|--:|--:|
| `gumption batch`, CSV to CSV | y, u, ν_eff, k, U, interval, findings (second order, poles, resolution of the arithmetic) | {rounded(rate["batch"])} | 1 |
| NumPy, vectorised, derivatives by hand, arrays in memory | y, u, ν_eff, k, U | {rounded(rate["numpy"])} | {rounded(rate["batch"] / rate["numpy"])} |
| uncertainties, row by row | y, u | {rounded(rate["uncertainties"])} | {rounded(rate["batch"] / rate["uncertainties"])} |

| Monte Carlo | trials per second and core |
|---|--:|
| {trials:,} trials for each of {rows} rows | {rounded(per_row)} |
| one budget with as many trials together | {rounded(of_one)} |
| ratio | {rounded(per_row / of_one)} |

| rows | largest memory |
|--:|--:|
""" + "\n".join(f"| {count:,} | {rounded(kilobytes / 1024)} MB |" for count, kilobytes in memory.items()))


if __name__ == "__main__":
    main()
