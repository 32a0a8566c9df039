"""Adhesion: an attraction between the surfaces that falls with the gap."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from typing import Any, get_args

import numpy as np

from ._arrays import choice, number
from ._core import CaseError
from ._words import AdhesionLaw


@dataclass(frozen=True, kw_only=True, repr=False)
class Adhesion:
    """An attraction between the surfaces, an argument of :func:`asperity.solve` and :func:`asperity.march`.

    `work` of adhesion [J/m2]; the `range` of the gap [m] over which it falls, or its largest value, the `strength` [Pa]; the `law`
    "exponential", "dugdale", "linear" or "van-der-waals". `tolerance` is the largest change in the last pass, relative to all forces.
    Cells that are too large for the range snap one by one: that is refused unless `allow_unresolved` (docs/adhesion.md).

    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(128, 128), size=(60e-6, 60e-6), radius=100e-6)
    >>> silicone = asp.Elastic(young=2e6, poisson=0.49)
    >>> pull = asp.table([(0.0, 0.5e-6), (1.0, -0.8e-6)])
    >>> glue = asp.Adhesion(work=50e-3, range=200e-9)
    >>> result = asp.solve(sphere, silicone, approach=pull, times=asp.uniform(1.0, 26), adhesion=glue)
    >>> ratio = -result.load.min() / (3.141593 * 50e-3 * 100e-6)          # between 3/2 (JKR) and 2 (DMT)
    >>> bool(1.5 < ratio < 1.7)
    True
    """

    work: float
    range: float | None = None
    strength: float | None = None
    law: AdhesionLaw = "exponential"
    allow_unresolved: bool = False
    tolerance: float = 1e-4

    def __post_init__(self) -> None:
        choice("law", self.law, get_args(AdhesionLaw))
        if (self.range is None) == (self.strength is None):
            raise CaseError("Adhesion takes a range [m] or a strength [Pa], one of the two")
        if not isinstance(self.allow_unresolved, (bool, np.bool_)):
            raise CaseError(f"allow_unresolved is {self.allow_unresolved!r}, but must be True or False")
        for name, unit in (("work", "J/m2"), ("range", "m"), ("strength", "Pa"), ("tolerance", "")):
            if (given := getattr(self, name)) is None:
                continue
            value = number(name, given)
            if not (0.0 < value < math.inf or (name == "work" and value == 0.0)):
                least = "0 or greater" if name == "work" else "greater than 0"
                raise CaseError(f"{name} is {f'{value:g} {unit}'.strip()}, but must be finite and {least}")
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        told = (f"{field.name}={getattr(self, field.name)!r}" for field in fields(self) if getattr(self, field.name) != field.default)
        return f"Adhesion({', '.join(told)})"

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of `[adhesion]`."""
        return {name: value for name, value in asdict(self).items() if value is not None}
