#!/usr/bin/env python3
"""Static checks of a linked Thumb program from its disassembly: worst-case stack of a call graph, and code that must not
be there. Exit status 1 when one fails.

    fwcheck.py ELF [--root SYMBOL] [--max-stack N] [--no-float] [--no-alloc] [--no-panic]

The stack bound is the deepest path of the call graph, where every downward move of sp in a function counts and upward
ones do not. Recursion, calls through registers and moves of sp by a register cannot be bounded this way: each is a
failure where --max-stack is given. Frames of exceptions are not included: 32 bytes a level, 104 with the FPU's."""
import argparse
import re
import subprocess
import sys

parser = argparse.ArgumentParser()
parser.add_argument("elf")
parser.add_argument("--root", help="function whose stack is bounded, by the end of its path: pipeline::job")
parser.add_argument("--max-stack", type=int)
for what in ("float", "alloc", "panic"):
    parser.add_argument("--no-" + what, action="store_true")
arguments = parser.parse_args()

HEAD = re.compile(r"^[0-9a-f]+ <(.+)>:$")
LINE = re.compile(r"^\s*[0-9a-f]+:\t(\S+)\s*(.*)$")
TARGET = re.compile(r"<(.+?)(\+0x[0-9a-f]+)?>$")


class Function:
    def __init__(self):
        self.frame, self.calls, self.unproven, self.fpu, self.read = 0, set(), [], False, False


def plain(symbol):
    """A mangled path without its hash: pipeline::job."""
    parts = re.findall(r"\d+", symbol) and re.match(r"_ZN(.*)E", symbol)
    if not parts:
        return symbol
    names, rest = [], parts[1]
    while m := re.match(r"(\d+)", rest):
        begin = m.end()
        names.append(rest[begin : begin + int(m[1])])
        rest = rest[begin + int(m[1]) :]
    return "::".join(n for n in names if not re.fullmatch(r"h[0-9a-f]{16}", n))


def registers(text):
    """Bytes of a register list."""
    total = 0
    for part in re.search(r"{(.*?)}", text)[1].split(","):
        m = re.match(r"\s*([a-z])(\d+)\s*-\s*[a-z](\d+)", part)
        count = int(m[3]) - int(m[2]) + 1 if m else 1
        total += count * (8 if part.strip().startswith("d") else 4)
    return total


def frame_of(op, text):
    """Bytes by which an instruction moves sp down; None where it cannot be told."""
    if re.match(r"v?push", op) or (re.match(r"v?stm(db|fd)", op) and "sp!" in text):
        return registers(text)
    if re.match(r"subw?(\.w)?$", op) and text.startswith("sp"):
        m = re.search(r"#(\d+)", text)
        return int(m[1]) if m else None
    if op.startswith("add") and re.match(r"sp, (sp, )?r\d", text):
        return None
    if m := re.match(r"str.*\[sp, #-(\d+)\]!", op + " " + text):
        return int(m[1])
    if op.startswith("mov") and re.match(r"sp, r(?!7)", text):
        return None
    return 0


functions, current, end = {}, None, 0
symbols = subprocess.run(["readelf", "-sW", arguments.elf], check=True, capture_output=True, text=True).stdout
sizes = {int(a, 16) & ~1: int(n) for a, n in re.findall(r"^\s*\d+: ([0-9a-f]+) +(\d+) FUNC", symbols, re.M)}
listing = subprocess.run(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", arguments.elf], check=True, capture_output=True,
                         text=True).stdout
# Thumb-1 moves sp by more than 508 bytes through a register: down by a constant from the literal pool, which is negative,
# and back up by way of the frame pointer r7.
words = {int(a, 16): int(w, 16) for a, w in re.findall(r"^\s*([0-9a-f]+):\t\.word\s+0x([0-9a-f]+)", listing, re.M)}
constants = {}
for line in listing.splitlines():
    if m := HEAD.match(line):
        if not m[1].startswith("$"):
            current = functions.setdefault(m[1], Function())
            constants = {}
            start = int(line.split(" ", 1)[0], 16)
            end = start + (sizes.get(start) or 2**32)
        continue
    m = LINE.match(line)
    # What the linker puts between functions looks like jumps.
    if not m or not current or int(line.split(":", 1)[0], 16) >= end:
        continue
    current.read = True
    op, text = m[1], re.sub(r"\s*[@;].*$", "", m[2])
    if m := re.match(r"\s*[0-9a-f]+:\tldr\s+(r\d), \[pc, #\d+\]\s*[@;] \(([0-9a-f]+)", line):
        word = words.get(int(m[2], 16), 0)
        constants[m[1]] = 2**32 - word if word >= 2**31 else None
    elif m := re.match(r"subs (r\d), (?:r7, )?#\d+$", op + " " + text):
        constants[m[1]] = 0
    moved = frame_of(op, text)
    if moved is None and (m := re.match(r"(?:add|mov)\S* sp, (r\d)$", op + " " + text)):
        moved = constants.get(m[1])
    if moved is None:
        current.unproven.append("sp moved by a register: " + line.strip())
    else:
        current.frame += moved
    if op.startswith("v") and not re.match(r"v(ld|st)4", op):
        current.fpu = True
    target = TARGET.search(text)
    if re.match(r"blx?(\.w)?$", op) and not target:
        current.unproven.append("a call through a register: " + line.strip())
    elif op == "bx" and text != "lr":
        current.unproven.append("a jump through a register: " + line.strip())
    elif re.match(r"b[a-z.]*$", op) and target:
        current.calls.add(target[1])

# A listing of another form would have no stack and nothing forbidden.
if not functions or sum(function.read for function in functions.values()) * 2 < len(functions):
    sys.exit(f"fwcheck: the disassembly of {arguments.elf} was not understood")
for name, function in functions.items():
    function.calls &= functions.keys()
    function.calls.discard(name)  # branches inside it; recursion of one function is looked for below
failures = []
calls_itself = re.compile(r"bl(\.w)?\s.*<(.+)>$")
name = None
for line in listing.splitlines():
    if m := HEAD.match(line):
        name = m[1]
    elif (m := calls_itself.search(line)) and m[2] == name:
        functions[name].unproven.append("calls itself")

known = {}


def deepest(name, path=()):
    """Bytes below `name`, and the path that takes them."""
    if name in path:
        functions[name].unproven.append("recursion: " + " > ".join(map(plain, path + (name,))))
        return 0, []
    if name not in known:
        function = functions[name]
        below = max((deepest(callee, path + (name,)) for callee in function.calls), default=(0, []))
        known[name] = (below[0] + function.frame, [f"{plain(name)} {function.frame}"] + below[1])
    return known[name]


if arguments.root:
    root = next((name for name in functions if plain(name) == arguments.root or name == arguments.root), None)
    if root is None:
        sys.exit(f"fwcheck: no function {arguments.root} in {arguments.elf}")
    depth, path = deepest(root)
    unproven = [f"{plain(name)}: {why}" for name in known for why in functions[name].unproven]
    print(depth)
    print("  " + ", ".join(path), file=sys.stderr)
    if arguments.max_stack is not None:
        failures += [f"unproven: {text}" for text in unproven]
        if depth > arguments.max_stack:
            failures.append(f"stack of {depth} bytes, more than {arguments.max_stack}")


def forbid(what, found):
    if found:
        failures.append(f"{what}: " + ", ".join(plain(name) for name in found[:8]))


def named(pattern):
    return [name for name in functions if re.search(pattern, name)]


if arguments.no_float:
    soft = r"__aeabi_(c?[fd](?!iv)|i2[fd]|ui2[fd]|u?l2[fd])|__(add|sub|mul|div|eq|lt|gt|ge|le|ne|fix|float|extend|trunc)\w*[sd]f"
    forbid("floating point", named(soft) + [name for name, function in functions.items() if function.fpu])
if arguments.no_alloc:
    forbid("an allocator", named(r"__rust_alloc|__rg_alloc|^malloc$|5alloc5alloc|__rust_no_alloc_shim"))
if arguments.no_panic:
    forbid("panic machinery", named(r"9panicking|rust_begin_unwind|panic_fmt"))
for failure in failures:
    print("fwcheck:", failure, file=sys.stderr)
sys.exit(bool(failures))
