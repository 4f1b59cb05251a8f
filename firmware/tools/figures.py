#!/usr/bin/env python3
"""figures.py [--write]: the tables in docs/guide/firmware.md and docs/maintain/firmware.md are those of the figures in expected/; with --write it
makes them so. `check.sh` compares expected/ with what it measures."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Target, format, what people call it.
COLUMNS = [
    ("thumbv7em-none-eabihf", "f32", "Cortex-M4F"),
    ("thumbv7em-none-eabihf", "micro", "Cortex-M4F"),
    ("thumbv8m.main-none-eabihf", "f32", "Cortex-M33"),
    ("thumbv7m-none-eabi", "q16", "Cortex-M3"),
    ("thumbv6m-none-eabi", "q16", "Cortex-M0"),
    ("riscv32imc-unknown-none-elf", "q16", "RV32IMC"),
]
# In docs/guide/firmware.md; docs/maintain/firmware.md has all.
SHOWN = [COLUMNS[0], COLUMNS[4], COLUMNS[5]]
FORMATS = {"f32": "`f32`", "micro": "`Micro`", "q16": "`Q16`"}


def figures(target, form):
    lines = (ROOT / f"firmware/expected/{target}-{form}.txt").read_text().splitlines()
    return {what.strip(): int(number) for number, what in (line.split(None, 1) for line in lines if line[0] != "#")}


def excesses():
    """ε of each format for two agents at M = VT = 10 m, as docs/reference/bounds.md has it (held by `tests/tests/outward.rs`,
    the_excess_is_as_documented)."""
    found = {}
    for line in (ROOT / "docs/reference/bounds.md").read_text().splitlines():
        if m := re.match(r'\| <a id="e-\w+"></a>(.*?) \|.*\| (.*) \|$', line):
            for name, value in zip(m[1].split(", "), m[2].split(", ")):
                found[name.strip("`").lower()] = value
    return found


def row(cells):
    return "| " + " | ".join(cells) + " |"


def number(found, what, unit=""):
    return f"{found[what]:,}{unit}" if what in found else "–"


CALLS = ["first_conflict", "first_overlap", "safe_intervals", "safe_lengths", "RegionRef::forbidden_delays", "earliest_start", "earliest_departure",
         "least_duration", "Encounter::closest", "RegionRef::slice_at", "PrecedenceTable::hold", "PrecedenceTable::check",
         "PrecedenceTable::as_planned", "PrecedenceTable::replace", "PrecedenceTable::admit"]


def most(found, what, calls):
    """The largest figure of some calls, which all have one or none."""
    values = [found[what + call] for call in calls if what + call in found]
    if values and len(values) < len(calls):
        sys.exit(f"not all of {calls} are measured")
    return f"{max(values):,} B" if values else "–"


def overview():
    """docs/guide/firmware.md: a line for each of some targets and formats."""
    yield row(["target, format", "ε at M = VT = 10 m", "library code", "table in RAM", "stack: the table", "any query", "instructions: the whole table, per region"])
    yield "|---" * 7 + "|"
    excess = excesses()
    for target, form, core in SHOWN:
        found = figures(target, form)
        yield row([f"{core}, {FORMATS[form]}", excess[form], number(found, "bytes of code of the library in it", " B"),
                   number(found, "bytes of the table in RAM", " B"),
                   number(found, "bytes of stack of the pipeline, measured", " B"),
                   most(found, "bytes of stack of ", CALLS),
                   f"{number(found, 'instructions: table of all agents')}, "
                   f"{number(found, 'instructions: ... per region, both directions')}"])


def details():
    """docs/maintain/firmware.md: a line for each figure."""
    found = [figures(target, form) for target, form, _ in COLUMNS]
    yield row(["12 agents"] + [f"{core}, {FORMATS[form]}" for _, form, core in COLUMNS])
    yield "|---" * (len(COLUMNS) + 1) + "|"
    for what in dict.fromkeys(what for figures in found for what in figures):
        yield row([what] + [number(figures, what) for figures in found])


def main():
    write = sys.argv[1:] == ["--write"]
    stale = []
    for name, table in (("docs/guide/firmware.md", overview), ("docs/maintain/firmware.md", details)):
        path = ROOT / name
        text = path.read_text()
        head, rest = text.split("<!-- figures: firmware/tools/figures.py --write -->\n", 1)
        _, tail = rest.split("<!-- end of figures -->\n", 1)
        made = head + "<!-- figures: firmware/tools/figures.py --write -->\n" + "\n".join(table()) + "\n<!-- end of figures -->\n" + tail
        if made != text:
            stale.append(name)
            if write:
                path.write_text(made)
    if stale and not write:
        sys.exit(f"figures in {' and '.join(stale)} are not those of firmware/expected: run firmware/tools/figures.py --write")


main()
