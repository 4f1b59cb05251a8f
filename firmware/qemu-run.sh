#!/usr/bin/env bash
# Starts a program in QEMU; cargo's runner for the targets of this folder: qemu-run.sh ELF
# The machine follows from the triple in ELF's path, unless QEMU_MACHINE names it. Output is by semihosting, and so is the exit status.
#   SERIAL=stdio     the serial line on standard input and output instead of nothing
#   ICOUNT=7         deterministic time, 2^7 ns an instruction
#   PLUGIN=a.so,...  a TCG plugin; it writes to the file PLUGIN_LOG
#   QEMU_TIMEOUT=3600  seconds after which it is ended, as a failure (without SERIAL): only a program that never ends, on however
#                    busy a machine, takes that long
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: $0 ELF" >&2; exit 2; }
elf=$1 qemu=qemu-system-arm
case $elf in
  */thumbv6m-none-eabi/*) machine=microbit ;;
  */thumbv7m-none-eabi/*) machine=mps2-an385 ;;
  */thumbv7em-none-eabihf/*) machine=mps2-an386 ;;
  */thumbv8m.main-none-eabihf/*) machine=mps2-an505 ;;
  */riscv32imc-unknown-none-elf/*) qemu=qemu-system-riscv32 machine="virt -bios none" ;;
  *) echo "qemu-run: no machine for $elf" >&2; exit 2 ;;
esac
command -v $qemu >/dev/null || { echo "qemu-run: no $qemu (Debian: qemu-system-arm, qemu-system-misc)" >&2; exit 2; }
options=(-display none -monitor none -semihosting-config enable=on,target=native)
options+=(-serial "${SERIAL:-none}")
if [ -n "${ICOUNT:-}" ]; then options+=(-icount "shift=$ICOUNT"); fi
if [ -n "${PLUGIN:-}" ]; then options+=(-plugin "$PLUGIN" -d plugin -D "${PLUGIN_LOG:?where the plugin writes to}"); fi
# shellcheck disable=SC2206
command=($qemu -machine ${QEMU_MACHINE:-$machine} "${options[@]}" -kernel "$elf")
# Whoever talks over the line ends QEMU by a signal to this process, which QEMU therefore has to be.
if [ -n "${SERIAL:-}" ]; then exec "${command[@]}"; fi
exec timeout "${QEMU_TIMEOUT:-3600}" "${command[@]}" </dev/null
