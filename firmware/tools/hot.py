#!/usr/bin/env python3
"""hot.py ELF COUNTS [ROOT]: instructions by source function, inlined ones told apart, from the plugin's `hot` file.

Two tables: `self` charges an instruction to the innermost inlined function, `with callees` to every function of its
inline stack (calls that were not inlined are not followed). ROOT keeps only code whose inline stack names it."""
import collections, re, subprocess, sys

elf, counts = sys.argv[1:3]
hits = [(a, int(n)) for a, n in (line.split() for line in open(counts))]
out = subprocess.run(["arm-none-eabi-addr2line", "-a", "-i", "-f", "-C", "-e", elf], text=True, check=True,
                     input="\n".join("0x" + a for a, _ in hits), capture_output=True).stdout.splitlines()
stacks, current = [], None
for line in out:
    if re.fullmatch(r"0x[0-9a-f]+", line):
        current = []
        stacks.append(current)
    else:
        current.append(line)
own, total, lines = collections.Counter(), collections.Counter(), collections.Counter()
for (_, n), stack in zip(hits, stacks):
    names = [re.sub(r"<[^<>]*>", "", re.sub(r"<[^<>]*>", "", name)) for name in stack[0::2]]
    if len(sys.argv) > 3 and not any(sys.argv[3] in name for name in names):
        continue
    own[names[0]] += n
    for name in set(names):
        total[name] += n
    for place in stack[1::2]:
        if "/pcr-core/" in place:
            lines[re.sub(r".*/pcr-core/src/", "", place).split(" ")[0]] += n
            break
print("all", sum(own.values()))
for title, table in (("self", own), ("with callees that were inlined", total), ("innermost line of pcr-core", lines)):
    print("\n" + title)
    for name, n in table.most_common(45):
        print(f"{n:9} {name}")
