"""For users of Tamaas and ContactMechanics: their words, and conversions.

============================  ==============================  =================================================
Tamaas                        ContactMechanics                asperity
============================  ==============================  =================================================
model.E, model.nu             young (it is E*)                contact_modulus=E/(1 - nu^2), or a material
surface (apex up)             topography (apex up)            Surface.heights (out of the body), apex up
solve(mean pressure)          external_force                  load= [N], pressure= (mean) [Pa], approach= [m]
traction                      force per cell                  pressure [Pa]
gap                           gap                             gap [m]
(none)                        offset                          approach: 0 where the sampled gap first closes
registerNonPeriodic           FreeFFTElasticHalfSpace         boundary="free" (the default)
(default)                     PeriodicFFTElasticHalfSpace     boundary="periodic"
tolerance                     pentol, forcetol                tolerance (relative), and a certificate
MaxwellViscoelastic           (none)                          Prony, ... and solve
============================  ==============================  =================================================

docs/compare.md has the same problems in each, with the numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ._arrays import line, number
from ._core import CaseError
from ._materials import Prony
from ._surface import Surface

__all__ = ["prony_of_tamaas", "topography"]


def prony_of_tamaas(
    *, E: float, nu: float, shear_moduli: Sequence[float], characteristic_times: Sequence[float], hardness: float | None = None
) -> Prony:
    """The material of ``tamaas.MaxwellViscoelastic(model, surface, tol, dt, shear_moduli, characteristic_times)``.

    `E` and `nu` are those of its model: the relaxed branch; `shear_moduli` [Pa] are absolute, `characteristic_times` [s]
    relaxation times.

    >>> from asperity import compat
    >>> rubber = compat.prony_of_tamaas(E=3e6, nu=0.5, shear_moduli=[2e6], characteristic_times=[1.0])
    >>> [round(float(rubber.relaxation_modulus(t))) for t in (0.0, 1e9)]
    [3000000, 1000000]
    """
    moduli, times = line("shear_moduli", shear_moduli), line("characteristic_times", characteristic_times)
    if len(moduli) != len(times):
        raise CaseError(f"there are {len(moduli)} shear_moduli, but {len(times)} characteristic_times")
    relaxed = number("E", E) / (2 * (1 + number("nu", nu)))
    terms = [(float(modulus), float(time)) for modulus, time in zip(moduli, times)]
    return Prony(equilibrium=relaxed, terms=terms, modulus="shear", poisson=nu, hardness=hardness)


def topography(surface: Surface, *, periodic: bool = False) -> Any:
    """The surface as a ``SurfaceTopography.Topography`` in metres, for ContactMechanics and contact.engineering.

    The other way needs no conversion: everything that takes a surface takes topographies.
    """
    import SurfaceTopography  # type: ignore[import-not-found,import-untyped,unused-ignore]

    return SurfaceTopography.Topography(surface.heights.copy(), surface.size, unit="m", periodic=periodic)
