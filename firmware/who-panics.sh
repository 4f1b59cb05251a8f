#!/usr/bin/env bash
# Which functions of a program call the panic machinery, and from which source lines: who-panics.sh ELF
# Build the program with the feature `who-panics`; without it, one that can panic is not linked.
set -euo pipefail
[ $# -eq 1 ] || { echo "usage: $0 ELF" >&2; exit 2; }
prefix=arm-none-eabi-
case $(readelf -h "$1" | sed -n 's/ *Machine: *//p') in *RISC-V*) prefix=riscv64-unknown-elf- ;; esac
command -v ${prefix}objdump >/dev/null || { echo "who-panics: no ${prefix}objdump (Debian: binutils-${prefix%-})" >&2; exit 2; }
"${prefix}objdump" -d -C --no-show-raw-insn "$1" | awk '
  /^[0-9a-f]+ <.*>:$/ { caller = $0; sub(/^[0-9a-f]+ /, "", caller) }
  /<core::(panicking|slice::index|option::(unwrap|expect)|result::unwrap|str::slice_error|cell::panic)/ {
    if (caller !~ /^<core::panicking/ && $1 ~ /:$/) { sub(/:$/, "", $1); callee = $0; sub(/.*</, "", callee); print $1, caller, "->", callee }
  }' | while read -r address call; do
  echo "$call"
  "${prefix}addr2line" -Cfie "$1" "0x$address" | paste - - | sed 's/^/      /' | head -4
done
