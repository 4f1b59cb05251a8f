#!/usr/bin/env python3
"""Files of a crate that import one another in a circle, which none may: circles.py FOLDER... A file and the files in the folder of its
name are one part, and may name each other; tests at the end of a file may name anything."""
import pathlib, re, sys

def module(path, root):
    parts = list(path.relative_to(root).with_suffix("").parts)
    return tuple(p for p in parts if p not in ("lib", "mod", "main"))

def graph(root):
    files = {module(p, root): p for p in root.rglob("*.rs") if "bin" not in p.relative_to(root).parts[:-1]}
    edges = {}
    for name, path in files.items():
        text = re.sub(r"//.*", "", path.read_text().split("#[cfg(test)]\nmod ")[0])
        found = set()
        for base, rest in re.findall(r"\b((?:super::)+|crate::)((?:\w+::)*(?:\w+|\{[^;]*?\}))", text):
            at = () if base == "crate::" else name[: len(name) - base.count("super::")]
            lead = tuple(p for p in rest.split("::") if re.fullmatch(r"\w+", p))
            group = re.search(r"\{(.*)\}", rest, re.S)
            heads = [lead] if not group else [lead + (i.strip().split("::")[0],) for i in group[1].split(",") if i.strip()]
            for head in heads:
                for n in range(len(head), 0, -1):
                    target = at + head[:n]
                    if target in files and target != name:
                        found.add(target)
                        break
        edges[name] = found
    return edges

def circles(edges):
    """Sets of modules that reach one another (Tarjan)."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in edges[node]:
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
                found.append(sorted("/".join(name) for name in part))

    for node in edges:
        if node not in index:
            visit(node)
    return found


folders = sys.argv[1:]
graphs = {folder: graph(pathlib.Path(folder)) for folder in folders}
if not folders or not all(graphs.values()):
    sys.exit("circles.py FOLDER...: no Rust files there")
bad = [f"{folder}: {' '.join(circle)}" for folder, edges in graphs.items() for circle in circles(edges)]
print("\n".join(bad), end="\n" if bad else "")
sys.exit(bool(bad))
