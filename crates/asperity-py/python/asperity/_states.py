"""States that bring all that belongs to their fields: a contact, the last fields of a result, a row of a march."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np

from ._arrays import AnyArray, Floats
from ._core import CaseError
from ._findings import warn_caller
from ._words import Boundary


#: Why a body of another kernel has no stress.
NO_HALF_SPACE = (
    "the stress below the surface is that of a half-space, but the contact is one of a given kernel: give stress the bare pressure, size and boundary "
    "where the body is nearly a half-space at the depths of interest"
)


@dataclass(frozen=True)
class State:
    """One state of a contact."""

    size: tuple[float, ...]
    boundary: Boundary
    gap: Floats | None
    pressure: Floats
    #: Where the surfaces touch.
    touches: AnyArray
    #: Poisson's ratios of the bodies, None where one is not constant; empty where they are not known.
    poisson: Sequence[float | None] = ()
    #: Tangential tractions along x and y on the first body.
    tractions: tuple[Floats, Floats] | None = None
    #: Why there is no stress below it, where there is none.
    no_stress: str | None = None


@runtime_checkable
class HasState(Protocol):
    """What a state can be taken from: an ElasticContact, a Result (its last fields), a Step."""

    def _state(self) -> State: ...


def refuse_beside(what: str, held: Any, given: dict[str, Any]) -> None:
    """Refuses arguments that a state brings itself."""
    if named := [name for name, value in given.items() if value is not None]:
        kind = type(held).__name__
        raise CaseError(f"{what} takes {', '.join(named)} from the {kind} itself: leave {'it' if len(named) == 1 else 'them'} out, or give the bare array")


def said(function: str, what: str, value: Any, usual: str, words: str) -> str:
    """What a bare array leaves open; without it the usual one, which is told."""
    if value is None:
        warn_caller(f"{function} of a bare array takes {what}={usual!r}: give {what}={words}, or the contact, result or row itself", UserWarning)
        return usual
    return str(value)


def touching(pressure: Floats) -> AnyArray:
    return np.ascontiguousarray(pressure > 0.0, dtype=np.uint8)
