#!/usr/bin/env python3
"""documents.py: README.md and what users read are no longer than they may be, and every relative link in a document leads to a file, with
"#" to a heading or an anchor of it."""
import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
# Bytes. Whoever adds something to these documents makes something else shorter.
README = 9_000
FOR_USERS = 150_000


def committed():
    """All documents: those that are committed, and those that will be."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md"],
                            cwd=TOP, check=True, stdout=subprocess.PIPE, text=True).stdout
    return sorted(path for name in listed.split("\0") if name and (path := TOP / name).is_file())


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
    documents = committed()
    for document in documents:
        wrong += [f"{document.relative_to(TOP)}: {problem}" for problem in broken(document)]
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"README.md has {size} bytes; guide and reference have {for_users}; the links of {len(documents)} documents lead somewhere")


if __name__ == "__main__":
    main()
