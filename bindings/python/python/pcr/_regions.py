"""Collision regions, one by one and as an array."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, SupportsIndex, Union, overload

from ._drawing import chains
from ._numbers import Span
from ._pcr import Error

if TYPE_CHECKING:
    from ._fleet import Fleet


class _Ranges(NamedTuple):
    i: int
    j: int
    t: Span
    l: Span
    l_j: Span
    #: Whether ``j`` is in the way already while it stands at its start: what is blocked at ``t[0]`` is so at all earlier times, too.
    open_start: bool
    #: The same for ``j`` at its end, after ``t[1]``.
    open_end: bool


class Region(_Ranges):
    """Where and when agent ``i`` would touch agent ``j``: times [s], lengths of ``i`` and of ``j`` along their paths [m].

    It lies within these intervals; :meth:`outline` has its shape.
    """

    # None in one that was not made by a fleet, such as by `_replace`.
    _fleet: Optional[Fleet] = None

    def outline(self, n: SupportsIndex) -> list[tuple[float, float, float]]:
        """What it covers at ``n`` evenly spaced times inside: time, from, to. A time comes more than once where it covers more than one
        stretch then.

        >>> path = [{"kind": "line", "length": 4}]
        >>> east, north = {"x": -2, "y": 0, "heading": 0}, {"x": 0, "y": -2, "heading": 1.5707963267948966}
        >>> fleet = Fleet([{"id": k, "radius": 0.25, "v_max": 1, "a_max": 1, "start": start, "path": path} for k, start in ((1, east), (2, north))])
        >>> [[round(number, 3) for number in row] for row in fleet.regions()[0].outline(3)]
        [[2.25, 1.567, 2.433], [2.5, 1.5, 2.5], [2.75, 1.567, 2.433]]
        """
        if self._fleet is None:
            raise Error("this region is not of a fleet")
        return self._outline(self._fleet.report(slices=n, agent=self.i))

    def _outline(self, answer: dict[str, Any]) -> list[tuple[float, float, float]]:
        """From a report on this agent."""
        rows = [*answer["regions"], *answer.get("margin_regions", [])]
        own = [row for row in rows if (row["j"], row["t"], row["l"]) == (self.j, list(self.t), list(self.l))]
        if not own:
            raise Error("this region is not one of its fleet")
        return [(slice["t"], lo, hi) for slice in own[0]["slices"] for lo, hi in slice["l"]]

    def polygons(self, n: SupportsIndex = 60) -> list[list[tuple[float, float]]]:
        """The corners (time, length) of polygons through what it covers at ``n`` times inside, for pictures: between these times their edges
        are chords, which leave out slivers of it. None where the other agent stands all the time, because it has no end then."""
        return [] if self.t[0] == self.t[1] else self._polygons(self.outline(n))

    def _polygons(self, outline: list[tuple[float, float, float]], *, tips: bool = False) -> list[list[tuple[float, float]]]:
        columns: dict[float, list[Span]] = {}
        for t, lo, hi in outline:
            columns.setdefault(t, []).append((lo, hi))
        return chains(list(columns.items()), self.t, (self.open_start, self.open_end), tips=tips)

    def plot(self, ax: Any, *, columns: SupportsIndex = 400, **style: Any) -> Any:
        """Draws it on matplotlib's ``ax``, which it returns: time [s] to the right, length [m] upwards, through what it covers at so many times
        (``columns``); between its ends and the first of them it has the form of what is next to them. ``style`` goes to ``ax.fill``."""
        outline = self.outline(columns)
        if self.t[0] == self.t[1]:
            # The other stands all the time.
            for lo, hi in sorted({(lo, hi) for _, lo, hi in outline}):
                ax.axhspan(lo, hi, **style)
            return ax
        for points in self._polygons(outline, tips=True):
            ax.fill([t for t, _ in points], [l for _, l in points], **style)
        return ax


#: The fields of an array of regions, for ``numpy.dtype``, aligned.
REGION = [("i", "<u8"), ("j", "<u8"), ("t", "<f8", (2,)), ("l", "<f8", (2,)), ("l_j", "<f8", (2,)), ("open_start", "?"), ("open_end", "?")]
_REGION = struct.Struct("<QQ6d??6x")


class Regions(Sequence[Region]):
    """Regions in the order of the tool: by both agents, then by time. Made into objects one by one, as they are asked for.

    ``numpy.asarray(regions)`` is a structured array of them, without a copy.
    """

    __slots__ = ("_fleet", "_rows")

    def __init__(self, rows: bytes, fleet: Fleet) -> None:
        self._rows, self._fleet = rows, fleet

    def __reduce__(self) -> tuple[Any, ...]:
        # Without it, protocols 0 and 1 refuse what has slots.
        return Regions, (self._rows, self._fleet)

    def __len__(self) -> int:
        return len(self._rows) // _REGION.size

    @overload
    def __getitem__(self, place: SupportsIndex) -> Region: ...
    @overload
    def __getitem__(self, place: slice) -> list[Region]: ...
    def __getitem__(self, place: Union[SupportsIndex, slice]) -> Union[Region, list[Region]]:
        if isinstance(place, slice):
            return [self[k] for k in range(*place.indices(len(self)))]
        i, j, *spans, start, end = _REGION.unpack_from(self._rows, range(len(self))[place] * _REGION.size)
        region = Region(i, j, (spans[0], spans[1]), (spans[2], spans[3]), (spans[4], spans[5]), start, end)
        region._fleet = self._fleet
        return region

    def __iter__(self) -> Iterator[Region]:
        return (self[k] for k in range(len(self)))

    def __eq__(self, other: object) -> bool:
        return self._rows == other._rows if isinstance(other, Regions) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._rows)

    @property
    def array(self) -> Any:
        """A structured NumPy array of all regions, without a copy: ``regions.array["t"][:, 0]`` are all first times. It cannot be written to."""
        import numpy

        return numpy.frombuffer(self._rows, dtype=numpy.dtype(REGION, align=True))

    def to_geopandas(self, n: SupportsIndex = 60) -> Any:
        """A ``GeoDataFrame`` with a row for each region: the fields of the array, each range as two columns, and as geometry its
        :meth:`Region.polygons`, time [s] as x and length [m] as y. The geometry is missing where the other agent stands all the time.
        """
        import geopandas  # type: ignore[import-not-found, import-untyped, unused-ignore]
        from shapely.geometry import MultiPolygon, Polygon  # type: ignore[import-untyped, import-not-found, unused-ignore]

        reports: dict[int, dict[str, Any]] = {}
        rows, shapes = [], []
        for region in self:
            if region.i not in reports:
                reports[region.i] = self._fleet.report(slices=n, agent=region.i)
            stands = region.t[0] == region.t[1]
            shapes.append(None if stands else MultiPolygon([Polygon(ring) for ring in region._polygons(region._outline(reports[region.i]))]))
            rows.append((region.i, region.j, *region.t, *region.l, *region.l_j, region.open_start, region.open_end))
        names = ("i", "j", "t_from", "t_to", "l_from", "l_to", "l_j_from", "l_j_to", "open_start", "open_end")
        columns = dict(zip(names, zip(*rows))) if rows else {name: () for name in names}
        return geopandas.GeoDataFrame(columns, geometry=shapes)

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> Any:
        array = self.array
        if copy is False and dtype not in (None, array.dtype):
            raise ValueError("regions have another type: they have to be copied")
        array = array if dtype is None else array.astype(dtype, copy=False)
        return array.copy() if copy else array

    def __repr__(self) -> str:
        return f"<{len(self)} regions>"
