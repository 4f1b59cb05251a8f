#!/usr/bin/env python3
"""What programs can use of pcr-core, as rustdoc shows it in the folder DOC/pcr_core.
  api.py DOC            docs/maintain/api-review.md names every public item with a reason, and no other; docs/maintain/api.txt has all their declarations:
                        signatures, generics and bounds, fields, variants, constants, implemented traits (Send and Sync are among them)
  api.py DOC --write    brings both up to date, and says what is missing; reasons are written by people
  api.py --since [REVISION]    what of docs/maintain/api.txt breaks programs that were written for REVISION (the last tag v*): exit status 1 if
                        anything does and the version has not been raised accordingly"""
import html
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
REVIEW = ROOT / "docs/maintain/api-review.md"
DECLARED = ROOT / "docs/maintain/api.txt"
KINDS = {"struct": "struct", "enum": "enum", "trait": "trait", "fn": "function", "type": "type", "constant": "constant", "macro": "macro"}
# Implemented by the compiler, and nothing that a program can name.
UNSTABLE = re.compile(r"(Freeze|UnsafeUnpin|StructuralPartialEq) for ")


def text(markup):
    """What a reader sees of it, on one line, wherever rustdoc breaks lines."""
    words = " ".join(html.unescape(re.sub(r"<[^>]+>", "", re.sub(r"<(?:div|br)\b[^>]*>", " ", markup))).split())
    return re.sub(r"\( ", "(", re.sub(r",(?: (?=\))|$)", "", words))


def declarations(page, declaration):
    """A line for each thing that a program can rely on."""
    whole = text(declaration)
    found = []
    if m := re.match(r"(?:#\[[^\]]+\] ?)*pub (?:unsafe )?(?:struct|enum|trait) [^{]*", whole):
        # What is in the braces has its own lines.
        private = " { private fields }" if re.search(r"\{.*/\* private fields \*/", whole) else ""
        found.append(m[0].strip() + private)
    else:
        found.append(whole)
    within = ""
    for part in re.split(r'(?=<h2 id=")', page):
        of = (re.match(r'<h2 id="([\w-]+)"', part) or [None, ""])[1]
        if of == "dyn-compatibility":
            found.append("not dyn compatible")
        # What is implemented for every type is not ours.
        if of in ("", "blanket-implementations", "dyn-compatibility"):
            continue
        signs = r'<(section|span) id="([^"]+)"[^>]*>.*?<(h3|h4|code)\b[^>]*>(.*?)</\3>'
        for _, name, _, shown in re.findall(signs, part, re.S):
            line = text(shown)
            kind, _, rest = name.partition(".")
            if name.startswith("impl-"):
                within = line
                if of != "implementations" and not UNSTABLE.search(line):
                    found.append(line)
            elif kind == "structfield" or (kind == "variant" and ".field." in rest):
                variant = f"variant {rest.partition('.')[0]}: " if kind == "variant" else ""
                found.append(f"{variant}field {line}")
            elif kind == "variant":
                found.append(f"variant {line}")
            elif of.startswith(("required", "provided")):
                found.append(f"{of.split('-')[0]} {line}")
            elif of == "implementations":
                found.append(f"{within}: {line}")
            elif kind == "associatedtype":
                found.append(f"{within}: {line}")
    return found


def items(folder):
    """Path of each public item: what it is, the names of its own functions, fields, variants and constants, and its declarations."""
    found = {}
    for link in re.findall(r'<a href="([\w/.]+\.html)">', (folder / "all.html").read_text()):
        if link.count(".") < 2 or link.startswith(".."):
            continue
        kind, name = pathlib.Path(link).name.removesuffix(".html").split(".")
        path = "::".join([*pathlib.Path(link).parent.parts, name])
        page = (folder / link).read_text()
        # What is implemented for foreign traits is theirs, and so are the methods of what a type dereferences to.
        own = re.split(r'<h2 id="(?:deref-methods-[^"]*|trait-implementations|synthetic-implementations|blanket-implementations|implementors|foreign-impls)"', page)[0]
        parts = re.findall(r'id="(?:method|tymethod|variant|structfield|associatedconstant|associatedtype)\.(\w+)"', own)
        declaration = re.search(r'<pre class="rust item-decl">(.*?)</pre>', page, re.S)[1]
        marks = [mark for mark in ("non_exhaustive", "must_use") if f"#[{mark}" in text(declaration)]
        found[path] = (KINDS[kind], list(dict.fromkeys(parts)), marks, declarations(page, declaration))
    return found


def row(path, item, why):
    kind, parts, marks, _ = item
    named = ", ".join(f"`{part}`" for part in parts)
    return f"| `{path}` | {kind}{''.join(f', `#[{mark}]`' for mark in marks)} | {why} | {named} |"


def reviewed(found, write):
    lines, seen, wrong = [], set(), []
    for line in REVIEW.read_text().splitlines():
        if m := re.match(r"\| `([\w:]+)` \|[^|]*\|([^|]*)\|[^|]*\|$", line):
            path, why = m[1], m[2].strip()
            seen.add(path)
            if path not in found:
                wrong.append(f"{path} is no public item")
                continue
            made = row(path, found[path], why)
            if not why:
                wrong.append(f"{path} has no reason")
            if made != line and not write:
                wrong.append(f"the row of {path} is\n{line}\nand would be\n{made}")
            line = made
        lines.append(line)
    for path in sorted(set(found) - seen):
        wrong.append(f"not named:\n{row(path, found[path], 'WHY')}")
    if write:
        REVIEW.write_text("\n".join(lines) + "\n")
    return wrong


def declared(found, write):
    # Sorted, so that code can be moved.
    lines = sorted({f"{path}: {line}" for path, item in found.items() for line in item[3]})
    if write:
        DECLARED.write_text("\n".join(lines) + "\n")
        return []
    before = DECLARED.read_text().splitlines()
    return [f"docs/maintain/api.txt has: {line}" for line in before if line not in lines] + [
        f"docs/maintain/api.txt lacks: {line}" for line in lines if line not in before
    ]


def breaking(before, now):
    """What is gone or has another signature, and what is new and makes programs fail to compile."""
    known, found = {line.split(": ")[0] for line in before}, [f"gone or changed: {line}" for line in before if line not in now]
    # More may come to these without notice.
    open_ = {line.split(": ")[0] for line in before if "#[non_exhaustive]" in line or "{ private fields }" in line}
    for line in now:
        path, _, rest = line.partition(": ")
        if line in before or path not in known:
            continue
        if rest.startswith("required ") or rest.startswith("not dyn ") or (rest.startswith(("field ", "variant ")) and path not in open_):
            found.append(f"new, and needed by all: {line}")
    return found


def version(manifest):
    found = re.search(r'^\[workspace\.package\][^\[]*?^version = "(\d+)\.(\d+)\.(\d+)', manifest, re.M | re.S)
    return tuple(map(int, found.groups()))


def since(revision):
    def git(*arguments):
        done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else sys.exit(f"git {' '.join(arguments)}: {done.stderr.strip()}")

    if revision is None:
        tags = git("tag", "--list", "v*", "--merged", "HEAD", "--sort=-v:refname").split()
        if not tags:
            print("no release is tagged (v*), so none can be broken; docs/maintain/api.txt is what this commit promises")
            return
        revision = tags[0]
    before, now = git("show", f"{revision}:docs/maintain/api.txt").splitlines(), DECLARED.read_text().splitlines()
    old, new = version(git("show", f"{revision}:Cargo.toml")), version((ROOT / "Cargo.toml").read_text())
    found = breaking(before, now)
    # By Cargo's rules: the first number that is not 0 is the one to raise.
    first = next((place for place, number in enumerate(old) if number), 2)
    if found and new[: first + 1] <= old[: first + 1]:
        sys.exit("\n".join([*found, f"{len(found)} changes break programs that use {revision} ({'.'.join(map(str, old))})"]))
    print("\n".join([*found, f"{len(found)} changes since {revision} that break programs; version {'.'.join(map(str, new))}"]))


def main():
    if "--since" in sys.argv:
        return since(next(iter(sys.argv[sys.argv.index("--since") + 1 :]), None))
    found, write = items(pathlib.Path(sys.argv[1]) / "pcr_core"), "--write" in sys.argv
    wrong = reviewed(found, write) + declared(found, write)
    if wrong:
        sys.exit("\n".join(wrong))
    count = len(DECLARED.read_text().splitlines())
    print(f"{len(found)} public items, each with its reason in docs/maintain/api-review.md, and {count} declarations as in docs/maintain/api.txt")


main()
