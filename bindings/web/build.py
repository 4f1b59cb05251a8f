#!/usr/bin/env python3
"""build.py MODULE.wasm PAGE.html: the playground as one file, with the module, the style of the tool's pages and the paper's agents."""
import base64
import gzip
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
LIMIT = 160 * 1024


def only(pattern):
    found = [path for path in TOP.glob(pattern) if "target" not in path.parts]
    if len(found) != 1:
        raise SystemExit(f"build: {len(found)} files {pattern}")
    return found[0].read_text()


def main(module, page):
    packed = base64.b64encode(gzip.compress(Path(module).read_bytes(), 9, mtime=0)).decode()
    scenario = json.dumps(json.loads((TOP / "tests/data/paper12.json").read_text()), separators=(",", ":"))
    code = only("pcr-host/**/outward.js") + "".join((HERE / name).read_text() for name in ("scenario.js", "draw.js", "history.js", "lessons.js", "playground.js"))
    # Comments of whole lines are read in the sources.
    code = "".join(line for line in code.splitlines(keepends=True) if not line.lstrip().startswith(("// ", "/** ")))
    text = (HERE / "playground.html").read_text()
    parts = {"/*STYLE*/": only("pcr-host/**/template.css"), "/*WASM*/": packed, "/*SCENARIO*/": scenario, "/*CODE*/": code}
    for mark, part in parts.items():
        if text.count(mark) != 1:
            raise SystemExit(f"build: {mark} is there {text.count(mark)} times")
        text = text.replace(mark, part)
    size = len(text.encode())
    if size > LIMIT:
        raise SystemExit(f"build: {size} bytes, more than {LIMIT}")
    Path(page).parent.mkdir(parents=True, exist_ok=True)
    Path(page).write_text(text)
    print(f"{page}: {size} bytes")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
