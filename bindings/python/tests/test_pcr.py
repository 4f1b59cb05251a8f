"""The package against the tool: the same bits, the same refusals; and its own errors."""

import json
import math
import os
import subprocess
import threading
import unittest
from pathlib import Path
from typing import Any

import pcr

TOP = Path(__file__).resolve().parents[3]
TOOL = os.environ["PCR"]
TWELVE = TOP / "tests/data/paper12.json"
GRAPH = TOP / "tests/data/real/nav2/warehouse_graph.geojson"


def tool(*arguments: Any) -> Any:
    run = subprocess.run([TOOL, *map(str, arguments), "--json", "-q"], capture_output=True, text=True, check=False)
    return json.loads(run.stdout)


class Tool(unittest.TestCase):
    def test_regions_are_those_of_the_tool_bit_for_bit(self) -> None:
        found = [(r.i, r.j, *r.t, *r.l, r.open_start, r.open_end) for r in pcr.Fleet.read(TWELVE).regions()]
        told = [(r["i"], r["j"], *r["t"], *r["l"], r["open_start"], r["open_end"]) for r in tool("regions", TWELVE)["regions"]]
        self.assertEqual(found, told)
        self.assertGreater(len(found), 100)

    def test_conflicts_and_plans_are_those_of_the_tool(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        found = [[c.i, c.j, list(c.t), c.depth, list(c.l_i), list(c.l_j), c.touching] for c in fleet.conflicts()]
        self.assertEqual(found, [[c[k] for k in ("i", "j", "t", "depth", "l_i", "l_j", "touching")] for c in tool("check", TWELVE)["conflicts"]])
        plan = fleet.plan()
        self.assertEqual(plan.report["agents"], tool("plan", TWELVE)["agents"])
        assert plan.fleet is not None
        self.assertEqual([c for c in plan.fleet.conflicts() if not c.touching], [])

    def test_locks_are_those_of_the_tool(self) -> None:
        found = [[lock.a, lock.b, list(lock.a_length), list(lock.b_length)] for lock in pcr.Layout.read(GRAPH, radius=0.4).locks()]
        told = tool("locks", GRAPH, "--radius", 0.4)["locks"]
        self.assertEqual(found, [[lock[k] for k in ("a", "b", "a_length", "b_length")] for lock in told])

    def test_delays_are_those_of_the_tool(self) -> None:
        # Straight at constant speed, from rest to rest, and curves; the limits of the nav2 graph are shares of the speed.
        lif = TOP / "tests/data/real/lif/example_02.lif.json"
        for file, radius, speed, acceleration in ((GRAPH, 0.4, 1.5, None), (GRAPH, 0.4, 0.8, 0.5), (lif, 0.3, 1.0, None)):
            with self.subTest(file=file.name, acceleration=acceleration):
                more = () if acceleration is None else ("--acceleration", acceleration)
                told = tool("locks", file, "--radius", radius, "--delays", "--speed", speed, *more)["delays"]
                rows = [[d["a"], d["b"], d["delay"], d.get("a_backward", False), d.get("b_backward", False)] for d in told]
                # Read for another vehicle.
                found = pcr.Layout.read(file, radius=0.1).delays(radius, speed, acceleration=acceleration)
                self.assertEqual([[d.a, d.b, list(d.delay), d.a_backward, d.b_backward] for d in found], rows)
                self.assertGreater(len(found), 100 if file == GRAPH else 2)
                own = pcr.Layout.read(file, radius=radius).delays(None, speed, acceleration=acceleration)
                self.assertEqual(own, found)

    def test_layouts_of_every_format_are_read(self) -> None:
        real = TOP / "tests/data/real"
        files = [GRAPH, real / "lif/example_02.lif.json", real / "rmf/office.building.yaml", real / "opendrive/Town01.planview.xodr",
                 real / "opentcs/Demo-01.xml", real / "ccbs/sparse_map.xml"]
        for file in files:
            with self.subTest(file.name):
                told = tool("locks", file, "--radius", 0.3)["locks"]
                found = [[lock.a, lock.b, list(lock.a_length), list(lock.b_length)] for lock in pcr.Layout.read(file, radius=0.3).locks()]
                self.assertEqual(found, [[lock[k] for k in ("a", "b", "a_length", "b_length")] for lock in told])
                self.assertGreater(len(found), 0)
        wide = pcr.Layout.read(GRAPH, radius=0.4).locks()
        self.assertEqual(pcr.Layout.read(GRAPH, radius=0.1).locks(0.4), wide)
        self.assertLess(len(pcr.Layout.read(GRAPH, radius=0.4).locks(0.1)), len(wide))

    def test_files_go_both_ways(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        self.assertEqual(pcr.Fleet.from_json(fleet.to_json()).to_json(), fleet.to_json())
        self.assertEqual(len(fleet), 12)


class Answers(unittest.TestCase):
    def test_maps_are_slices_of_regions(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        regions = [region for region in fleet.regions() if region.i == 3]
        rows = fleet.map(3, 0.0, 0.1, 300)
        self.assertGreater(len(rows), 100)
        for place, other, lo, hi in rows:
            self.assertTrue(any(r.j == other and r.t[0] <= place * 0.1 <= r.t[1] and r.l[0] - 1e-9 <= lo <= hi <= r.l[1] + 1e-9 for r in regions))

    def test_outlines_are_slices(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        for region in list(fleet.regions())[::7]:
            rows = region.outline(5)
            self.assertGreaterEqual(len(rows), 5)
            inner = [region.t[0] + (region.t[1] - region.t[0]) * (k / 6) for k in range(1, 6)]
            self.assertEqual(sorted({t for t, _, _ in rows}), inner)
            for t, lo, hi in rows:
                self.assertTrue(region.l[0] - 1e-9 <= lo <= hi <= region.l[1] + 1e-9)
                self.assertTrue(any(j == region.j and a <= lo + 1e-9 and hi <= b + 1e-9 for _, j, a, b in fleet.map(region.i, t, 1.0, 1)))
        with self.assertRaises(pcr.Error):
            fleet.regions()[0].outline(-1)

    def test_safe_intervals_leave_out_conflicts(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        conflict = fleet.conflicts()[0]
        middle = sum(conflict.l_i) / 2
        for lo, hi in fleet.safe_intervals(conflict.i, middle, (0.0, 60.0)):
            self.assertLess(lo, hi)
        distance, _, radii = fleet.closest(conflict.i, conflict.j)
        self.assertLess(distance, radii)

    def test_holds_keep_the_order_of_the_plan(self) -> None:
        plan = pcr.Fleet.read(TWELVE).plan().fleet
        assert plan is not None
        holds = plan.holds([0.0] * 12)
        self.assertTrue(any(math.isfinite(hold) for hold in holds))
        # Everybody may go on as planned, at any time.
        for time in range(0, 40):
            lengths = [place[3] for place in plan.places(float(time))]
            self.assertTrue(all(length <= hold for length, hold in zip(lengths, plan.holds(list(lengths)))))
        with self.assertRaisesRegex(pcr.Error, "meet"):
            pcr.Fleet.read(TWELVE).holds([0.0] * 12)

    def test_arrays(self) -> None:
        try:
            import numpy
        except ModuleNotFoundError as missing:
            self.fail(f"the check needs NumPy: {missing}")
        regions = pcr.Fleet.read(TWELVE).regions()
        array = regions.array
        self.assertEqual(array.shape, (len(regions),))
        self.assertTrue(numpy.array_equal(array["t"], [region.t for region in regions]))
        self.assertTrue(numpy.array_equal(array["i"], [region.i for region in regions]))

    def test_other_threads_run_meanwhile(self) -> None:
        agents = json.loads(TWELVE.read_text())["agents"]
        copies = [dict(agent, id=100 * k + agent["id"]) for k in range(8) for agent in agents]
        fleet, ticks, done = pcr.Fleet(copies), 0, threading.Event()

        def compute() -> None:
            fleet.conflicts()
            done.set()

        worker = threading.Thread(target=compute)
        worker.start()
        while not done.is_set():
            ticks += 1
        worker.join()
        self.assertGreater(ticks, 0)


class Refusals(unittest.TestCase):
    def test_scenarios_say_where(self) -> None:
        agent = {"id": 7, "radius": 0.3, "v_max": 1, "a_max": 1, "start": {"x": 0, "y": 0, "heading": 0},
                 "path": [{"kind": "line", "length": 1}, {"kind": "arc", "radius": -2, "sweep": 1}]}
        with self.assertRaises(pcr.ScenarioError) as caught:
            pcr.Fleet([agent])
        error = caught.exception
        self.assertEqual((error.agent, error.segment, error.field), ("agent 7", "segment 2", "radius"))
        self.assertIn("allowed", str(error))
        self.assertIsInstance(error, ValueError)

    def test_what_cannot_be_answered_is_an_error(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        for ask in (lambda: fleet.map(99, 0.0, 1.0, 5), lambda: fleet.map(1, math.nan, 1.0, 5), lambda: fleet.places(math.inf),
                    lambda: fleet.safe_intervals(1, math.nan, (0.0, 1.0)), lambda: fleet.safe_intervals(1, 1.0, (2.0, 1.0)),
                    lambda: fleet.safe_intervals(99, 1.0, (0.0, 1.0)), lambda: fleet.holds([0.0]), lambda: fleet.plan("fast"),
                    lambda: fleet.closest(1, 99), lambda: pcr.Fleet.read("no such file"), lambda: pcr.Layout.read(TWELVE),
                    lambda: pcr.Layout.read(GRAPH, radius=-1.0), lambda: pcr.Layout.read(GRAPH, radius=0.4).delays(0.4, 0.0),
                    lambda: pcr.Layout.read(GRAPH, radius=0.4).delays(0.4, math.nan), lambda: pcr.Layout.read(GRAPH).delays(0.4, 1.0, acceleration=-1.0),
                    lambda: pcr.Fleet.read(TWELVE, radius=0.5)):
            with self.assertRaises(pcr.Error):
                ask()
        with self.assertRaises(IndexError):
            fleet.regions()[10_000]


if __name__ == "__main__":
    unittest.main()
