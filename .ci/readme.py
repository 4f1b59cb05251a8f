#!/usr/bin/env python3
"""readme.py SECTION...: runs the blocks of these sections of docs/guide/languages.md, literally, in the top folder: "In Python",
"In the browser", "On your board", "In C".

A section is a paragraph that begins with its name in bold, and what follows up to the next one or the next heading. It has to start with a
block, as that is what gets pasted. What a section says in blocks of sh and python is run in one shell; a block of text is what the
block before it has to print last."""
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
PAGE = "docs/guide/languages.md"
MARK = "-- end of a block --"


def section(page, name):
    parts = re.split(r"^(?=\*\*|#+ )", without_blocks(page), flags=re.M)
    found = [part for part in parts if part.startswith(f"**{name}")]
    if len(found) != 1:
        raise SystemExit(f"{PAGE} has {len(found)} sections {name}")
    return found[0]


def without_blocks(page):
    """Marks at the beginning of a line inside of a block begin no section."""
    return re.sub(r"^```.*?^```$", lambda block: re.sub(r"^(?=\*\*|#)", "\0", block[0], flags=re.M), page, flags=re.M | re.S)


def blocks(text):
    """Kind and content of each block."""
    return [(kind, body.replace("\0", "")) for kind, body in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S)]


def run(name, page):
    text = section(page, name)
    # A line of its own with the name, then a block.
    if not re.match(r"[^\n]*\n\n```(sh|python)\n", text):
        raise SystemExit(f"the section {name} of {PAGE} does not start with a block to paste")
    script, expected = ["set -euo pipefail"], []
    for kind, body in blocks(text):
        if kind == "text":
            expected[-1] = body
        elif kind in ("sh", "python"):
            script += [body if kind == "sh" else f"python <<'README'\n{body}README", f"echo '{MARK}'"]
            expected.append("")
    done = subprocess.run(["bash", "-c", "\n".join(script)], cwd=TOP, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=False)
    print(done.stdout.replace(MARK + "\n", ""), end="")
    printed = done.stdout.split(MARK + "\n")
    if done.returncode or len(printed) != len(expected) + 1:
        raise SystemExit(f"the section {name} of {PAGE}: block {len(printed)} ends with status {done.returncode}")
    for number, (said, out) in enumerate(zip(expected, printed), 1):
        if not out.endswith(said):
            raise SystemExit(f"the section {name} of {PAGE}: block {number} should print\n{said}but it prints\n{out}")
    print(f"{PAGE}, {name}: {len(expected)} blocks do what they say")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    for wanted in sys.argv[1:]:
        run(wanted, (TOP / PAGE).read_text())
