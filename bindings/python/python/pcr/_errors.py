"""What is raised where there is no answer."""

from __future__ import annotations

from typing import Any, Optional

from ._pcr import Error

__all__ = ["Error", "ScenarioError", "scenario"]


class ScenarioError(Error):
    """A scenario was refused; it says what it is about.

    >>> try:
    ...     Fleet.from_json('{"agents": [{"id": 4, "radius": -1}]}')
    ... except ScenarioError as error:
    ...     error.agent, error.field, error.line
    ('agent 4', 'radius', 1)
    """

    def __init__(self, message: str, line: int, agent: Optional[str], part: Optional[str], field: Optional[str]) -> None:
        super().__init__(message)
        #: Line of the text, from 1.
        self.line = line
        #: For example ``"agent 7"``.
        self.agent = agent
        #: For example ``"segment 2"``, counted from 1.
        self.segment = part
        #: For example ``"radius"``.
        self.field = field

    def __reduce__(self) -> tuple[Any, ...]:
        # Exceptions are made anew from `args`, which is the message only: processes could not hand this one on.
        return ScenarioError, (str(self), self.line, self.agent, self.segment, self.field)


def scenario(make: Any, *arguments: Any) -> Any:
    """The core's errors about a scenario have several parts."""
    try:
        return make(*arguments)
    except Error as error:
        # Of many scenarios, the last part is the place of the one with the fault.
        parts, number = (error.args[:-1], error.args[-1]) if len(error.args) in (2, 6) else (error.args, None)
        message = parts[0] if number is None else f"scenario {number}: {parts[0]}"
        if len(parts) == 5:
            raise ScenarioError(message, *parts[1:]) from None
        raise Error(message) from None
