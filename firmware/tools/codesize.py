#!/usr/bin/env python3
"""codesize.py ELF: bytes of code that come from the library (pcr-core, pcr-fixed, libm, micromath), inlined or not, by the
line table: an instruction counts where any function of its inline stack does."""
import re
import subprocess
import sys

elf = sys.argv[1]
machine = subprocess.run(["readelf", "-h", elf], check=True, capture_output=True, text=True).stdout
prefix = "riscv64-unknown-elf-" if "RISC-V" in machine else "arm-none-eabi-"


def run(tool, *arguments, **options):
    return subprocess.run([prefix + tool, *arguments], check=True, capture_output=True, text=True, **options).stdout


listing = run("objdump", "-d", elf)
found = re.findall(r"^\s*([0-9a-f]+):\t((?:[0-9a-f]{4,8} ?)+)\s*\t", listing, re.M)
sizes = {address: len(code.replace(" ", "")) // 2 for address, code in found}
ours = re.compile(r"/(pcr-core|pcr-fixed)/src/|/(libm|micromath)-[0-9.]+/")
total, address, counted = 0, None, True
for line in run("addr2line", "-a", "-i", "-e", elf, input="\n".join(sizes)).splitlines():
    if m := re.fullmatch(r"0x0*([0-9a-f]+)", line):
        address, counted = m[1], False
    elif not counted and ours.search(line):
        total += sizes[address]
        counted = True
print(total)
