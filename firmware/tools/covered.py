#!/usr/bin/env python3
"""covered.py PROOF FOLDER...: every public function of the library is called in the proof that nothing panics.

Functions are `pub fn` and the methods of public traits. A method of a type counts as called where the proof says
`Type::name`, a method of a trait where it says `Trait::name` or `S::name`, `S` being its number type; a free function
where it is called. Conversions from and to floating point, which firmware in fixed point must not use, are named below."""
import pathlib
import re
import sys

HOST_ONLY = {"from_f64", "from_f32", "to_f64", "to_f32", "to_radians", "from_radians"}
# What the proof calls types and traits.
NAMES = {"Scalar": "Scalar|S", "Angle": "Angle|S::Angle", "Wide": "Wide|S::Wide", "Unit": "Unit|S::Unit", "Q": "Number"}


def scope_of(line):
    """Type or trait of a block that begins in this line, and whether it is a trait."""
    if m := re.match(r"pub trait (\w+)", line):
        return m[1], True
    if m := re.match(r"impl\b(.*)", line):
        rest, depth = m[1], 0
        for place, sign in enumerate(rest):
            depth += {"<": 1, ">": -1}.get(sign, 0) if rest[place - 1] != "-" else 0
            if depth == 0 and sign in " >":
                rest = rest[place + 1:]
                break
        rest = rest.split(" for ")[-1].strip()
        return (None if line.endswith("{}") else re.match(r"\w+", rest)[0]), False
    return None


def functions(text):
    """Scope and name of all public functions."""
    scope, trait = None, False
    for line in text.splitlines():
        if line.startswith(("#[cfg(test)]", "#[cfg(all(test", "mod tests")):
            return
        if line.startswith("}"):
            scope, trait = None, False
        if found := scope_of(line):
            scope, trait = found
        if m := re.match(r"(?:    )?%s(?:const )?fn (\w+)" % ("" if trait else "pub "), line):
            yield scope, m[1]


def called(proof, scope, name):
    before = r"\b(?:%s)(?:::<[^;]*?>)?::" % NAMES.get(scope, scope) if scope else r"(?<!:)\b"
    return re.search(before + name + r"(?:::<[^;]*?>)?\b[(;)]?", proof)


proof = pathlib.Path(sys.argv[1]).read_text()
known = [(path, *function) for folder in sys.argv[2:] for path in sorted(pathlib.Path(folder).rglob("*.rs"))
         for function in functions(path.read_text())]
missing = [f"{path}: {scope or ''}::{name}" for path, scope, name in known
           if name not in HOST_ONLY and not called(proof, scope, name)]
if missing or len(known) < 100:
    sys.exit("not in the proof that nothing panics:\n  " + "\n  ".join(missing))
