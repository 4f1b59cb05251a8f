#!/usr/bin/env bash
# Counts the instructions that jobs of the library take on the host, and compares them with instructions.txt.
#   instructions.sh            fails if a figure differs from that file by more than 3 %
#   UPDATE=1 instructions.sh   writes the file
# Counts repeat to the digit on one machine; another C library or toolchain moves them a little.
set -euo pipefail
cd "$(dirname "$0")"

command -v valgrind >/dev/null || ../.ci/install.sh valgrind
# With the profile and the features of the Python package, whose build has the libraries then.
cargo build --quiet --locked --profile wheel -p pcr-py -p pcr-benches --bin work --bin segments
built=$(cargo metadata --format-version 1 --no-deps --locked | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')/wheel
work=$built/work

counted() { valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 >/dev/null | sed -n 's/.*Collected : //p'; }

# figure JOB FLEET WHAT [TIMES]: two runs, whose difference is so many times the job; five times, where none is said.
figure() {
  local job=$1 fleet=$2 what=$3 times=${4:-5} once pairs pieces
  once=$((($(counted "$work" "$job" "$fleet" $((times + 1))) - $(counted "$work" "$job" "$fleet" 1)) / times))
  read -r pairs pieces < <("$work" "$job" "$fleet" 0)
  printf '%9d  %s: %s\n' "$once" "$fleet" "$what"
  case $job:$pieces in
    conflicts:* | pairs:*) printf '%9d  ... per pair of agents\n' $((once / pairs)) ;;
    table:0) printf '%9d  ... per pair of agents that cannot meet\n' $((once / pairs)) ;;
    table:*) printf '%9d  ... per piece of either direction\n' $((once / pieces)) ;;
  esac
}

# segments KINDS BODY: the regions of a pair of segments, the mean of 200 pairs.
segments() {
  local kinds=$1 body=$2 more once
  more=$(counted "$built/segments" "$kinds" "$body" 5)
  once=$(counted "$built/segments" "$kinds" "$body" 0)
  printf '%9d  a pair of segments, %s: all regions, %s\n' $(((more - once) / 1000)) "$kinds" "${body}s"
}

{
  echo "# instructions, f64, $(rustc -V), $(uname -m)"
  for fleet in paper12 table6-100 scattered; do
    figure table $fleet "all regions, both directions"
    figure conflicts $fleet "when agents are in contact"
    figure pairs $fleet "when agents are in contact, pair by pair"
  done
  figure table serpentine "all regions, both directions" # linear in the pieces, although all are of one pair
  figure exchange table6-100 "exchange of one agent"
  figure certify paper12 "proof of the table"
  figure motions paper12 "proof of the motions, or a contact of each pair"
  figure certify table6-100 "proof of the table" 1
  for kinds in lines both arcs; do
    for body in disc rectangle; do segments $kinds $body; done
  done
} | tee -a /dev/stderr >instructions.new

if [ "${UPDATE:-}" = 1 ]; then
  mv instructions.new instructions.txt
else
  paste -d '|' instructions.txt instructions.new | awk -F '|' '
    NR > 1 { split($1, old, "  +"); split($2, new, "  +"); a = $1 + 0; b = $2 + 0
      if (substr($1, 10) != substr($2, 10) || b > 1.03 * a + 1 || b < 0.97 * a - 1) { print "was " $1 ", is " $2; bad = 1 } }
    END { exit bad }' >&2 || { echo "the figures differ: UPDATE=1 $0 writes them anew" >&2; rm instructions.new; exit 1; }
  rm instructions.new
fi
