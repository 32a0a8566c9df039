"""Adhesion: an attraction between the surfaces that falls with the gap."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ._core import CaseError
from ._declared import Table
from ._words import AdhesionLaw


@dataclass(frozen=True, kw_only=True, repr=False)
class Adhesion(Table):
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
        super().__post_init__()
        if (self.range is None) == (self.strength is None):
            raise CaseError("Adhesion takes a range [m] or a strength [Pa], one of the two")
        for name, unit in {"work": " J/m2", "range": " m", "strength": " Pa", "tolerance": ""}.items():
            value, least = getattr(self, name), "0 or greater" if name == "work" else "greater than 0"
            if value is not None and not (0.0 < value < math.inf or (name == "work" and value == 0.0)):
                raise CaseError(f"{name} is {value:g}{unit}, but must be finite and {least}")
