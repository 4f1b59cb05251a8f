"""Fleets, and what is asked of them."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, SupportsFloat, SupportsIndex

from . import _pcr
from ._errors import Error, scenario
from ._numbers import Ranged, Span, finite, ordered, plain, span, whole
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
        found = json.loads(self._fleet.check_json())["conflicts"]
        return [Conflict(c["i"], c["j"], tuple(c["t"]), c["depth"], tuple(c["l_i"]), tuple(c["l_j"]), c["touching"]) for c in found]

    def map(self, agent: SupportsIndex, start: SupportsFloat, step: SupportsFloat, times: SupportsIndex) -> list[tuple[int, int, float, float]]:
        """The collision map of an agent at ``times`` times: number of the time, other agent, and the lengths forbidden then, from, to."""
        begin, by, count = finite("start", start), finite("step", step), whole("times", times, TIMES)
        if count and not math.isfinite(begin + by * (count - 1)):
            raise Error(f"times: the last one, {begin} + {count - 1} * {by}, is too large")
        rows = self._fleet.map(whole("agent", agent), begin, by, count)
        return list(struct.iter_unpack("<QQ2d", rows))

    def places(self, time: SupportsFloat) -> list[tuple[float, float, float, float]]:
        """Where every agent is at a time: x, y, heading, travelled length."""
        return list(struct.iter_unpack("<4d", self._fleet.places(finite("time", time))))

    def safe_intervals(self, agent: SupportsIndex, length: Ranged, during: Ranged) -> list[Span]:
        """When no other agent blocks a length, or a stretch of lengths, of an agent's path, within ``during``."""
        return self._fleet.safe_intervals(whole("agent", agent), span("length", length), span("during", during))

    def closest(self, i: SupportsIndex, j: SupportsIndex) -> tuple[float, float, float]:
        """The least distance of two agents' centres, or of the polygons of their outlines, the first time of it, and the sum of their radii."""
        return self._fleet.closest(whole("agent", i), whole("agent", j))

    def plan(self, method: str = "delay") -> Plan:
        """Later starts (``"delay"``), or waits and other speeds on the way (``"speed"``), so that nobody collides."""
        if method not in ("delay", "speed"):
            raise Error(f'method "{method}": it is "delay" or "speed"')
        report, fleet = self._fleet.plan(method == "speed")
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
        """Draws the paths, or with ``agent`` its collision map, on matplotlib's ``ax``; returns it."""
        import matplotlib.pyplot as plt  # type: ignore[import-not-found, import-untyped, unused-ignore]

        columns = whole("columns", columns, SLICES)
        if columns == 0:
            raise Error("columns: 0 times draw nothing")
        axes = plt.subplots()[1] if ax is None else ax
        agents = self.agents
        numbers = [a["id"] for a in agents]
        # From 0, or from the first start where that is before it.
        first = min((a["start"] for a in agents), default=0.0)
        first, last = min(first, 0.0), max((a["arrival"] for a in agents), default=1.0)
        step = (last - first) / columns
        times = [first + step * k for k in range(columns + 1)]
        tracks = list(zip(*(self.places(time) for time in times)))
        if agent is None:
            for number, track in zip(numbers, tracks):
                axes.plot([p[0] for p in track], [p[1] for p in track], label=str(number))
            axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
            return axes
        if agent not in numbers:
            raise Error(f"no agent {agent}")
        rows = self.map(agent, first, step, columns + 1)
        for other in numbers:
            bars = [(times[k], lo, hi) for k, j, lo, hi in rows if j == other]
            if bars:
                axes.bar([t for t, _, _ in bars], [hi - lo for _, lo, hi in bars], bottom=[lo for _, lo, _ in bars], width=step, label=str(other), alpha=0.6)
        own = tracks[numbers.index(agent)]
        axes.plot(times, [p[3] for p in own], color="black")
        axes.set(xlabel="time [s]", ylabel="travelled length [m]")
        return axes

    def __len__(self) -> int:
        return len(self._fleet.agents())

    def __eq__(self, other: object) -> bool:
        return self.to_json() == other.to_json() if isinstance(other, Fleet) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __repr__(self) -> str:
        return f"<fleet {self.name!r} of {len(self)}>"
