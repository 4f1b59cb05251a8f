"""Pictures with matplotlib, and shapes of Shapely. Both are imported when they are asked for."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ._numbers import Span

if TYPE_CHECKING:
    from ._fleet import Fleet

#: Points of a circle, and of a rounded corner.
ROUND = 32

#: Points between the end of a region and what is blocked next to it.
TIP = 8

Corner = tuple[float, float]
#: A time, and the lengths that are blocked then.
Column = tuple[float, Sequence[Span]]


#: A time, and what is blocked then, from and to.
Slice = tuple[float, float, float]


def tip(at: float, near: Slice, beyond: Slice) -> list[Slice]:
    """What a picture shows between the end of a region at the time ``at`` and the first two slices from there: their width is taken for a power of
    the time from the end, a root where discs begin to touch, linear where corners do, constant where sides do, and their middle for linear."""
    (t, lo, hi), (t_beyond, lo_beyond, hi_beyond) = near, beyond
    width, wider = hi - lo, hi_beyond - lo_beyond
    power = math.log(wider / width) / math.log((t_beyond - at) / (t - at)) if 0.0 < width < wider else 0.0
    slope = (lo_beyond + hi_beyond - lo - hi) / 2 / (t_beyond - t)
    found = []
    for part in ((k / TIP) ** 2 for k in range(TIP)):
        time = at + (t - at) * part
        middle, half = (lo + hi) / 2 + slope * (time - t), width / 2 * part ** min(power, 1.0)
        found.append((time, middle - half, middle + half))
    return found


def chains(columns: Sequence[Column], t: Span, is_open: tuple[bool, bool], *, tips: bool = False) -> list[list[Corner]]:
    """The polygons, in time and length, around what is blocked at evenly spaced times between the ends of a region: a stretch goes on as long as
    it overlaps just one of the next time, and no other does. ``is_open`` tells whether the other agent stands before and after. With ``tips`` the
    ends have the form that the next slices have, for pictures; without, they are chords."""
    done: list[list[Slice]] = []
    open_: list[list[Slice]] = []
    for time, stretches in columns:
        continued: list[list[Slice]] = []
        for lo, hi in stretches:
            before = [chain for chain in open_ if chain[-1][1] <= hi and lo <= chain[-1][2]]
            after = [other for other in stretches if before and before[0][-1][1] <= other[1] and other[0] <= before[0][-1][2]]
            if len(before) == 1 and len(after) == 1:
                before[0].append((time, lo, hi))
                continued.append(before[0])
            else:
                # Where stretches meet or part, the new one begins at what was blocked before.
                continued.append([(chain[-1][0], max(lo, chain[-1][1]), min(hi, chain[-1][2])) for chain in before[:1]] + [(time, lo, hi)])
        done += [chain for chain in open_ if not any(chain is other for other in continued)]
        open_ = continued
    polygons = []
    for chain in done + open_:
        # Its ends are not among the times that were asked for. It tapers off there, unless what is blocked stays so.
        head, end = (_end(t[0], chain[:2], is_open[0], tips) if chain[0][0] == columns[0][0] else [],
                     _end(t[1], chain[:-3:-1], is_open[1], tips) if chain[-1][0] == columns[-1][0] else [])
        chain = [*head, *chain, *reversed(end)]
        points = [(time, lo) for time, lo, _ in chain] + [(time, hi) for time, _, hi in reversed(chain)]
        # Where both sides meet, a corner is one point.
        polygons.append([point for place, point in enumerate(points) if point != points[place - 1]])
    return polygons


def _end(at: float, slices: Sequence[Slice], stays: bool, tips: bool) -> list[Slice]:
    """What is between the end of a region at the time ``at`` and its slices next to it, the end first."""
    lo, hi = slices[0][1:]
    if stays:
        return [(at, lo, hi)]
    return tip(at, *slices) if tips and len(slices) == 2 else [(at, (lo + hi) / 2, (lo + hi) / 2)]


def body(agent: dict[str, Any], pose: Sequence[float]) -> list[Corner]:
    """The corners of an agent of a scenario file at a pose: of its footprint without what it is grown by, or points on the circle of a disc."""
    x, y, heading = pose[:3]
    cos, sin = math.cos(heading), math.sin(heading)
    if "footprint" in agent:
        own = [(corner["ahead"], corner["left"]) for corner in agent["footprint"]["polygon"]]
    else:
        turns = [2 * math.pi * k / ROUND for k in range(ROUND)]
        own = [(agent["radius"] * math.cos(turn), agent["radius"] * math.sin(turn)) for turn in turns]
    return [(x + ahead * cos - left * sin, y + ahead * sin + left * cos) for ahead, left in own]


def colour(place: int) -> tuple[float, float, float]:
    """The colour of an agent in all pictures: hues by the golden angle, so that neighbours differ."""
    return colorsys.hls_to_rgb((0.58 + 0.381966 * place) % 1.0, 0.45, 0.7)


def paths(fleet: Fleet, axes: Any, times: Sequence[float]) -> Any:
    """The paths, with every agent as it is at its start, and its number."""
    tracks = list(zip(*(fleet.places(time) for time in times)))
    for place, (agent, track) in enumerate(zip(fleet.scenario["agents"], tracks)):
        label = str(agent.get("label") or agent["id"])
        axes.plot([p[0] for p in track], [p[1] for p in track], color=colour(place), label=label)
        corners = body(agent, track[0])
        axes.fill([x for x, _ in corners], [y for _, y in corners], color=colour(place), alpha=0.35)
        axes.annotate(label, track[0][:2], ha="center", va="center")
    axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    if tracks:
        axes.legend(title="agent", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return axes


def collision_map(fleet: Fleet, agent: int, axes: Any, times: Sequence[float]) -> Any:
    """The regions of an agent, one colour for each other agent, and its motion."""
    told = fleet.report(slices=len(times) - 1, agent=agent)
    names = {a["id"]: str(a.get("label") or a["id"]) for a in fleet.scenario["agents"]}
    places = {a["id"]: place for place, a in enumerate(fleet.agents)}
    drawn: set[int] = set()
    for region in told["regions"]:
        other, t = region["j"], region["t"]
        style: dict[str, Any] = {"alpha": 0.6, "linewidth": 0.0, "color": colour(places[other])}
        if other not in drawn:
            style["label"] = names[other]
            drawn.add(other)
        columns = [(slice["t"], [(lo, hi) for lo, hi in slice["l"]]) for slice in region["slices"]]
        spans = sorted({span for _, stretches in columns for span in stretches})
        if t[0] == t[1]:
            # The other agent stands all the time.
            for lo, hi in spans:
                axes.axhspan(lo, hi, **style)
                style.pop("label", None)
            continue
        widest = max(((hi - lo, time, lo + hi) for time, stretches in columns for lo, hi in stretches), default=None)
        if widest is not None:
            axes.annotate(names[other], (widest[1], widest[2] / 2), ha="center", va="center", fontsize="small", annotation_clip=True)
        for points in chains(columns, (t[0], t[1]), (region["open_start"], region["open_end"]), tips=True):
            axes.fill([x for x, _ in points], [y for _, y in points], **style)
            style.pop("label", None)
        # What the other agent blocks while it stands is blocked before and after, too.
        for is_open, at, end in ((region["open_start"], 0, times[0]), (region["open_end"], -1, times[-1])):
            if is_open and columns:
                for lo, hi in columns[at][1]:
                    axes.fill_between([t[at], end], lo, hi, **style)
    axes.plot(times, [fleet.places(time)[places[agent]][3] for time in times], color="black", label="its motion")
    axes.set(xlabel="time [s]", ylabel=f"travelled length of agent {names[agent]} [m]", xlim=(times[0], times[-1]))
    if (length := fleet.agents[places[agent]]["length"]) > 0.0:
        axes.set_ylim(0.0, length)
    axes.legend(title="blocked by agent", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return axes
