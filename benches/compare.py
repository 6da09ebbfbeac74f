"""Times gumption, and puts the figures of compare.sh into a table.

    compare.py measure GUMPTION    one JSON line per model, number of trials and threads, of whole programs
                                   and of the calculation alone (benches/throughput.rs)
    compare.py report FOLDER       Markdown from all JSON lines in the folder
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
RUNS = {10**6: 9, 10**7: 5, 10**8: 3}
#: Most trials of the long models.
MOST = {"gauge": 10**8, "twenty": 10**7, "thousand": 10**6}
PEERS = {
    "numpy-best": "NumPy, best practice",
    "numba": "numba",
    "suncal": "suncal",
}


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


def calculation(file, trials, threads):
    """CPU and wall seconds of the evaluation inside a process."""
    command = ["cargo", "bench", "--quiet", "--bench", "throughput", "--"]
    command += [str(word) for word in (file, trials, threads, RUNS[trials])]
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)


def measure(program):
    with tempfile.TemporaryDirectory() as work:
        for model in MODELS:
            file = pathlib.Path(work) / f"{model}.toml"
            file.write_text(budget(model))
            for trials in TRIALS:
                if trials > MOST.get(model, trials):
                    continue
                for threads in (1, 2):
                    runs = [run(program, file, trials, threads) for _ in range(RUNS[trials])]
                    cpu, wall, memory = (statistics.median(column) for column in zip(*runs))
                    record = {"gumption": model, "n": trials, "threads": threads}
                    record |= {"program": cpu, "program_wall": wall, "memory": memory}
                    print(json.dumps(record | calculation(file, trials, threads)), flush=True)


#: What is measured of gumption.
OWN = ("cpu", "wall", "program", "program_wall", "memory")


def read(folder):
    """The best of all turns: gumption's runs, those of the others, rates of the limits."""
    own, others, limits = {}, {}, {}
    for file in sorted(pathlib.Path(folder).glob("*.jsonl")):
        for line in file.read_text().splitlines():
            record = json.loads(line)
            if "limit" in record:
                name = record["limit"]
                limits[name] = max(limits.get(name, 0), record["per_second"])
            elif "gumption" in record:
                key = record["gumption"], record["n"], record["threads"]
                before = own.get(key, record)
                own[key] = {column: min(before[column], record[column]) for column in OWN}
            elif record.get("task") == "throughput":
                key = record["peer"], record["model"], record["n"]
                others[key] = min(others.get(key, float("inf")), record["cpu_median_s"])
    return own, others, limits


def power(trials):
    return f"10^{len(str(trials)) - 1}"


def ratio_row(model, trials, own, others, limits):
    one = own[model, trials, 1]
    cells = [model, power(trials), f"{1000 * one['cpu']:.1f}"]
    for peer in PEERS:
        other = others.get((peer, model, trials))
        cells.append(f"{other / one['cpu']:.1f} × ({other / one['program']:.1f} ×)" if other else "–")
    kernel = limits.get(model)
    cells.append(f"{100 * trials / one['cpu'] / kernel:.0f} %" if kernel else "–")
    cells.append(f"{one['wall'] / own[model, trials, 2]['wall']:.2f} ×")
    return cells


def program_row(model, trials, own, *_):
    one, two = own[model, trials, 1], own[model, trials, 2]
    times = [one["program"], one["program_wall"], two["program_wall"]]
    return [model, power(trials), *(f"{1000 * time:.1f}" for time in times), f"{one['memory']:.0f}"]


def table(heads, row, *measured):
    print("| " + " | ".join(heads) + " |")
    print("|---|" + "--:|" * (len(heads) - 1))
    for model in MODELS:
        for trials in TRIALS:
            if (model, trials, 1) in measured[0]:
                print("| " + " | ".join(row(model, trials, *measured)) + " |")


def report(folder):
    measured = own, others, limits = read(folder)
    print("# Performance of the Monte Carlo method\n")
    print("Written by `benches/compare.sh`. All figures are from one session on one machine")
    print(f"({platform.machine()}, {os.cpu_count()} processors; load average {os.getloadavg()[0]:.1f} at the end), the")
    print("programs in turns, medians of several runs, of two turns the better one.\n")
    absent = [text for peer, text in PEERS.items() if not any(key[0] == peer for key in others)]
    if absent:
        print(f"Not installed, hence not compared: {', '.join(absent)}.\n")
    print("## Calculation\n")
    print("CPU milliseconds on one thread, in a process that runs already, from the budget to estimate, u and both")
    print("coverage intervals; this is also what the others measure of themselves. A ratio is CPU time of the other")
    print("over that of gumption; in brackets over that of the whole program `gumption eval`, with its start, the")
    print("file and the JSON, where the others' interpreters have been started before. *Of the kernel*: the rate")
    print("over that of the same model written by hand on the same kernels (draws, model and moments only). *Two")
    print("threads*: wall time of one over that of two.\n")
    heads = ["model", "trials", "CPU ms", *PEERS.values(), "of the kernel", "two threads"]
    table(heads, ratio_row, *measured)
    print("\n## Whole program\n")
    print("Milliseconds of `gumption eval --json` from start to end.\n")
    heads = ["model", "trials", "CPU ms", "wall ms", "wall ms, two threads", "peak MB"]
    table(heads, program_row, *measured)
    print("\n## Time to two stable digits\n")
    print("Quasi-random points beside random trials of gumption, each until it guarantees estimate, u and both ends")
    print("of the 95 % interval to two digits of u ([docs/monte-carlo.md](../docs/monte-carlo.md)).\n")
    print("```text")
    print(pathlib.Path(folder, "quasi.txt").read_text().strip())
    print("```")
    print("\n## Models\n")
    for model, text in MODELS.items():
        print(f"- `{model}`: {text}")
    print("\n## Limits of this machine\n")
    print("Million lanes a second, one thread, from the same session.\n")
    print("| kernel | rate |\n|---|--:|")
    for name, rate in limits.items():
        print(f"| {name} | {rate / 1e6:.1f} |")


{"measure": measure, "report": report}[sys.argv[1]](sys.argv[2])
