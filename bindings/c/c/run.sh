#!/usr/bin/env bash
# Installs the library into a scratch folder, for the host and for a Cortex-M4F, compiles the programs of this folder against it, runs
# them, on the target in QEMU, and compares what they print with their .out files. That an image links proves that it cannot panic.
# Then the wrapper for C++ and the example for CMake, on the host, where FetchContent takes what is committed, and the sample for Zephyr,
# with a stand-in for Zephyr.
#   --accept   writes the .out files anew
set -euo pipefail
cd "$(dirname "$0")"
root=$PWD/../../..
target=thumbv7em-none-eabihf
packages=()
command -v arm-none-eabi-gcc >/dev/null || packages+=(gcc-arm-none-eabi libnewlib-arm-none-eabi)
command -v qemu-system-arm >/dev/null || packages+=(qemu-system-arm)
command -v cc >/dev/null || packages+=(gcc libc6-dev)
command -v c++ >/dev/null || packages+=(g++)
command -v pkg-config >/dev/null || packages+=(pkg-config)
command -v cmake >/dev/null || packages+=(cmake make)
if [ ${#packages[@]} -gt 0 ]; then
  "$root/.ci/install.sh" "${packages[@]}"
fi
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cd "$root"
bindings/c/install.sh "$build/host"
bindings/c/install.sh "$build/target" $target
flags() { PKG_CONFIG_PATH=$build/$1/lib/pkgconfig pkg-config "${@:2}" pcr; }
warnings=(-O2 -Wall -Wextra -Wpedantic -Werror)
for program in crossing trucks resolve passing robot_q16; do
  cc -std=c11 "${warnings[@]}" $(flags host --cflags) bindings/c/c/$program.c $(flags host --libs) -o "$build/$program"
  arm-none-eabi-gcc -std=c11 "${warnings[@]}" $(flags target --cflags) -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard \
    -ffunction-sections -fdata-sections -Wl,--gc-sections -nostartfiles -T bindings/c/c/m4.ld bindings/c/c/start.c \
    bindings/c/c/$program.c $(flags target --libs) --specs=nano.specs --specs=rdimon.specs -u _printf_float -lm -o "$build/$program.elf"
  "$build/$program" >"$build/host.out"
  # Only a program that never ends takes that long.
  timeout 3600 qemu-system-arm -machine mps2-an386 -display none -monitor none -serial none \
    -semihosting-config enable=on,target=native -kernel "$build/$program.elf" </dev/null >"$build/target.out"
  if [ "${1:-}" = --accept ]; then cp "$build/host.out" bindings/c/c/$program.out; fi
  diff bindings/c/c/$program.out "$build/host.out"
  diff bindings/c/c/$program.out "$build/target.out"
  arm-none-eabi-size "$build/$program.elf"
  cat "$build/target.out"
done
echo "bindings/c: the same on the host and on a Cortex-M4F"
# Without outlines a program is smaller, and says that it needs them.
bindings/c/install.sh "$build/discs" "" discs
cc -std=c11 "${warnings[@]}" $(flags discs --cflags) bindings/c/c/trucks.c $(flags discs --libs) -o "$build/trucks"
if "$build/trucks" >"$build/host.out" || ! grep PCR_STATUS_NEEDS_OUTLINES "$build/host.out"; then
  echo "a library for discs took a polygon" >&2
  exit 1
fi
c++ -std=c++17 "${warnings[@]}" $(flags host --cflags) bindings/c/c/wrapper.cpp $(flags host --libs) -o "$build/wrapper"
"$build/wrapper"
# by_cmake FOLDER OPTIONS...: the example for CMake, built there.
by_cmake() {
  cmake -S bindings/c/c/cmake -B "$1" "${@:2}" >"$build/cmake.log" 2>&1 && cmake --build "$1" >>"$build/cmake.log" 2>&1 || { cat "$build/cmake.log" >&2; exit 1; }
  "$1/passing" | diff bindings/c/c/passing.out -
  "$1/wrapper"
}
by_cmake "$build/installed" -DCMAKE_PREFIX_PATH="$build/host"
by_cmake "$build/checkout" -DPCR_CHECKOUT="$PWD" -DPCR_TARGET_DIR="$(realpath "${CARGO_TARGET_DIR:-target}")"
# What is committed, as somebody else would fetch it.
by_cmake "$build/fetched" -DPCR_REPOSITORY="file://$PWD" -DPCR_REVISION="$(git rev-parse HEAD)"
echo "bindings/c: C++, and CMake by find_package, add_subdirectory and FetchContent"
cmake -S bindings/c/zephyr/sample -B "$build/zephyr" -DZephyr_DIR="$PWD/bindings/c/zephyr/stand-in" >"$build/cmake.log" || { cat "$build/cmake.log" >&2; exit 1; }
cmake --build "$build/zephyr" >"$build/cmake.log" || { cat "$build/cmake.log" >&2; exit 1; }
timeout 3600 qemu-system-arm -machine mps2-an386 -display none -monitor none -serial none \
  -semihosting-config enable=on,target=native -kernel "$build/zephyr/app" </dev/null | diff bindings/c/c/robot_q16.out -
echo "bindings/c: the module for Zephyr, without Zephyr"
