#!/bin/sh
# Nanoseconds a pair for unsafe delays of straight edges, ours beside the published equations in C++ (benches/peers/delays.cc), on the edges of
# a roadmap of CPLP: benches/delays.sh [ROADMAP.json]. Every pair, near or far, and the nearest ones (edges within 12 m) alone.
set -eu
cd "$(dirname "$0")/.."
roadmap=${1:-tests/data/real/cplp/set0_301c854d.json}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"${CXX:-c++}" -std=c++17 -O3 -DNDEBUG -Wall -Wextra -o "$work/peer" benches/peers/delays.cc
cargo build --quiet --release -p pcr-benches --bin delays
python3 - "$roadmap" "$work" <<'PY'
import json, sys
graph = json.load(open(sys.argv[1]))["graph"]
at = {node["id"]: node["pos"] for node in graph["nodes"]}
edges = [(*at[link["source"]], *at[link["target"]]) for link in graph["links"]]
x, y = at[graph["nodes"][0]["id"]]
near = [e for e in edges if abs(e[0] - x) + abs(e[1] - y) < 12]
for name, some in (("all", edges), ("near", near)):
    open(f"{sys.argv[2]}/{name}", "w").writelines("%r %r %r %r\n" % e for e in some)
PY
for which in all near; do
    echo "$which, $(wc -l <"$work/$which") edges: ns a pair, pairs with an interval, sum of their lengths [s]"
    echo "  pcr        $(target/release/delays 20 2 <"$work/$which")"
    echo "  published  $("$work/peer" 20 2 <"$work/$which")"
done
