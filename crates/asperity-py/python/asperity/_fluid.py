"""A fluid in the gap whose pressure opens the contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ._declared import Table
from ._histories import History, as_history
from ._words import Coupling, Flow, Gas, Pockets, Reference, Sides


@dataclass(frozen=True, kw_only=True, repr=False)
class Fluid(Table):
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
    gas: Gas | None = None
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
        super().__post_init__()
        object.__setattr__(self, "inlet", as_history("inlet", self.inlet, "Pa"))

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of `[leakage]`."""
        given = {**super()._keys, "inlet": as_history("inlet", self.inlet, "Pa")._keys}
        return {name: value for name, value in given.items() if name != "pockets" or self.coupling != "uniform"}
