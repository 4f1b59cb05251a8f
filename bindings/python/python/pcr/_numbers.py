"""Numbers as callers write them: of Python, of NumPy, and ranges of them."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Mapping, Sequence, Set
from numbers import Real
from typing import Any, SupportsFloat, SupportsIndex, TypeVar, Union

from ._pcr import Error

Span = tuple[float, float]
#: A number, or from and to.
Ranged = Union[SupportsFloat, Sequence[SupportsFloat]]
Item = TypeVar("Item")
TEXTS = (str, bytes, bytearray)


def finite(**numbers: SupportsFloat) -> None:
    for name, number in numbers.items():
        if not math.isfinite(number):
            raise Error(f"{name}: {number} is not a finite number")


def whole(name: str, number: SupportsIndex, most: int = 2**64 - 1) -> int:
    """A whole number from 0."""
    found = operator.index(number)
    if not 0 <= found <= most:
        raise Error(f"{name}: {found} is out of range; allowed is 0 to {most}")
    return found


def span(name: str, value: Ranged) -> Span:
    """The same number twice where there is one."""
    # Two digits of a text would be from and to, and what has no order is neither.
    if isinstance(value, (*TEXTS, Set, Mapping)):
        raise TypeError(f"{name}: {value!r} is neither a number nor from and to")
    try:
        lo, hi = value  # type: ignore[misc]
    except TypeError:
        lo = hi = value
    except ValueError:
        raise Error(f"{name}: {value} is neither a number nor from and to") from None
    if isinstance(lo, TEXTS) or isinstance(hi, TEXTS):
        raise TypeError(f"{name}: from {lo!r} to {hi!r} are no numbers")
    return float(lo), float(hi)


def ordered(name: str, values: Iterable[Item]) -> list[Item]:
    """A list of what has an order: keys of a mapping are not its values, and a set has any order."""
    if isinstance(values, (*TEXTS, Set, Mapping)):
        raise TypeError(f"{name}: {values!r} is no list")
    return list(values)


def plain(value: object) -> Any:
    """What JSON has for a value that it does not know itself: numbers and arrays of NumPy, and any mapping."""
    if isinstance(value, Mapping):
        return dict(value)
    if hasattr(value, "tolist"):
        found = value.tolist()
        # A longdouble remains one, and would be asked for without end.
        if type(found) is not type(value):
            return found
        if isinstance(found, Real):
            return float(found)
    raise TypeError(f"{type(value).__name__} is nothing that a scenario file can hold")
