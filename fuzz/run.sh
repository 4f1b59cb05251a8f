#!/usr/bin/env bash
# Fuzzes every target for a bounded number of runs: run.sh [TARGET[=RUNS]...]; installs cargo-fuzz if it is missing.
# Needs a nightly toolchain. What fails is kept in fuzz/artifacts.
set -euo pipefail
cd "$(dirname "$0")/.."
if ! cargo +nightly --version >/dev/null 2>&1; then
  echo "fuzz: no nightly toolchain: rustup toolchain install nightly --profile minimal" >&2
  exit 2
fi
if ! command -v cargo-fuzz >/dev/null; then
  echo "fuzz: installing cargo-fuzz" >&2
  cargo install --quiet --locked cargo-fuzz --version 0.13.2
fi
jobs=("$@")
# A minute or two in all, building aside; those that take longest for a run get fewest.
if [ $# -eq 0 ]; then
  jobs=(scenario=1000 pair=250 limits=80 fleet=100 rmf=100 nav2=150 lif=1000 vda5050=1500 opendrive=300 opentcs=300 ccbs=300 grid=300 path=300 dump=1000 serve=300 journal=500)
fi
for run in "${jobs[@]}"; do
  target=${run%%=*} runs=${run##*=}
  if [ "$runs" = "$target" ]; then runs=100000; fi
  corpus=fuzz/corpus/$target
  mkdir -p "$corpus"
  real=tests/data/real small=tests/data/small
  case $target in
    scenario) seeds=(tests/data/paper12.json tests/data/table6-5.json "$small/outlines.json") ;;
    nav2) seeds=("$real/nav2/sample_graph.geojson") ;;
    lif) seeds=("$real"/lif/example_0[1-6].lif.json "$real/lif/example_17.lif.json") ;;
    vda5050) seeds=("$real"/vda5050/*.json "$small/state.json") ;;
    rmf) seeds=("$real/rmf/triple_H.building.yaml") ;;
    opendrive) seeds=("$small/track.xodr") ;;
    opentcs) seeds=("$small/plant.xml") ;;
    ccbs) seeds=("$real/ccbs/example_grid_task_log.xml" "$small/roadmap.xml") ;;
    grid) seeds=("$small/grid.path") ;;
    fleet) seeds=("$small/factsheet.json" "$real"/rmf/config/*.yaml) ;;
    path) seeds=("$small/points.path") ;;
    dump) seeds=(tests/data/dumps/pair-*.txt) ;;
    *) seeds=() ;;
  esac
  if [ ${#seeds[@]} -gt 0 ]; then cp "${seeds[@]}" "$corpus"; fi
  # Without AddressSanitizer, which takes longer to build: the crates forbid unsafe code.
  cargo +nightly fuzz run --sanitizer none "$target" "$corpus" -- -runs="$runs" -seed=1 -timeout=600 -max_len=10000
done
