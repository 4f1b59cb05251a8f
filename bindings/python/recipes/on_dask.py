#!/usr/bin/env python3
"""on_dask.py [SCENARIOS] [PROCESSES]: checks so many scenarios (100,000) on a cluster of so many processes (one a core) with Dask.

A task is a range of numbers, not the scenarios: each process makes those itself, so that the cluster moves numbers only, and an answer
has no more than what is asked for. For another machine, give ``Client`` its scheduler's address, and install ``pcr`` there, too.
It needs ``pip install dask distributed``."""

import json
import math
import random
import sys
from collections.abc import Callable, Iterator

import pcr
from dask.distributed import Client, LocalCluster, as_completed

BATCH = 1000


def crossing(number: int) -> str:
    """A scenario as text, the same for the same number: five discs that cross a square from random places. Put your own here."""
    chance = random.Random(number)
    agents = []
    for k in range(5):
        angle, heading = chance.uniform(0, 2 * math.pi), chance.uniform(-0.5, 0.5)
        start = {"x": 10 * math.cos(angle), "y": 10 * math.sin(angle), "heading": angle + math.pi + heading}
        agents.append({"id": k, "radius": 0.4, "v_max": 1, "a_max": 0.5, "t_start": chance.uniform(0, 5), "start": start, "path": [{"kind": "line", "length": 20}]})
    return json.dumps({"agents": agents})


def check(make: Callable[[int], str], begin: int, end: int) -> list[int]:
    """The numbers of those scenarios of a range in which agents collide. One thread: the cluster has a process for each core."""
    try:
        found = pcr.check_all((make(number) for number in range(begin, end)), threads=1)
    except pcr.Error as error:
        # It tells the place in the range. As text, what it was made of need not travel.
        raise ValueError(f"in the scenarios from {begin} on: {error}") from None
    return [begin + place for place, conflicts in enumerate(found) if conflicts]


def colliding(client: Client, make: Callable[[int], str], scenarios: int, batch: int = BATCH) -> Iterator[list[int]]:
    """Answers of batches, as they come. A batch that fails raises here; one whose process dies is done again by Dask."""
    begins = range(0, scenarios, batch)
    tasks = client.map(check, [make] * len(begins), begins, [min(begin + batch, scenarios) for begin in begins], pure=False)
    for task in as_completed(tasks):
        yield task.result()
        # Or else the cluster keeps every answer until the end.
        task.release()


def main() -> None:
    scenarios = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    processes = int(sys.argv[2]) if len(sys.argv) > 2 else None
    with LocalCluster(n_workers=processes, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        count = sum(map(len, colliding(client, crossing, scenarios)))
    print(f"{count} of {scenarios} scenarios have a conflict")


# Processes of the cluster import this file.
if __name__ == "__main__":
    main()
