#!/usr/bin/env bash
# All checks and tests, step by step; stops at the first that fails. Any part that cannot run is a failure.
# Needs rustup's cargo (https://rustup.rs); what else is missing it installs, and says so.
#   .ci/test.sh            everything
#   .ci/test.sh STEP...    some: style docs tests release features no_std
set -euo pipefail
cd "$(dirname "$0")/.."

step() { printf '\n== %s\n' "$*"; }

style() {
  step "format and lints"
  cargo fmt --all --check
  cargo clippy --workspace --all-targets --locked -- -D warnings
}

docs() {
  step "documentation"
  RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps --locked
}

tests() {
  step "tests, debug: overflow checks and assertions on"
  cargo test --workspace --locked
}

release() {
  step "tests, release"
  cargo test --workspace --release --locked
  step "benchmarks, one pass each"
  cargo bench --workspace --locked -- --test
}

features() {
  step "pcr-core with each set of features, and without any"
  local set
  for set in "" libm std serde defmt libm,serde libm,defmt std,serde,defmt; do
    echo "features: ${set:-none}"
    cargo clippy -q -p pcr-core --locked --no-default-features --features "$set" -- -D warnings
  done
  step "what pcr-core depends on"
  local tree
  tree=$(cargo tree -p pcr-core --locked --all-features -e normal,build --prefix none)
  echo "$tree"
  if grep -E '^(proptest|criterion|std) ' <<<"$tree"; then
    echo "a test tool reached pcr-core" >&2
    return 1
  fi
}

no_std() {
  # These targets have no standard library at all, so that nothing can hide behind it.
  local target
  for target in thumbv7em-none-eabihf thumbv6m-none-eabi; do
    step "no_std: $target"
    firmware/cross.sh "$target" build --release --locked -p pcr-core -p pcr-fixed
    firmware/cross.sh "$target" build --release --locked -p pcr-core --no-default-features --features libm,serde,defmt
  done
}

# shellcheck disable=SC2048
for part in ${*:-style docs features no_std tests release}; do
  "$part"
done
step "all passed"
