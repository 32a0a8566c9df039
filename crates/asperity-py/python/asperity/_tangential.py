"""Friction, and loads along the surfaces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Any

import numpy as np

from ._arrays import ArrayLike, Floats, as_plane, number
from ._core import CaseError
from ._declared import Table
from ._histories import Function, History, one_of
from ._sealed import Named
from ._surface import Surface, per_cell
from ._units import is_labelled
from ._words import Coupled


@dataclass(frozen=True, repr=False)
class Friction(Table):
    """Friction between the surfaces, an argument of :func:`asperity.solve` and :func:`asperity.march` (docs/tangential.md).

    `coefficient`, a number or an array (nx, ny) with one for each cell; `shear_limit` [Pa]: the largest tangential traction, whatever the
    pressure; `coupling`: what pressure and tangential traction of bodies with different elastic constants do to each other, "neglect" or
    "full". A number in place of this is a coefficient alone.

    >>> import asperity as asp
    >>> asp.Friction(0.3, shear_limit=50e6)
    Friction(0.3, shear_limit=50000000.0)
    """

    coefficient: float | ArrayLike
    _: KW_ONLY
    shear_limit: float | None = None
    coupling: Coupled = "neglect"

    def _parts(self, shape: Surface) -> tuple[dict[str, Any], dict[str, Floats]]:
        """The keys of `[friction]`, and the arrays that they name."""
        keys = self._keys
        if np.ndim(self.coefficient) == 0:
            return {**keys, "coefficient": number("friction", self.coefficient)}, {}
        keys["array"] = "friction"
        return keys, {"friction": as_plane(per_cell("friction", keys.pop("coefficient"), shape, ""))}


@dataclass(frozen=True, repr=False)
class Tangential(Named):
    """A load along the surfaces: see :func:`asperity.tangential`."""

    control: str
    #: Its components along x and y over time; numbers are held from t = 0 on.
    course: tuple[History | Function | float, History | Function | float]

    def __repr__(self) -> str:
        return f"tangential({self.control}={self.course!r})"

    def _keys(self, line: bool, history: Callable[[str, Any, str], dict[str, Any]]) -> dict[str, Any]:
        """The keys of `[tangential]`; `history` gives the keys of one."""
        unit = ("N/m" if line else "N") if self.control == "force" else "m"
        x, y = (history(f"{self.control} along {axis}", value, unit) for axis, value in zip("xy", self.course))
        return {"control": self.control, "x": x, "y": y}


def tangential(*, force: Any = None, displacement: Any = None) -> Tangential:
    """A load along the surfaces, for the argument `tangential` of :func:`asperity.solve` and :func:`asperity.march`, with `friction`.

    Parameters
    ----------
    force, displacement : one of the two [N, of a line contact N/m; m]: a number, a history (step, ramp, triangle, sine, table ...) or a function of time [s] along
        x, or a pair of them, along x and y. A force or displacement other than 0 at the start acts suddenly at t = 0.

    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(48, 48), size=(0.6e-3, 0.6e-3), radius=10e-3)
    >>> glass = asp.Elastic(young=70e9, poisson=0.22)
    >>> pull = asp.tangential(force=asp.ramp(1.5, duration=1.0))
    >>> result = asp.solve(sphere, glass, load=10.0, times=asp.uniform(1.0, 4), friction=0.3, tangential=pull)
    >>> share = result.stick_area[-1] / (result.stick_area[-1] + result.slip_area[-1])    # Mindlin: (1 - 1.5/3)^(2/3) = 0.63
    >>> bool(abs(share - 0.63) < 0.03)
    True
    """
    control, value = one_of({"force": force, "displacement": displacement}, "give")
    course = tuple(value) if _is_pair(value) else (value, 0.0)
    if any(one is None for one in course):
        raise CaseError(f"{control} is {value!r}, but must be a number or a history along x, or a pair of them, along x and y")
    return Tangential(control, (course[0], course[1]))


def _is_pair(value: Any) -> bool:
    """Whether it has one part along x and one along y; two points of a table are no pair."""
    if isinstance(value, (tuple, list)):
        return len(value) == 2 and not all(isinstance(part, (tuple, list)) for part in value)
    return getattr(value, "ndim", 0) == 1 and len(value) == 2 and not is_labelled(value) and not hasattr(value, "index")
