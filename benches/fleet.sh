#!/bin/sh
# Runs `gumption batch` beside NumPy and packages for uncertain numbers in one session on this machine, and writes
# reports/fleet.md.
#
#   benches/fleet.sh [PYTHON]
#
# PYTHON is an interpreter that has what it needs: pip install GTC metrolopy numpy pandas scipy uncertainties.
set -eu
cd "$(dirname "$0")/.."
python=${1:-python3}
target=${CARGO_TARGET_DIR:-target}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cargo build --release --quiet --bin gumption
cargo bench --quiet --bench batch >"$work/batch.txt"
"$python" benches/fleet.py "$target/release/gumption" "$work/batch.txt" >"$work/fleet.md"
mv "$work/fleet.md" reports/fleet.md
