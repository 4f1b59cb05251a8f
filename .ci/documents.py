#!/usr/bin/env python3
"""documents.py: README.md and what users read are no longer than they may be, and every relative link in a document leads to a file, with
"#" to a heading or an anchor of it. The maps of modules at the beginning of Rust files name modules that exist."""
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
# Bytes. Whoever adds something to these documents makes something else shorter.
README = 9_000
FOR_USERS = 150_000


def committed(pattern):
    """All files of this pattern, where they are: those that are committed, and those that will be."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", pattern],
                            cwd=TOP, check=True, stdout=subprocess.PIPE, text=True).stdout
    return sorted(path for name in listed.split("\0") if name and (path := TOP / name).is_file() and not path.is_symlink())


def without_code(text):
    return re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)


def anchors(text):
    """What a link may name behind "#": headings as GitHub writes them, and explicit anchors."""
    text = without_code(text)
    found = set(re.findall(r'<a id="([^"]+)"></a>', text))
    for heading in re.findall(r"^#+ (.*)$", text, re.M):
        heading = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
        found.add(re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-"))
    return found


def broken(document):
    """The links of a document that lead nowhere."""
    text = re.sub(r"`[^`\n]*`", "", without_code(document.read_text()))
    # Formulas have brackets of their own.
    text = re.sub(r"\$\$.*?\$\$|\$[^$\n]+\$", "", text, flags=re.S)
    for link in re.findall(r"\]\(([^()\s]+)\)", text):
        name, _, anchor = link.partition("#")
        if re.match(r"[a-z]+:", name):
            continue
        path = (document.parent / name).resolve() if name else document
        if not path.exists():
            yield f"{link}: no such file"
        elif anchor and path.suffix == ".md" and anchor not in anchors(path.read_text()):
            yield f"{link}: no such heading or anchor"


def no_modules(source):
    """The names in maps of modules that are no modules of the file. A map is a block of text of whose lines half begin with modules."""
    text = source.read_text()
    modules = set(re.findall(r"^(?:pub(?:\([a-z]+\))? )?mod (\w+);", text, re.M))
    head = "\n".join(line[4:] for line in text.splitlines() if line.startswith("//!"))
    for block in re.findall(r"^```text\n(.*?)^```", head, re.M | re.S):
        names = [name for each in re.findall(r"^ *(\w+(?:, \w+)*)", block, re.M) for name in each.split(", ")]
        if len(names) > 3 and 2 * sum(name in modules for name in names) >= len(names):
            yield from (name for name in names if name not in modules)


def main():
    wrong = []
    size = (TOP / "README.md").stat().st_size
    if size > README:
        wrong.append(f"README.md has {size} bytes, {README} are allowed")
    for_users = sum(path.stat().st_size for folder in ("guide", "reference") for path in (TOP / "docs" / folder).rglob("*.md"))
    if not for_users:
        wrong.append("docs/guide and docs/reference have no documents")
    if for_users > FOR_USERS:
        wrong.append(f"docs/guide and docs/reference have {for_users} bytes, {FOR_USERS} are allowed")
    documents = committed("*.md")
    for document in documents:
        wrong += [f"{document.relative_to(TOP)}: {problem}" for problem in broken(document)]
    for source in committed("*.rs"):
        wrong += [f"{source.relative_to(TOP)}: its map of modules names {name}, which is none" for name in no_modules(source)]
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"README.md has {size} bytes; guide and reference have {for_users}; the links of {len(documents)} documents lead somewhere")


if __name__ == "__main__":
    main()
