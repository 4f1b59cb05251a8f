#!/usr/bin/env python3
"""What the workspaces depend on, from `cargo metadata`:

  dependencies.py             the Rust that they need, whether each is used, and what a manifest has to tell; fails where something is wrong
  dependencies.py sbom CRATE  the bill of materials of a crate, CycloneDX 1.5, on the standard output: the same bytes for the same lock file

Licences and origins are looked at by cargo-deny (deny.toml, .ci/test.sh style)."""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
WORKSPACES = [".", "firmware", "firmware/examples", "fuzz"]
# Named in no source: start-up code and critical sections, which macros, features and the linker ask for.
BY_OTHERS = {"cortex-m", "cortex-m-rt", "portable-atomic"}


def metadata(folder):
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--manifest-path", str(ROOT / folder / "Cargo.toml")]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout)


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
    if wrong:
        sys.exit("\n".join(sorted(set(wrong))))
    print(f"{len(crates)} crates of others: the Rust they need and use are in order")


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
