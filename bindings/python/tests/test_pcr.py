"""The package against the tool: the same bits, the same refusals; and its own errors."""

import copy
import json
import math
import os
import pickle
import subprocess
import sys
import tempfile
import threading
import types
import unittest
import warnings
from pathlib import Path
from typing import Any

import pcr

TOP = Path(__file__).resolve().parents[3]
TOOL = os.environ["PCR"]
TWELVE = TOP / "tests/data/paper12.json"
GRAPH = TOP / "tests/data/real/nav2/warehouse_graph.geojson"


AGENT = {"radius": 0.25, "v_max": 1.0, "a_max": 1.0, "path": [{"kind": "line", "length": 4}]}
CROSSING: list[dict[str, Any]] = [{"id": 1, "start": {"x": -2, "y": 0, "heading": 0}, **AGENT},
                                  {"id": 2, "start": {"x": 0, "y": -2, "heading": math.pi / 2}, **AGENT}]


def crossing(first: int, second: int) -> pcr.Fleet:
    return pcr.Fleet([dict(CROSSING[0], id=first), dict(CROSSING[1], id=second)])


def fleet_place(fleet: pcr.Fleet, number: int) -> int:
    return [agent["id"] for agent in fleet].index(number)


def tool(*arguments: Any) -> Any:
    run = subprocess.run([TOOL, *map(str, arguments), "--json", "-q"], capture_output=True, text=True, check=False)
    return json.loads(run.stdout)


class Tool(unittest.TestCase):
    def test_regions_are_those_of_the_tool_bit_for_bit(self) -> None:
        found = [(r.i, r.j, *r.t, *r.l, r.open_start, r.open_end) for r in pcr.Fleet.read(TWELVE).regions()]
        told = [(r["i"], r["j"], *r["t"], *r["l"], r["open_start"], r["open_end"]) for r in tool("regions", TWELVE)["regions"]]
        self.assertEqual(found, told)
        self.assertGreater(len(found), 100)

    def test_regions_are_open_where_the_other_agent_stands(self) -> None:
        across: dict[str, Any] = {**AGENT, "start": {"x": 0, "y": 0, "heading": math.pi / 2}}
        fleet = pcr.Fleet([CROSSING[0], {"id": 2, **across}])
        self.assertEqual([(r.i, r.j, r.open_start, r.open_end) for r in fleet.regions()], [(1, 2, True, False), (2, 1, False, False)])
        across["start"]["y"] = -4
        fleet = pcr.Fleet([CROSSING[0], {"id": 2, **across}])
        self.assertEqual([(r.i, r.j, r.open_start, r.open_end) for r in fleet.regions()], [(1, 2, False, True), (2, 1, False, False)])

    def test_conflicts_and_plans_are_those_of_the_tool(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        found = [[c.i, c.j, list(c.t), c.depth, list(c.l_i), list(c.l_j), c.touching] for c in fleet.conflicts()]
        self.assertEqual(found, [[c[k] for k in ("i", "j", "t", "depth", "l_i", "l_j", "touching")] for c in tool("check", TWELVE)["conflicts"]])
        plan = fleet.plan()
        self.assertEqual(plan.report["agents"], tool("plan", TWELVE)["agents"])
        assert plan.fleet is not None
        self.assertEqual([c for c in plan.fleet.conflicts() if not c.touching], [])
        # What the tool writes and reads again has the same bits.
        for method in ("delay", "speed"):
            with tempfile.TemporaryDirectory() as folder:
                written = Path(folder) / "plan.json"
                subprocess.run([TOOL, "plan", str(TWELVE), "--method", method, "-o", str(written), "-q"], check=True, stdout=subprocess.DEVNULL)
                planned = fleet.plan(method).fleet
                assert planned is not None
                self.assertEqual(planned, pcr.Fleet.read(written))
                self.assertEqual(planned.regions(), pcr.Fleet.read(written).regions())

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

    def test_fleets_of_every_format_are_read(self) -> None:
        real, small = TOP / "tests/data/real", TOP / "tests/data/small"
        files: list[tuple[str, Path, list[str], dict[str, Any]]] = [
            ("nav2", GRAPH, ["--route", "0:5", "--radius", "0.3"], {"routes": ["0:5"], "radius": 0.3}),
            ("lif", real / "lif/example_02.lif.json", ["--route", "N1:N2", "--radius", "0.3"], {"routes": ["N1:N2"], "radius": 0.3}),
            ("rmf", real / "rmf/hotel.building.yaml", ["--graph", "2", "--route", "L1/81:L1/80", "--radius", "0.3"],
             {"graph": 2, "routes": ["L1/81:L1/80"], "radius": 0.3}),
            ("opendrive", small / "track.xodr", ["--route", "1/start:2/end", "--radius", "0.3"], {"routes": ["1/start:2/end"], "radius": 0.3}),
            ("opentcs", real / "opentcs/Demo-01.xml", ["--route", "Point-0001:Point-0002", "--radius", "0.3"], {"routes": ["Point-0001:Point-0002"], "radius": 0.3}),
            ("ccbs", real / "ccbs/solved/sparse_01_n15_log.xml", [], {}),
            ("grid", small / "grid.path", [], {}),
            ("path", small / "points.path", ["--radius", "0.3", "--tolerance", "0.01", "--margin", "0.1"], {"radius": 0.3, "tolerance": 0.01, "margin": 0.1}),
            ("vda5050", small / "horizon.json", ["--fleet", str(small / "factsheet.json"), "--horizon", "--partial"],
             {"fleet": small / "factsheet.json", "horizon": True, "partial": True}),
        ]
        for form, file, options, named in files:
            with self.subTest(file.name), tempfile.TemporaryDirectory() as folder:
                made = Path(folder) / "fleet.json"
                run = subprocess.run([TOOL, "import", form, str(file), *options, "-o", str(made), "-q"], capture_output=True, text=True, check=False)
                self.assertEqual(run.returncode, 0, run.stderr)
                fleet = pcr.Fleet.read(file, **named)
                self.assertEqual(fleet.to_json(), pcr.Fleet.read(made).to_json())
                self.assertGreater(len(fleet), 0)
                self.assertEqual(fleet.warnings, json.loads(made.read_text()).get("warnings", []))

    def test_layouts_tell_their_warnings(self) -> None:
        # Two levels: with a graph named it can be read, and the rest is warned of.
        file = TOP / "tests/data/real/rmf/hotel.building.yaml"
        layout, told = pcr.Layout.read(file, graph=2, radius=0.3), tool("locks", file, "--graph", 2, "--radius", 0.3)
        self.assertEqual(layout.warnings, told["warnings"])
        self.assertEqual(len(layout.locks()), len(told["locks"]))
        layout, told = pcr.Layout.read(GRAPH, radius=0.3), tool("locks", GRAPH, "--radius", 0.3)
        self.assertEqual(layout.warnings, told["warnings"])

    def test_warnings_are_those_of_the_file_of_a_fleet(self) -> None:
        fleet = pcr.Fleet.read(GRAPH, routes=["0:5"], radius=0.3)
        self.assertGreater(len(fleet.warnings), 0)
        planned = fleet.plan().fleet
        assert planned is not None
        for same in (pcr.Fleet.from_json(fleet.to_json()), planned, copy.copy(fleet), pickle.loads(pickle.dumps(fleet))):
            self.assertEqual(same.warnings, fleet.warnings)
        # What is read otherwise for another vehicle than the layout was read for.
        file = TOP / "tests/data/real/lif/example_02.lif.json"
        layout, told = pcr.Layout.read(file, radius=0.3), tool("locks", file, "--radius", 0.3, "--delays", "--speed", 1.0, "--acceleration", 0.5)
        more = [text for text in told["warnings"] if text not in layout.warnings]
        self.assertGreater(len(more), 0)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            layout.delays(0.3, 1.0, acceleration=0.5)
        self.assertEqual([str(warning.message) for warning in caught], more)

    def test_layouts_are_read_again_in_any_folder(self) -> None:
        office = TOP / "tests/data/real/rmf"
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(office)
        layout = pcr.Layout.read("office.building.yaml", fleet="config/office_tinyRobot_config.yaml")
        locks, delays = layout.locks(0.3), layout.delays(0.3, 1.0)
        os.chdir(here)
        self.assertEqual((layout.locks(0.3), layout.delays(0.3, 1.0)), (locks, delays))
        self.assertGreater(len(locks), 0)

    def test_files_go_both_ways(self) -> None:
        twelve, data = pcr.Fleet.read(TWELVE), TOP / "tests/data"
        self.assertEqual(len(twelve), 12)
        # Profiles are fitted to their paths when they are read: once.
        faster = twelve.plan("speed").fleet
        assert faster is not None
        for fleet in (twelve, faster, pcr.Fleet.read(data / "real/ccbs/solved/sparse_01_n15_log.xml"), pcr.Fleet.read(data / "small/points.path", radius=0.3)):
            self.assertEqual(pcr.Fleet.from_json(fleet.to_json()), fleet)
            self.assertEqual(pickle.loads(pickle.dumps(fleet)), fleet)
            self.assertEqual(pcr.Fleet.from_json(fleet.to_json()).regions(), fleet.regions())


class Outlines(unittest.TestCase):
    CORNERS = ((0.6, 0.4), (-0.6, 0.4), (-0.6, -0.4), (0.6, -0.4))

    def lanes(self, apart: float, **more: Any) -> pcr.Fleet:
        polygon = [{"ahead": ahead, "left": left} for ahead, left in self.CORNERS]
        truck = {"footprint": {"polygon": polygon}, "v_max": 1.0, "a_max": 1.0, "path": [{"kind": "line", "length": 6}], **more}
        return pcr.Fleet([{"id": 1, "start": {"x": 0, "y": 0, "heading": 0}, **truck},
                          {"id": 2, "start": {"x": 6, "y": apart, "heading": math.pi}, **truck}])

    def test_trucks_pass_as_near_as_they_are_wide(self) -> None:
        free, meets = self.lanes(0.801), self.lanes(0.799)
        self.assertEqual((len(free.regions()), len(meets.regions())), (0, 2))
        self.assertEqual((free.conflicts(), len(meets.conflicts())), ([], 1))
        separation, _, radii = free.closest(1, 2)
        self.assertAlmostEqual(separation - radii, 0.001, 9)
        self.assertEqual([region.t for region in meets.regions()], [tuple(region["t"]) for region in meets.report()["regions"]])
        self.assertTrue(meets.map(1, 0.0, 0.1, 60))

    def test_several_bodies_are_told(self) -> None:
        loaded = self.lanes(0.9, loads=[{"segments": [1, 1], "radius": 0.9}])
        self.assertTrue(loaded.report()["regions"])
        with self.assertRaisesRegex(pcr.Error, "agent 1: it is concave or has loads"):
            loaded.regions()


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

    def test_instants_are_safe_unless_they_are_blocked(self) -> None:
        fleet = pcr.Fleet([CROSSING[0], {"id": 2, "start": {"x": 2, "y": 0, "heading": 0}, **AGENT, "path": []}])
        for time in (0.5, 2.0, 4.5):
            self.assertEqual(fleet.safe_intervals(1, 2.0, time), [(time, time)])
            self.assertEqual(fleet.safe_intervals(1, (0.0, 4.0), time), [])
        # The second one has no path: it is in the way of the first one's end.
        self.assertEqual(fleet.safe_intervals(2, 0.0, 0.0), [(0.0, 0.0)])
        self.assertEqual(fleet.safe_intervals(2, 0.0, 9.0), [])

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

    def test_files_that_cannot_be_read_are_errors_of_the_system(self) -> None:
        for read in (pcr.Fleet.read, pcr.Layout.read):
            with self.assertRaises(FileNotFoundError) as caught:
                read("no such file.json")
            self.assertEqual((caught.exception.filename, caught.exception.strerror), ("no such file.json", "No such file or directory"))
            with self.assertRaises(IsADirectoryError):
                read(str(TOP / "docs"))

    def test_plans_have_the_options_of_the_tool(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        for options, arguments in (({"objective": "makespan"}, ["--objective", "makespan"]), ({"priority": "longest"}, ["--priority", "longest"]),
                                   ({"priority": [7, 3]}, ["--priority", "7,3"]), ({"prove": True}, ["--prove"]),
                                   ({"leave_out": True}, ["--leave-out"]), ({"method": "speed", "priority": "crowded"}, ["--method", "speed", "--priority", "crowded"])):
            with self.subTest(options=options):
                self.assertEqual(fleet.plan(**options).report, tool("plan", TWELVE, *arguments))

    def test_fleets_are_sequences_of_agents(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        self.assertEqual(list(fleet), fleet.agents)
        self.assertEqual((len(fleet), fleet[0]["id"], fleet[-1]["id"]), (12, 1, 12))
        with self.assertRaises(IndexError):
            fleet[12]

    def test_collision_maps_are_those_of_the_slices(self) -> None:
        import numpy

        fleet = pcr.Fleet.read(TWELVE)
        times, lengths, blocked = fleet.collision_map(6, columns=50, rows=70)
        self.assertEqual(blocked.shape, (70, 50))
        for column in range(0, 50, 7):
            rows = [row for row in fleet.map(6, times[0], times[1] - times[0], 50) if row[0] == column]
            for at, length in enumerate(lengths):
                inside = [other for _, other, lo, hi in rows if lo <= length <= hi]
                self.assertEqual(blocked[at, column], min((fleet_place(fleet, other) for other in inside), default=-1))
        self.assertTrue(numpy.any(blocked >= 0))
        with self.assertRaises(pcr.Error):
            fleet.collision_map(99)
        with self.assertRaises(pcr.Error):
            fleet.collision_map(1, rows=1)

    def test_regions_and_agents_have_polygons(self) -> None:
        from shapely.geometry import Point, Polygon  # type: ignore[import-untyped]

        fleet = pcr.Fleet.read(TWELVE)
        for region in fleet.regions()[:40]:
            whole = [Polygon(points) for points in region.polygons(200)]
            for t, lo, hi in region.outline(7):
                for length in (0.9 * lo + 0.1 * hi, 0.1 * lo + 0.9 * hi):
                    self.assertTrue(any(polygon.distance(Point(t, length)) < 0.02 for polygon in whole), (region, t, length))
            self.assertTrue(all(region.t[0] <= x <= region.t[1] for polygon in whole for x, _ in polygon.exterior.coords))
        # One that leaves a place blocks it from the beginning: the polygon does not taper off there.
        leaving: dict[str, Any] = {**AGENT, "start": {"x": 0, "y": 0, "heading": math.pi / 2}}
        region = pcr.Fleet([CROSSING[0], {"id": 2, **leaving}]).regions()[0]
        self.assertTrue(region.open_start)
        (t, lo, hi), whole = region.outline(200)[0], [Polygon(points) for points in region.polygons(200)]
        self.assertTrue(any(polygon.distance(Point(region.t[0], lo + 0.05 * (hi - lo))) < 1e-3 for polygon in whole))
        crossing_docs = pcr.Fleet.read(TOP / "docs/forklift.json")
        bodies = crossing_docs.shapes(0.0)
        self.assertEqual([round(body.area, 3) for body in bodies], [0.96, 0.502])
        self.assertFalse(bodies[0].intersects(bodies[1]))
        conflict = crossing_docs.conflicts()[0]
        first, second = crossing_docs.shapes(sum(conflict.t) / 2)
        self.assertTrue(first.intersects(second))

    def test_many_scenarios_are_checked_at_once(self) -> None:
        fleets: list[Any] = [pcr.Fleet.read(TWELVE), crossing(1, 2), TWELVE.read_text()] * 20
        for threads in (None, 1, 3):
            found = pcr.check_all(fleets, threads=threads)
            self.assertEqual(found, [fleets[0].conflicts(), fleets[1].conflicts(), fleets[0].conflicts()] * 20)
        with self.assertRaisesRegex(pcr.ScenarioError, "scenario 2: .*radius") as caught:
            pcr.check_all([fleets[0], fleets[1], json.dumps({"agents": [dict(CROSSING[0], radius=-1)]})])
        self.assertEqual((caught.exception.agent, caught.exception.field), ("agent 1", "radius"))
        self.assertEqual(pcr.check_all([]), [])

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

    def test_arrays_outlive_their_fleets_and_cannot_be_written_to(self) -> None:
        import numpy

        fleet = pcr.Fleet.read(TWELVE)
        array, told = fleet.regions().array, [region.t for region in fleet.regions()]
        del fleet
        self.assertTrue(numpy.array_equal(array["t"], told))
        with self.assertRaises(ValueError):
            array["t"][0] = 0
        regions = pcr.Fleet.read(TWELVE).regions()
        self.assertTrue(numpy.array_equal(numpy.asarray(regions), array))
        with self.assertRaises(ValueError):
            numpy.asarray(regions, dtype=numpy.dtype(array.dtype.descr), copy=False)
        self.assertTrue(numpy.shares_memory(numpy.asarray(regions, dtype=array.dtype, copy=False), regions.array))
        writable = numpy.array(regions)
        writable["t"] = 0
        self.assertEqual([region.t for region in regions], told)
        self.assertEqual([array.dtype[name].kind for name in ("i", "j", "open_start", "open_end")], ["u", "u", "b", "b"])
        self.assertEqual(pcr.Fleet([]).regions().array.shape, (0,))

    def test_numbers_of_agents_are_exact(self) -> None:
        # Two that are one and the same number in floating point.
        first, second = 2**60 + 1, 2**60 + 2
        fleet = crossing(first, second)
        self.assertEqual([(r.i, r.j) for r in fleet.regions()], [(first, second), (second, first)])
        self.assertEqual(fleet.regions().array["i"].tolist(), [first, second])
        self.assertEqual({row[1] for row in fleet.map(first, 0.0, 0.25, 40)}, {second})
        self.assertEqual(len(fleet.regions()[0].outline(3)), 3)
        self.assertEqual([(c.i, c.j) for c in fleet.conflicts()], [(first, second)])
        with self.assertRaisesRegex(pcr.Error, f"{first} and {second} meet"):
            fleet.passings(first)

    def test_passings_are_those_of_both(self) -> None:
        plan = pcr.Fleet.read(TWELVE).plan().fleet
        assert plan is not None
        regions = plan.regions()
        found = {agent["id"]: plan.passings(agent["id"]) for agent in plan.agents}
        self.assertEqual(sum(map(len, found.values())), len(regions))
        for i, passings in found.items():
            for p in passings:
                self.assertEqual(p.i, i)
                self.assertIn((p.j, i, p.l_j, p.l, not p.first), found[p.j])
                self.assertTrue(any((r.i, r.j, r.l, r.l_j) == (i, p.j, p.l, p.l_j) for r in regions))
        # Whoever has to wait has a hold before the region; who goes first has not.
        holds = plan.holds([0.0] * 12)
        for agent, hold in zip(plan.agents, holds):
            waits = [p.l[0] for p in found[agent["id"]] if not p.first]
            self.assertEqual(math.isfinite(hold), bool(waits))
            self.assertTrue(all(hold <= begin for begin in waits))

    def test_fleets_are_values(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        for same in (pickle.loads(pickle.dumps(fleet)), copy.copy(fleet), copy.deepcopy(fleet), pcr.Fleet.read(TWELVE)):
            self.assertEqual(same, fleet)
            self.assertEqual(hash(same), hash(fleet))
            self.assertEqual(same.regions(), fleet.regions())
        self.assertNotEqual(fleet, pcr.Fleet([]))
        self.assertNotEqual(fleet, "fleet")
        region = fleet.regions()[5]
        for other in (pickle.loads(pickle.dumps(region)), copy.deepcopy(region)):
            self.assertEqual((other, other.outline(4)), (region, region.outline(4)))
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            for value in (fleet, fleet.regions(), region):
                self.assertEqual(pickle.loads(pickle.dumps(value, protocol)), value)
            self.assertEqual(pickle.loads(pickle.dumps(fleet.regions(), protocol))[5].outline(4), region.outline(4))
        with self.assertRaises(pcr.Error):
            region._replace(i=region.j).outline(4)

    def test_what_numpy_holds_is_taken(self) -> None:
        import numpy

        agents = [dict(agent, radius=numpy.float32(0.25), id=numpy.int64(agent["id"]), path=tuple(agent["path"])) for agent in CROSSING]
        fleet = pcr.Fleet(types.MappingProxyType(agent) for agent in agents)
        self.assertEqual(fleet, pcr.Fleet(CROSSING))
        told = fleet.safe_intervals(1, 2.0, (0.0, 9.0))
        self.assertEqual(len(told), 2)
        for length in (numpy.float32(2), numpy.int64(2), numpy.array(2.0), [2, 2], numpy.array([2.0, 2.0])):
            self.assertEqual(fleet.safe_intervals(numpy.uint8(1), length, numpy.array([0.0, 9.0])), told)
        later = pcr.Fleet([CROSSING[0], dict(CROSSING[1], t_start=5.0)])
        self.assertEqual(later.holds(numpy.zeros(2, dtype=numpy.float32)), later.holds([0.0, (0.0, 0.0)]))
        self.assertEqual(fleet.places(numpy.float32(1)), fleet.places(1))
        long = [dict(agent, radius=numpy.longdouble(0.25), start={name: numpy.longdouble(at) for name, at in agent["start"].items()}) for agent in CROSSING]
        self.assertEqual(pcr.Fleet(long), fleet)
        with self.assertRaises(TypeError):
            pcr.Fleet([dict(CROSSING[0], radius=numpy.clongdouble(0.25))])

    def test_who_sets_off_before_0_is_drawn_from_there(self) -> None:
        import matplotlib

        matplotlib.use("Agg")
        early = pcr.Fleet([dict(CROSSING[0], t_start=-8.0), CROSSING[1]])
        ax = early.plot()
        self.assertEqual(ax.lines[0].get_xdata()[0], -2.0)
        ax = early.plot(agent=1)
        self.assertEqual((ax.lines[0].get_xdata()[0], ax.lines[0].get_ydata()[0]), (-8.0, 0.0))
        ax = early.regions()[0].plot(ax)
        self.assertIs(pcr.Fleet([]).plot(ax), ax)
        # One that stands is in the way at all times.
        standing = pcr.Fleet([CROSSING[0], dict(CROSSING[1], start={"x": 0, "y": 0, "heading": 0}, path=[])])
        ax = standing.regions()[0].plot(pcr.Fleet([]).plot())
        self.assertEqual([round(bar.get_window_extent().width / ax.bbox.width, 6) for bar in ax.patches], [1.0])

    def test_pictures_have_smooth_outlines_numbers_and_units(self) -> None:
        import matplotlib

        matplotlib.use("Agg")
        # The discs cross at a right angle at 1 m/s: the region is a circle, whose edges are far shorter than a pixel is wide.
        ax = pcr.Fleet(CROSSING).plot(agent=1)
        points = ax.patches[0].get_xy()
        edges = [(a + (b - a) * part) - (2.5, 2.0) for a, b in zip(points, points[1:]) for part in (0.0, 0.5)]
        self.assertLess(max(abs(math.hypot(*at) - 0.5) for at in edges), 2e-4)
        self.assertEqual((ax.get_xlabel(), ax.get_ylabel()), ("time [s]", "travelled length of agent 1 [m]"))
        self.assertEqual([text.get_text() for text in ax.texts], ["2"])
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], ["2", "its motion"])
        # The whole legend is in the figure, and the outline ends with the axes.
        ax.figure.canvas.draw()
        self.assertLessEqual(ax.get_legend().get_window_extent().x1, ax.figure.bbox.x1)
        # Squares, side by side from the first contact on: what is blocked begins at once with all of its width, and it has corners.
        square = {"polygon": [{"ahead": x, "left": y} for x, y in ((0.2, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.2, -0.2))]}
        squares = pcr.Fleet([{**{name: value for name, value in agent.items() if name != "radius"}, "footprint": square} for agent in CROSSING])
        region = squares.regions()[0]
        ax = region.plot(pcr.Fleet([]).plot())
        points = ax.patches[0].get_xy()
        for at, length in ((region.t[0], region.l[0]), (region.t[0], region.l[1]), (region.t[1], region.l[0]), (region.t[1], region.l[1])):
            self.assertLess(min(math.hypot(t - at, l - length) for t, l in points), 1e-6)
        ax = squares.plot()
        self.assertEqual([len(patch.get_xy()) for patch in ax.patches], [5, 5])
        self.assertEqual((ax.get_xlabel(), ax.get_ylabel(), [text.get_text() for text in ax.texts]), ("x [m]", "y [m]", ["1", "2"]))

    def test_other_threads_run_meanwhile(self) -> None:
        agents = json.loads(TWELVE.read_text())["agents"]
        fleet = pcr.Fleet([dict(agent, id=100 * k + agent["id"]) for k in range(8) for agent in agents])
        begun, ended, between = threading.Event(), threading.Event(), False

        def compute() -> None:
            begun.set()
            fleet.conflicts()
            ended.set()

        # Nobody is made to give up the interpreter between two lines: who sees one of them done and not the other one ran
        # while the library computed.
        interval = sys.getswitchinterval()
        sys.setswitchinterval(1e6)
        try:
            for _ in range(1000):
                for event in (begun, ended):
                    event.clear()
                worker = threading.Thread(target=compute)
                worker.start()
                begun.wait()
                between = not ended.is_set()
                worker.join()
                if between:
                    break
        finally:
            sys.setswitchinterval(interval)
        self.assertTrue(between)

    def test_threads_get_the_same_answers(self) -> None:
        fleet = pcr.Fleet.read(TWELVE)
        told, wrong = (fleet.regions(), fleet.conflicts(), fleet.places(3.0)), []

        def ask() -> None:
            for _ in range(5):
                if (fleet.regions(), fleet.conflicts(), fleet.places(3.0)) != told:
                    wrong.append(1)

        threads = [threading.Thread(target=ask) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])


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
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((type(again), str(again), vars(again)), (pcr.ScenarioError, str(error), vars(error)))
        for field, wrong in (("radius", {"radius": math.nan}), ("v_max", {"v_max": math.inf}), ("start.x", {"start": {"x": -math.inf, "y": 0, "heading": 0}})):
            with self.assertRaises(pcr.ScenarioError) as caught:
                pcr.Fleet([dict(CROSSING[0], **wrong)])
            self.assertEqual((caught.exception.agent, caught.exception.field), ("agent 1", field))

    def test_what_cannot_be_answered_is_an_error(self) -> None:
        import numpy

        fleet = pcr.Fleet.read(TWELVE)
        for ask in (lambda: fleet.map(99, 0.0, 1.0, 5), lambda: fleet.map(1, math.nan, 1.0, 5), lambda: fleet.places(math.inf),
                    lambda: fleet.safe_intervals(1, math.nan, (0.0, 1.0)), lambda: fleet.safe_intervals(1, 1.0, (2.0, 1.0)),
                    lambda: fleet.safe_intervals(99, 1.0, (0.0, 1.0)), lambda: fleet.holds([0.0]), lambda: fleet.plan("fast"),
                    lambda: fleet.closest(1, 99), lambda: fleet.plan(objective="fast"), lambda: fleet.plan(priority="first"), lambda: fleet.plan(priority=[99]),
                    lambda: fleet.plan("speed", prove=True), lambda: fleet.plan(time_limit=-1.0), lambda: pcr.Layout.read(TWELVE),
                    lambda: pcr.Layout.read(GRAPH, radius=-1.0), lambda: pcr.Layout.read(GRAPH, radius=0.4).delays(0.4, 0.0),
                    lambda: pcr.Layout.read(GRAPH, radius=0.4).delays(0.4, math.nan), lambda: pcr.Layout.read(GRAPH).delays(0.4, 1.0, acceleration=-1.0),
                    lambda: pcr.Fleet.read(TWELVE, radius=0.5), lambda: pcr.Fleet.read(TWELVE, format="xml"), lambda: pcr.Layout.read(GRAPH, tolerance=2e6),
                    # What has no effect: edges have no corners, and a straight route has none.
                    lambda: pcr.Layout.read(GRAPH, corner_radius=1.0), lambda: pcr.Layout.read(GRAPH, routes=["0:1"]), lambda: pcr.Layout.read(GRAPH, tolerance=0.1),
                    lambda: pcr.Fleet.read(GRAPH, routes=["0:1"], corner_radius=1.0),
                    # What is nowhere on the path is not "free".
                    lambda: fleet.safe_intervals(1, -0.5, (0.0, 50.0)), lambda: fleet.safe_intervals(1, 99.0, (0.0, 50.0)),
                    lambda: fleet.closest(1, 1), lambda: fleet.map(-1, 0.0, 1.0, 5), lambda: fleet.map(1, 0.0, 1.0, -5), lambda: fleet.map(1, 0.0, 1.0, 2**70),
                    lambda: fleet.map(2**70, 0.0, 1.0, 5), lambda: fleet.report(slices=2**40), lambda: fleet.safe_intervals(1, (1.0, 2.0, 3.0), (0.0, 1.0)),
                    # A time that overflows is not one at which nothing is in the way.
                    lambda: fleet.map(1, 0, 1e308, 10), lambda: fleet.map(1, -1e308, -1e308, 2),
                    lambda: fleet.plot(columns=0), lambda: fleet.passings(1), lambda: fleet.passings(99)):
            with self.assertRaises(pcr.Error):
                ask()
        later = pcr.Fleet([CROSSING[0], dict(CROSSING[1], t_start=5.0)])
        for place in (-1, 100, (-2, -1), (4.1, 5.0)):
            with self.assertRaisesRegex(pcr.Error, "agent 2: .* is not on the path, 0 to 4"):
                later.holds([0, place])
        # Partly on the path, and at its ends.
        self.assertEqual(later.holds([(-0.1, 0.1), (-0.1, 0.0)]), later.holds([0, 0]))
        self.assertEqual(len(later.holds([4, (3.9, 4.1)])), 2)
        for value in ("12", "1", b"12", bytearray(b"12"), {1, 2}, frozenset((1, 2)), {1: 2, 2: 3}, {1: 2, 2: 3}.keys(), ["1", "2"], [b"1", 2]):
            with self.assertRaises(TypeError):
                later.safe_intervals(1, value, (0.0, 20.0))  # type: ignore[arg-type]
            with self.assertRaises(TypeError):
                later.safe_intervals(1, 1.0, value)  # type: ignore[arg-type]
            with self.assertRaises(TypeError):
                later.holds([0.0, value])  # type: ignore[list-item]
        # Keys of a mapping, even of none, are not its values; a set has no order.
        places: Any
        none: Any
        for places in ({1: 0.0, 2: 0.0}, {1: 0.0, 2: 0.0}.keys(), {0.0, 1.0}, frozenset((0.0, 1.0)), b"12", bytearray(b"12"), "12"):
            with self.assertRaisesRegex(TypeError, "places: .* is no list"):
                later.holds(places)
        self.assertEqual(later.holds({1: 0.0, 2: 0.0}.values()), later.holds(iter([0.0, 0.0])))
        for none in ({}, set(), "", b""):
            with self.assertRaisesRegex(TypeError, "agents: .* is no list"):
                pcr.Fleet(none)
            with self.assertRaisesRegex(TypeError, "routes: .* is no list"):
                pcr.Fleet.read(GRAPH, routes=none)
        with self.assertRaises(IndexError):
            fleet.regions()[10_000]
        order, sheet = TOP / "tests/data/small/horizon.json", TOP / "tests/data/small/factsheet.json"
        text: Any
        for text in ("no", "false", 0, 1, [], numpy.float64(1)):
            for option in ("horizon", "partial"):
                options: dict[str, Any] = {"horizon": True, "partial": True, option: text}
                with self.assertRaisesRegex(TypeError, option):
                    pcr.Fleet.read(order, fleet=sheet, **options)
        whole = pcr.Fleet.read(order, fleet=sheet, horizon=True, partial=True)
        true: Any = numpy.bool_(True)
        self.assertEqual(pcr.Fleet.read(order, fleet=sheet, horizon=true, partial=true), whole)
        for large in (lambda: fleet.places(10**400), lambda: fleet.map(1, 10**400, 1, 1), lambda: later.holds([0, 10**400]),
                      lambda: fleet.safe_intervals(1, 10**400, 0), lambda: pcr.Fleet.read(GRAPH, radius=10**400)):
            with self.assertRaises(pcr.Error):
                large()
        for none in ("0.4", True, numpy.bool_(True), 1 + 2j, numpy.complex128(1 + 2j), numpy.complex64(1)):
            for asked in (lambda none=none: fleet.places(none), lambda none=none: fleet.map(1, none, 1, 1), lambda none=none: later.holds([0, none]),
                          lambda none=none: pcr.Layout.read(GRAPH, radius=none), lambda none=none: pcr.Layout.read(GRAPH).delays(0.4, none)):
                with self.assertRaises(TypeError):
                    asked()
        for mistaken in (lambda: pcr.Fleet(None), lambda: pcr.Fleet([{1, 2}]), lambda: fleet.map("1", 0.0, 1.0, 5), lambda: fleet.places("1"),  # type: ignore[arg-type, list-item]
                         lambda: pcr.Layout.read(GRAPH, raduis=0.4), lambda: pcr.Layout.read(GRAPH, routes="1:2")):  # type: ignore[call-arg]
            with self.assertRaises(TypeError):
                mistaken()


if __name__ == "__main__":
    unittest.main()
