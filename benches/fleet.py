"""Measures `gumption batch` beside NumPy and packages for uncertain numbers, for fleet.sh.

    python benches/fleet.py GUMPTION BATCH

BATCH is what `cargo bench --bench batch` prints.
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


def looking_further(np, stats, values):
    """The same, and what `gumption batch` looks for besides: second-order terms (GUM 5.1.2, note), poles in reach of the
    coverage intervals, what the arithmetic resolves; and the interval."""
    y, uncertainty, freedom, k, expanded = by_numpy(np, stats, values)
    a, b, c, d, e, f, g, h, i, j = (values[:, 2 * at] for at in range(len(NAMES)))
    ua, ub, uc, ud, ue, uf, ug, uh, ui, uj = (values[:, 2 * at + 1] ** 2 for at in range(len(NAMES)))
    mixed = (
        ua * ub / c**2 + ua * uc * (b / c**2) ** 2 + ub * uc * (a / c**2) ** 2 + ud * ue
        + uf * ug / g**4 + uh * ui * j**2 + uh * uj * i**2 + ui * uj * h**2
    )
    squares = (2 * a * b / c**3 * uc) ** 2 / 2 + (2 * f / g**3 * ug) ** 2 / 2
    cubes = (
        (b / c) * (2 * b / c**3) * ua * uc + (a / c) * (2 * a / c**3) * ub * uc
        + (a * b / c**2) * (6 * a * b / c**4) * uc**2
        + (1 / g) * (2 / g**3) * uf * ug + (f / g**2) * (6 * f / g**4) * ug**2
    )
    bends = mixed + squares + cubes > (0.05 * uncertainty) ** 2
    poles = (np.abs(c) < 4 * np.sqrt(uc)) | (np.abs(g) < 4 * np.sqrt(ug))
    rounding = 2.0**-52 * (np.abs(a * b / c) + np.abs(d * e) + np.abs(f / g) + np.abs(h * i * j))
    return y, uncertainty, freedom, k, expanded, y - expanded, y + expanded, bends | poles | (rounding > 0.005 * uncertainty)


def from_csv_to_csv(np, pandas, stats, source, goal):
    """`by_numpy` between files that pandas reads and writes, with every digit."""
    values = pandas.read_csv(source, float_precision="round_trip").to_numpy()
    found = by_numpy(np, stats, values)
    pandas.DataFrame(dict(zip(("y", "u", "nu", "k", "U"), found))).to_csv(goal, index=False)


def model(a, b, c, d, e, f, g, h, i, j):
    return a * b / c + d * e - f / g + h * i * j


def by_uncertainties(ufloat, values):
    """y and u, row by row; the package knows neither ν_eff nor k."""
    found = []
    for row in values:
        y = model(*(ufloat(row[2 * at], row[2 * at + 1]) for at in range(len(NAMES))))
        found.append((y.nominal_value, y.std_dev))
    return found


def by_gtc(gtc, values):
    """y, u, ν_eff, k and U, row by row."""
    found = []
    for row in values:
        y = model(*(gtc.ureal(row[2 * at], row[2 * at + 1], 5 + at) for at in range(len(NAMES))))
        k = gtc.reporting.k_factor(y.df)
        found.append((y.x, y.u, y.df, k, k * y.u))
    return found


def by_metrolopy(gummy, values):
    """y, u, ν_eff, k and U, row by row."""
    found = []
    for row in values:
        y = model(*(gummy(row[2 * at], row[2 * at + 1], dof=5 + at) for at in range(len(NAMES))))
        y.p = 0.95
        found.append((y.x, y.u, y.dof, y.k, y.U))
    return found


def cpu(task) -> float:
    start = time.process_time()
    task()
    return time.process_time() - start


def rounded(number: float) -> str:
    digits = 1 - math.floor(math.log10(number))
    return f"{round(number, digits):,.{max(digits, 0)}f}".replace(",", " ")


def main() -> None:
    gumption, bench = sys.argv[1:]
    import GTC
    import metrolopy
    import numpy as np
    import pandas
    import scipy
    import uncertainties
    from scipy import stats

    few = 2_000
    rows, trials = 500, 10_000
    seconds: dict[str, list[float]] = {}
    memory: dict[str, list[int]] = {}
    with tempfile.TemporaryDirectory() as folder:
        files = Path(folder)
        (files / "budget.toml").write_text(budget())
        text, values = table(ROWS)
        (files / "rows.csv").write_text(text)
        head, *lines = text.splitlines()
        (files / "few.csv").write_text("\n".join([head, *lines[:rows]]) + "\n")
        for name, times in (("named.csv", 1), ("many.csv", 10)):
            with open(files / name, "w") as many:
                many.write(f"label,type,{head}\n")
                for turn in range(times):
                    many.writelines(f"{turn}-{at},{'AB'[at % 2]},{line}\n" for at, line in enumerate(lines))
        array = np.array(values)
        batch = [gumption, "batch", str(files / "budget.toml")]
        one = ["--threads", "1"]
        monte_carlo = ["--monte-carlo", "--trials", str(trials)]
        ways = {
            "batch": lambda: program([*batch, str(files / "rows.csv"), *one]),
            "pandas": lambda: cpu(lambda: from_csv_to_csv(np, pandas, stats, files / "rows.csv", files / "out.csv")),
            "numpy": lambda: cpu(lambda: by_numpy(np, stats, array)),
            "further": lambda: cpu(lambda: looking_further(np, stats, array)),
            "uncertainties": lambda: cpu(lambda: by_uncertainties(uncertainties.ufloat, values[:few])),
            "gtc": lambda: cpu(lambda: by_gtc(GTC, values[:few])),
            "metrolopy": lambda: cpu(lambda: by_metrolopy(metrolopy.gummy, values[:few])),
            "trials": lambda: program([*batch, str(files / "few.csv"), *monte_carlo, *one]),
            "whole": lambda: program(
                [gumption, "eval", str(files / "budget.toml"), "--trials", str(rows * trials), *one]
            ),
        }
        for _ in range(TURNS):
            for name, way in ways.items():
                seconds.setdefault(name, []).append(way())
        kinds = {
            "figures alone, `--keep type`": ["--keep", "type"],
            "and `--shares --contributions`": ["--keep", "type", "--shares", "--contributions"],
        }
        for kind, more in kinds.items():
            sizes = ("named.csv", "many.csv")
            memory[kind] = [memory_of([*batch, str(files / name), *one, *more]) for name in sizes]
        # The same figures, or nothing is compared.
        out = subprocess.run([*batch, str(files / "few.csv")], capture_output=True, text=True, check=True).stdout
        ours = np.array([[float(cell) for cell in line.split(",")[1:6]] for line in out.splitlines()[1:]])
        theirs = np.array(by_numpy(np, stats, array[:rows])).T
        assert np.allclose(ours[:, [0, 1, 3, 4]], theirs[:, [0, 1, 3, 4]], rtol=1e-9)
        for package in (by_uncertainties(uncertainties.ufloat, values[:9]), by_gtc(GTC, values[:9])):
            assert np.allclose(np.array(package)[:, :2], ours[:9, :2], rtol=1e-9)
        for package in (by_gtc(GTC, values[:9]), by_metrolopy(metrolopy.gummy, values[:9])):
            # Whole degrees of freedom here, ν_eff as it is there.
            assert np.allclose(np.array(package)[:, 2], theirs[:9, 2], rtol=1e-9)
    # Of the bench, which runs in one process: `from columns to columns`, rows a second.
    (columns,) = [line for line in Path(bench).read_text().splitlines() if line.startswith("from columns to columns")]
    counts = dict.fromkeys(("uncertainties", "gtc", "metrolopy"), few)
    rate = {name: counts.get(name, ROWS) / statistics.median(found) for name, found in seconds.items()}
    rate["columns"] = float(columns.removeprefix("from columns to columns").split()[0])

    def line(what: str, gets: str, name: str, beside: tuple[str, ...] = ("batch", "columns")) -> str:
        ratios = [rounded(rate[ours] / rate[name]) if ours in beside else "" for ours in ("batch", "columns")]
        return f"| {what} | {gets} | {rounded(rate[name])} | {ratios[0]} | {ratios[1]} |"

    figures, all_figures = "y, u, ν_eff, k, U", "y, u, ν_eff, k, U, interval, findings (second order, poles, resolution of the arithmetic)"
    lines = [
        line("`gumption batch`, CSV to CSV", all_figures, "batch"),
        line("the same, columns of doubles to columns", all_figures, "columns"),
        line("NumPy with pandas, CSV to CSV, derivatives by hand", figures, "pandas", ("batch",)),
        line("NumPy, arrays to arrays, derivatives by hand", figures, "numpy"),
        line("the same with second-order terms, poles, rounding and interval by hand", all_figures, "further"),
        line(f"uncertainties {uncertainties.__version__}, in a loop", "y, u", "uncertainties"),
        line(f"GTC {GTC.version}, in a loop", figures, "gtc"),
        line(f"metrolopy {metrolopy.__version__}, in a loop", figures, "metrolopy"),
    ]
    per_row, of_one = (rows * trials / statistics.median(seconds[name]) for name in ("trials", "whole"))
    print(f"""# Fleets

Written by `benches/fleet.sh` on {platform.system()}, {platform.machine()}; Python {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__},
pandas {pandas.__version__}. CPU time on one thread, medians of {TURNS} turns. A row has ten inputs, each with value, u and ν; the model is
`{MODEL}`. Ratios hold for other machines, rates do not.

| | a row gets | rows per second and core | `batch`, CSV to CSV, is × as fast | columns to columns |
|---|---|--:|--:|--:|
{chr(10).join(lines)}

Vectorised code by hand for one model is faster than a program that takes any model, and will be: a row in memory is {8 * (2 * len(NAMES) + 7)} bytes of doubles in and out, so that NumPy
without looking further is near what memory delivers: thirty times as fast as that cannot be had, nor many times. What it costs is the derivatives by hand, anew for each model.
Packages in a loop spend their time on an object for each input and each operation.

| Monte Carlo | trials per second and core |
|---|--:|
| {trials:,} trials for each of {rows} rows | {rounded(per_row)} |
| one budget with as many trials together | {rounded(of_one)} |
| ratio | {rounded(per_row / of_one)} |

| largest memory, CSV to CSV | {ROWS:,} rows | {10 * ROWS:,} rows |
|---|--:|--:|
""" + "\n".join(f"| {kind} | {' | '.join(f'{rounded(one / 1024)} MB' for one in both)} |" for kind, both in memory.items()))


if __name__ == "__main__":
    main()
