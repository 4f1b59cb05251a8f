#!/usr/bin/env bash
# Counts the instructions that the regions of 100 agents take as a NumPy array, and fails where they are more than 1.3 times those that
# benches/instructions.txt has of the table in Rust. Two runs of Python in valgrind take a quarter of a minute of processor time.
#   arrays.sh PYTHON     PYTHON has the package and NumPy: target/python/bin/python after check.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
python=${1:?usage: $0 PYTHON}
command -v valgrind >/dev/null || .ci/install.sh valgrind
rust=$(sed -n 's/^ *\([0-9]*\)  table6-100: all regions, both directions$/\1/p' benches/instructions.txt)
# counted TIMES: all instructions of a program that asks so often.
counted() {
  # Threads that wait would be counted, too.
  OPENBLAS_NUM_THREADS=1 RAYON_NUM_THREADS=1 valgrind --tool=callgrind --callgrind-out-file=/dev/null "$python" -I -c '
import sys, pcr
fleet = pcr.Fleet.read("tests/data/table6-100.json")
for _ in range(int(sys.argv[1])):
    assert len(fleet.regions().array) > 3000' "$1" 2>&1 >/dev/null | sed -n 's/.*Collected : //p'
}
once=$((($(counted 6) - $(counted 1)) / 5))
echo "$once instructions, $rust in Rust"
[ "$once" -le $((rust * 13 / 10)) ] || { echo "more than 1.3 times those of Rust" >&2; exit 1; }
