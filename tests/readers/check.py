#!/usr/bin/env python3
"""check.py PCR FOLDER: lets the tool PCR write exclusions into layouts of `tests/data/real` and the same in other forms, and reads them with readers.py.

Fails where two vehicles that obey a written file can touch, where anything else in it has changed, and where no file is written. Needs PyYAML.
"""

import json
import subprocess
import sys
from pathlib import Path

import readers
import yaml

DATA = Path(__file__).resolve().parents[2] / "tests/data/real"
# Layout, format, radius [m], and how it is cut [m].
LAYOUTS = [
    ("nav2/warehouse_graph.geojson", "nav2", 0.4, "1.5"), ("nav2/aws_graph.geojson", "nav2", 0.3, "1"), ("nav2/sample_graph.geojson", "nav2", 0.3, "0.8"),
    ("rmf/office.building.yaml", "rmf", 0.45, "1"), ("rmf/triple_H.building.yaml", "rmf", 0.45, "2"),
    ("rmf/battle_royale.building.yaml", "rmf", 0.45, "2"), ("rmf/hotel.building.yaml", "rmf", 0.45, "4"),
    ("opentcs/Demo-01.xml", "opentcs", 0.9, "2"),
]


class Plain(yaml.SafeDumper):
    """Without anchors for what is the same object."""

    def ignore_aliases(self, data):
        return True


def forms(kind, text):
    """The same layout laid out otherwise."""
    yield "", text
    yield "-windows", "\ufeff" + text.replace("\n", "\r\n")
    if kind == "nav2":
        yield "-dense", json.dumps(json.loads(text), separators=(",", ":"))
        yield "-tabs", json.dumps(json.loads(text), indent="\t")
    if kind == "rmf" and len(text) < 100_000:
        root = yaml.safe_load(text)
        for name, flow in (("lines", False), ("mixed", None), ("brackets", True)):
            yield "-" + name, yaml.dump(root, default_flow_style=flow, Dumper=Plain, sort_keys=False)


def main():
    tool, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    files, faults = 0, []
    for name, kind, radius, most in LAYOUTS:
        text = (DATA / name).read_text(encoding="utf-8")
        ending = name[name.index("."):]
        for form, content in forms(kind, text):
            layout = folder / (Path(name).name.split(".")[0] + form + ending)
            layout.write_bytes(content.encode())
            wanted = [(kind, []), (kind, ["--split", most])]
            if kind == "opentcs":
                wanted += [(kind, ["--envelopes", "key"]), (kind, ["--envelopes", "key", "--split", most])]
            # Zones and stretches are sampled, which takes a while.
            if form == "" and ("sample" in name or "office" in name):
                wanted += [("vda5050", []), ("vda5050", ["--split", most]), ("pcr", [])]
            for target, more in wanted:
                what = f"{layout.name} {target} {' '.join(more)}".strip()
                out = folder / ("written" + (ending if target == kind else ".json"))
                out.unlink(missing_ok=True)
                command = [tool, "locks", layout, "--radius", str(radius), "--write", target, "-o", out, "-q", *more]
                done = subprocess.run(command, capture_output=True, text=True)
                if done.returncode or not out.exists():
                    faults.append(f"{what}: {done.returncode} {done.stderr}")
                    continue
                written = out.read_bytes().decode()
                count, missing = readers.check(target, kind, content, written, radius)
                files += 1
                if missing or count < 10:
                    faults.append(f"{what}: {len(missing)} of {count} pairs can touch and are not excluded: {missing[:3]}")
                if target == kind and "--split" not in more and readers.changed(kind, content, written):
                    faults.append(f"{what}: more than exclusions has changed")
                if target == kind and "\r\n" in content and written.count("\n") != written.count("\r\n"):
                    faults.append(f"{what}: lines end otherwise")
    print(f"{files} written files, read by readers of their own: {len(faults)} faults")
    print("\n".join(faults))
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
