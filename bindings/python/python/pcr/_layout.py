"""Layouts, and which of their edges exclude one another."""

from __future__ import annotations

import json
import os
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, SupportsFloat

from . import _pcr
from ._numbers import Span, real
from ._options import Options, Path, absolute, checked

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Lock(NamedTuple):
    """Two edges of a layout, and the lengths [m] of each on which a vehicle can touch one on the other."""

    a: Any
    b: Any
    a_length: Span
    b_length: Span


class Delay(NamedTuple):
    """How much later [s] than on edge ``a`` a vehicle may not set off on edge ``b``, because the two would touch."""

    a: Any
    b: Any
    #: Less than 0 is earlier.
    delay: Span
    #: Whether ``a`` is driven from its end to its start.
    a_backward: bool
    b_backward: bool


class Layout:
    """A road map of nav2, LIF, Open-RMF, OpenDRIVE, openTCS or Continuous-CBS, for one vehicle."""

    __slots__ = ("_layout", "_options", "_path", "warnings")

    def __init__(self, path: Path, options: Options) -> None:
        # Another folder may be the current one when it is read again.
        self._path, self._options = os.path.abspath(path), absolute(options)
        self._layout: _pcr.Layout
        #: What was read otherwise than it is written in the file.
        self.warnings: list[str]
        self._layout, self.warnings = _pcr.Layout.read(path, checked(options))

    @classmethod
    def read(cls, path: Path, **options: Unpack[Options]) -> Layout:
        """A layout file, with the options of ``pcr locks``: ``radius=0.4`` for vehicles of this radius, ``vehicle`` for one of the file's types,
        ``graph`` for one of several of Open-RMF."""
        return cls(path, options)

    def _for(self, **vehicle: Unpack[Options]) -> _pcr.Layout:
        """The layout for another vehicle: the file is read again. Whatever is read otherwise because of that is warned of."""
        other: Options = {**self._options, **vehicle}
        layout, told = _pcr.Layout.read(self._path, checked(other))
        for text in told:
            if text not in self.warnings:
                warnings.warn(text, stacklevel=3)
        return layout

    def locks(self, radius: Optional[SupportsFloat] = None) -> list[Lock]:
        """Which edges exclude one another, and on which lengths: two vehicles on other lengths cannot touch.

        With a ``radius`` for vehicles of that radius, whatever the layout was read for.
        """
        layout = self._layout if radius is None else self._for(radius=radius)
        found = json.loads(layout.locks_json(False))["locks"]
        return [Lock(lock["a"], lock["b"], tuple(lock["a_length"]), tuple(lock["b_length"])) for lock in found]

    def delays(self, radius: Optional[SupportsFloat], speed: SupportsFloat, *, acceleration: Optional[SupportsFloat] = None) -> list[Delay]:
        """Unsafe delays: how much later than on one edge a vehicle may not set off on another. Pairs that are not listed never touch.

        Edges are driven at constant ``speed`` (that of the edge, where its limit is lower), with an ``acceleration`` from rest to rest;
        one that may be driven in both directions is two ways. Without a ``radius`` for vehicles as the layout was read for.

        >>> import json, tempfile
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
        radius = self._options.get("radius") if radius is None else radius
        layout = self._for(radius=radius, speed=speed, acceleration=acceleration)
        found = json.loads(layout.delays_json(real("speed", speed), None if acceleration is None else real("acceleration", acceleration)))["delays"]
        return [Delay(d["a"], d["b"], tuple(d["delay"]), d.get("a_backward", False), d.get("b_backward", False)) for d in found]

    def __repr__(self) -> str:
        name, nodes, edges = self._layout.sizes()
        return f"<layout {name!r}: {nodes} nodes, {edges} edges>"
