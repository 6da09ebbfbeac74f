#!/bin/sh
# Runs gumption beside other ways of doing the same Monte Carlo calculation, in one session on this
# machine, and writes reports/performance.md.
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
cargo bench --bench limits --bench quasi --bench throughput --no-run --quiet

# In turns, so that whatever else the machine does falls on all of them.
for turn in 1 2; do
    cargo bench --bench limits --quiet >>"$work/limits.jsonl"
    "$python" benches/compare.py measure "$target/release/gumption" >>"$work/gumption.jsonl"
    for peer in numpy numba suncal; do
        [ -f "$baselines/bench_$peer.py" ] || continue
        (cd "$baselines" && PYTHONDONTWRITEBYTECODE=1 "$python" "bench_$peer.py" throughput --n=1e6,1e7 --runs=3) \
            >>"$work/$peer.jsonl" 2>/dev/null || echo "$peer: not run" >&2
    done
done

cargo bench --bench quasi --quiet >"$work/quasi.txt"

"$python" benches/compare.py report "$work" >"$work/performance.md"
mv "$work/performance.md" reports/performance.md
