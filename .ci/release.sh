#!/usr/bin/env bash
# What a release consists of, built twice from clean clones in two folders and compared bit for bit:
#   .ci/release.sh OUT            everything
#   .ci/release.sh OUT PART...    some: x86_64 aarch64 wheel library playground
# OUT gets the tool as a static binary (musl) for two machines with completions and its manual page, the Python wheel, the library for C,
# the playground, the bill of materials (CycloneDX) and SHA256SUMS. What is not committed is not in it.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,7s/^# //p' "$0" >&2; exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift
parts=" ${*:-x86_64 aarch64 wheel library playground} "
for part in $parts; do
  case $part in
    x86_64 | aarch64 | wheel | library | playground) ;;
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

wheel() {
  local here=$1 made=$2 python=$scratch/python name
  name=CARGO_TARGET_$(tr 'a-z.-' 'A-Z__' <<<"$host")_RUSTFLAGS
  if [ ! -x "$python/bin/maturin" ]; then
    python3 -m venv "$python" >/dev/null 2>&1 || { .ci/install.sh python3-venv && python3 -m venv "$python"; }
    "$python/bin/pip" install -q --disable-pip-version-check "maturin>=1.9,<2"
  fi
  .ci/dependencies.py sbom pcr-py >"$here/pcr-py.cdx.json"
  env "$name=$(flags "$here")" "$python/bin/maturin" build -q -m bindings/python/Cargo.toml --profile wheel --locked --out "$made" \
    --sbom-include "$here/pcr-py.cdx.json"
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

# once FOLDER: a release, from a clone there.
once() {
  local here=$scratch/$1/source made=$scratch/$1/made part
  git clone -q --no-checkout "$root" "$here"
  git -C "$here" checkout -q --detach "$revision" # whatever is committed meanwhile
  mkdir -p "$made"
  cd "$here"
  for part in x86_64 aarch64; do if [[ $parts == *" $part "* ]]; then tool "$here" "$made" $part; fi; done
  for part in wheel library playground; do if [[ $parts == *" $part "* ]]; then $part "$here" "$made"; fi; done
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
