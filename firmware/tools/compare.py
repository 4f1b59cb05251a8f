#!/usr/bin/env python3
"""compare.py EXPECTED SEEN: figures of a build against those in the repository, within 3 % or 16, whichever is more: what
another compiler of a neighbouring version makes of the same source. Exit status 1 where one is out, or missing."""
import sys

PART, FEW = 0.03, 16


def figures(path):
    lines = (line.split(None, 1) for line in open(path) if line.strip() and not line.startswith("#"))
    return {what.strip(): int(number) for number, what in lines}


expected, seen = figures(sys.argv[1]), figures(sys.argv[2])
out = 0
for what in expected.keys() | seen.keys():
    a, b = expected.get(what), seen.get(what)
    if a is None or b is None or abs(a - b) > max(FEW, PART * a):
        print(f"{what}: expected {a}, seen {b}", file=sys.stderr)
        out = 1
sys.exit(out)
