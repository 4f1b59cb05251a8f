"""What others compute with: a cluster of Dask, and frames of GeoPandas."""

import subprocess
import sys
import unittest
from pathlib import Path

import geopandas
import pcr
import shapely
from dask.distributed import Client, LocalCluster

TOP = Path(__file__).resolve().parents[3]
RECIPES = TOP / "bindings/python/recipes"
sys.path.insert(0, str(RECIPES))
from on_dask import colliding, crossing  # noqa: E402

COUNT = 2_050


def some_refused(number: int) -> str:
    return "{}" if number == 73 else crossing(number)


class Dask(unittest.TestCase):
    def test_a_cluster_says_what_one_process_says(self) -> None:
        alone = [number for number, found in enumerate(pcr.check_all(map(crossing, range(COUNT)))) if found]
        self.assertTrue(COUNT // 4 < len(alone) < COUNT)
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            answers = list(colliding(client, crossing, COUNT, 100))
            # The last batch is not a whole one.
            self.assertEqual((len(answers), sorted(sum(answers, []))), (21, alone))
            used = [info["pid"] for info in client.run(lambda dask_worker: {"pid": __import__("os").getpid()}).values()]
            self.assertEqual(len(set(used)), 2)
            with self.assertRaisesRegex(ValueError, "in the scenarios from 50 on: scenario 23: agents: missing"):
                list(colliding(client, some_refused, 100, 50))
        run = subprocess.run([sys.executable, RECIPES / "on_dask.py", str(COUNT), "2"], capture_output=True, text=True, check=True)
        self.assertEqual(run.stdout, f"{len(alone)} of {COUNT} scenarios have a conflict\n")


class Frames(unittest.TestCase):
    def test_regions_are_rows_with_their_shapes(self) -> None:
        fleet = pcr.Fleet.read(TOP / "tests/data/paper12.json")
        regions = fleet.regions()
        frame = regions.to_geopandas(40)
        self.assertIsInstance(frame, geopandas.GeoDataFrame)
        self.assertEqual(list(zip(frame["i"], frame["j"], frame["t_from"], frame["t_to"], frame["l_from"], frame["l_to"])), [(r.i, r.j, *r.t, *r.l) for r in regions])
        self.assertTrue(frame.geometry.is_valid.all() and (frame.geometry.area > 0).all())
        for shape, region in zip(frame.geometry, regions):
            self.assertEqual([list(part.exterior.coords)[:-1] for part in shape.geoms], [list(shapely.Polygon(ring).exterior.coords)[:-1] for ring in region.polygons(40)])
        # What a frame is for: who is in the way of agent 3 at 10 s, by an overlay instead of a loop.
        blocked = frame[(frame["i"] == 3) & frame.intersects(shapely.LineString([(10, 0), (10, 1e3)]))]
        self.assertEqual(sorted(blocked["j"]), sorted(j for _, j, lo, hi in fleet.map(3, 10, 1, 1)))
        self.assertTrue(len(blocked))

    def test_what_has_no_end_has_no_shape(self) -> None:
        agent = {"radius": 0.25, "v_max": 1, "a_max": 1}
        stands = {"id": 2, **agent, "start": {"x": 2, "y": 0, "heading": 0}, "path": []}
        frame = pcr.Fleet([{"id": 1, **agent, "start": {"x": 0, "y": 0, "heading": 0}, "path": [{"kind": "line", "length": 4}]}, stands]).regions().to_geopandas()
        self.assertEqual([(row.i, row.j, row.geometry is None) for row in frame.itertuples() if row.i == 1], [(1, 2, True)])
        empty = pcr.Fleet([]).regions().to_geopandas()
        self.assertEqual((len(empty), "t_from" in empty), (0, True))


if __name__ == "__main__":
    unittest.main()
