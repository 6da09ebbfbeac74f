"""Times gumption and puts the figures of compare.sh into a table (Markdown on standard output)."""

import json
import os
import pathlib
import platform
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
TRIALS = [10**6, 10**7, 10**8]
RUNS = 5


def budget(model):
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
    """Best of several runs: CPU seconds, wall seconds, peak memory in MB."""
    best = [float("inf")] * 3
    runs = RUNS if trials <= 10**7 else 2
    for _ in range(runs):
        start = time.perf_counter()
        process = subprocess.Popen(
            [program, "eval", file, "--json", "--trials", str(trials), "--threads", str(threads)],
            stdout=subprocess.DEVNULL,
        )
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        if status:
            sys.exit(f"gumption failed on {file}")
        cpu = usage.ru_utime + usage.ru_stime
        best = [min(a, b) for a, b in zip(best, (cpu, wall, usage.ru_maxrss / 1024))]
    return best


def records(folder):
    for file in sorted(pathlib.Path(folder).glob("*.jsonl")):
        for line in file.read_text().splitlines():
            yield json.loads(line)


def main():
    program, folder = sys.argv[1:]
    others, limits = {}, {}
    for record in records(folder):
        if "limit" in record:
            limits[record["limit"]] = record["per_second"]
        elif record.get("task") == "throughput":
            others[record["peer"], record["model"], record["n"]] = record["cpu_median_s"]
    peers = ["numpy-best", "numba", "suncal"]
    print("# Performance of the Monte Carlo method\n")
    print("Written by `benches/compare.sh`; all figures are from one session on one machine")
    print(f"({platform.machine()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the end).")
    print("CPU seconds of the whole program, from the file to both coverage intervals, on one thread;")
    print("a ratio is CPU seconds of the other over those of gumption.\n")
    absent = [peer for peer in peers if not any(key[0] == peer for key in others)]
    if absent:
        print(f"Not installed, hence not compared: {', '.join(absent)}.\n")
    print("| model | trials | CPU s | wall s | peak MB | 2 threads: wall s | " + " | ".join(peers) + " | of the kernel |")
    print("|---|--:|--:|--:|--:|--:|" + "--:|" * (len(peers) + 1))
    with tempfile.TemporaryDirectory() as work:
        for model in MODELS:
            file = pathlib.Path("budgets/length/gauge-block-gum-s1-9-5.toml")
            if model != "gauge":
                file = pathlib.Path(work) / f"{model}.toml"
                file.write_text(budget(model))
            for trials in TRIALS[: 1 if model == "thousand" else 2 if model == "twenty" else 3]:
                cpu, wall, memory = run(program, file, trials, 1)
                two = run(program, file, trials, 2)[1]
                ratios = []
                for peer in peers:
                    other = others.get((peer, model, trials))
                    ratios.append(f"{other / cpu:.1f} ×" if other else "–")
                kernel = limits.get(model)
                share = f"{100 * trials / cpu / kernel:.0f} %" if kernel else "–"
                cells = [model, f"10^{len(str(trials)) - 1}", f"{cpu:.3f}", f"{wall:.3f}", f"{memory:.0f}", f"{two:.3f}"]
                print("| " + " | ".join(cells + ratios + [share]) + " |")
    print("\n## Models\n")
    for model, text in MODELS.items():
        print(f"- `{model}`: {text}")
    print("\n## Limits of this machine\n")
    print("Measured in the same session, one thread; kernels draw, evaluate and sum moments, nothing else.\n")
    for name, rate in limits.items():
        print(f"- {name}: {rate / 1e6:.0f} million a second")


main()
