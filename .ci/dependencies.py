#!/usr/bin/env python3
"""What the workspaces depend on, from `cargo metadata`:

  dependencies.py             licences, origins, the Rust that they need, and whether each is used; fails where something is wrong
  dependencies.py sbom CRATE  the bill of materials of a crate, CycloneDX 1.5, on the standard output: the same bytes for the same lock file

Instead of cargo-deny and cargo-machete, which take minutes to build. Advisories are not looked at: their database is not in a registry."""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
WORKSPACES = [".", "firmware", "firmware/examples", "fuzz"]
# What may be linked into programs of any licence; Unicode-3.0 and the like ask for a notice only.
ALLOWED = {"MIT", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "CC0-1.0", "0BSD", "ISC",
           "MIT-0", "MPL-2.0", "NCSA", "OFL-1.1", "Unicode-3.0", "Unlicense", "Zlib"}
REGISTRY = "registry+https://github.com/rust-lang/crates.io-index"
# Named in no source: start-up code and critical sections, which macros, features and the linker ask for.
BY_OTHERS = {"cortex-m", "cortex-m-rt", "portable-atomic"}


def metadata(folder):
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--manifest-path", str(ROOT / folder / "Cargo.toml")]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout)


def allowed(expression):
    """Whether one may choose licences of an SPDX expression that are all allowed."""
    tokens = re.findall(r"\(|\)|[^\s()]+(?: WITH [^\s()]+)?", expression.replace("/", " OR "))

    def any_of():
        found = all_of()
        while tokens and tokens[0] == "OR":
            tokens.pop(0)
            found = all_of() or found
        return found

    def all_of():
        found = one()
        while tokens and tokens[0] == "AND":
            tokens.pop(0)
            found = one() and found
        return found

    def one():
        token = tokens.pop(0)
        if token != "(":
            return token in ALLOWED
        found = any_of()
        tokens.pop(0)
        return found

    return any_of()


def release(version):
    return [int(part) for part in version.split(".")]


def oldest(found):
    """The Rust that the members of a workspace ask for."""
    members = set(found["workspace_members"])
    return next((package["rust_version"] for package in found["packages"] if package["id"] in members and package["rust_version"]), "999")


def used(package, dependency):
    """Whether the source of a package names a dependency."""
    name = (dependency["rename"] or dependency["name"]).replace("-", "_")
    folder = pathlib.Path(package["manifest_path"]).parent
    inner = [path.parent for path in folder.rglob("Cargo.toml") if path.parent != folder]
    word = re.compile(rf"\b{name}\b")
    files = [path for path in folder.rglob("*.rs") if not any(path.is_relative_to(other) for other in inner) and "target" not in path.parts]
    return any(word.search(path.read_text()) for path in files)


def check():
    wrong, crates = [], set()
    for folder in WORKSPACES:
        found = metadata(folder)
        members = set(found["workspace_members"])
        for package in found["packages"]:
            name = f"{package['name']} {package['version']}"
            if package["id"] in members:
                told = ["license"] + (["description", "keywords", "categories", "rust_version"] if package["publish"] is None else [])
                wrong += [f"{folder}: {package['name']} has no {key}" for key in told if not package[key]]
                for dependency in package["dependencies"]:
                    feature = any(f"dep:{dependency['name']}" in made or dependency["name"] in made for made in package["features"].values())
                    if dependency["kind"] != "build" and not used(package, dependency) and not feature and dependency["name"] not in BY_OTHERS:
                        wrong.append(f"{folder}: {package['name']} does not use {dependency['name']}")
            elif package["source"]:
                crates.add(name)
                if package["rust_version"] and release(package["rust_version"]) > release(oldest(found)):
                    wrong.append(f"{folder}: {name} needs Rust {package['rust_version']}, more than {oldest(found)}")
                if package["source"] != REGISTRY:
                    wrong.append(f"{folder}: {name} comes from {package['source']}")
                if not package["license"] or not allowed(package["license"]):
                    wrong.append(f"{folder}: {name} has the licence {package['license'] or package['license_file']}")
    if wrong:
        sys.exit("\n".join(sorted(set(wrong))))
    print(f"{len(crates)} crates of others: licences, origins, the Rust they need and use are in order")


def sbom(name):
    found = metadata(".")
    packages = {package["id"]: package for package in found["packages"]}
    edges = {node["id"]: [d["pkg"] for d in node["deps"] if any(kind["kind"] is None for kind in d["dep_kinds"])] for node in found["resolve"]["nodes"]}
    tool = next(package for package in packages.values() if package["name"] == name)
    reached, ahead = set(), [tool["id"]]
    while ahead:
        if (here := ahead.pop()) not in reached:
            reached.add(here)
            ahead += edges[here]
    sums = {}
    for block in (ROOT / "Cargo.lock").read_text().split("[[package]]"):
        fields = dict(re.findall(r'^(name|version|checksum) = "(.*)"$', block, re.M))
        if "checksum" in fields:
            sums[fields["name"], fields["version"]] = fields["checksum"]

    def reference(identity):
        return f"pkg:cargo/{packages[identity]['name']}@{packages[identity]['version']}"

    def component(package):
        made = {"type": "library", "bom-ref": reference(package["id"]), "name": package["name"], "version": package["version"],
                "purl": reference(package["id"]), "licenses": [{"expression": package["license"].replace("/", " OR ")}]}
        if (known := sums.get((package["name"], package["version"]))):
            made["hashes"] = [{"alg": "SHA-256", "content": known}]
        return made

    order = sorted(reached, key=reference)
    made = {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
            "metadata": {"component": component(tool) | {"type": "application"}},
            "components": [component(packages[identity]) for identity in order if identity != tool["id"]],
            "dependencies": [{"ref": reference(identity), "dependsOn": sorted(reference(other) for other in edges[identity])} for identity in order]}
    print(json.dumps(made, indent=1))


if __name__ == "__main__":
    sbom(sys.argv[2]) if sys.argv[1:2] == ["sbom"] else check()
