#!/usr/bin/env bash
# Mutants of pcr-core, of pcr-fixed, of the importers, of the readers of scenarios, of the writers of exclusions, of the proofs
# of start delays and of the line protocol, run against the tests that reach them.
#   tests/mutants/run.sh FOLDER [SECONDS [JOBS]]     a copy of what is committed is made in FOLDER/copy and built there; a mutant has
#                                                    SECONDS of tests (4). Again: goes on where it stopped. FOLDER/results
#                                                    has a line a mutant, `mutants table FOLDER` counts them.
#   ONLY='scalar|pcr-fixed' tests/mutants/run.sh FOLDER    those whose line in FOLDER/all matches; one ONLY a folder
#   ONLY=exclusions/ SAMPLE=40 tests/mutants/run.sh FOLDER  of these only so many, at random, always the same
#   ONLY=serve/ TESTS=pcr-serve WAIT=4 tests/mutants/run.sh FOLDER   with the tests of these packages, not of all; a test that
#                                                    waits for ever is ended after 4 times (60) the core's time that it may take
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$(realpath -m "$1") seconds=${2:-4} jobs=${3:-2}
copy=$folder/copy
cargo build -q --release --locked --manifest-path tests/mutants/Cargo.toml --target-dir tests/mutants/target
tool=$PWD/tests/mutants/target/release/mutants

sorted() { LC_ALL=C sort; }
kernels() { find pcr-core/src -name '*.rs' | grep -vE 'src/(lib|scalar|recorded|internals)\.rs|src/scalar/' | sorted; }
floats() { find pcr-core/src/scalar.rs pcr-core/src/scalar -name '*.rs' | grep -vE 'vsqrt|tests' | sorted; }
fixed() { find pcr-fixed/src -name '*.rs' | grep -v 'src/lib\.rs' | sorted; }
importers() {
  find pcr-host/formats/src/{import,import.rs,scenario,scenario.rs} -name '*.rs' | grep -vE 'scenario/(tests|round_trip)' | sorted
}
# The audit and what it reports is not here.
writers() { find pcr-host/exclusions/src -name '*.rs' | grep -vE 'src/(lib|audit|meetings|nearest|report|settings)\.rs' | sorted; }
# What comes over a socket, up to what it asks of the supervisor; not the sockets, whose macro is called within functions.
line_protocol() {
  printf 'pcr-host/serve/src/%s.rs\n' clients connection_limit event hello line_angles lines query refusals request_error server token unanswered_lines
}
# Those that are run, of FOLDER/all.
chosen() { grep -E "${ONLY:-.}" "$folder/all" | if [ -n "${SAMPLE:-}" ]; then shuf -n "$SAMPLE" --random-source=<(yes); else cat; fi; }

# Numbers of their own for each crate, as all are in one build. Those in SKIP get no switch.
# shellcheck disable=SC2046
put() {
  git checkout -q -- pcr-core pcr-fixed pcr-host proofs
  # What converts is `const` for its users, and could not have a switch.
  sed -i 's/const fn/fn/' pcr-fixed/src/convert.rs
  "$tool" put 0 pcr-core/src/lib.rs $(kernels) $(floats)
  "$tool" put 10000 pcr-host/formats/src/lib.rs $(importers)
  "$tool" put 20000 pcr-fixed/src/lib.rs $(fixed)
  "$tool" put 30000 pcr-host/exclusions/src/lib.rs $(writers)
  "$tool" put 40000 proofs/certify/src/lib.rs proofs/certify/src/delays.rs
  "$tool" put 50000 pcr-host/serve/src/lib.rs $(line_protocol)
}

if [ ! -e "$copy" ]; then
  mkdir -p "$folder"
  git clone -q . "$copy"
fi
cd "$copy"
if [ ! -e "$folder/binaries" ]; then
  # As many cases as in a debug run, though optimized.
  sed -i '/cfg=optimized/d' tests/build.rs
  SKIP="" put >"$folder/all"
  SKIP=$(chosen | cut -f1 | grep -vxFf - <(cut -f1 "$folder/all") | tr '\n' ' ') || true
  export SKIP
  for ((;;)); do
    put >"$folder/list"
    if cargo check -q --profile checked --locked -p pcr-exclusions -p pcr-formats -p pcr-fixed -p pcr-certify -p pcr-serve -p pcr-core -F pcr-core/micromath \
      --message-format=short 2>"$folder/messages"; then break; fi
    more=$("$tool" broken <"$folder/messages" | tr '\n' ' ')
    [ -n "$more" ] || { cat "$folder/messages" >&2; exit 1; }
    echo "left out, as they do not compile: $more"
    SKIP+=" $more"
  done
  # Not the tests of the tool `pcr`: the files that they write have one name, and jobs run side by side.
  tests=${TESTS:-pcr-core pcr-fixed pcr-formats pcr-exclusions pcr-certify pcr-serve pcr-tests}
  targets=(--lib)
  if [[ $tests == *pcr-tests* ]]; then targets+=(--test all); fi
  if [[ $tests == *pcr-serve* ]]; then targets+=(--test serve); fi
  # shellcheck disable=SC2086
  cargo test --profile checked --locked $(printf -- '-p %s ' $tests) "${targets[@]}" --no-run --message-format=json |
    python3 -c 'import json, os, sys
for line in sys.stdin:
    message = json.loads(line)
    if message.get("executable") and message["profile"]["test"]:
        print(os.path.dirname(message["manifest_path"]) + ":" + message["executable"])' >"$folder/binaries.new"
  mv "$folder/binaries.new" "$folder/binaries"
fi
mapfile -t binaries <"$folder/binaries"
"$tool" run "$folder" "$seconds" "$jobs" "${binaries[@]}"
"$tool" table "$folder"
