#!/usr/bin/env python3
"""What the workspaces depend on, from `cargo metadata`:

  dependencies.py [FOLDER...]  the Rust that they need, and what a manifest has to tell; fails where something is wrong (without folders: of those below)
  dependencies.py sbom CRATE  the bill of materials of a crate, CycloneDX 1.5, on the standard output: the same bytes for the same lock file

Licences and origins are looked at by cargo-deny (deny.toml), and whether each is used by cargo-shear: .ci/test.sh style."""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
WORKSPACES = [".", "firmware", "firmware/examples", "fuzz"]


def metadata(folder):
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--manifest-path", str(ROOT / folder / "Cargo.toml")]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout)


def release(version):
    return ([int(part) for part in version.split(".")] + [0, 0])[:3]


def oldest(found):
    """The Rust that the members of a workspace ask for."""
    members = set(found["workspace_members"])
    return next((package["rust_version"] for package in found["packages"] if package["id"] in members and package["rust_version"]), "999")


def check(folders):
    wrong, crates = [], set()
    for folder in folders:
        found = metadata(folder)
        members = set(found["workspace_members"])
        for package in found["packages"]:
            name = f"{package['name']} {package['version']}"
            if package["id"] in members:
                told = ["license"] + (["description", "keywords", "categories", "rust_version"] if package["publish"] is None else [])
                wrong += [f"{folder}: {package['name']} has no {key}" for key in told if not package[key]]
            elif package["source"]:
                crates.add(name)
                if package["rust_version"] and release(package["rust_version"]) > release(oldest(found)):
                    wrong.append(f"{folder}: {name} needs Rust {package['rust_version']}, more than {oldest(found)}")
    if wrong:
        sys.exit("\n".join(sorted(set(wrong))))
    print(f"{len(crates)} crates of others: none needs a newer Rust than promised")


def sbom(name):
    found = metadata(".")
    packages = {package["id"]: package for package in found["packages"]}
    edges = {node["id"]: [d["pkg"] for d in node["deps"] if any(kind["kind"] is None for kind in d["dep_kinds"])] for node in found["resolve"]["nodes"]}
    tool = next(package for package in packages.values() if package["name"] == name)
    # `cargo metadata` turns on what any crate of the workspace asks for; `cargo tree` only what the crate itself does.
    command = ["cargo", "tree", "--locked", "-p", name, "-e", "normal", "--target", "all", "--prefix", "none", "--format", "{p}"]
    tree = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout
    linked = {tuple(line.split()[:2]) for line in tree.splitlines() if line}
    reached = {identity for identity, package in packages.items() if (package["name"], f"v{package['version']}") in linked}
    edges = {identity: [other for other in edges[identity] if other in reached] for identity in reached}
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
    sbom(sys.argv[2]) if sys.argv[1:2] == ["sbom"] else check(sys.argv[1:] or WORKSPACES)
