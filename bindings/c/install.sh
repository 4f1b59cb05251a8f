#!/usr/bin/env bash
# Builds the library for C and puts it where compilers find it:
#   install.sh PREFIX            for this machine
#   install.sh PREFIX TARGET     for a target, such as thumbv7em-none-eabihf
#   install.sh PREFIX "" discs   for discs only, without the code of outlines; with a target, too
# PREFIX/include has the headers, PREFIX/lib the static library, with files for pkg-config and CMake.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
mkdir -p "$1"
prefix=$(cd "$1" && pwd)
target=${2:-}
features=()
case ${3:-} in
  "") ;;
  discs) features=(--no-default-features) ;;
  *) echo "install.sh: $3 is neither nothing nor discs" >&2; exit 2 ;;
esac
cd "$(dirname "$0")/../.."
built=${CARGO_TARGET_DIR:-$PWD/target}
if [ -n "$target" ]; then
  firmware/cross.sh "$target" build --quiet --locked --profile ffi -p pcr-ffi "${features[@]}"
  built+=/$target
  needs="" libraries=""
else
  cargo build --quiet --locked --profile ffi -p pcr-ffi "${features[@]}"
  # What a static library of Rust needs on Unix.
  needs="-lpthread -ldl -lm" libraries="pthread;dl;m"
fi
version=$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)
[ -n "$version" ] || { echo "no version in Cargo.toml" >&2; exit 1; }
mkdir -p "$prefix"/{include,lib/pkgconfig,lib/cmake/pcr}
install -m 644 bindings/c/include/*.h bindings/c/include/*.hpp "$prefix/include"
install -m 644 "$built/ffi/libpcr_ffi.a" "$prefix/lib/libpcr.a"
fill() { sed -e "s|@version@|$version|g; s|@needs@|$needs|g; s|@libraries@|$libraries|g" "$1" >"$2"; }
fill bindings/c/cmake/pcr.pc.in "$prefix/lib/pkgconfig/pcr.pc"
fill bindings/c/cmake/pcrConfig.cmake.in "$prefix/lib/cmake/pcr/pcrConfig.cmake"
fill bindings/c/cmake/pcrConfigVersion.cmake.in "$prefix/lib/cmake/pcr/pcrConfigVersion.cmake"
