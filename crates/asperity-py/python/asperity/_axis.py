"""What the rows of a result follow one another in: times, or the velocities of steady states of motion."""

from __future__ import annotations

from typing import NamedTuple


class Axis(NamedTuple):
    """The coordinate of the rows."""

    #: Its name, also of its dimension.
    name: str
    #: Its symbol.
    symbol: str
    #: Its unit.
    unit: str


TIME = Axis("time", "t", "s")
VELOCITY = Axis("velocity", "v", "m/s")
