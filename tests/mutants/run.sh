#!/usr/bin/env bash
# Mutants of pcr-core (but for its number formats) and of the importers, run against the tests that reach them.
#   tests/mutants/run.sh FOLDER [SECONDS [JOBS]]     a copy of what is committed is made in FOLDER/copy and built there; a mutant has
#                                                    SECONDS of tests (4). Again: goes on where it stopped. FOLDER/results
#                                                    has a line a mutant, `mutants table FOLDER` counts them.
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$(realpath -m "$1") seconds=${2:-4} jobs=${3:-2}
copy=$folder/copy
cargo build -q --release --locked --manifest-path tests/mutants/Cargo.toml
tool=$PWD/tests/mutants/target/release/mutants

core() { find pcr-core/src -name '*.rs' | grep -vE 'src/(lib|scalar|recorded|internals)\.rs|src/scalar/' | LC_ALL=C sort; }
importers() { find pcr-host/formats/src/import pcr-host/formats/src/import.rs -name '*.rs' | LC_ALL=C sort; }

# shellcheck disable=SC2046
put() {
  git checkout -q -- pcr-core pcr-host
  "$tool" put 0 pcr-core/src/lib.rs $(core) >"$folder/list"
  # Numbers of their own, as both crates are in one build.
  "$tool" put 10000 pcr-host/formats/src/lib.rs $(importers) >>"$folder/list"
}

if [ ! -e "$copy" ]; then
  mkdir -p "$folder"
  git clone -q . "$copy"
fi
cd "$copy"
if [ ! -e "$folder/binaries" ]; then
  # As many cases as in a debug run, though optimized.
  sed -i '/cfg=optimized/d' tests/build.rs
  SKIP=""
  export SKIP
  for ((;;)); do
    put
    if cargo check -q --profile checked --locked -p pcr-formats --message-format=short 2>"$folder/messages"; then break; fi
    more=$("$tool" broken <"$folder/messages" | tr '\n' ' ')
    [ -n "$more" ] || { cat "$folder/messages" >&2; exit 1; }
    SKIP+=" $more"
  done
  # Not the tests of the tool `pcr`: the files that they write have one name, and jobs run side by side.
  cargo test --profile checked --locked -p pcr-core -p pcr-formats -p pcr-tests --lib --test all --no-run --message-format=json |
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
