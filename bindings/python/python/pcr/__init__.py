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

from . import _pcr
from ._errors import Error, ScenarioError
from ._fleet import Conflict, Fleet, Passing, Plan, check_all
from ._layout import Delay, Layout, Lock
from ._regions import Region, Regions

__all__ = ["Conflict", "Delay", "Error", "Fleet", "Layout", "Lock", "Passing", "Plan", "Region", "Regions", "ScenarioError", "check_all"]
__version__ = _pcr.version

# They are of this module for whoever reads a message or a pickle.
for _public in (Conflict, Delay, Fleet, Layout, Lock, Passing, Plan, Region, Regions, ScenarioError, check_all):
    _public.__module__ = __name__
del _public
