#!/usr/bin/env python3
"""check.py BINARY: the node pcr-ros2, with CycloneDDS on the other side. Publishes paths and fleet states, and compares every field of
what the node publishes with what these paths have."""
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import make_idl_struct
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from ros_types import Messages

MESSAGES = Messages(pathlib.Path(__file__).resolve().parents[2] / "pcr_msgs")
# How long an answer may take before the test gives up [s]; it takes a fraction of a second.
PATIENCE = 60
FLEET_ROBOT = {"name": "cart", "fleet": "tiny", "level": "L1", "outline": [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.3], [-0.5, 0.3]],
               "margin": 0.0}
SERVICE = "/east/route_server/DynamicEdgesScorer/adjust_edges"
CONFIG = {"frame": "map", "max_age": 600, "fleet_states": "/fleet_states", "route_graph": {"file": "graph.geojson", "stands": 0.1},
          "robots": [{"name": "east", "path": "/east/plan", "radius": 0.4, "margin": 0.1, "route_server": SERVICE},
                     {"name": "north", "path": "/north/plan", "radius": 0.3, "margin": 0.05}, FLEET_ROBOT]}
REACH = 0.4 + 0.1 + 0.3 + 0.05
UNKNOWN, CLEAR, CONFLICT = (MESSAGES.constant("pcr_msgs/msg/Pair", name) for name in ("UNKNOWN", "CLEAR", "CONFLICT"))
FREE, LIMITED = (MESSAGES.constant("pcr_msgs/msg/Authority", name) for name in ("FREE", "LIMITED"))
NO_POSE = {"position": {"x": 0.0, "y": 0.0, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}


def stamp(seconds):
    """A time since 1970, in seconds from BEGIN."""
    whole = math.floor(seconds)
    return {"sec": BEGIN + whole, "nanosec": round((seconds - whole) * 1e9)}


def pose(x, y, yaw=0.0):
    return {"position": {"x": float(x), "y": float(y), "z": 0.0},
            "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}}


def path(poses, frame="map"):
    """A path of times, positions and headings."""
    stamped = [{"header": {"stamp": stamp(at), "frame_id": frame}, "pose": pose(x, y, yaw)} for at, x, y, yaw in poses]
    return {"header": {"stamp": stamp(0), "frame_id": frame}, "poses": stamped}


# Nodes and edges: the robot of the fleet, 0.6 m wide, is at (0, 20).
NODES = [(-3, 20), (3, 20), (-3, 21), (3, 21), (-3, 20.79)]
LINES = {11: (0, 1), 65535: (2, 3), 12: (4, 1)}


def graph():
    """The route graph."""
    def feature(kind, coordinates, properties):
        return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}

    nodes = [feature("Point", node, {"id": k, "frame": "map"}) for k, node in enumerate(NODES)]
    edges = [feature("MultiLineString", [[NODES[a], NODES[b]]], {"id": k, "startid": a, "endid": b}) for k, (a, b) in LINES.items()]
    return {"type": "FeatureCollection", "features": nodes + edges}


def fleet(*robots, goes_on=True):
    """The state of a fleet."""
    location = {"t": stamp(0), "yaw": 0.0, "obey_approach_speed_limit": True, "approach_speed_limit": 0.5, "level_name": "L1", "index": 7}
    states = [{"name": name, "model": "small", "task_id": "t1", "seq": 3, "battery_percent": 80.0,
               "mode": {"mode": 2, "mode_request_id": 5, "performing_action": ""}, "location": location | {"x": x, "y": y},
               "path": [location | {"x": x, "y": y + 1.0, "t": stamp(9), "index": 8}] if goes_on else []} for name, x, y in robots]
    return {"name": "tiny", "robots": states}


class Side:
    """The other side: writers of what the node reads, readers of what it publishes."""

    def __init__(self, domain):
        self.participant = DomainParticipant(domain)
        reliable = [Policy.Reliability.Reliable(duration(seconds=10)), Policy.DataRepresentation(use_cdrv0_representation=True)]
        self.plain = Qos(*reliable, Policy.History.KeepLast(10))
        self.many = Qos(*reliable, Policy.History.KeepLast(100))
        self.paths = {robot["name"]: self.writer(robot["path"], MESSAGES["nav_msgs/msg/Path"])
                      for robot in CONFIG["robots"] if "path" in robot}
        self.fleets = self.writer(CONFIG["fleet_states"], MESSAGES["rmf_fleet_msgs/msg/FleetState"])
        request, self.answer = MESSAGES.service("nav2_msgs", "DynamicEdges")
        self.requests = DataReader(self.participant, Topic(self.participant, f"rq{SERVICE}Request", request, qos=self.plain), qos=self.plain)
        self.replies = DataWriter(self.participant, Topic(self.participant, f"rr{SERVICE}Reply", self.answer, qos=self.plain), qos=self.plain)
        self.read()

    def read(self):
        """Makes new readers."""
        kinds = [("conflicts", "pcr_msgs/msg/Conflicts"), ("authorities", "pcr_msgs/msg/Authorities"),
                 ("markers", "visualization_msgs/msg/MarkerArray")]
        self.readers = {name: DataReader(self.participant, Topic(self.participant, f"rt/pcr/{name}", MESSAGES[kind], qos=self.many),
                                         qos=self.many) for name, kind in kinds}
        self.answers = {}

    def writer(self, topic, kind):
        return DataWriter(self.participant, Topic(self.participant, f"rt{topic}", kind, qos=self.plain), qos=self.plain)

    def matched(self):
        writers = [*self.paths.values(), self.fleets]
        return all(writer.get_matched_subscriptions() for writer in [*writers, self.replies]) and all(
            reader.get_matched_publications() for reader in [*self.readers.values(), self.requests])

    def take(self):
        """The answers that are complete: conflicts, authorities and markers of one time."""
        for name, reader in self.readers.items():
            for message in reader.take(N=100):
                header = message.markers[0].header if name == "markers" else message.header
                self.answers.setdefault((header.stamp.sec, header.stamp.nanosec), {})[name] = message
        complete = sorted(at for at, parts in self.answers.items() if len(parts) == 3)
        return [self.answers.pop(at) for at in complete]

    def send(self, robot, message):
        self.paths[robot].write(MESSAGES.make("nav_msgs/msg/Path", message))

    def wait(self, what, is_it):
        """The first answer of which this is true."""
        until, last = time.monotonic() + PATIENCE, None
        while time.monotonic() < until:
            for answer in self.take():
                if is_it(answer):
                    return answer
                last = answer
            time.sleep(0.01)
        sys.exit(f"no answer: {what}; the last one is {last}")

    def asked(self, closed, opened):
        """The next request, which has to be this one."""
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            for request in self.requests.take(N=1):
                found = (list(request.closed_edges), list(request.opened_edges), list(request.adjust_edges))
                assert found == (closed, opened, []), found
                return request
            time.sleep(0.01)
        sys.exit(f"no request to close {closed} and open {opened}")

    def reply(self, request, success, number=0):
        """Answers a request, or another one."""
        self.replies.write(self.answer(client=request.client, number=request.number + number, success=success))

    def settled(self, again):
        """An answer to all that was sent, of which the last is `again`. The node reads before it takes its time: the first answer after the
        messages have arrived may miss one."""
        for writer in [*self.paths.values(), self.fleets]:
            assert writer.wait_for_acks(duration(seconds=PATIENCE)), "a message has not arrived"
        after = time.time_ns()
        for _ in range(2):
            again()
            answer = self.wait("in the end", lambda answer: nanoseconds(answer) > after)
            after = nanoseconds(answer)
        return answer


def nanoseconds(answer):
    at = answer["conflicts"].header.stamp
    return at.sec * 10 ** 9 + at.nanosec


def refusals(answer):
    return [(refusal.topic, refusal.robot, refusal.reason) for refusal in answer["conflicts"].refusals]


def states(answer):
    return [pair.state for pair in answer["conflicts"].pairs]


def of_crossing(answer):
    """What is expected of the paths of `crossing`, in closed form: at t one is at t - 4 and the other one at t - 4.5 of their ways."""
    half = math.sqrt(2 * REACH ** 2 - 0.25) / 2
    begin, end, deepest = 4.25 - half, 4.25 + half, 4.25
    header = {"stamp": vars_of(answer["conflicts"].header.stamp), "frame_id": "map"}
    at = [pose(0.25, 0.0), pose(0.0, -0.25, math.pi / 2)]
    pairs = [{"robot_a": a, "robot_b": b, "state": state, "reason": ""}
             for a, b, state in [("east", "north", CONFLICT), ("east", "cart", CLEAR), ("north", "cart", CLEAR)]]
    conflict = {"robot_a": "east", "robot_b": "north", "begin": stamp(begin), "end": stamp(end), "lasting": False,
                "begin_length_a": begin - 1, "end_length_a": end - 1, "begin_length_b": begin - 2, "end_length_b": end - 2,
                "deepest": stamp(deepest), "pose_a": at[0], "pose_b": at[1], "depth": REACH - math.sqrt(0.125), "touching": False}
    conflicts = {"header": header, "pairs": pairs, "conflicts": [conflict], "refusals": []}
    free = {"state": FREE, "waits_for": "", "reason": ""}
    robots = [{"robot": "east", "length": 6.0, "time": stamp(7), "pose": pose(3, 0)} | free,
              {"robot": "north", "state": LIMITED, "length": 2.5 - REACH, "time": stamp(2 + 2.5 - REACH), "pose": pose(0, -REACH, math.pi / 2),
               "waits_for": "east", "reason": ""},
              {"robot": "cart", "length": 1.0, "time": stamp(9), "pose": pose(0, 21)} | free]
    authorities = {"header": header, "robots": robots, "stuck": ""}
    nothing = {"r": 0.0, "g": 0.0, "b": 0.0, "a": 0.0}
    marker = {"header": header, "ns": "", "id": 0, "type": 0, "action": 3, "pose": NO_POSE, "scale": {"x": 0.0, "y": 0.0, "z": 0.0},
              "color": nothing, "lifetime": {"sec": 0, "nanosec": 0}, "frame_locked": False, "points": [], "colors": [],
              "texture_resource": "", "uv_coordinates": [], "text": "", "mesh_resource": "", "mesh_use_embedded_materials": False,
              "texture": {"header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}, "format": "", "data": []},
              "mesh_file": {"filename": "", "data": []}}
    kinds = {name: MESSAGES.constant("visualization_msgs/msg/Marker", name) for name in ("LINE_STRIP", "ADD", "DELETEALL")}
    markers = [marker | {"action": kinds["DELETEALL"]}]
    for number, radius in enumerate([0.4, 0.3]):
        turns = [math.tau * k / 32 for k in range(32)] + [0.0]
        points = [{"x": radius * math.cos(turn), "y": radius * math.sin(turn), "z": 0.0} for turn in turns]
        markers.append(marker | {"ns": "conflicts", "id": number, "type": kinds["LINE_STRIP"], "action": kinds["ADD"], "pose": at[number],
                                 "scale": {"x": 0.03, "y": 0.0, "z": 0.0}, "color": {"r": 1.0, "g": 0.1, "b": 0.1, "a": 1.0},
                                 "points": points})
    return {"conflicts": conflicts, "authorities": authorities, "markers": {"markers": markers}}


def vars_of(at):
    return {"sec": at.sec, "nanosec": at.nanosec}


EAST = [(1, -3, 0, 0), (7, 3, 0, 0)]
NORTH = [(2, 0, -2.5, math.pi / 2), (7, 0, 2.5, math.pi / 2)]
KINDS = {"conflicts": "pcr_msgs/msg/Conflicts", "authorities": "pcr_msgs/msg/Authorities", "markers": "visualization_msgs/msg/MarkerArray"}


def crossing(side):
    """Nothing is told before all paths have come; then every field."""
    first = side.wait("before any path", lambda _: True)
    missing = [("/east/plan", "east"), ("/north/plan", "north"), ("/fleet_states", "cart")]
    assert refusals(first) == [(*each, "no path has come yet") for each in missing], refusals(first)
    assert states(first) == [UNKNOWN] * 3, first
    side.send("east", path(EAST))
    side.send("north", path(NORTH))
    side.fleets.write(MESSAGES.make("rmf_fleet_msgs/msg/FleetState", fleet(("cart", 0.0, 20.0))))
    answer = side.wait("a crossing", lambda answer: not refusals(answer))
    for name, expected in of_crossing(answer).items():
        MESSAGES.compare(KINDS[name], answer[name], expected)
    # It is told again, and whoever is late gets nothing that is old.
    side.wait("a second time", lambda later: later["conflicts"].header.stamp != answer["conflicts"].header.stamp)
    side.read()
    late = side.wait("to a reader that is late", lambda _: True)
    for name, expected in of_crossing(late).items():
        MESSAGES.compare(KINDS[name], late[name], expected)


def refused(side):
    """Each message that cannot be used is told with its reason, and nothing is claimed about its robot."""
    def changed(change):
        message = path(NORTH)
        change(message)
        return message

    def set_in(message, keys, value):
        for key in keys[:-1]:
            message = message[key]
        message[keys[-1]] = value

    tilted = {"x": 1.0, "y": 0.0, "z": 0.0, "w": 0.0}
    bad = [("the path has no poses", changed(lambda m: m["poses"].clear())),
           ("pose 1: it is not later than the one before", changed(lambda m: m["poses"].reverse())),
           ("pose 1: a number is not finite", changed(lambda m: set_in(m, ["poses", 1, "pose", "position", "x"], math.nan))),
           ('the path is in frame "odom", not "map"', path(NORTH, "odom")),
           ("the path is more than 600 s old", changed(lambda m: set_in(m, ["header", "stamp"], stamp(-700)))),
           ("the path is of a time more than 600 s from now", changed(lambda m: set_in(m, ["header", "stamp"], stamp(1400)))),
           ("pose 0: its orientation is not a rotation about z", changed(lambda m: set_in(m, ["poses", 0, "pose", "orientation"], tilted)))]
    for reason, message in bad:
        side.send("north", message)
        answer = side.wait(reason, lambda answer: refusals(answer) == [("/north/plan", "north", reason)])
        told = [(pair.state, pair.reason) for pair in answer["conflicts"].pairs]
        assert told == [(UNKNOWN, f"north: {reason}"), (CLEAR, ""), (UNKNOWN, f"north: {reason}")], told
        assert answer["conflicts"].conflicts == [] and len(answer["markers"].markers) == 1, answer
        assert [(robot.state, robot.length, robot.reason) for robot in answer["authorities"].robots] == [(UNKNOWN, 0.0, f"north: {reason}")] * 3
        side.send("north", path(NORTH))
        side.wait(f"after: {reason}", lambda answer: states(answer) == [CONFLICT, CLEAR, CLEAR])
    stranger = fleet(("cart", 0.0, 20.0), ("ghost", 3.0, 20.0))
    side.fleets.write(MESSAGES.make("rmf_fleet_msgs/msg/FleetState", stranger))
    reason = 'robot "ghost" of fleet "tiny" is not configured'
    answer = side.wait(reason, lambda answer: refusals(answer) == [("/fleet_states", "", reason)])
    assert states(answer) == [CONFLICT, CLEAR, CLEAR]
    assert [(robot.state, robot.reason) for robot in answer["authorities"].robots] == [(UNKNOWN, reason)] * 3
    side.fleets.write(MESSAGES.make("rmf_fleet_msgs/msg/FleetState", fleet(("cart", 0.0, 20.0))))
    side.wait("without a stranger", lambda answer: not refusals(answer))


def unreadable(side):
    """A message of the same type name that ends too early."""
    short = make_idl_struct("Path_", "nav_msgs.msg.dds_.Path_", {"header": MESSAGES["std_msgs/msg/Header"]})
    participant = DomainParticipant(DOMAIN)
    writer = DataWriter(participant, Topic(participant, "rt/north/plan", short, qos=side.plain), qos=side.plain)
    until = time.monotonic() + PATIENCE
    while not writer.get_matched_subscriptions() and time.monotonic() < until:
        time.sleep(0.01)
    writer.write(short(header=MESSAGES.make("std_msgs/msg/Header", path(NORTH)["header"])))
    answer = side.wait("a short message", lambda answer: len(refusals(answer)) == 1)
    topic, robot, reason = refusals(answer)[0]
    assert (topic, robot) == ("/north/plan", "north") and reason.startswith("the message cannot be read: "), refusals(answer)
    side.send("north", path(NORTH))
    side.wait("after a short message", lambda answer: states(answer) == [CONFLICT, CLEAR, CLEAR])


def long_path(side):
    """A message that takes many packets."""
    poses = [(1 + k * 0.01, -30 + k * 0.01, 30 + math.sin(k * 0.01), 0) for k in range(6000)]
    side.send("east", path(poses))
    length = sum(math.dist(one[1:3], other[1:3]) for one, other in zip(poses, poses[1:]))
    answer = side.settled(lambda: side.send("north", path(NORTH)))
    assert states(answer) == [CLEAR] * 3, answer["conflicts"].pairs
    east = answer["authorities"].robots[0]
    assert east.state == FREE and abs(east.length - length) < 1e-6, (east, length)


def closed_edges(side):
    """A robot that stands closes the edges that another one could not drive, which is told until it is done; when it goes on, they are open."""
    def cart(**way):
        side.fleets.write(MESSAGES.make("rmf_fleet_msgs/msg/FleetState", fleet(("cart", 0.0, 20.0), **way)))

    cart(goes_on=False)
    first = side.asked([11, 12], [])
    # There is no answer, and then one that is no answer to this.
    second = side.asked([11, 12], [])
    assert second.client == first.client and second.number != first.number, (first, second)
    side.reply(second, True, number=1000)
    third = side.asked([11, 12], [])
    # It could not be done.
    side.reply(third, False)
    side.reply(side.asked([11, 12], []), True)
    # Again and again it is told, should the server have forgotten it.
    side.reply(side.asked([11, 12], []), True)
    cart()
    side.reply(side.asked([], [11, 12]), True)


def simulated(binary, file, side):
    """With `use_sim_time` nothing is told before there is a time, and then all of that time."""
    file.write_text(json.dumps(CONFIG | {"use_sim_time": True}))
    node = subprocess.Popen([binary, file], env=environment())
    try:
        side.read()
        latest = Qos(Policy.Reliability.BestEffort, Policy.DataRepresentation(use_cdrv0_representation=True), Policy.History.KeepLast(1))
        kind = MESSAGES["rosgraph_msgs/msg/Clock"]
        clock = DataWriter(side.participant, Topic(side.participant, "rt/clock", kind, qos=latest), qos=latest)
        until = time.monotonic() + PATIENCE
        while not (clock.get_matched_subscriptions() and side.matched()):
            if time.monotonic() > until or node.poll() is not None:
                sys.exit("the node with simulated time is not found")
            time.sleep(0.01)
        at = {"sec": 4000, "nanosec": 7}
        told = 0
        while told < 2:
            clock.write(MESSAGES.make("rosgraph_msgs/msg/Clock", {"clock": at}))
            for answer in side.take():
                assert nanoseconds(answer) == 4000 * 10 ** 9 + 7, answer
                told += 1
            assert time.monotonic() < until, "no answer with simulated time"
            time.sleep(0.05)
    finally:
        node.terminate()
        node.wait()


def place(poses, at):
    """Where a robot is, and how fast, from this time on."""
    for (t0, x0, y0, _), (t1, x1, y1, _) in zip(poses, poses[1:]):
        if t0 <= at < t1:
            speed = ((x1 - x0) / (t1 - t0), (y1 - y0) / (t1 - t0))
            return (x0 + speed[0] * (at - t0), y0 + speed[1] * (at - t0)), speed
    _, x, y, _ = poses[0] if at < poses[0][0] else poses[-1]
    return (x, y), (0.0, 0.0)


def contacts(a, b, since):
    """Begins and ends of all contacts of two discs, by the roots of a quadratic between any two times of their paths."""
    times = sorted({since} | {pose[0] for pose in a + b if pose[0] > since})
    found = []
    for begin, end in zip(times, times[1:]):
        (p, u), (q, v) = place(a, begin), place(b, begin)
        d, w = (p[0] - q[0], p[1] - q[1]), (u[0] - v[0], u[1] - v[1])
        square, mixed, free = w[0] ** 2 + w[1] ** 2, d[0] * w[0] + d[1] * w[1], d[0] ** 2 + d[1] ** 2 - REACH ** 2
        if square > 0:
            root = mixed ** 2 - square * free
            if root <= 0:
                continue
            span = [begin + (-mixed - math.sqrt(root)) / square, begin + (-mixed + math.sqrt(root)) / square]
        else:
            span = [begin, end] if free < 0 else [end, begin]
        lo, hi = max(span[0], begin), min(span[1], end)
        if lo < hi:
            if found and abs(found[-1][1] - lo) < 1e-9:
                found[-1][1] = hi
            else:
                found.append([lo, hi])
    return found


def random_paths(side):
    """The conflicts are those that the paths have."""
    randoms, counts = random.Random(1), {CLEAR: 0, CONFLICT: 0}
    for number in range(60):
        ways = []
        for _ in range(2):
            at, poses = randoms.uniform(100, 102), []
            for _ in range(randoms.randint(2, 6)):
                # In nanoseconds, as messages have it.
                poses.append((round(at, 9), randoms.uniform(-3, 3), randoms.uniform(-3, 3), randoms.uniform(-3, 3)))
                at += randoms.uniform(0.5, 4)
            ways.append(poses)
        side.send("east", path(ways[0]))
        side.send("north", path(ways[1]))
        answer = side.settled(lambda: side.send("north", path(ways[1])))
        expected = contacts(*ways, 99)
        last = max(way[-1][0] for way in ways)
        # Who stands together before both set off does so from the time of the answer on.
        found = [(max(c.begin.sec - BEGIN + c.begin.nanosec * 1e-9, 99), c.end.sec - BEGIN + c.end.nanosec * 1e-9)
                 for c in answer["conflicts"].conflicts]
        assert len(found) == len(expected), (number, found, expected, ways)
        for one, other in zip(found, expected):
            assert all(abs(a - b) < 1e-6 for a, b in zip(one, other)), (number, found, expected, ways)
        state = CONFLICT if expected else CLEAR
        assert states(answer)[0] == state, answer
        counts[state] += 1
        for conflict, (_, end) in zip(answer["conflicts"].conflicts, expected):
            (x, y), _ = place(ways[0], conflict.deepest.sec - BEGIN + conflict.deepest.nanosec * 1e-9)
            assert math.dist((x, y), (conflict.pose_a.position.x, conflict.pose_a.position.y)) < 1e-6
            assert conflict.lasting == (abs(end - last) < 1e-9), (conflict, last)
    assert min(counts.values()) > 8, counts
    return sum(counts.values())


def environment(**changed):
    """That of the node."""
    return os.environ | {"ROS_DOMAIN_ID": str(DOMAIN), "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"} | changed


def starts(binary, folder):
    """What is wrong with a command or a configuration is told."""
    file = folder / "bad.json"
    for text, problem in [('{"frame": "map", "max_age": 2, "robots": []}', "there are not two robots"), ("{", "EOF")]:
        file.write_text(text)
        found = subprocess.run([binary, file], capture_output=True, text=True, timeout=PATIENCE)
        assert found.returncode == 1 and problem in found.stderr, found
    found = subprocess.run([binary], capture_output=True, text=True, timeout=PATIENCE)
    assert found.returncode == 2 and "CONFIGURATION.json" in found.stderr, found
    file.write_text(json.dumps(CONFIG))
    found = subprocess.run([binary, file], capture_output=True, text=True, timeout=PATIENCE)
    assert found.returncode == 1 and "graph.geojson: " in found.stderr, found
    (folder / "graph.geojson").write_text(json.dumps(graph()))
    found = subprocess.run([binary, file], capture_output=True, text=True, timeout=PATIENCE, env=environment(RMW_IMPLEMENTATION="rmw_other"))
    assert found.returncode == 1 and '"rmw_other" answers requests is not known' in found.stderr, found
    found = subprocess.run([binary, file], capture_output=True, text=True, timeout=PATIENCE, env=environment(ROS_DOMAIN_ID="many"))
    assert found.returncode == 1 and 'ROS_DOMAIN_ID: "many" is not a domain' in found.stderr, found


# One that no other program on this network is likely to use.
DOMAIN = random.SystemRandom().randint(1, 200)
BEGIN = int(time.time()) + 60


def main():
    binary = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        starts(binary, folder)
        file = folder / "robots.json"
        file.write_text(json.dumps(CONFIG))
        with open(folder / "log", "w") as log:
            node = subprocess.Popen([binary, file], env=environment(), stderr=log)
        try:
            side = Side(DOMAIN)
            until = time.monotonic() + PATIENCE
            while not side.matched():
                if time.monotonic() > until or node.poll() is not None:
                    sys.exit(f"the node is not found: {(folder / 'log').read_text()}")
                time.sleep(0.01)
            crossing(side)
            refused(side)
            unreadable(side)
            closed_edges(side)
            long_path(side)
            number = random_paths(side)
            assert node.poll() is None
        finally:
            node.terminate()
            node.wait()
        log = (folder / "log").read_text()
        assert f"pcr-ros2: {SERVICE}: no answer; the server is asked until there is one" in log.splitlines(), log
        assert f"pcr-ros2: {SERVICE}: the server says that it could not; it is asked again" in log.splitlines(), log
        simulated(binary, file, side)
        assert 'pcr-ros2: north: the path is in frame "odom", not "map"' in log.splitlines(), log
    print(f"pcr-ros2 and CycloneDDS, domain {DOMAIN}: every field of a crossing, refusals, edges closed and opened, simulated time, {number} random paths")


main()
