"""How the times of a material depend on temperature: shift factors a_T.

In a thermorheologically simple material all times scale by one factor: E(t, T) = E(t/a_T, T_r). A body of changing
temperature runs on its reduced time, d xi = dt/a_T(T(t)).

Sources: M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701; L. W. Morland, E. H. Lee, Trans.
Soc. Rheology 4 (1960) 233.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from . import _core
from ._arrays import AnyPath, ArrayLike, Floats, each, number, points
from ._core import CaseError
from ._findings import warn_caller
from ._parameters import call, parameters
from ._sealed import Named
from ._units import carries


#: How moduli depend on temperature, besides their times: "density", its expansion [1/K], or (temperature [K], b_T) points.
Vertical = str | float | Sequence[tuple[float, float]] | None


@dataclass(frozen=True)
class Shift(Named):
    """A shift factor a_T over temperature [K]; made by :func:`wlf`, :func:`arrhenius`, :func:`shift_table` or a fit.

    With a vertical shift the moduli at a temperature are those at the reference over b_T: ``vertical="density"`` is
    b_T = T_r/T (a rubber), a number its volume expansion alpha [1/K] besides, b_T = (T_r/T)(1 + alpha (T - T_r)), and points are
    (temperature [K], b_T), with ln b_T linear in between. A run needs a constant temperature then.
    """

    model: str
    numbers: tuple[float, ...]
    #: Points of a table: (temperature [K], log10 a_T).
    points: tuple[tuple[float, float], ...] = ()
    #: How moduli depend on temperature: the expansion [1/K] of a density, or points (temperature [K], b_T).
    vertical: float | tuple[tuple[float, float], ...] | None = None

    #: Constants of WLF: c1, and c2 [K]; activation energy of Arrhenius [J/mol]; reference temperature [K].
    c1, c2, activation_energy, reference = parameters(float, 4)

    @property
    def _parameters(self) -> dict[str, Any]:
        return dict(zip(_NUMBERS[self.model], self.numbers))

    def factor(self, temperature: ArrayLike) -> Floats:
        """a_T at temperatures [K]: processes take a_T times as long as at the reference temperature.

        >>> import asperity as asp
        >>> round(float(asp.wlf(c1=8.86, c2=101.6, reference=293.15).factor(303.15)), 3)
        0.161
        """
        return each(functools.partial(_core.shift_factor, self._keys), "temperatures", temperature)

    def vertical_factor(self, temperature: ArrayLike) -> Floats:
        """b_T at temperatures [K]: moduli are those at the reference temperature over b_T; 1 without a vertical shift.

        >>> import asperity as asp
        >>> rubber = asp.wlf(c1=8.86, c2=101.6, reference=293.15, vertical="density")
        >>> round(1 / float(rubber.vertical_factor(353.15)), 4)
        1.2047
        """
        return each(functools.partial(_core.vertical_shift_factor, self._keys), "temperatures", temperature)

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of a `shift`."""
        keys: dict[str, Any] = {"model": self.model, **{_KEYS.get(name, name): value for name, value in self._parameters.items()}}
        if self.model == "table":
            keys["points"] = [list(point) for point in self.points]
        if isinstance(self.vertical, tuple):
            keys["vertical"] = [list(point) for point in self.vertical]
        elif self.vertical is not None:
            keys["vertical"] = {"expansion": self.vertical} if self.vertical else "density"
        return keys

    def __repr__(self) -> str:
        vertical = list(self.vertical) if isinstance(self.vertical, tuple) else "density" if self.vertical == 0.0 else self.vertical
        given = {**({"pairs": list(self.points)} if self.model == "table" else self._parameters), "vertical": vertical}
        shown = {name: value for name, value in given.items() if value is not None}
        return call("shift_table" if self.model == "table" else self.model, shown, int(self.model == "table"))


#: What the numbers of a shift are called, and in a case where they have another name there.
_NUMBERS = {"wlf": ("c1", "c2", "reference"), "arrhenius": ("activation_energy", "reference"), "table": ()}
_KEYS = {"activation_energy": "energy"}


def wlf(*, c1: float, c2: float, reference: float, vertical: Vertical = None) -> Shift:
    """log10 a_T = -c1 (T - T_r)/(c2 + T - T_r), c2 and the reference temperature T_r in K; `vertical` as :class:`Shift` says."""
    return _checked(Shift("wlf", (number("c1", c1), number("c2", c2), _kelvin("reference", reference)), vertical=_vertical(vertical)))


def arrhenius(*, activation_energy: float, reference: float, vertical: Vertical = None) -> Shift:
    """ln a_T = (E_a/R)(1/T - 1/T_r), the activation energy in J/mol, the reference temperature in K; `vertical` as :class:`Shift`
    says."""
    numbers = (number("activation_energy", activation_energy), _kelvin("reference", reference))
    return _checked(Shift("arrhenius", numbers, vertical=_vertical(vertical)))


def shift_table(pairs: Sequence[tuple[float, float]] | AnyPath, *, vertical: Vertical = None) -> Shift:
    """log10 a_T, linear between (temperature [K], log10 a_T) points in order of temperature; or the path of a table of temperatures
    and shift factors with a header, in a text file or a spreadsheet, as ``asperity material fit --shift-table`` reads it.

    >>> import asperity as asp
    >>> round(float(asp.shift_table([(283.15, 1.0), (293.15, 0.0)]).factor(288.15)), 9)
    3.16227766
    """
    if isinstance(pairs, (str, os.PathLike)):
        shift = made(_core.read_shift_table(os.fspath(pairs)))
        assert shift is not None
        return _checked(replace(shift, vertical=_vertical(vertical)))
    return _checked(Shift("table", (), tuple(points("points of the shift", pairs, ("K", ""))), _vertical(vertical)))


def _vertical(given: Vertical) -> float | tuple[tuple[float, float], ...] | None:
    if given is None or given == "density":
        return None if given is None else 0.0
    if isinstance(given, str):
        raise CaseError(f"vertical is {given!r}, but must be 'density', an expansion in 1/K, or (temperature, b_T) points")
    if not isinstance(given, (list, tuple)) and np.ndim(given) == 0:
        return number("vertical", given)
    pairs = points("points of the vertical shift", given, ("K", ""))
    if any(not factor > 0.0 for _, factor in pairs):
        raise CaseError(f"points of the vertical shift are {pairs!r}, but the factors b_T must be greater than 0")
    return tuple(pairs)


def _kelvin(what: str, value: Any) -> float:
    """A temperature [K], with a warning where it looks like one in degrees Celsius."""
    kelvin = number(what, value)
    coldest, _ = _core.POLYMERS
    if 0.0 < kelvin < coldest and not carries(value):
        words = f"{what} is {kelvin:g} K, which is {kelvin - 273.15:g} °C: temperatures are in K, and {kelvin:g} °C is {kelvin + 273.15:g} K"
        warn_caller(f"{words} [unlikely-unit]")
    return kelvin


def _checked(shift: Shift) -> Shift:
    # The core checks the constants even where no temperature is asked for.
    _core.shift_factor(shift._keys, np.empty(0))
    return shift


def made(keys: dict[str, Any] | None) -> Shift | None:
    """The shift of these keys."""
    if keys is None:
        return None
    numbers = tuple(keys[_KEYS.get(name, name)] for name in _NUMBERS[keys["model"]])
    vertical = keys.get("vertical")
    if isinstance(vertical, dict):
        vertical = vertical["expansion"]
    return Shift(keys["model"], numbers, tuple(tuple(point) for point in keys.get("points", ())), _vertical(vertical))


def temperature_keys(value: float | Sequence[tuple[float, float]]) -> dict[str, Any]:
    """The keys of `[temperature]`, of a temperature of the run [K] or its (time [s], temperature [K]) points."""
    if carries(value) or (not isinstance(value, (list, tuple)) and np.ndim(value) == 0):
        return {"history": {"kind": "constant", "value": _kelvin("temperature", value)}}
    pairs = points("temperature", value, ("s", "K"))
    if not pairs:
        raise CaseError("temperature holds no points: give a number [K] or (time [s], temperature [K]) pairs")
    return {"history": {"kind": "table", "points": [list(point) for point in pairs]}}
