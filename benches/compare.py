"""Times gumption beside others, and puts the figures into a table.

    compare.py measure GUMPTION BASELINES    one JSON line for each turn of a model and a number of trials
    compare.py report FILE QUASI PROPAGATION Markdown from these lines and the output of two benches

In a turn everything that is compared runs within seconds, because the clock of a machine drifts: ratios
are of one turn, and medians over the turns.
"""

import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile
import time

MODELS = {
    "add": "y = x1 + x2 + x3 + x4, rectangular (JCGM 101, 9.2.3)",
    "mm0": "y = x1² + x2², normal, r = 0 (9.4)",
    "mm9": "the same, r = 0.9",
    "gauge": "gauge block, nine inputs, four of them t (9.5)",
    "twenty": "sum of 20 squares, normal, all r = 0.5",
    "thousand": "sum of 1000 squares, normal",
}
GAUGE = "budgets/length/gauge-block-gum-s1-9-5.toml"
TRIALS = [10**6, 10**7, 10**8]
#: Runs of one measurement, of which the median counts, as with the others.
RUNS = {10**6: 9, 10**7: 7, 10**8: 3}
#: Turns of a model and a number of trials.
TURNS = {10**6: 5, 10**7: 3, 10**8: 3}
#: Most trials of the long models.
MOST = {"gauge": 10**8, "twenty": 10**7, "thousand": 10**6}
#: For the table, the script that prints the lines of a baseline, its name in them, and its environment. NumPy asks
#: for huge pages of memory; suncal, which keeps all trials, is half as fast where the system has none left.
PEERS = {
    "NumPy, best practice": ("bench_numpy.py", "numpy-best", {}),
    "numba": ("bench_numba.py", "numba", {}),
    "suncal": ("bench_suncal.py", "suncal", {}),
    "suncal, small pages": ("bench_suncal.py", "suncal", {"NUMPY_MADVISE_HUGEPAGE": "0"}),
}
#: What the baselines know.
PEER_MODELS = ("add", "mm0", "mm9", "gauge")
PEER_TRIALS = 10**7


def budget(model):
    """The text of a budget file."""
    if model == "gauge":
        return pathlib.Path(GAUGE).read_text()
    lines = ['title = "Benchmark"', "[measurand.Y]"]
    if model == "add":
        lines += ['model = "x1 + x2 + x3 + x4"']
        lines += [f"[input.x{i}]\nvalue = 0\nhalf_width = 1.7320508075688772" for i in range(1, 5)]
    elif model in ("mm0", "mm9"):
        lines += ['model = "x1^2 + x2^2"', "[input]"]
        lines += ["x1 = { value = 0.050, u = 0.005 }", "x2 = { value = 0, u = 0.005 }"]
        if model == "mm9":
            lines += ['[[correlation]]\nbetween = ["x1", "x2"]\nr = 0.9']
    else:
        count = {"twenty": 20, "thousand": 1000}[model]
        lines += ['model = "' + " + ".join(f"x{i}^2" for i in range(count)) + '"']
        lines += [f"[input.x{i}]\nvalue = 1\nu = 0.01" for i in range(count)]
        if model == "twenty":
            pairs = [(i, j) for i in range(count) for j in range(i)]
            lines += [f'[[correlation]]\nbetween = ["x{j}", "x{i}"]\nr = 0.5' for i, j in pairs]
    return "\n".join(lines) + "\n"


def run(program, file, trials, threads):
    """CPU seconds, wall seconds and peak memory in MB of one run."""
    start = time.perf_counter()
    process = subprocess.Popen(
        [program, "eval", file, "--json", "--trials", str(trials), "--threads", str(threads)],
        stdout=subprocess.DEVNULL,
    )
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    if status:
        sys.exit(f"gumption failed on {file}")
    return usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024


def lines_of(command, folder=".", environment=None):
    """The JSON lines that a command prints; none where it fails."""
    environment = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"} | (environment or {})
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    if done.returncode:
        return []
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def bench(name, *words):
    """The JSON line of one of our benchmarks."""
    lines = lines_of(["cargo", "bench", "--quiet", "--bench", name, "--", *words])
    if len(lines) != 1:
        sys.exit(f"the benchmark {name} failed")
    return lines[0]


def program_figures(program, file, trials, threads):
    """CPU and wall seconds and peak memory of whole programs."""
    runs = [run(program, file, trials, threads) for _ in range(RUNS[trials])]
    return dict(zip(("cpu", "wall", "memory"), (statistics.median(column) for column in zip(*runs))))


def peers(baselines, model, trials):
    """CPU seconds of the others."""
    times = {}
    if model not in PEER_MODELS or trials > PEER_TRIALS:
        return times
    for peer, (script, name, environment) in PEERS.items():
        if not pathlib.Path(baselines, script).exists():
            continue
        command = [sys.executable, script, "throughput", f"--n={trials}", "--runs=3", f"--models={model}"]
        for line in lines_of(command, baselines, environment):
            if line.get("peer") == name:
                times[peer] = line["cpu_median_s"]
    return times


def measure(program, baselines):
    """Turn by turn over all cells: a slow minute falls on few cells, and on one turn of each."""
    with tempfile.TemporaryDirectory() as work:
        for model in MODELS:
            file = pathlib.Path(work) / f"{model}.toml"
            file.write_text(budget(model))
        for turn in range(max(TURNS.values())):
            for model in MODELS:
                file = pathlib.Path(work) / f"{model}.toml"
                for trials in TRIALS:
                    if trials > MOST.get(model, trials) or turn >= TURNS[trials]:
                        continue
                    record = {"model": model, "n": trials}
                    record["limit"] = bench("limits", model)["per_second"]
                    record["inside"] = bench("throughput", file, trials, RUNS[trials])
                    record["program"] = {
                        name: program_figures(program, file, trials, threads)
                        for name, threads in (("one", 1), ("two", 2))
                    }
                    record["peers"] = peers(baselines, model, trials)
                    print(json.dumps(record), flush=True)
        for limit in ("uniform", "normal"):
            print(json.dumps(bench("limits", limit)))


def read(file):
    """The turns of each model and number of trials, and the rates of random numbers."""
    turns, limits = {}, {}
    for line in pathlib.Path(file).read_text().splitlines():
        record = json.loads(line)
        if "model" in record:
            turns.setdefault((record["model"], record["n"]), []).append(record)
        else:
            limits[record["limit"]] = record["per_second"]
    for (model, _), records in turns.items():
        limits[model] = statistics.median(record["limit"] for record in records)
    return turns, limits


def power(trials):
    return f"10^{len(str(trials)) - 1}"


def median(records, figure):
    return statistics.median(figure(record) for record in records)


def inside(column):
    """A figure of the calculation in a turn."""
    return lambda record: record["inside"][column]


def program(column, threads="one"):
    """A figure of the whole program in a turn."""
    return lambda record: record["program"][threads][column]


def ratio_row(model, trials, records):
    cells = [model, power(trials), f"{1000 * median(records, inside('cpu')):.1f}"]
    for peer in PEERS:
        with_peer = [record for record in records if peer in record["peers"]]
        if not with_peer:
            cells.append("–")
            continue
        calculation, whole = (
            median(with_peer, lambda record: record["peers"][peer] / cpu(record))
            for cpu in (inside("cpu"), program("cpu"))
        )
        cells.append(f"{calculation:.1f} × ({whole:.1f} ×)")
    share = median(records, lambda record: trials / inside("cpu")(record) / record["limit"])
    cells.append(f"{100 * share:.0f} %")
    two, pair = (
        median(records, lambda record: times * inside("one")(record) / inside(way)(record))
        for way, times in (("two", 1), ("pair", 2))
    )
    cells.append(f"{two:.2f} × of {pair:.2f} ×")
    return cells


def program_row(model, trials, records):
    figures = program("cpu"), program("wall"), program("wall", "two")
    times = [f"{1000 * median(records, figure):.1f}" for figure in figures]
    return [model, power(trials), *times, f"{median(records, program('memory')):.0f}"]


def table(heads, row, turns):
    print("| " + " | ".join(heads) + " |")
    print("|---|" + "--:|" * (len(heads) - 1))
    for model in MODELS:
        for trials in TRIALS:
            if (model, trials) in turns:
                print("| " + " | ".join(row(model, trials, turns[model, trials])) + " |")


def quote(file):
    """The output of a benchmark as it is."""
    print("```text")
    print(pathlib.Path(file).read_text().strip())
    print("```")


def report(file, quasi, propagation):
    turns, limits = read(file)
    print("# Performance\n")
    print("Written by `benches/compare.sh`. All figures are from one session on one machine")
    print(f"({platform.machine()}, {os.cpu_count()} processors; load average {os.getloadavg()[0]:.1f} at the end).")
    print("What is compared ran in turns of seconds; figures and ratios are medians over the turns, ratios of")
    print("figures of the same turn.\n")
    met = {peer for records in turns.values() for record in records for peer in record["peers"]}
    absent = [peer for peer in PEERS if peer not in met]
    if absent:
        print(f"Not installed, hence not compared: {', '.join(absent)}.\n")
    print("## Monte Carlo: calculation\n")
    print("CPU milliseconds on one thread, in a process that runs already, from the budget to estimate, u and both")
    print("coverage intervals; this is also what the others measure of themselves. A ratio is CPU time of the other")
    print("over that of gumption; in brackets over that of the whole program `gumption eval`, with its start, the")
    print("file and the JSON, where the others' interpreters have been started before. *Of the kernel*: the rate")
    print("over that of the same model written by hand on the same kernels (draws, model and moments only). *Two")
    print("threads*: wall time of one over that of two, *of* what two calculations at once reach, on a thread each.")
    print("*Small pages*: without the huge pages of memory that NumPy asks for, and does not always get.\n")
    heads = ["model", "trials", "CPU ms", *PEERS, "of the kernel", "two threads"]
    table(heads, ratio_row, turns)
    print("\n## Monte Carlo: whole program\n")
    print("Milliseconds of `gumption eval --json` from start to end.\n")
    heads = ["model", "trials", "CPU ms", "wall ms", "wall ms, two threads", "peak MB"]
    table(heads, program_row, turns)
    print("\n## Monte Carlo: time to two stable digits\n")
    print("Quasi-random points beside random trials of gumption, each until it guarantees estimate, u and both ends")
    print("of the 95 % interval to two digits of u ([docs/monte-carlo.md](../docs/monte-carlo.md)).\n")
    quote(quasi)
    print("\n## Propagation of many inputs\n")
    print("From the budget to u, k, U, degrees of freedom, every line of the budget, second order and what a reader has")
    print("to know, without Monte Carlo; and from the text of the file to the budget.\n")
    quote(propagation)
    print("\n## Models of Monte Carlo\n")
    for model, text in MODELS.items():
        print(f"- `{model}`: {text}")
    print("\n## Limits of this machine\n")
    print("Million lanes a second, one thread, from the same session.\n")
    print("| kernel | rate |\n|---|--:|")
    for name, rate in limits.items():
        print(f"| {name} | {rate / 1e6:.1f} |")


{"measure": measure, "report": report}[sys.argv[1]](*sys.argv[2:])
