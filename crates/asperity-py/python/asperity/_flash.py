"""Flash temperature of a contact in motion."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np

from ._declared import Table
from ._findings import warn_caller
from ._words import Feedback, Partition


@dataclass(frozen=True, repr=False)
class Flash(Table):
    """How warm friction makes the surfaces, an argument of :func:`asperity.slide` and :func:`asperity.steady` (docs/flash.md).

    `conductivity` [W/(m K)] and `diffusivity` [m2/s] of both bodies, or pairs: of the slider, which carries the surfaces that move, and of
    the track. The heat is that of `friction`, a coefficient, or of the argument `shear_stress`; with `hysteresis` also what the bodies
    lose. `partition`: how it divides. `heated_for` [s]: for how long the surfaces of a periodic domain have been heated;
    needed there. `feedback`: whether the material of steady states is as warm as the contact in the
    mean.

    >>> import asperity as asp
    >>> roller = asp.Surface.cylinder(cells=(128,), size=(4e-3,), radius=10e-3)
    >>> rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    >>> warm = asp.Flash(0.2, 1e-7, friction=0.5, partition="track")
    >>> result = asp.steady(roller, rubber, load=300.0, velocities=[0.1, 1.0], flash=warm)
    >>> bool(result.flash_temperature_max[1] > result.flash_temperature_max[0] > 0.0)
    True
    """

    conductivity: float | tuple[float, float]
    diffusivity: float | tuple[float, float]
    _: KW_ONLY
    friction: float | None = None
    hysteresis: bool = False
    partition: Partition = "mean"
    heated_for: float | None = None
    feedback: Feedback = "none"

    def __post_init__(self) -> None:
        super().__post_init__()
        # That of diamond, the best of all, is 1e-3.
        if (most := float(np.max(self.diffusivity))) > 1e-2:
            warn_caller(f"the diffusivity is {most:g} m2/s, but no solid has more than 1e-3: the conductivity [W/(m K)] comes first [unlikely-unit]")
