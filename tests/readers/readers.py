"""What vehicles may do at the same time by the files that fleets load: readers that share nothing with the tool, written from what loads these files.

Each `check_*` takes a written file and the radius of a disc, and returns how many pairs of places can touch and those of them that the file does not exclude.
"""

import json
import math
import re
import xml.etree.ElementTree as ET

# Contacts that are less deep prove nothing: distances are computed in plain floating point.
DEEP = 1e-7
# Of curves, which are polylines of so many points here, and of corners at whole millimetres.
CURVE, DEEP_CURVE = 50, 2e-3


def to_segment(p, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    share = 0 if square == 0 else max(0, min(1, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square))
    return math.hypot(a[0] + share * dx - p[0], a[1] + share * dy - p[1])


def turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def of_segments(p, q, r, s):
    if turn(p, q, r) * turn(p, q, s) < 0 and turn(r, s, p) * turn(r, s, q) < 0:
        return 0.0
    return min(to_segment(p, r, s), to_segment(q, r, s), to_segment(r, p, q), to_segment(s, p, q))


def distance(a, b):
    """Of two polylines, or points."""
    a, b = (line if len(line) > 1 else line * 2 for line in (a, b))
    return min(of_segments(a[i], a[i + 1], b[j], b[j + 1]) for i in range(len(a) - 1) for j in range(len(b) - 1))


def box(line):
    return [min(p[0] for p in line), min(p[1] for p in line), max(p[0] for p in line), max(p[1] for p in line)]


def far(a, b, reach):
    return a[0] - reach > b[2] or b[0] - reach > a[2] or a[1] - reach > b[3] or b[1] - reach > a[3]


def touching(lines, reach):
    """Pairs of lines, and each with itself, that come nearer than that."""
    boxes = [box(line) for line in lines]
    for i, line in enumerate(lines):
        for j in range(i, len(lines)):
            if not far(boxes[i], boxes[j], reach) and distance(line, lines[j]) < reach:
                yield i, j


def plain(text):
    return text.lstrip("\ufeff")


def of_yaml(text):
    import yaml

    return yaml.load(plain(text), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


# ---- nav2: closed_edges in the metadata, as nav2_route's loader finds features ----


def number(name):
    """An id, which some tools write as a text or with a decimal point."""
    return int(float(name))


def nav2(text):
    nodes, edges, closed = {}, [], {}
    features = json.loads(plain(text))["features"]
    for of in ("Point", "Line"):
        for feature in features:
            kind, own = feature["geometry"]["type"], feature["properties"]
            barred = set((own.get("metadata") or {}).get("closed_edges", []))
            # As the service takes them.
            assert all(isinstance(edge, int) and 0 <= edge <= 65535 for edge in barred), barred
            if kind == "Point" and of == "Point":
                nodes[number(own["id"])] = tuple(feature["geometry"]["coordinates"][:2])
                closed.setdefault(number(own["id"]), []).append(barred)
            elif kind in ("LineString", "MultiLineString") and of == "Line":
                edges.append((number(own["id"]), [nodes[number(own["startid"])], nodes[number(own["endid"])]], barred))
    return nodes, edges, closed


def check_nav2(written, radius):
    nodes, edges, closed = nav2(written)
    count, missing, reach = 0, [], 2 * radius - DEEP
    for i, j in touching([line for _, line, _ in edges], reach):
        count += 1
        (a, _, of_a), (b, _, of_b) = edges[i], edges[j]
        if b not in of_a or a not in of_b:
            missing.append((a, b))
    for edge, line, _ in edges:
        for node, at in nodes.items():
            if distance([at], line) < reach:
                count += 1
                if not all(edge in barred for barred in closed[node]):
                    missing.append((f"node {node}", edge))
    return count, missing


# ---- Open-RMF: mutex groups, as rmf_building_map_tools and parse_graph of rmf_fleet_adapter read them ----


def rmf(text):
    """Of each level: its name, places of vertices, their groups, and lanes of one way: from, to, group, place in the file."""
    root = of_yaml(text)
    for name, level in root["levels"].items():
        vertices, lanes = level.get("vertices") or [], level.get("lanes") or []
        if not lanes:
            continue
        if "building_name" in root:
            at, groups = [tuple(v[:2]) for v in vertices], [v[2].get("mutex", "") for v in vertices]
            ways = [(a, b, more.get("mutex", ""), k) for k, (a, b, more) in enumerate(lanes)]
        else:
            scale, up = 1.0, 1.0
            if root.get("coordinate_system", "reference_image") == "reference_image":
                of = [m[2]["distance"][1] / math.dist(vertices[m[0]][:2], vertices[m[1]][:2]) for m in level["measurements"]]
                scale, up = sum(of) / len(of), -1.0
            given = lambda more, what: (more or {}).get(what, (0, None))[1]
            at = [(v[0] * scale, v[1] * scale * up) for v in vertices]
            groups = [given(v[4], "mutex") if len(v) > 4 else "" for v in vertices]
            ways = []
            for k, lane in enumerate(lanes):
                more = lane[2] if len(lane) > 2 else {}
                ways.append((lane[0], lane[1], given(more, "mutex"), k))
                if given(more, "bidirectional"):
                    ways.append((lane[1], lane[0], given(more, "mutex"), k))
        yield name, at, groups, ways


def check_rmf(written, radius):
    count, missing, reach = 0, [], 2 * radius - DEEP
    for name, at, groups, ways in rmf(written):
        # On its way a robot has the groups of the lane and of the vertex ahead.
        has = [{group for group in (own, groups[to]) if group} for _, to, own, _ in ways]
        lines = [[at[a], at[b]] for a, b, _, _ in ways]
        for i, j in touching(lines, reach):
            count += 1
            if not has[i] & has[j]:
                missing.append((name, ways[i], ways[j]))
        for i, line in enumerate(lines):
            for vertex in {end for way in ways for end in way[:2]}:
                if distance([at[vertex]], line) < reach:
                    count += 1
                    if not groups[vertex] or groups[vertex] not in has[i]:
                        missing.append((name, f"vertex {vertex}", ways[i]))
    return count, missing


# ---- openTCS: points and paths are one vehicle's, and so are blocks and envelopes of the key of all vehicles ----


def opentcs(text):
    root = ET.fromstring(plain(text).encode())
    of = lambda node, tag: [child for child in node if child.tag.rsplit("}", 1)[-1] == tag]
    place = lambda node, x, y: (float(node.get(x)) / 1e3, float(node.get(y)) / 1e3)
    units = [(float(v.get("scaleX")), float(v.get("scaleY"))) for v in of(root, "visualLayout")] or [(50.0, 50.0)]
    # Names changed with version 6.
    new = int(root.get("version").split(".")[0]) >= 6
    own = ("positionX", "positionY") if new else ("xPosition", "yPosition")
    points = {p.get("name"): place(p, *own) for p in of(root, "point")}
    # Up to version 0.0.3 the visual layout has the curves.
    drawn = {
        element.get("visualizedObjectName"): {p.get("name"): p.get("value") for p in of(element, "property")}
        for visual in of(root, "visualLayout")
        for element in of(visual, "modelLayoutElement")
    }
    paths = {}
    for path in of(root, "path"):
        ends = (path.get("sourcePoint"), path.get("destinationPoint"))
        layout = (of(path, "pathLayout") or [ET.Element("none")])[0]
        control = [place(c, "x", "y") for c in of(layout, "controlPoint")]
        if path.get("name") in drawn:
            layout = ET.Element("none", connectionType=drawn[path.get("name")].get("CONN_TYPE", ""))
            pairs = [pair for pair in drawn[path.get("name")].get("CONTROL_POINTS", "").split(";") if pair]
            control = [tuple(float(x) / 1e3 for x in pair.split(",")) for pair in pairs]
        corners = [points[ends[0]], *((x * units[0][0], -y * units[0][1]) for x, y in control), points[ends[1]]]
        line = corners
        if layout.get("connectionType", "").startswith("BEZIER"):
            line = corners[:1]
            for k in range(0, len(corners) - 3, 3):
                for t in (n / CURVE for n in range(1, CURVE + 1)):
                    weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3)
                    line.append(tuple(sum(w * c[x] for w, c in zip(weights, corners[k : k + 4])) for x in (0, 1)))
        paths[path.get("name")] = (ends, line)
    single = "SINGLE_VEHICLE_ONLY"
    blocks = [{m.get("name") for m in of(b, "member")} for b in of(root, "block") if b.get("type", single) == single]
    keys = {vehicle.get("envelopeKey") for vehicle in of(root, "vehicle")}
    envelopes = {
        element.get("name"): [place(v, "x", "y") for v in of(envelope, "vertex")]
        for element in of(root, "point") + of(root, "path")
        for envelope in of(element, "vehicleEnvelope")
        if len(keys) == 1 and envelope.get("key") in keys
    }
    return points, paths, blocks, envelopes


def inside(p, corners):
    found = False
    for a, b in zip(corners[-1:] + corners, corners):
        if (a[1] > p[1]) != (b[1] > p[1]) and p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]):
            found = not found
    return found


def check_opentcs(written, radius):
    points, paths, blocks, envelopes = opentcs(written)
    count, missing, reach = 0, [], 2 * radius - DEEP_CURVE
    known = {}

    def meet(a, b):
        if (a, b) not in known:
            p, q = envelopes.get(a), envelopes.get(b)
            known[a, b] = bool(p and q) and (inside(p[0], q) or inside(q[0], p) or distance(p + p[:1], q + q[:1]) <= 0)
        return known[a, b]

    def excluded(own, other):
        with_blocks = [set(some) | {k for k, block in enumerate(blocks) if block & set(some)} for some in (own, other)]
        return bool(with_blocks[0] & with_blocks[1]) or any(meet(a, b) for a in own for b in other)

    names = list(paths)
    has = {name: (name, *paths[name][0]) for name in names}
    for i, j in touching([paths[name][1] for name in names], reach):
        count += 1
        if not excluded(has[names[i]], has[names[j]]):
            missing.append((names[i], names[j]))
    for point, at in points.items():
        for name in names:
            if distance([at], paths[name][1]) < reach:
                count += 1
                if not excluded((point,), has[name]):
                    missing.append((f"point {point}", name))
    return count, missing


# ---- of a layout in any of these formats: the zones of VDA 5050, and the project's own lock file ----


def lines(kind, text):
    """Edges by their names: level and line; and nodes."""
    if kind == "nav2":
        nodes, edges, _ = nav2(text)
        named, seen = {}, {}
        for edge, line, _ in edges:
            seen[edge] = seen.get(edge, 0) + 1
            named[str(edge) if seen[edge] == 1 else f"{edge}#{seen[edge]}"] = ("", line)
        return named, {str(node): ("", at) for node, at in nodes.items()}
    if kind == "rmf":
        named, nodes = {}, {}
        for level, at, _, ways in rmf(text):
            for a, b, _, k in reversed(ways):
                named[f"{level}/{k}"] = (level, [at[a], at[b]])
                nodes.update({f"{level}/{end}": (level, at[end]) for end in (a, b)})
        return named, nodes
    points, paths, _, _ = opentcs(text)
    return {name: ("", line) for name, (_, line) in paths.items()}, {name: ("", at) for name, at in points.items()}


def samples(line, step):
    """Lengths and points along a line, no farther apart than that."""
    found, before = [(0.0, line[0])], 0.0
    for a, b in zip(line, line[1:]):
        length = math.dist(a, b)
        count = max(1, math.ceil(length / step))
        found += [(before + length * k / count, tuple(a[x] + (b[x] - a[x]) * k / count for x in (0, 1))) for k in range(1, count + 1)]
        before += length
    return found


def near_samples(edges, radius, deep):
    """Names and samples of two edges of one level, of which two discs overlap there."""
    taken = {name: samples(line, radius / 2) for name, (_, line) in edges.items()}
    boxes = {name: box(line) for name, (_, line) in edges.items()}
    names, reach = list(edges), 2 * radius - deep
    for i, a in enumerate(names):
        for b in names[i:]:
            if edges[a][0] == edges[b][0] and not far(boxes[a], boxes[b], reach):
                yield from ((a, b, p, q) for p in taken[a] for q in taken[b] if math.dist(p[1], q[1]) < reach)


def check_vda5050(kind, layout, written, radius):
    sets = json.loads(plain(written))
    sets = [message["zoneSet"] for message in (sets if isinstance(sets, list) else [sets])]
    missing = [("one name twice", of["mapId"]) for of in sets if len({zone["zoneId"] for zone in of["zones"]}) < len(of["zones"])]
    zones = {of["mapId"]: [[(v["x"], v["y"]) for v in zone["vertices"]] for zone in of["zones"] if zone["zoneType"] == "RELEASE"] for of in sets}
    edges, nodes = lines(kind, layout)
    known = {}

    def entered(level, p):
        """Zones that a disc is in with any part of it."""
        if (level, p) not in known:
            there = zones.get(level) if len(zones) > 1 else next(iter(zones.values()))
            known[level, p] = {
                k for k, zone in enumerate(there or [])
                if not far([*p, *p], box(zone), radius) and (inside(p, zone) or distance([p], zone + zone[:1]) <= radius)
            }
        return known[level, p]

    count = 0
    for a, b, (_, p), (_, q) in near_samples(edges, radius, DEEP):
        count += 1
        if not entered(edges[a][0], p) & entered(edges[b][0], q):
            missing.append((a, b, p, q))
    missing += [(f"node {node}",) for node, (level, at) in nodes.items() if not entered(level, at)]
    return count, missing


def check_pcr(kind, layout, written, radius):
    root, locks, at_nodes = json.loads(written), {}, {}
    for entry in root["edges"]:
        for lock in entry["locks"]:
            locks.setdefault((str(entry["edge"]), str(lock["edge"])), []).append((lock["own"], lock["other"]))
    for entry in root["nodes"]:
        for lock in entry["locks"]:
            at_nodes.setdefault((str(entry["node"]), str(lock["edge"])), []).append(lock["other"])
    edges, nodes = lines(kind, layout)
    # Lengths of a curve are those along its arcs there, and along a polyline here.
    holds = lambda length, stretch: stretch[0] - 2 * DEEP_CURVE <= length <= stretch[1] + 2 * DEEP_CURVE
    count, missing = 0, []
    for a, b, (l, _), (s, _) in near_samples(edges, radius, 5 * DEEP_CURVE):
        count += 1
        for own, other, here, there in ((a, b, l, s), (b, a, s, l)):
            if not any(holds(here, x) and holds(there, y) for x, y in locks.get((own, other), [])):
                missing.append((own, other, here, there))
    for name, (level, line) in edges.items():
        for l, p in samples(line, radius / 3):
            for node, (floor, at) in nodes.items():
                if floor == level and math.dist(p, at) < 2 * radius - 5 * DEEP_CURVE:
                    count += 1
                    if not any(holds(l, y) for y in at_nodes.get((node, name), [])):
                        missing.append((f"node {node}", name, l))
    return count, missing


def check(target, kind, layout, written, radius):
    if target == "vda5050":
        return check_vda5050(kind, layout, written, radius)
    if target == "pcr":
        return check_pcr(kind, layout, written, radius)
    return {"nav2": check_nav2, "rmf": check_rmf, "opentcs": check_opentcs}[target](written, radius)


# ---- geometry: a written layout is the one before, with its edges cut ----


def ways(kind, text):
    """Nodes with their levels and places, and edges in the directions in which they may be travelled: name, ends, line."""
    if kind == "nav2":
        nodes, _, _ = nav2(text)
        found = []
        for feature in json.loads(plain(text))["features"]:
            own = feature["properties"]
            if feature["geometry"]["type"] != "Point":
                ends = (number(own["startid"]), number(own["endid"]))
                found.append((number(own["id"]), *ends, [nodes[end] for end in ends]))
        return {name: ("", at) for name, at in nodes.items()}, found
    if kind == "rmf":
        nodes, found = {}, []
        for level, at, _, lanes in rmf(text):
            nodes.update({(level, k): (level, place) for k, place in enumerate(at)})
            found += [((level, k), (level, a), (level, b), [at[a], at[b]]) for a, b, _, k in lanes]
        return nodes, found
    points, paths, _, _ = opentcs(text)
    back = {}
    for path in ET.fromstring(plain(text).encode()):
        back[path.get("name")] = float(path.get("maxReverseVelocity") or 0) > 0
    found = [(name, a, b, line) for name, ((a, b), line) in paths.items()]
    found += [(name, b, a, line[::-1]) for name, ((a, b), line) in paths.items() if back[name]]
    return {name: ("", at) for name, at in points.items()}, found


def along(line, p):
    """How far along a straight line a point is, and how far beside it."""
    (x, y), (u, v) = line[0], line[-1]
    long = math.hypot(u - x, v - y)
    dx, dy = (u - x) / long, (v - y) / long
    return (p[0] - x) * dx + (p[1] - y) * dy, abs((p[1] - y) * dx - (p[0] - x) * dy)


def moved(kind, before, after, most):
    """What is no longer where it was: nodes, edges that are neither as they were nor chains of parts that are no longer than `most`, and what was added."""
    nodes, edges = ways(kind, before)
    new_nodes, parts = ways(kind, after)
    off = 1.01e-3 if kind == "opentcs" else 1e-7
    faults = [f"node {name} is at {new_nodes.get(name)}, was at {at}" for name, at in nodes.items() if new_nodes.get(name) != at]
    left, passed = list(parts), set()
    for name, a, b, line in edges:
        same = [part for part in left if part[1:3] == (a, b) and part[3] == line]
        same.sort(key=lambda part: part[0] != name)
        if same:
            left.remove(same[0])
            continue
        at, done, straight = a, 0.0, len(line) == 2
        while straight and at != b:
            following = [
                part
                for part in left
                if part[1] == at and len(part[3]) == 2 and (part[2] == b or part[2] not in nodes)
                and along(line, new_nodes[part[2]][1])[1] <= off
                and done < along(line, new_nodes[part[2]][1])[0] <= math.dist(*line) + off
                and along(line, new_nodes[part[2]][1])[0] - done <= most + 2 * off
            ]
            if not following:
                break
            following.sort(key=lambda part: part[0] != name)
            left.remove(following[0])
            at = following[0][2]
            done = along(line, new_nodes[at][1])[0]
            passed.add(at)
        if at != b or not straight:
            faults.append(f"edge {name} from {a} to {b} is gone behind {at}")
    faults += [f"edge {part[:3]} was not there" for part in left]
    faults += [f"node {name} was not there" for name in new_nodes if name not in nodes and name not in passed]
    return faults


def stamp(target, text):
    """For which vehicle a file says that it was written."""
    if target in ("nav2", "rmf"):
        return of_yaml(text)["pcr_vehicle"]
    if target == "opentcs":
        root = ET.fromstring(plain(text).encode())
        said = [child.get("value") for child in root if child.tag == "property" and child.get("name") == "pcr:vehicle"]
        said += re.findall(r"<!-- pcr:vehicle (.*) -->", text)
        return json.loads(said[0])
    if target == "vda5050":
        sets = json.loads(plain(text))
        return json.loads((sets if isinstance(sets, list) else [sets])[0]["zoneSet"]["zoneSetDescriptor"])
    return json.loads(text)["written"]


def without_exclusions(kind, text):
    """All that a file says beside exclusions, for comparing what else has changed."""
    if kind == "nav2":
        root = json.loads(plain(text))
        root.pop("pcr_vehicle", None)
        for feature in root["features"]:
            own = feature["properties"]
            if isinstance(own.get("metadata"), dict):
                own["metadata"].pop("closed_edges", None)
            if not own.get("metadata"):
                own.pop("metadata", None)
        return root
    if kind == "rmf":
        root = of_yaml(text)
        root.pop("pcr_vehicle", None)
        for level in root["levels"].values():
            for element in (level.get("lanes") or []) + (level.get("vertices") or []):
                for more in (part for part in element if isinstance(part, dict)):
                    more.pop("mutex", None)
                    more.pop("bidirectional", None)
                while element and element[-1] in ({}, "", 0) and len(element) > 2:
                    element.pop()
        return root
    root = ET.fromstring(plain(text).encode())
    for element in list(root):
        if re.fullmatch(r"pcr-block-\d{4,}", element.get("name", "")) or element.get("name") == "pcr:vehicle":
            root.remove(element)
        if element.tag == "visualLayout":
            for drawn in list(element):
                if drawn.get("visualizedObjectName", "").startswith("pcr-block-"):
                    element.remove(drawn)
    for element in root.iter():
        element.attrib.pop("envelopeKey", None)
        element.tail = None
        element.text = element.text if (element.text or "").strip() else None
        for child in [child for child in element if child.tag.endswith("vehicleEnvelope")]:
            element.remove(child)
    return ET.canonicalize(ET.tostring(root, encoding="unicode"))


def changed(kind, before, after):
    """Whether anything else has changed; lanes and vertices that were added come last."""
    before, after = without_exclusions(kind, before), without_exclusions(kind, after)
    if kind == "rmf":
        for name, level in before["levels"].items():
            for what in ("lanes", "vertices"):
                if level.get(what):
                    after["levels"][name][what] = after["levels"][name][what][: len(level[what])]
    return before != after
