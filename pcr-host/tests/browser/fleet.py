"""A fleet that runs, for the live page: `pcr serve` in lines of JSON, and robots that go as far as they are told.

One has stopped on the way of another, one has arrived, one is off its path; two go to and fro for ever."""

import json
import math
import re
import subprocess
import threading
import time

ABILITIES = {"radius": 0.4, "speed": 1, "acceleration": 0.5}
LINE = lambda length: {"kind": "line", "length": length}
NORTH, WEST = math.pi / 2, math.pi
# Start, path, and how far along it a robot goes.
ROBOTS = {
    "east-1": ([-12, 0, 0], [LINE(24)], 6),
    "north-2": ([-6, -9, NORTH], [LINE(18)], 18),
    "bend-3": ([2, -9, NORTH], [LINE(4), {"kind": "arc", "radius": 3, "sweep": -NORTH}, LINE(4)], math.inf),
    "west-4": ([12, 3, WEST], [LINE(14)], math.inf),
    "there-5": ([8, -8, 0], [LINE(3)], 3),
    "a robot with a name of some length 6": ([-9, 8, 0], [LINE(6)], 2),
}
TO_AND_FRO = ("bend-3", "west-4")
STEP = 0.2


class Fleet:
    def __init__(self, tool):
        self.process = subprocess.Popen([tool, "serve", "--page", "0"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        # Where the page is, is in the log; what is in the log after that nobody reads.
        self.log = []
        while not (said := re.search(r"127\.0\.0\.1:\d+", self.log[-1] if self.log else "")):
            self.log.append(self.process.stderr.readline())
            if not self.log[-1]:
                raise SystemExit(f"pages: pcr serve has ended: {''.join(self.log)}")
        self.address = f"http://{said[0]}/"
        threading.Thread(target=self.process.stderr.read, daemon=True).start()
        self.robots = {name: {"path": 1, "at": 0.0, "origin": 0.0, "hold": 0.0, "length": 0.0, "trips": 0} for name in ROBOTS}
        self.lock, self.refused = threading.Lock(), []
        threading.Thread(target=self.listen, daemon=True).start()
        self.ask(verb="watch")
        pose = lambda start: dict(zip(("x", "y", "heading"), start))
        self.ask(verb="layout", name="hall", lanes=[{"start": pose(start), "path": path} for start, path, _ in ROBOTS.values()])
        for name, (start, _, _) in ROBOTS.items():
            self.ask(verb="add", robot=name, start=pose(start), abilities=ABILITIES)
        for name, (_, path, _) in ROBOTS.items():
            self.ask(verb="mission", robot=name, mission="order 0", path=path)
        self.goes = True
        self.driver = threading.Thread(target=self.drive)
        self.driver.start()

    def ask(self, **request):
        with self.lock:
            self.process.stdin.write(json.dumps(request) + "\n")
            self.process.stdin.flush()

    def listen(self):
        for line in self.process.stdout:
            told = json.loads(line)
            if "error" in told:
                self.refused.append(line)
            if told.get("event") not in ("admitted", "hold"):
                continue
            robot = self.robots[told["robot"]]
            with self.lock:
                if told["event"] == "admitted":
                    robot["at"] += robot["origin"] - told["origin"]
                    robot |= {key: told[key] for key in ("path", "origin", "length", "hold")}
                robot["hold"] = max(robot["hold"], told["hold"])

    def drive(self):
        off = next(reversed(ROBOTS))
        while self.goes:
            for name, (_, path, furthest) in ROBOTS.items():
                with self.lock:
                    robot = self.robots[name]
                    robot["at"] = min(robot["at"] + STEP, robot["hold"], furthest)
                    at, number = robot["at"], robot["path"]
                    arrived = number == 2 + robot["trips"] and at >= robot["length"] - 0.05
                if name == off and at == furthest:
                    self.ask(verb="off", robot=name, x=-5, y=6.5)
                else:
                    self.ask(verb="position", robot=name, path=number, at=[at, at])
                if name in TO_AND_FRO and arrived:
                    robot["trips"] += 1
                    back = [{**shape, "sweep": -shape["sweep"]} if "sweep" in shape else shape for shape in reversed(path)]
                    way = back if robot["trips"] % 2 else path
                    self.ask(verb="mission", robot=name, mission=f"order {robot['trips']}", path=[{"kind": "turn", "sweep": math.pi}, *way])
            time.sleep(STEP)

    def close(self):
        """Ends it, as standard input ends; what the supervisor has refused."""
        self.goes = False
        self.driver.join()
        self.process.stdin.close()
        status = self.process.wait(timeout=10)
        return self.refused + ([f"pcr serve ended with {status}"] if status else [])
