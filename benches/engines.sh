#!/bin/sh
# Measures what a row costs on Dask, Ray and Spark with one, two and four workers, and writes reports/engines.md.
#
#   benches/engines.sh
#
# Spark needs Java.
set -eu
cd "$(dirname "$0")/.."
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT

python3 -m venv "$home"
"$home/bin/pip" install --quiet './crates/python[arrow,engines]' psutil
"$home/bin/python" benches/engines.py >"$home/engines.md"
mv "$home/engines.md" reports/engines.md
