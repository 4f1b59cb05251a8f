"""Options of the importers."""

from typing import Optional, TypedDict


class Options(TypedDict):
    """The options of ``pcr import`` that fleets and layouts need; ``None`` means that an option is not given."""

    radius: Optional[float]
    speed: Optional[float]
    acceleration: Optional[float]
    rotation: Optional[float]
    vehicle: Optional[str]
    routes: list[str]
    partial: bool
