"""Exact collision regions of discs that move on lines and arcs: will robots collide, where, when, and when may each start?

Units are metres, seconds and radians; left turns are positive. The data of a fleet are those of the files of the tool ``pcr``:

>>> fleet = Fleet([
...     {"id": 1, "radius": 0.25, "v_max": 1.0, "a_max": 1.0, "start": {"x": -2, "y": 0, "heading": 0},
...      "path": [{"kind": "line", "length": 4}]},
...     {"id": 2, "radius": 0.25, "v_max": 1.0, "a_max": 1.0, "start": {"x": 0, "y": -2, "heading": 1.5707963267948966},
...      "path": [{"kind": "line", "length": 4}]},
... ])
>>> region = fleet.regions()[0]
>>> region.i, region.j, [round(t, 3) for t in region.t], [round(l, 3) for l in region.l]
(1, 2, [2.0, 3.0], [1.5, 2.5])
>>> len(fleet.conflicts()), len(fleet.plan().fleet.conflicts())
(1, 0)

If a question cannot be answered, an :class:`Error` is raised; an empty answer always means that there is nothing. Other threads can run
during a computation.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, NamedTuple, Optional, Union, overload

from . import _pcr
from ._options import Options
from ._pcr import Error

__all__ = ["Conflict", "Delay", "Error", "Fleet", "Layout", "Lock", "Plan", "Region", "Regions", "ScenarioError"]
__version__ = _pcr.version

Path = Union[str, PathLike[str]]
Span = tuple[float, float]


class ScenarioError(Error):
    """A scenario was refused. The attributes say where the fault is.

    >>> try:
    ...     Fleet.from_json('{"agents": [{"id": 4, "radius": -1}]}')
    ... except ScenarioError as error:
    ...     error.agent, error.field, error.line
    ('agent 4', 'radius', 1)
    """

    def __init__(self, message: str, line: int, agent: Optional[str], part: Optional[str], field: Optional[str]) -> None:
        super().__init__(message)
        #: Line of the text, from 1.
        self.line = line
        #: For example ``"agent 7"``.
        self.agent = agent
        #: For example ``"segment 2"``, counted from 1.
        self.segment = part
        #: For example ``"radius"``.
        self.field = field


def _read(make: Any, *arguments: Any) -> Any:
    """Calls ``make``. An error with five parts is about a scenario."""
    try:
        return make(*arguments)
    except Error as error:
        if len(error.args) == 5:
            raise ScenarioError(*error.args) from None
        raise


class _Ranges(NamedTuple):
    i: int
    j: int
    t: Span
    l: Span
    l_j: Span
    #: Whether it reaches the start of the path, where ``i`` stands before it sets off, or the end.
    open_start: bool
    open_end: bool


class Region(_Ranges):
    """Where and when agent ``i`` would touch agent ``j``: times [s], lengths of ``i`` and of ``j`` along their paths [m].

    The region lies within these intervals; :meth:`outline` gives its shape.
    """

    _fleet: _pcr.Fleet

    def outline(self, n: int) -> list[tuple[float, float, float]]:
        """The lengths inside the region at ``n`` evenly spaced times: time, from, to. A time is repeated if the region covers more than one
        interval of lengths then.

        >>> path = [{"kind": "line", "length": 4}]
        >>> east, north = {"x": -2, "y": 0, "heading": 0}, {"x": 0, "y": -2, "heading": math.pi / 2}
        >>> fleet = Fleet([{"id": k, "radius": 0.25, "v_max": 1, "a_max": 1, "start": start, "path": path} for k, start in ((1, east), (2, north))])
        >>> [[round(number, 3) for number in row] for row in fleet.regions()[0].outline(3)]
        [[2.25, 1.567, 2.433], [2.5, 1.5, 2.5], [2.75, 1.567, 2.433]]
        """
        if n < 0:
            raise Error(f"{n} times")
        answer = json.loads(self._fleet.regions_json(n, self.i))
        rows = [*answer["regions"], *answer.get("margin_regions", [])]
        own = next(row for row in rows if (row["j"], row["t"], row["l"]) == (self.j, list(self.t), list(self.l)))
        return [(slice["t"], lo, hi) for slice in own["slices"] for lo, hi in slice["l"]]

    def plot(self, ax: Any, *, columns: int = 60, **style: Any) -> Any:
        """Draws the region on matplotlib's ``ax``, and returns ``ax``: time to the right, length upwards. ``style`` is passed to ``ax.bar``."""
        rows = self.outline(columns)
        width = (self.t[1] - self.t[0]) / (columns + 1)
        ax.bar([t for t, _, _ in rows], [hi - lo for _, lo, hi in rows], bottom=[lo for _, lo, _ in rows], width=width, **style)
        return ax


class Conflict(NamedTuple):
    """Two discs in contact: when [s], how deep [m], and where on both paths [m]."""

    i: int
    j: int
    t: Span
    depth: float
    l_i: Span
    l_j: Span
    #: Whether the discs only touch, within rounding.
    touching: bool


class Lock(NamedTuple):
    """Two edges of a layout, and the lengths [m] of each on which a vehicle can touch a vehicle on the other edge."""

    a: Any
    b: Any
    a_length: Span
    b_length: Span


class Delay(NamedTuple):
    """Forbidden delays [s]: a vehicle that sets off on edge ``b`` this much later than another one on edge ``a`` would touch it."""

    a: Any
    b: Any
    #: Negative delays are earlier.
    delay: Span
    #: Whether the vehicle drives ``a`` from its end to its start.
    a_backward: bool
    b_backward: bool


#: Fields of an array of regions, for ``numpy.dtype``.
REGION = [("i", "<f8"), ("j", "<f8"), ("t", "<f8", (2,)), ("l", "<f8", (2,)), ("l_j", "<f8", (2,)), ("open_start", "<f8"), ("open_end", "<f8")]
_REGION = struct.Struct("=10d")


class Regions(Sequence[Region]):
    """Regions, sorted like those of the tool: by both agents, then by time. An object is created each time that a region is accessed."""

    __slots__ = ("_fleet", "_rows")

    def __init__(self, rows: bytes, fleet: _pcr.Fleet) -> None:
        self._rows, self._fleet = rows, fleet

    def __len__(self) -> int:
        return len(self._rows) // _REGION.size

    @overload
    def __getitem__(self, place: int) -> Region: ...
    @overload
    def __getitem__(self, place: slice) -> list[Region]: ...
    def __getitem__(self, place: Union[int, slice]) -> Union[Region, list[Region]]:
        if isinstance(place, slice):
            return [self[k] for k in range(*place.indices(len(self)))]
        if not -len(self) <= place < len(self):
            raise IndexError(f"region {place} of {len(self)}")
        row = _REGION.unpack_from(self._rows, place % len(self) * _REGION.size)
        i, j, *spans, start, end = row
        region = Region(int(i), int(j), (spans[0], spans[1]), (spans[2], spans[3]), (spans[4], spans[5]), start != 0, end != 0)
        region._fleet = self._fleet
        return region

    def __iter__(self) -> Iterator[Region]:
        return (self[k] for k in range(len(self)))

    @property
    def array(self) -> Any:
        """A structured NumPy array of all regions, without a copy. For example, ``regions.array["t"][:, 0]`` are the begins of all regions."""
        import numpy

        return numpy.frombuffer(self._rows, dtype=numpy.dtype(REGION))

    def __repr__(self) -> str:
        return f"<{len(self)} regions>"


def _finite(**numbers: float) -> None:
    for name, number in numbers.items():
        if not math.isfinite(number):
            raise Error(f"{name}: {number} is not a finite number")


class Plan(NamedTuple):
    """Result of :meth:`Fleet.plan`."""

    #: The planned fleet; ``None`` if there is no plan.
    fleet: Optional[Fleet]
    #: The output of ``pcr plan --json``: delays, costs, and agents that cannot be planned, with the reason.
    report: dict[str, Any]


class Fleet:
    """Agents on their paths. A fleet is immutable; methods that change something return another fleet.

    ``agents`` are mappings with the fields of the tool's files (``docs/formats.md``).

    >>> Fleet([], name="nobody").agents
    []
    """

    __slots__ = ("_fleet", "warnings")

    def __init__(self, agents: Sequence[Mapping[str, Any]], name: str = "") -> None:
        text = json.dumps({"name": name, "agents": list(agents)}, allow_nan=False)
        self._fleet: _pcr.Fleet = _read(_pcr.Fleet.from_json, text)
        #: Warnings about parts of the file that were not read exactly as written.
        self.warnings: list[str] = []

    @classmethod
    def _of(cls, fleet: _pcr.Fleet, warnings: Optional[list[str]] = None) -> Fleet:
        made = cls.__new__(cls)
        made._fleet, made.warnings = fleet, warnings or []
        return made

    @classmethod
    def from_json(cls, text: str) -> Fleet:
        """Reads a fleet from the text of a scenario file."""
        return cls._of(_read(_pcr.Fleet.from_json, text))

    @classmethod
    def read(cls, path: Path, *, radius: Optional[float] = None, speed: Optional[float] = None, acceleration: Optional[float] = None,
             rotation: Optional[float] = None, vehicle: Optional[str] = None, routes: Sequence[str] = (), partial: bool = False) -> Fleet:
        """Reads a fleet from a file: a scenario, or any format that ``pcr import`` reads, with the same options."""
        options = _options(radius, speed, acceleration, rotation, vehicle, routes, partial)
        fleet, warnings = _read(_pcr.Fleet.read, path, options)
        return cls._of(fleet, warnings)

    def to_json(self) -> str:
        """The text of a scenario file, which :meth:`from_json` and the tool can read."""
        return self._fleet.to_json()

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self._fleet.name()

    @property
    def agents(self) -> list[dict[str, Any]]:
        """Number, label, radius, length of the path and arrival of every agent."""
        names = ("id", "label", "radius", "length", "arrival")
        return [dict(zip(names, agent)) for agent in self._fleet.agents()]

    def regions(self, *, margins: bool = False) -> Regions:
        """All collision regions; with ``margins`` the regions in which margins overlap."""
        return Regions(self._fleet.regions(margins), self._fleet)

    def report(self, *, slices: Optional[int] = None, agent: Optional[int] = None) -> dict[str, Any]:
        """The output of ``pcr regions --json``: regions with their pieces and slices. Also works for fleets with footprints."""
        answer: dict[str, Any] = json.loads(self._fleet.regions_json(slices, agent))
        return answer

    def conflicts(self) -> list[Conflict]:
        """The conflicts of the motions as they are given, sorted by their begin. An empty list means that no agents touch."""
        found = json.loads(self._fleet.check_json())["conflicts"]
        return [Conflict(c["i"], c["j"], tuple(c["t"]), c["depth"], tuple(c["l_i"]), tuple(c["l_j"]), c["touching"]) for c in found]

    def map(self, agent: int, start: float, step: float, times: int) -> list[tuple[int, int, float, float]]:
        """The collision map of an agent at ``times`` times, from ``start`` on in steps of ``step``: index of the time, other agent, forbidden
        lengths (from, to)."""
        _finite(start=start, step=step)
        rows = struct.iter_unpack("=4d", self._fleet.map(agent, start, step, times))
        return [(int(place), int(other), lo, hi) for place, other, lo, hi in rows]

    def places(self, time: float) -> list[tuple[float, float, float, float]]:
        """The place of every agent at a time: x, y, heading, travelled length."""
        return [(x, y, heading, length) for x, y, heading, length in struct.iter_unpack("=4d", self._fleet.places(time))]

    def safe_intervals(self, agent: int, length: Union[float, Span], during: Span) -> list[Span]:
        """The times within ``during`` at which no other agent blocks a length, or an interval of lengths, of an agent's path."""
        stretch = (length, length) if isinstance(length, (int, float)) else length
        return self._fleet.safe_intervals(agent, stretch, during)

    def closest(self, i: int, j: int) -> tuple[float, float, float]:
        """The least distance between the centres of two agents, its first time, and the sum of their radii."""
        return self._fleet.closest(i, j)

    def plan(self, method: str = "delay") -> Plan:
        """Plans later starts (``"delay"``), or waits and other speeds on the way (``"speed"``), so that no agents collide."""
        if method not in ("delay", "speed"):
            raise Error(f'method "{method}": it is "delay" or "speed"')
        report, fleet = self._fleet.plan(method == "speed")
        return Plan(None if fleet is None else Fleet._of(fleet), json.loads(report))

    def holds(self, places: Sequence[Union[float, Span]]) -> list[float]:
        """How far every agent may go if all keep the order in which their motions pass one another, whatever their delays.

        ``places`` are the travelled lengths, exact or as (from, to), in the order of :attr:`agents`. A hold is infinite if no other agent is in
        the way, and minus infinity for an agent that is already where it should have waited. If motions collide, there is no order and an
        :class:`Error` is raised.
        """
        return self._fleet.holds([(p, p) if isinstance(p, (int, float)) else p for p in places])

    def plot(self, ax: Any = None, *, agent: Optional[int] = None, columns: int = 400) -> Any:
        """Draws the paths, or the collision map of ``agent``, on matplotlib's ``ax``, and returns ``ax``."""
        import matplotlib.pyplot as plt  # type: ignore[import-not-found, import-untyped, unused-ignore]

        axes = plt.subplots()[1] if ax is None else ax
        arrivals = {a["id"]: a for a in self.agents}
        last = max((a["arrival"] for a in arrivals.values()), default=1.0)
        times = [last * k / columns for k in range(columns + 1)]
        tracks = list(zip(*(self.places(time) for time in times)))
        if agent is None:
            for number, track in zip(arrivals, tracks):
                axes.plot([p[0] for p in track], [p[1] for p in track], label=str(number))
            axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
            return axes
        if agent not in arrivals:
            raise Error(f"no agent {agent}")
        step = last / columns
        for other in arrivals:
            bars = [(k * step, lo, hi) for k, j, lo, hi in self.map(agent, 0.0, step, columns + 1) if j == other]
            if bars:
                axes.bar([t for t, _, _ in bars], [hi - lo for _, lo, hi in bars], bottom=[lo for _, lo, _ in bars], width=step, label=str(other), alpha=0.6)
        own = tracks[list(arrivals).index(agent)]
        axes.plot(times, [p[3] for p in own], color="black")
        axes.set(xlabel="time [s]", ylabel="travelled length [m]")
        return axes

    def __len__(self) -> int:
        return len(self._fleet.agents())

    def __repr__(self) -> str:
        return f"<fleet {self.name!r} of {len(self)}>"


def _options(radius: Optional[float], speed: Optional[float], acceleration: Optional[float], rotation: Optional[float],
             vehicle: Optional[str], routes: Sequence[str], partial: bool) -> Options:
    for name, number in (("radius", radius), ("speed", speed), ("acceleration", acceleration), ("rotation", rotation)):
        if number is not None and not (math.isfinite(number) and number > 0):
            raise Error(f"{name}: {number} is not above 0")
    return {"radius": radius, "speed": speed, "acceleration": acceleration, "rotation": rotation, "vehicle": vehicle,
            "routes": list(routes), "partial": partial}


class Layout:
    """A road map of nav2, LIF, Open-RMF, OpenDRIVE, openTCS or Continuous-CBS, for one vehicle."""

    __slots__ = ("_layout", "_options", "_path")

    def __init__(self, path: Path, options: Options) -> None:
        self._path, self._options, self._layout = path, options, _pcr.Layout.read(path, options)

    @classmethod
    def read(cls, path: Path, *, radius: Optional[float] = None, vehicle: Optional[str] = None, partial: bool = False) -> Layout:
        """Reads a layout file, for vehicles with this radius, or of this type."""
        return cls(path, _options(radius, None, None, None, vehicle, (), partial))

    def _for(self, radius: Optional[float], speed: Optional[float], acceleration: Optional[float]) -> _pcr.Layout:
        """Reads the layout for another vehicle."""
        own = self._options
        radius = own["radius"] if radius is None else radius
        return _pcr.Layout.read(self._path, _options(radius, speed, acceleration, None, own["vehicle"], (), own["partial"]))

    def locks(self, radius: Optional[float] = None) -> list[Lock]:
        """Pairs of edges that exclude one another, with the lengths concerned. Vehicles at other lengths cannot touch.

        With a ``radius``, the locks are for vehicles with that radius instead of the vehicle that the layout was read for.
        """
        layout = self._layout if radius is None else self._for(radius, None, None)
        found = json.loads(layout.locks_json(False))["locks"]
        return [Lock(lock["a"], lock["b"], tuple(lock["a_length"]), tuple(lock["b_length"])) for lock in found]

    def delays(self, radius: Optional[float], speed: float, *, acceleration: Optional[float] = None) -> list[Delay]:
        """Unsafe delays: pairs of edges, and the delays between two departures with which the vehicles would touch. Other pairs never touch.

        Vehicles drive at constant ``speed`` (or at the limit of the edge if that is lower); with an ``acceleration`` they drive from rest to
        rest. An edge that may be driven in both directions counts as two. Without a ``radius``, the vehicle is that which the layout was read for.

        >>> import tempfile
        >>> points = [[-2, 0], [2, 0], [0, -2], [0, 2]]
        >>> nodes = [{"type": "Feature", "properties": {"id": k, "frame": "map"}, "geometry": {"type": "Point", "coordinates": at}} for k, at in enumerate(points)]
        >>> edges = [{"type": "Feature", "properties": {"id": 10 + k, "startid": k, "endid": k + 1}, "geometry": {"type": "MultiLineString", "coordinates": []}} for k in (0, 2)]
        >>> with tempfile.NamedTemporaryFile("w", suffix=".geojson") as file:
        ...     _ = file.write(json.dumps({"type": "FeatureCollection", "features": nodes + edges}))
        ...     file.flush()
        ...     crossing = Layout.read(file.name).delays(0.25, 1.0)
        >>> [(d.a, d.b, [round(s, 3) for s in d.delay]) for d in crossing]
        [(10, 10, [-0.5, 0.5]), (10, 12, [-0.707, 0.707]), (12, 12, [-0.5, 0.5])]
        """
        found = json.loads(self._for(radius, speed, acceleration).delays_json(speed, acceleration))["delays"]
        return [Delay(d["a"], d["b"], tuple(d["delay"]), d.get("a_backward", False), d.get("b_backward", False)) for d in found]

    def __repr__(self) -> str:
        name, nodes, edges = self._layout.sizes()
        return f"<layout {name!r}: {nodes} nodes, {edges} edges>"
