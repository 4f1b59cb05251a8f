#!/usr/bin/env python3
"""Finds modules of a crate that import one another in a circle, which none may: circles.py FOLDER...

A file and the files in the folder of its name are one part: they may name each other, and what any of them imports the part imports.
Parts are compared with the others of their folder. Modules under `#[cfg(test)]`, in a file or of their own, may name anything."""
import pathlib, re, sys

# What `#[cfg(test)]` and further attributes stand before: a module of its own, or one that ends where a line begins with `}`.
TESTS = re.compile(r"^#\[cfg\(test\)\]\n(?:#\[.*\]\n)*(?:pub(?:\([^)]*\))? )?mod (\w+)(?:;| \{\n(?:(?!\}).*\n)*\})", re.M)
IMPORT = re.compile(r"\b((?:super::)+|crate::|self::)")


def module(path, root):
    parts = path.relative_to(root).with_suffix("").parts
    return tuple(part for part in parts if part not in ("lib", "mod", "main"))


def leaves(text):
    """Yields the paths that a `use` or a call names, from the end of `crate::` or `super::` on; groups may be nested."""
    head = re.match(r"\s*(\w+)", text)
    if text.lstrip().startswith("{"):
        depth, begin = 0, text.index("{") + 1
        for place in range(begin - 1, len(text)):
            depth += {"{": 1, "}": -1}.get(text[place], 0)
            if text[place] == "," and depth == 1 or depth == 0:
                yield from leaves(text[begin:place])
                begin = place + 1
            if depth == 0:
                return
    elif head:
        rest = text[head.end():]
        yield from ((head[1], *leaf) for leaf in leaves(rest[2:])) if rest.startswith("::") else [(head[1],)]
    else:
        # Such as `*`: all of what stands before it.
        yield ()


def imports(text, name):
    """Yields the absolute paths that the text of the module `name` imports or names."""
    for base in IMPORT.finditer(text):
        word = base[1]
        at = {"crate::": (), "self::": name}.get(word, name[: len(name) - word.count("super::")])
        yield from (at + leaf for leaf in leaves(text[base.end():]))


def graph(root):
    """Returns for each folder of modules which of its parts import which others, with a file that does."""
    texts = {module(path, root): path.read_text() for path in sorted(root.rglob("*.rs")) if "bin" not in path.relative_to(root).parts[:-1]}
    tests = {name + (test,) for name, text in texts.items() for test in TESTS.findall(text)}
    texts = {name: text for name, text in texts.items() if not any(name[: len(test)] == test for test in tests)}
    edges = {}
    for name, text in texts.items():
        for path in imports(re.sub(r"//.*", "", TESTS.sub("", text)), name):
            target = next((path[:n] for n in range(len(path), -1, -1) if path[:n] in texts), ())
            same = next((k for k, (a, b) in enumerate(zip(name, target)) if a != b), None)
            if same is not None:
                edges.setdefault(name[:same], {}).setdefault(name[same], {}).setdefault(target[same], name)
    return texts, edges


def circles(edges):
    """Returns the sets of parts that reach one another (Tarjan)."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in edges.get(node, ()):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            place = stack.index(node)
            part = stack[place:]
            del stack[place:]
            if len(part) > 1:
                found.append(sorted(part))

    for node in edges:
        if node not in index:
            visit(node)
    return found


def report(root):
    """Returns a line for each circle of a folder of sources."""
    texts, folders = graph(root)
    if not texts:
        sys.exit(f"circles.py: {root} has no Rust files")
    lines = []
    for folder, edges in folders.items():
        for circle in circles(edges):
            through = [f"{a} imports {b} in {'/'.join(name)}" for a in circle for b, name in edges.get(a, {}).items() if b in circle]
            lines.append(f"{'/'.join((str(root), *folder))}: {' '.join(circle)} ({'; '.join(through)})")
    return lines


if __name__ == "__main__":
    if not sys.argv[1:]:
        sys.exit("circles.py FOLDER...")
    bad = [line for folder in sys.argv[1:] for line in report(pathlib.Path(folder))]
    print("\n".join(bad), end="\n" if bad else "")
    sys.exit(bool(bad))
