"""Numbers as callers write them: of Python, of NumPy, and ranges of them."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Mapping, Sequence, Set
from numbers import Complex, Real
from typing import Any, Optional, SupportsFloat, SupportsIndex, TypeVar, Union

from ._pcr import Error

Span = tuple[float, float]
#: A number, or from and to.
Ranged = Union[SupportsFloat, Sequence[SupportsFloat]]
Item = TypeVar("Item")
TEXTS = (str, bytes, bytearray)


def real(name: str, number: SupportsFloat) -> float:
    """A number as a float. Complex numbers, ``True`` and ``False``, and texts are refused."""
    if isinstance(number, TEXTS) or is_truth(number) or (isinstance(number, Complex) and not isinstance(number, Real)):
        raise TypeError(f"{name}: {number!r} is no number")
    try:
        return float(number)
    except OverflowError:
        raise Error(f"{name}: the number is too large") from None


def finite(name: str, number: SupportsFloat) -> float:
    found = real(name, number)
    if not math.isfinite(found):
        raise Error(f"{name}: {found} is not a finite number")
    return found


def is_truth(value: object) -> bool:
    """Whether it is ``True`` or ``False``, of Python or of NumPy."""
    return isinstance(value, bool) or (getattr(getattr(value, "dtype", None), "kind", "") == "b" and getattr(value, "shape", None) == ())


def truth(name: str, value: Optional[bool]) -> bool:
    """``None`` is ``False``. Other values are refused, because Python takes most of them for true, ``"no"`` among them."""
    if value is not None and not is_truth(value):
        raise TypeError(f"{name}: {value!r} is neither True nor False")
    return bool(value)


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
    return real(name, lo), real(name, hi)


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
