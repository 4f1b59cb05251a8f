#!/usr/bin/env python3
"""covered.py PROOF FOLDER...: every public function of the library is called in the proof that nothing panics.

Functions are found by name: `pub fn` and the methods of public traits, with the type of the `impl` they stand in.
Conversions from and to floating point, which firmware in fixed point must not use, are named below."""
import pathlib
import re
import sys

HOST_ONLY = {"from_f64", "from_f32", "to_f64", "to_f32", "to_radians", "from_radians"}

proof = open(sys.argv[1]).read()
missing = []
for folder in sys.argv[2:]:
    for path in sorted(pathlib.Path(folder).rglob("*.rs")):
        scope = None
        for line in path.read_text().splitlines():
            if line.startswith(("#[cfg(test)]", "#[cfg(all(test", "mod tests")):
                break
            if m := re.match(r"(?:pub )?(?:impl|trait)\b(?:<[^{]*?>)?\s*(?:.*\bfor\s+)?([A-Z]\w*)", line.removeprefix("pub ")):
                scope = m[1] if line.startswith(("impl", "pub trait")) else None
                trait = line.startswith("pub trait")
            m = re.match(r"\s*pub (?:const )?fn (\w+)", line) or (
                re.match(r"    (?:const )?fn (\w+)", line) if scope and trait else None)
            if m and m[1] not in HOST_ONLY and not re.search(r"\b%s\b" % m[1], proof):
                missing.append(f"{path}: {scope or ''}::{m[1]}")
if missing:
    sys.exit("not in the proof that nothing panics:\n  " + "\n  ".join(missing))
