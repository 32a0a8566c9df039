"""A fluid in the gap whose pressure opens the contact."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, get_args

from ._arrays import choice, number
from ._core import CaseError
from ._histories import History, as_history
from ._words import Coupling, Flow, Pockets, Reference, Sides


@dataclass(frozen=True, kw_only=True, repr=False)
class Fluid:
    """A fluid that acts on the surfaces, an argument of :func:`asperity.solve` and :func:`asperity.march` (docs/leakage.md).

    `inlet`, a number or a history, and `outlet`: absolute pressures [Pa]; the `viscosity` [Pa s] of a liquid, or a `gas` ("air", "helium",
    ...), or the viscosity and `molar_mass` [kg/mol] of one, at a `temperature` [K]. The load does not contain the pressure of the
    `reference`, "outlet" or "vacuum". `coupling` is "two-way", or "uniform": the pressure of the inlet acts everywhere. `pockets` are "kept",
    "drained", "sealed" with a liquid of this `bulk_modulus` [Pa] or a gas, or "connected" through contacts with the gap `smallest_gap` [m].

    >>> import asperity as asp
    >>> wave = asp.Surface.wave(cells=(16, 64), size=(1e-3, 1e-3), amplitude=1e-6, wavelength=(float("inf"), 1e-3))
    >>> rubber = asp.Elastic(young=3e6, poisson=0.5)
    >>> water = asp.Fluid(inlet=4e3, outlet=0.0, viscosity=1e-3)
    >>> result = asp.solve(wave, rubber, pressure=5e3, times=[1.0], boundary="periodic", fluid=water)
    >>> bool(0.0 < result.fluid_load[-1] < result.load[-1])
    True
    """

    inlet: History | float
    outlet: float
    viscosity: float | None = None
    gas: str | None = None
    molar_mass: float | None = None
    temperature: float | None = None
    coupling: Coupling = "two-way"
    pockets: Pockets = "kept"
    bulk_modulus: float | None = None
    reference: Reference = "outlet"
    direction: Flow = "x"
    sides: Sides | None = None
    smallest_gap: float = 0.0

    def __post_init__(self) -> None:
        words = {"coupling": Coupling, "pockets": Pockets, "reference": Reference, "direction": Flow}
        for name, allowed in words.items():
            choice(name, getattr(self, name), get_args(allowed))
        if self.sides is not None:
            choice("sides", self.sides, get_args(Sides))
        for name in ("outlet", "viscosity", "molar_mass", "temperature", "bulk_modulus", "smallest_gap"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, number(name, getattr(self, name)))
        object.__setattr__(self, "inlet", as_history("inlet", self.inlet, "Pa"))

    def __repr__(self) -> str:
        told = (f"{field.name}={getattr(self, field.name)!r}" for field in fields(self) if getattr(self, field.name) != field.default)
        return f"Fluid({', '.join(told)})"

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of `[leakage]`."""
        if not isinstance(self.inlet, History):
            raise CaseError(f"inlet is {self.inlet!r}, but must be a pressure [Pa] or a history")
        given = {field.name: getattr(self, field.name) for field in fields(self) if getattr(self, field.name) is not None}
        if self.coupling == "uniform":
            del given["pockets"]
        return {**given, "inlet": self.inlet._keys}
