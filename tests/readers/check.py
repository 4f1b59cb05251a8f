#!/usr/bin/env python3
"""check.py PCR FOLDER [SEEDS]: lets the tool PCR write exclusions into layouts of `tests/data/real` and the same in other forms, and reads them with readers.py.

The same for random small layouts in every version of a format, with odd coordinates, names that are numbers, and without what may be left out. Fails
where two vehicles that obey a written file can touch, where a node or an edge is no longer where it was, where anything else has changed, where a file
does not say for which vehicle it is, and where no file is written. Needs PyYAML.
"""

import json
import random
import re
import subprocess
import sys
from pathlib import Path

import readers
import yaml

DATA = Path(__file__).resolve().parents[2] / "tests/data/real"
SMALL = Path(__file__).resolve().parents[2] / "tests/data/small"
VERSIONS = ["0.0.1", "0.0.2", "0.0.3", "0.0.4", "0.0.5", "6.0.0", "7.0.0"]
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


def graph(draw):
    """A route graph whose ids are numbers in any form, some with a frame, names or metadata."""
    ids = [draw.choice([k, str(k), float(k)]) for k in draw.sample(range(60000), 20)]
    features, at = [], []
    for k in range(8):
        at.append([round(draw.uniform(-30, 30), draw.choice([0, 1, 3, 9])) for _ in range(2)])
        own = {"id": ids[k], **draw.choice([{}, {"name": "7"}, {"metadata": None}, {"metadata": {"class": 3}}])}
        features.append({"type": "Feature", "properties": own, "geometry": {"type": "Point", "coordinates": at[k]}})
    for k in range(10):
        a, b = draw.sample(range(8), 2)
        own = {"id": ids[8 + k], "startid": ids[a], "endid": ids[b], **draw.choice([{}, {"metadata": {}}, {"cost": 0.0}, {"operations": []}])}
        kind = draw.choice(["LineString", "MultiLineString"])
        features.append({"type": "Feature", "properties": own, "geometry": {"type": kind, "coordinates": []}})
    return json.dumps({"type": "FeatureCollection", "features": features}, indent=draw.choice([None, 2]))


def building(draw):
    """A building in metres or pixels, or a navigation graph; vertices with and without what may be left out."""
    kind = draw.choice(["cartesian_meters", "reference_image", "graph"])
    levels, digits = {}, draw.choice([0, 2, 9])
    for level in draw.sample(["L1", "2", "ground floor"], draw.choice([1, 2])):
        scale = 20 if kind == "reference_image" else 1
        vertices = [[round(draw.uniform(-20, 20) * scale, digits), round(draw.uniform(-20, 20) * scale, digits)] for _ in range(7)]
        ends = [draw.sample(range(7), 2) for _ in range(8)]
        if kind == "graph":
            lanes = [[a, b, draw.choice([{}, {"speed_limit": 0.5}])] for a, b in ends]
            vertices = [[x, y, {"name": draw.choice(["", "7", "dock"])}] for x, y in vertices]
            levels[level] = {"lanes": lanes, "vertices": vertices}
            continue
        lanes = [[a, b, {"bidirectional": [4, draw.random() < 0.5], "graph_idx": [2, 0]}] for a, b in ends]
        vertices = [vertex + draw.choice([[0.0, ""], [0.0, f"v{k}", {"is_parking_spot": [4, True]}], [0.0, f"v{k}"]]) for k, vertex in enumerate(vertices)]
        levels[level] = {"elevation": 0, "lanes": lanes, "vertices": vertices}
        if kind == "reference_image":
            levels[level]["measurements"] = [[0, 1, {"distance": [3, 7.3]}]]
    head = {"building_name": "random"} if kind == "graph" else {"coordinate_system": kind, "name": "random"}
    return yaml.dump({**head, "levels": levels}, default_flow_style=draw.choice([None, False]), Dumper=Plain, sort_keys=False)


def plant(draw, version):
    """A plant model of a version, without some of what may be left out, moved, and with other names."""
    text = (SMALL / f"opentcs/plant-{version}.xml").read_text(encoding="utf-8")
    old = VERSIONS.index(version) < 5
    away = [r' vehicleOrientationAngle="[^"]*"'] + ([r' zPosition="[^"]*"', r' length="\d+"'] if old else [])
    for pattern in away:
        if draw.random() < 0.5:
            text = re.sub(pattern, "", text)
    if draw.random() < 0.3:
        text = re.sub(r" *<visualLayout.*</visualLayout>\n", "", text, flags=re.DOTALL)
        # Without units there are no curves.
        text = re.sub(r'BEZIER" layerId="2">.*?</pathLayout>', 'DIRECT" layerId="2"/>', text, flags=re.DOTALL)
    if draw.random() < 0.5:
        text = re.sub(r' id="\d+"', "", text)
    if draw.random() < 0.5:
        text = text.replace('"A --- B"', '"1"').replace('"C"', '"2"')
    if "BEZIER" not in text:
        by = [draw.randint(-10**6, 10**6) for _ in range(2)]
        for axis, far in zip("XY", by):
            names = f"position{axis}|{axis.lower()}Position"
            text = re.sub(rf'({names})="(-?\d+)"', lambda found: f'{found[1]}="{int(found[2]) + far}"', text)
    return text


def random_layouts(seed):
    draw = random.Random(seed)
    yield f"random-{seed}.geojson", "nav2", graph(draw)
    yield f"random-{seed}.building.yaml", "rmf", building(draw)
    for version in VERSIONS:
        yield f"random-{seed}-{version}.xml", "opentcs", plant(draw, version)


def check_random(tool, folder, seeds):
    """Faults of what is written for random layouts, and how many files were written."""
    files, faults = 0, []
    for seed in seeds:
        for name, kind, content in random_layouts(seed):
            layout = folder / name
            layout.write_text(content, encoding="utf-8")
            radius, most = random.Random(seed).uniform(0.3, 1.2), random.Random(seed).choice([0.7, 2.5, 3.3])
            for target, more in [(kind, []), (kind, ["--split", str(most)]), ("vda5050", []), ("pcr", [])]:
                out = folder / ("written-" + name if target == kind else "written.json")
                out.unlink(missing_ok=True)
                command = [tool, "locks", layout, "--radius", str(radius), "--write", target, "-o", out, "-q", *more]
                done = subprocess.run(command, capture_output=True, text=True)
                what = f"{name} {target} {' '.join(more)}".strip()
                if done.returncode or not out.exists():
                    faults.append(f"{what}: {done.returncode} {done.stderr}")
                    continue
                written = out.read_bytes().decode()
                files += 1
                if readers.stamp(target, written)["radius"] != radius:
                    faults.append(f"{what}: {readers.stamp(target, written)} is not of {radius}")
                if target != kind:
                    continue
                faults += [f"{what}: {fault}" for fault in readers.moved(kind, content, written, most if more else 0)[:2]]
                _, missing = readers.check(target, kind, content, written, radius)
                if missing:
                    faults.append(f"{what}: not excluded: {missing[:3]}")
    return files, faults


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
                if target == kind:
                    faults += [f"{what}: {fault}" for fault in readers.moved(kind, content, written, float(most) if "--split" in more else 0)[:2]]
                if readers.stamp(target, written)["radius"] != radius:
                    faults.append(f"{what}: it says {readers.stamp(target, written)}")
                if target == kind and "--split" not in more and readers.changed(kind, content, written):
                    faults.append(f"{what}: more than exclusions has changed")
                if target == kind and "\r\n" in content and written.count("\n") != written.count("\r\n"):
                    faults.append(f"{what}: lines end otherwise")
    count, found = check_random(tool, folder, range(int(sys.argv[3]) if len(sys.argv) > 3 else 12))
    files, faults = files + count, faults + found
    print(f"{files} written files, read by readers of their own: {len(faults)} faults")
    print("\n".join(faults))
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
