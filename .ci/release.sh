#!/usr/bin/env bash
# What a release consists of, built twice from clean clones in two folders and compared bit for bit:
#   .ci/release.sh OUT            everything
#   .ci/release.sh OUT PART...    some: x86_64 aarch64 wheel-x86_64 wheel-aarch64 library playground report
# OUT gets the tool as a static binary (musl) for two machines with completions and its manual page, the Python wheels for both (manylinux),
# the library for C, the playground, the report, the bill of materials (CycloneDX) and SHA256SUMS. What is not committed is not in it.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,7s/^# //p' "$0" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift
parts=" ${*:-x86_64 aarch64 wheel-x86_64 wheel-aarch64 library playground report} "
for part in $parts; do
  case $part in
    x86_64 | aarch64 | wheel-x86_64 | wheel-aarch64 | library | playground | report) ;;
    *) echo "release: no part is called $part" >&2; exit 2 ;;
  esac
done
cd "$(dirname "$0")/.."
root=$PWD
if [ -n "$(git status --porcelain)" ]; then echo "release: what is not committed is not in it" >&2; fi
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
revision=$(git rev-parse HEAD)
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct "$revision")
export SOURCE_DATE_EPOCH CARGO_INCREMENTAL=0 RUSTUP_AUTO_INSTALL=0 LC_ALL=C TZ=UTC
host=$(rustc -vV | sed -n 's/^host: //p')
unset CARGO_TARGET_DIR
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# pack ARCHIVE FOLDER: the same bytes for the same files.
pack() { tar --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner -C "$(dirname "$2")" -cf - "$(basename "$2")" | gzip -9n >"$1"; }

# Where files were built does not show in what they contain.
flags() { echo "--remap-path-prefix=$1=/pcr --remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=/cargo"; }

tool() {
  local here=$1 made=$2 folder=$2/.pcr machine=$3 target=$3-unknown-linux-musl name pcr run=()
  name=CARGO_TARGET_$(tr 'a-z.-' 'A-Z__' <<<"$target")_RUSTFLAGS
  env "$name=$(flags "$here")" firmware/cross.sh "$target" build --release --locked --quiet -p pcr-host
  folder+=/pcr-$version-$target
  mkdir -p "$folder"
  cp "target/$target/release/pcr" README.md LICENSE-MIT LICENSE-APACHE "$folder"
  pcr=$folder/pcr
  if readelf -lW "$pcr" | grep -q INTERP; then echo "release: $target is not static" >&2; return 1; fi
  # The other machine is emulated.
  if [ "$machine" != "$(uname -m)" ]; then
    command -v "qemu-$machine" >/dev/null || .ci/install.sh qemu-user
    run=("qemu-$machine")
  fi
  run+=("$pcr")
  if "${run[@]}" check -q docs/crossing.json >/dev/null; then echo "release: $target finds no conflict" >&2; return 1; fi
  "${run[@]}" plan -q docs/crossing.json -o - | "${run[@]}" check -q >/dev/null # planned they do not collide
  for shell in bash zsh fish; do "${run[@]}" completions $shell >"$folder/pcr.$shell"; done
  "${run[@]}" man >"$folder/pcr.1"
  pack "$made/pcr-$version-$target.tar.gz" "$folder"
  rm -r "$made/.pcr"
}

# environment NAME PACKAGE...: an environment of Python with these packages, once; its folder.
environment() {
  local folder=$scratch/$1
  if [ ! -x "$folder/bin/pip" ]; then
    python3 -m venv "$folder" >/dev/null 2>&1 || { .ci/install.sh python3-venv >&2 && python3 -m venv "$folder" >&2; }
    if [ $# -gt 1 ]; then "$folder/bin/pip" install -q --disable-pip-version-check "${@:2}" >&2; fi
  fi
  echo "$folder"
}

# Linked by Zig, for the glibc of manylinux2014 and later ones, whichever this machine has.
wheel() {
  local here=$1 made=$2 machine=$3 target=$3-unknown-linux-gnu python name
  name=CARGO_TARGET_$(tr 'a-z.-' 'A-Z__' <<<"$target")_RUSTFLAGS
  python=$(environment maturin "maturin>=1.9,<2" ziglang)
  .ci/dependencies.py sbom pcr-py >"$here/pcr-py.cdx.json"
  env "$name=$(flags "$here")" PATH="$python/bin:$PATH" firmware/cross.sh "$target" -- "$python/bin/maturin" build -q --zig --target "$target" \
    --compatibility manylinux2014 -m bindings/python/Cargo.toml --profile wheel --locked --out "$made" --sbom-include "$here/pcr-py.cdx.json"
  try_wheel "$machine" "$made"/pcr_py-*"_$machine.whl"
}

# As a new user has it: no compiler in sight, and nothing from a registry. On the other machine, which is emulated, with Debian's Python.
try_wheel() {
  local machine=$1 wheel=$2 python program
  program='import sys, pcr
fleet = pcr.Fleet.read(sys.argv[1])
assert len(fleet.regions()) == 136 and fleet.conflicts() and not fleet.plan().fleet.conflicts()
import platform
assert platform.machine() == sys.argv[2]'
  if [ "$machine" = "$(uname -m)" ]; then
    rm -rf "$scratch/clean"
    python=$(environment clean)
    "$python/bin/pip" install -q --disable-pip-version-check --no-index --no-deps "$wheel"
    env -i "$python/bin/python" -I -c "$program" tests/data/paper12.json "$machine"
  else
    command -v "qemu-$machine" >/dev/null || .ci/install.sh qemu-user
    if [ ! -e "$scratch/$machine" ]; then .ci/unpack.sh --needs "$machine" "$scratch/$machine" python3; fi
    rm -rf "$scratch/site"
    python3 -m zipfile -e "$wheel" "$scratch/site"
    env -i "$(command -v "qemu-$machine")" -L "$scratch/$machine" "$scratch/$machine/usr/bin/python3" -I -c "import sys; sys.path.insert(0, '$scratch/site')
$program" tests/data/paper12.json "$machine"
  fi
}

library() {
  local here=$1 made=$2 folder=$2/.c name
  name=CARGO_TARGET_$(tr 'a-z.-' 'A-Z__' <<<"$host")_RUSTFLAGS
  env "$name=$(flags "$here")" bindings/c/install.sh "$folder/pcr-c-$version-$host" >/dev/null
  cp LICENSE-MIT LICENSE-APACHE "$folder/pcr-c-$version-$host"
  pack "$made/pcr-c-$version-$host.tar.gz" "$folder/pcr-c-$version-$host"
  rm -r "$folder"
}

playground() {
  local here=$1 made=$2 target=wasm32-unknown-unknown
  env CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS="$(flags "$here")" firmware/cross.sh $target build --profile web --locked --quiet -p pcr-web
  bindings/web/build.py target/$target/web/pcr_web.wasm "$made/pcr-playground-$version.html" >/dev/null
}

# Its tools in versions that are named, because another one may set it otherwise.
report() {
  local here=$1 made=$2 python
  python=$(environment report pypandoc_binary==1.17 typst==0.15.2)
  "$python/bin/python" docs/theory/report/build.py "$made/pcr-report-$version.pdf"
}

# once FOLDER: a release, from a clone there.
once() {
  local here=$scratch/$1/source made=$scratch/$1/made part
  git clone -q --no-checkout "$root" "$here"
  git -C "$here" checkout -q --detach "$revision" # whatever is committed meanwhile
  mkdir -p "$made"
  cd "$here"
  for part in x86_64 aarch64; do if [[ $parts == *" $part "* ]]; then tool "$here" "$made" $part; fi; done
  for part in x86_64 aarch64; do if [[ $parts == *" wheel-$part "* ]]; then wheel "$here" "$made" $part; fi; done
  for part in library playground report; do if [[ $parts == *" $part "* ]]; then $part "$here" "$made"; fi; done
  .ci/dependencies.py sbom pcr-host >"$made/pcr-$version.cdx.json"
  (cd "$made" && find . -maxdepth 1 -type f ! -name SHA256SUMS -printf '%f\n' | sort | xargs sha256sum >SHA256SUMS)
  cd "$root"
}

once one
rm -rf "$scratch/one/source"
once another
diff -r "$scratch/one/made" "$scratch/another/made"
cp "$scratch/another/made"/* "$out"
cat "$out/SHA256SUMS"
echo "release: the same bit for bit, built twice in two folders"
