#!/usr/bin/env bash
# Compiles crossing.c and resolve.c against the library with the host's compiler and with arm-none-eabi-gcc, runs both, the latter in
# QEMU on a Cortex-M4F, and compares what they print with crossing.out and resolve.out. That an image links proves that it cannot panic.
#   --accept   writes these anew
set -euo pipefail
cd "$(dirname "$0")"
root=$PWD/../../..
target=thumbv7em-none-eabihf
packages=()
command -v arm-none-eabi-gcc >/dev/null || packages+=(gcc-arm-none-eabi libnewlib-arm-none-eabi)
command -v qemu-system-arm >/dev/null || packages+=(qemu-system-arm)
command -v cc >/dev/null || packages+=(gcc libc6-dev)
if [ ${#packages[@]} -gt 0 ]; then
  echo "pcr-ffi: installing ${packages[*]}" >&2
  [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || { echo "pcr-ffi: please install ${packages[*]}" >&2; exit 2; }
  { apt-get -o DPkg::Lock::Timeout=600 update && apt-get -o DPkg::Lock::Timeout=600 install -y --no-install-recommends "${packages[@]}"; } >&2
fi
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cd "$root"
built=${CARGO_TARGET_DIR:-$root/target}
cargo build --quiet --locked --profile ffi -p pcr-ffi
firmware/cross.sh $target build --quiet --locked --profile ffi -p pcr-ffi
warnings=(-std=c11 -O2 -Wall -Wextra -Wpedantic -Werror -Ibindings/c/include)
for program in crossing resolve; do
  cc "${warnings[@]}" bindings/c/c/$program.c "$built/ffi/libpcr_ffi.a" -lpthread -ldl -lm -o "$build/host"
  arm-none-eabi-gcc "${warnings[@]}" -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -ffunction-sections \
    -fdata-sections -Wl,--gc-sections -nostartfiles -T bindings/c/c/m4.ld bindings/c/c/start.c bindings/c/c/$program.c \
    "$built/$target/ffi/libpcr_ffi.a" --specs=nano.specs --specs=rdimon.specs -u _printf_float -lm -o "$build/$program.elf"
  "$build/host" >"$build/host.out"
  # Only a program that never ends takes that long.
  timeout 3600 qemu-system-arm -machine mps2-an386 -display none -monitor none -serial none \
    -semihosting-config enable=on,target=native -kernel "$build/$program.elf" </dev/null >"$build/target.out"
  if [ "${1:-}" = --accept ]; then cp "$build/host.out" bindings/c/c/$program.out; fi
  diff bindings/c/c/$program.out "$build/host.out"
  diff bindings/c/c/$program.out "$build/target.out"
  arm-none-eabi-size "$build/$program.elf"
  cat "$build/target.out"
done
echo "pcr-ffi: the same on the host and on a Cortex-M4F"
