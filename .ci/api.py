#!/usr/bin/env python3
"""api.py DOC [--write]: docs/api-review.md names every public item of pcr-core, as rustdoc lists them in the folder DOC/pcr_core, and
no other. With --write it brings the lists of functions, fields and variants up to date; reasons are written by people."""
import html
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
REVIEW = ROOT / "docs/api-review.md"
KINDS = {"struct": "struct", "enum": "enum", "trait": "trait", "fn": "function", "type": "type", "constant": "constant", "macro": "macro"}


def items(folder):
    """Path of each public item: what it is, and the names of its own functions, fields, variants and constants."""
    found = {}
    for link in re.findall(r'<a href="([\w/.]+\.html)">', (folder / "all.html").read_text()):
        if link.count(".") < 2 or link.startswith(".."):
            continue
        kind, name = pathlib.Path(link).name.removesuffix(".html").split(".")
        path = "::".join([*pathlib.Path(link).parent.parts, name])
        page = (folder / link).read_text()
        # What is implemented for foreign traits is theirs.
        own = re.split(r'<h2 id="(?:trait-implementations|synthetic-implementations|blanket-implementations|implementors|foreign-impls)"', page)[0]
        parts = re.findall(r'id="(?:method|tymethod|variant|structfield|associatedconstant|associatedtype)\.(\w+)"', own)
        declaration = html.unescape(re.sub(r"<[^>]+>", "", re.search(r'<pre class="rust item-decl">(.*?)</pre>', page, re.S)[1]))
        marks = [mark for mark in ("non_exhaustive", "must_use") if f"#[{mark}" in declaration]
        found[path] = (KINDS[kind], list(dict.fromkeys(parts)), marks)
    return found


def row(path, item, why):
    kind, parts, marks = item
    named = ", ".join(f"`{part}`" for part in parts)
    return f"| `{path}` | {kind}{''.join(f', `#[{mark}]`' for mark in marks)} | {why} | {named} |"


def main():
    found = items(pathlib.Path(sys.argv[1]) / "pcr_core")
    text = REVIEW.read_text()
    lines, seen, wrong = [], set(), []
    for line in text.splitlines():
        if m := re.match(r"\| `([\w:]+)` \|[^|]*\|([^|]*)\|[^|]*\|$", line):
            path, why = m[1], m[2].strip()
            seen.add(path)
            if path not in found:
                wrong.append(f"{path} is no public item")
                continue
            made = row(path, found[path], why)
            if not why:
                wrong.append(f"{path} has no reason")
            if made != line and "--write" not in sys.argv:
                wrong.append(f"the row of {path} is\n{line}\nand would be\n{made}")
            line = made
        lines.append(line)
    for path in sorted(set(found) - seen):
        wrong.append(f"not named:\n{row(path, found[path], 'WHY')}")
    if "--write" in sys.argv:
        REVIEW.write_text("\n".join(lines) + "\n")
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(found)} public items, each with its reason in docs/api-review.md")


main()
