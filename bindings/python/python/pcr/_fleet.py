"""Fleets, and what is asked of them."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, SupportsFloat, SupportsIndex, Union

from . import _drawing, _pcr
from ._errors import Error, scenario
from ._numbers import Ranged, Span, finite, ordered, plain, span, truth, whole
from ._options import Options, Path, checked
from ._regions import Regions

if TYPE_CHECKING:
    from typing_extensions import Unpack

#: Times that one question may be about: the answer has to fit into memory.
TIMES, SLICES = 1_000_000, 100_000


class Conflict(NamedTuple):
    """Two agents in contact: when [s], how deep [m], and where on both paths [m]."""

    i: int
    j: int
    t: Span
    depth: float
    l_i: Span
    l_j: Span
    #: Whether they but touch, within rounding.
    touching: bool


class Passing(NamedTuple):
    """A region of agent ``i`` with agent ``j``, the lengths [m] of both in it, and who passes it first as the motions say."""

    i: int
    j: int
    l: Span
    l_j: Span
    #: Whether ``i`` passes before ``j``.
    first: bool


class Plan(NamedTuple):
    """What :meth:`Fleet.plan` found."""

    #: The fleet as planned; ``None`` where there is no plan.
    fleet: Optional[Fleet]
    #: What ``pcr plan --json`` prints: delays, costs, and who cannot be planned, with the reason.
    report: dict[str, Any]


class Fleet:
    """Agents on their paths. It does not change; what changes something returns another fleet.

    ``agents`` are mappings with the fields of the tool's files (``docs/reference/formats.md``).

    >>> Fleet([], name="nobody").agents
    []
    """

    __slots__ = ("_fleet",)

    def __init__(self, agents: Iterable[Mapping[str, Any]], name: str = "") -> None:
        # What is not finite is refused as in a file, with the agent and the field.
        text = json.dumps({"name": name, "agents": ordered("agents", agents)}, default=plain)
        self._fleet: _pcr.Fleet = scenario(_pcr.Fleet.from_json, text)

    @classmethod
    def _of(cls, fleet: _pcr.Fleet) -> Fleet:
        made = cls.__new__(cls)
        made._fleet = fleet
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return Fleet.from_json, (self.to_json(),)

    @classmethod
    def from_json(cls, text: str) -> Fleet:
        """The fleet in the text of a scenario file."""
        return cls._of(scenario(_pcr.Fleet.from_json, text))

    @classmethod
    def read(cls, path: Path, **options: Unpack[Options]) -> Fleet:
        """The fleet in a file: a scenario, or any format that ``pcr import`` reads, with its options.

        >>> Fleet.read("fleet.json", speed=-1)
        Traceback (most recent call last):
        pcr.Error: speed: -1.0 is out of range; allowed is above 0, up to 1000000
        """
        return cls._of(scenario(_pcr.Fleet.read, path, checked(options)))

    def to_json(self) -> str:
        """The text of a scenario file, which :meth:`from_json` and the tool read."""
        return self._fleet.to_json()

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self._fleet.name()

    @property
    def warnings(self) -> list[str]:
        """What was read otherwise than it is written in the file; scenario files that are made of it hold that, too."""
        return self._fleet.warnings()

    @property
    def agents(self) -> list[dict[str, Any]]:
        """Number, label, radius, length of the path, start and arrival of every agent."""
        names = ("id", "label", "radius", "length", "start", "arrival")
        return [dict(zip(names, agent)) for agent in self._fleet.agents()]

    def regions(self, *, margins: bool = False) -> Regions:
        """All collision regions; with ``margins`` those in which margins overlap."""
        return Regions(self._fleet.regions(margins), self)

    def report(self, *, slices: Optional[SupportsIndex] = None, agent: Optional[SupportsIndex] = None) -> dict[str, Any]:
        """What ``pcr regions --json`` prints: regions with their pieces and slices; of concave outlines and of loads, too."""
        answer: dict[str, Any] = json.loads(self._fleet.regions_json(
            None if slices is None else whole("slices", slices, SLICES), None if agent is None else whole("agent", agent)))
        return answer

    def conflicts(self) -> list[Conflict]:
        """Who collides, moving as given: sorted by the begin. An empty list is the answer "nobody touches"."""
        return _conflicts(self._fleet.check_json())

    def map(self, agent: SupportsIndex, start: SupportsFloat, step: SupportsFloat, times: SupportsIndex) -> list[tuple[int, int, float, float]]:
        """The collision map of an agent at ``times`` times: number of the time, other agent, and the lengths forbidden then, from, to."""
        begin, by, count = finite("start", start), finite("step", step), whole("times", times, TIMES)
        if count and not math.isfinite(begin + by * (count - 1)):
            raise Error(f"times: the last one, {begin} + {count - 1} * {by}, is too large")
        rows = self._fleet.map(whole("agent", agent), begin, by, count)
        return list(struct.iter_unpack("<QQ2d", rows))

    def collision_map(self, agent: SupportsIndex, *, columns: SupportsIndex = 400, rows: SupportsIndex = 400) -> tuple[Any, Any, Any]:
        """The collision map of an agent as NumPy arrays: times [s], travelled lengths [m], and for each length (row) and time (column) the
        place of the first agent in :attr:`agents` that blocks it, or -1 where nobody does. Each entry is exact at its time and length.
        """
        import numpy

        count, steps = whole("columns", columns, SLICES), whole("rows", rows, SLICES)
        if count < 2 or steps < 2:
            raise Error("columns, rows: at least two of each")
        agents = self.agents
        numbers = [a["id"] for a in agents]
        own = whole("agent", agent)
        if own not in numbers:
            raise Error(f"no agent {own}")
        times = numpy.linspace(*self._span(), count)
        lengths = numpy.linspace(0.0, agents[numbers.index(own)]["length"], steps)
        blocked = numpy.full((steps, count), -1, dtype=numpy.int32)
        places = {number: place for place, number in enumerate(numbers)}
        for column, other, lo, hi in self.map(own, times[0], times[1] - times[0], count):
            stretch = blocked[numpy.searchsorted(lengths, lo):numpy.searchsorted(lengths, hi, side="right"), column]
            place = places[other]
            stretch[(stretch < 0) | (stretch > place)] = place
        return times, lengths, blocked

    def _span(self) -> Span:
        """From 0, or from the first start where that is before it, to the last arrival."""
        agents = self.agents
        return min((min(a["start"], 0.0) for a in agents), default=0.0), max((a["arrival"] for a in agents), default=1.0)

    @property
    def scenario(self) -> dict[str, Any]:
        """What :meth:`to_json` has, as mappings and lists."""
        found: dict[str, Any] = json.loads(self.to_json())
        return found

    def shapes(self, time: SupportsFloat) -> list[Any]:
        """The agents at a time as polygons of Shapely, in the order of :attr:`agents`: discs as circles of 128 points, outlines as they are."""
        from shapely.geometry import Point, Polygon  # type: ignore[import-untyped, import-not-found, unused-ignore]

        found = []
        for agent, place in zip(self.scenario["agents"], self.places(time)):
            if "footprint" in agent:
                found.append(Polygon(_drawing.body(agent, place)).buffer(agent["footprint"].get("growth", 0.0)))
            else:
                found.append(Point(*place[:2]).buffer(agent["radius"], quad_segs=32))
        return found

    def places(self, time: SupportsFloat) -> list[tuple[float, float, float, float]]:
        """Where every agent is at a time: x, y, heading, travelled length."""
        return list(struct.iter_unpack("<4d", self._fleet.places(finite("time", time))))

    def safe_intervals(self, agent: SupportsIndex, length: Ranged, during: Ranged) -> list[Span]:
        """When no other agent blocks a length, or a stretch of lengths, of an agent's path, within ``during``."""
        return self._fleet.safe_intervals(whole("agent", agent), span("length", length), span("during", during))

    def closest(self, i: SupportsIndex, j: SupportsIndex) -> tuple[float, float, float]:
        """The least distance of two agents' centres, or of the polygons of their outlines, the first time of it, and the sum of their radii."""
        return self._fleet.closest(whole("agent", i), whole("agent", j))

    def plan(self, method: str = "delay", *, priority: Union[str, Iterable[SupportsIndex]] = "best", objective: str = "sum",
             leave_out: bool = False, prove: bool = False, time_limit: Optional[SupportsFloat] = None) -> Plan:
        """Later starts (``"delay"``), or waits and other speeds on the way (``"speed"``), so that nobody collides.

        The options are those of ``pcr plan``: ``priority`` is ``"best"``, ``"longest"``, ``"crowded"`` or numbers of agents that go first;
        ``objective`` ``"sum"`` or ``"makespan"``; ``leave_out`` leaves agents out if need be; ``prove`` searches until no plan is better;
        ``time_limit`` ends the search after so many seconds.

        >>> Fleet([]).plan(objective="shortest")
        Traceback (most recent call last):
        pcr.Error: objective "shortest": it is "sum" or "makespan"
        """
        for name, value, known in (("method", method, ("delay", "speed")), ("objective", objective, ("sum", "makespan"))):
            if value not in known:
                raise Error(f'{name} "{value}": it is {" or ".join(f"{chr(34)}{one}{chr(34)}" for one in known)}')
        if isinstance(priority, str) and priority not in ("best", "longest", "crowded"):
            raise Error(f'priority "{priority}": it is "best", "longest", "crowded" or numbers of agents')
        if method == "speed" and (truth("prove", prove) or time_limit is not None):
            raise Error('prove and time_limit are for the method "delay"')
        report, fleet = self._fleet.plan({
            "speeds": method == "speed", "makespan": objective == "makespan", "leave_out": truth("leave_out", leave_out), "prove": truth("prove", prove),
            "time_limit": None if time_limit is None else finite("time_limit", time_limit), "rule": priority if isinstance(priority, str) else "given",
            "first": [] if isinstance(priority, str) else [whole("priority", number) for number in ordered("priority", priority)]})
        return Plan(None if fleet is None else Fleet._of(fleet), json.loads(report))

    def passings(self, agent: SupportsIndex) -> list[Passing]:
        """Who passes the regions of an agent first, in the order in which the motions do. Motions that meet have no order: that is an error.

        >>> path = [{"kind": "line", "length": 4}]
        >>> east, north = {"x": -2, "y": 0, "heading": 0}, {"x": 0, "y": -2, "heading": 1.5707963267948966}
        >>> agent = {"radius": 0.25, "v_max": 1, "a_max": 1, "path": path}
        >>> fleet = Fleet([{"id": 1, "start": east, **agent}, {"id": 2, "start": north, "t_start": 2, **agent}])
        >>> [(passing.j, passing.first) for passing in fleet.passings(1)], [round(hold, 3) for hold in fleet.holds([0, 0])]
        ([(2, True)], [inf, 1.5])
        """
        rows = struct.iter_unpack("<QQ4d?7x", self._fleet.passings(whole("agent", agent)))
        return [Passing(i, j, (lo, hi), (lo_j, hi_j), first) for i, j, lo, hi, lo_j, hi_j, first in rows]

    def holds(self, places: Iterable[Ranged]) -> list[float]:
        """How far every agent may go in the order in which the motions pass one another, whatever the delays.

        ``places`` are the travelled lengths, exact or from-to, in the order of :attr:`agents`. Infinite where nobody is in the
        way; minus infinity for an agent that is where it should have waited. Places off the path are an error. Motions that meet have no order: that is an error.
        """
        spans = [span("place", place) for place in ordered("places", places)]
        for (lo, hi), agent in zip(spans, self.agents):
            if hi < 0 or lo > agent["length"]:
                raise Error(f"place: agent {agent['id']}: {lo} to {hi} is not on the path, 0 to {agent['length']}")
        return self._fleet.holds(spans)

    def plot(self, ax: Any = None, *, agent: Optional[SupportsIndex] = None, columns: SupportsIndex = 400) -> Any:
        """Draws the paths with the agents at their starts, or with ``agent`` its collision map, on matplotlib's ``ax``; returns it.
        The legend is beside the axes: make the figure of your own ``ax`` with ``layout="constrained"``."""
        import matplotlib.pyplot as plt  # type: ignore[import-not-found, import-untyped, unused-ignore]

        count = whole("columns", columns, SLICES)
        if count == 0:
            raise Error("columns: 0 times draw nothing")
        own = None if agent is None else whole("agent", agent)
        if own is not None and own not in [a["id"] for a in self.agents]:
            raise Error(f"no agent {own}")
        # The legend is beside the axes: a figure of one's own has room for it.
        axes = plt.subplots(layout="constrained")[1] if ax is None else ax
        first, last = self._span()
        times = [first + (last - first) / count * k for k in range(count + 1)]
        return _drawing.paths(self, axes, times) if own is None else _drawing.collision_map(self, own, axes, times)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.agents)

    def __getitem__(self, place: SupportsIndex) -> dict[str, Any]:
        """An entry of :attr:`agents`."""
        return self.agents[place]

    def __len__(self) -> int:
        return len(self._fleet.agents())

    def __eq__(self, other: object) -> bool:
        return self.to_json() == other.to_json() if isinstance(other, Fleet) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __repr__(self) -> str:
        return f"<fleet {self.name!r} of {len(self)}>"


def check_all(scenarios: Iterable[Union[Fleet, str]], *, threads: Optional[SupportsIndex] = None) -> list[list[Conflict]]:
    """What :meth:`Fleet.conflicts` says of each of many fleets, or texts of scenario files, in their order: on all cores, or so many
    ``threads``, while other threads of Python run. The first fault is raised, with the place of its scenario.

    >>> check_all([Fleet([]), '{"agents": []}'])
    [[], []]
    >>> check_all([Fleet([]), "{}"])
    Traceback (most recent call last):
    pcr.ScenarioError: scenario 1: agents: missing
    """
    texts = [one.to_json() if isinstance(one, Fleet) else one for one in ordered("scenarios", scenarios)]
    answers = scenario(_pcr.check_all, texts, None if threads is None else whole("threads", threads, 4096))
    return [_conflicts(text) for text in answers]


def _conflicts(text: str) -> list[Conflict]:
    found = json.loads(text)["conflicts"]
    return [Conflict(c["i"], c["j"], tuple(c["t"]), c["depth"], tuple(c["l_i"]), tuple(c["l_j"]), c["touching"]) for c in found]
