"""Wear of the surfaces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Any

import numpy as np

from ._arrays import ArrayLike, Floats, as_plane, number
from ._declared import Table
from ._findings import warn_caller
from ._surface import Surface, per_cell
from ._units import has_unit


@dataclass(frozen=True, repr=False)
class Wear(Table):
    """Wear by Archard's law, an argument of :func:`asperity.solve`, :func:`asperity.march` and :func:`asperity.slide` (docs/wear.md).

    `coefficient` [m2/N]: worn volume over load and sliding distance, of the body that carries the moving surfaces, or a pair, of that body
    and of the counterbody. `velocity` [m/s]: the sliding velocity where nothing moves on the grid, a number, a history or a function of
    time; with :func:`asperity.slide` and with `tangential` their sliding counts instead. `threshold` [Pa]: pressure below which nothing
    wears. `map`: a factor of the coefficient in each cell, (nx, ny). `cycles_per_step`: cycles that each computed cycle of a tangential
    load stands for; with `cycles_tolerance` that many at most, chosen such that the place of this share of what a cycle wears is uncertain. `depth_limit` [m]: the depth at which a body is worn out, for the answers of a result.

    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(48, 48), size=(0.6e-3, 0.6e-3), radius=10e-3)
    >>> steel = asp.Elastic(young=210e9, poisson=0.3)
    >>> worn = asp.solve(sphere, steel, load=10.0, times=asp.uniform(100.0, 10), wear=asp.Wear(1e-15, velocity=0.1))
    >>> bool(abs(worn.wear_volume[-1] / (1e-15 * 10.0 * 10.0) - 1) < 1e-12)    # k W s
    True
    """

    coefficient: float | tuple[float, float]
    _: KW_ONLY
    velocity: Any = None
    threshold: float = 0.0
    map: ArrayLike | None = None
    cycles_per_step: float = 1.0
    cycles_tolerance: float | None = None
    depth_limit: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        most = float(np.max(np.abs(self.coefficient)))
        if most > 1e-9:
            warn_caller(f"the coefficient of wear is {most:g} m2/N: usual ones are below 1e-11, and 1 mm^3/(N m) is 1e-9 m2/N [unlikely-unit]")
        # A plain number, as the others; a labelled array is a history.
        if has_unit(self.velocity) and np.size(getattr(self.velocity, "magnitude", self.velocity)) == 1:
            object.__setattr__(self, "velocity", number("velocity", self.velocity))

    def _parts(self, shape: Surface, history: Callable[[str, Any], dict[str, Any]]) -> tuple[dict[str, Any], dict[str, Floats]]:
        """The keys of `[wear]`, and the arrays that they name; `history` gives the keys of one."""
        keys = self._keys
        if self.velocity is not None:
            keys["velocity"] = history("velocity", self.velocity)
        if self.map is None:
            return keys, {}
        keys["array"] = "wear"
        return keys, {"wear": as_plane(per_cell("wear map", keys.pop("map"), shape, ""))}
