#!/usr/bin/env python3
"""Checks that types have names of their own, so that a reader knows a type without its module: names.py FOLDER...

Looks for the definitions of structures, enumerations, unions, traits and aliases in the Rust files of the folders. Prints the names that
are defined more than once, with the places, and which share of all definitions they are. Fails if the share is above the limit.
Tests are left out: they are read on their own, and nothing imports from them."""
import collections, pathlib, re, sys

import circles

# In percent. Some names are the same on purpose, such as those of a type and of what stands for it in another language.
LIMIT = 15
# An alias counts if it begins its line; those with an indent belong to traits.
DEFINITION = re.compile(r"^(?:[ \t]*(?:pub(?:\([^)]*\))? )?(?:unsafe )?(?:struct|enum|union|trait)|(?:pub(?:\([^)]*\))? )?type) (\w+)", re.M)


def definitions(text):
    """Yields the name and the line of each type that a file defines, without its tests."""
    text = circles.TESTS.sub(lambda found: "\n" * found[0].count("\n"), text)
    for found in DEFINITION.finditer(text):
        yield found[1], text.count("\n", 0, found.start(1)) + 1


def is_test(path):
    return path.stem == "tests" or {"tests", "examples"} & set(path.parts[:-1])


def places(folders):
    """Returns the places of the definitions by name."""
    found = collections.defaultdict(list)
    for folder in folders:
        files = [path for path in sorted(folder.rglob("*.rs")) if not is_test(path.relative_to(folder))]
        if not files:
            sys.exit(f"names.py: {folder} has no Rust files")
        for path in files:
            for name, line in definitions(path.read_text()):
                found[name].append(f"{path}:{line}")
    return found


def report(found, limit=LIMIT):
    """Returns the lines of the report, and whether the share is within the limit."""
    shared = {name: where for name, where in found.items() if len(where) > 1}
    part, total = (sum(map(len, names.values())) for names in (shared, found))
    lines = [f"{name}: {' '.join(where)}" for name, where in sorted(shared.items(), key=lambda entry: (-len(entry[1]), entry[0]))]
    share = 100 * part / total if total else 0
    lines.append(f"names.py: {part} of {total} definitions of types share their name with another one: {share:.1f} %, at most {limit} % may")
    return lines, share <= limit


if __name__ == "__main__":
    if not sys.argv[1:]:
        sys.exit("names.py FOLDER...")
    lines, good = report(places([pathlib.Path(folder) for folder in sys.argv[1:]]))
    print("\n".join(lines))
    sys.exit(not good)
