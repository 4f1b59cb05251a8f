"""Options of the importers."""

from __future__ import annotations

import os
from collections.abc import Sequence
from os import PathLike
from typing import Any, Optional, SupportsFloat, SupportsIndex, TypedDict, Union

from ._numbers import ordered, real, truth, whole
from ._pcr import Error

Path = Union[str, PathLike[str]]


class Options(TypedDict, total=False):
    """The options of ``pcr import``, by their names there. ``None`` is as if it was not there.

    An option without effect raises an :class:`Error`: ``tolerance`` where there is no curve, ``horizon`` where all edges are released,
    ``corner_radius`` where no corner is rounded with it or without it. For a :class:`Layout` so do ``routes`` and ``corner_radius``.
    """

    #: nav2, lif, rmf, opendrive, opentcs, ccbs, grid, path or vda5050; by name and content if left out.
    format: Optional[str]
    #: Ways of agents, FROM:TO or FROM:TO@TIME.
    routes: Sequence[str]
    #: Of the vehicle [m].
    radius: Optional[SupportsFloat]
    #: To keep around discs that have none of their own [m].
    margin: Optional[SupportsFloat]
    #: [m/s], [m/s²], [rad/s], [rad/s²]
    speed: Optional[SupportsFloat]
    acceleration: Optional[SupportsFloat]
    rotation: Optional[SupportsFloat]
    rotation_acceleration: Optional[SupportsFloat]
    #: Type of the vehicle, where a layout has several (LIF).
    vehicle: Optional[str]
    #: Fleet configuration (Open-RMF) or factsheet (VDA 5050).
    fleet: Optional[Path]
    #: Of corners (nav2) [m].
    corner_radius: Optional[SupportsFloat]
    #: Largest distance of arcs from curves [m].
    tolerance: Optional[SupportsFloat]
    #: Navigation graph, where there are several (Open-RMF).
    graph: Optional[SupportsIndex]
    #: Include the horizon of an order, not only its base (VDA 5050).
    horizon: bool
    #: Read what can be read of a layout; without it, a file is refused for anything that would be left out.
    partial: bool


ABOVE_0 = ("radius", "speed", "acceleration", "rotation", "rotation_acceleration", "tolerance")
FROM_0 = ("margin", "corner_radius")
MOST = 1e6


def checked(given: Options) -> dict[str, Any]:
    """All options, as the command line takes them."""
    unknown = [name for name in given if name not in Options.__annotations__]
    if unknown:
        raise TypeError(f"there is no option {unknown[0]!r}; there are {', '.join(Options.__annotations__)}")
    found: dict[str, Any] = {name: None for name in Options.__annotations__}
    found.update(given)
    for name in (*ABOVE_0, *FROM_0):
        if found[name] is not None:
            number = real(name, found[name])
            if not (0 <= number <= MOST) or (number == 0 and name in ABOVE_0):
                raise Error(f"{name}: {number} is out of range; allowed is {'above' if name in ABOVE_0 else 'from'} 0, up to {MOST:.0f}")
            found[name] = number
    if found["graph"] is not None:
        found["graph"] = whole("graph", found["graph"])
    found.update({name: truth(name, found[name]) for name in ("horizon", "partial")})
    found["routes"] = ordered("routes", [] if found["routes"] is None else found["routes"])
    return found


def absolute(given: Options) -> Options:
    """The same options, whatever the current folder is."""
    fleet = given.get("fleet")
    return given if fleet is None else {**given, "fleet": os.path.abspath(fleet)}
