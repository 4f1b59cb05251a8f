#!/usr/bin/env python3
"""codesize.py ELF [PATTERN]: bytes of code that come from the library (pcr-core, pcr-fixed, libm, micromath), inlined or not, by the
line table: an instruction counts where any function of its inline stack does. With a pattern, what comes from files that it
fits, and not from the library."""
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
wanted = re.compile(sys.argv[2]) if len(sys.argv) > 2 else None
stacks = {}
for line in run("addr2line", "-a", "-i", "-e", elf, input="\n".join(sizes)).splitlines():
    if m := re.fullmatch(r"0x0*([0-9a-f]+)", line):
        stack = stacks.setdefault(m[1], [])
    else:
        stack.append(line)


def counts(stack):
    library = any(map(ours.search, stack))
    return library if wanted is None else not library and any(map(wanted.search, stack))


print(sum(sizes[address] for address, stack in stacks.items() if counts(stack)))
