#!/bin/sh
# Runs gumption beside other ways of doing the same Monte Carlo calculation, and the propagation of many
# inputs, in one session on this machine, and writes reports/performance.md.
#
#   benches/compare.sh [BASELINES [PYTHON]]
#
# BASELINES is a folder with bench_numpy.py, bench_numba.py and bench_suncal.py, which print JSON lines
# (default ../shared/bench); PYTHON an interpreter that has what they need (pip install numpy scipy numba
# numexpr suncal). What is missing is left out and named in the report.
set -eu
cd "$(dirname "$0")/.."
baselines=${1:-../shared/bench}
python=${2:-python3}
target=${CARGO_TARGET_DIR:-target}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cargo build --release --quiet --bin gumption
cargo bench --bench limits --bench quasi --bench throughput --bench propagation --no-run --quiet

"$python" benches/compare.py measure "$target/release/gumption" "$baselines" >"$work/turns.jsonl"
cargo bench --bench quasi --quiet >"$work/quasi.txt"
cargo bench --bench propagation --quiet >"$work/propagation.txt"
"$python" benches/compare.py report "$work/turns.jsonl" "$work/quasi.txt" "$work/propagation.txt" >"$work/performance.md"
mv "$work/performance.md" reports/performance.md
