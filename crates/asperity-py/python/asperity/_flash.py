"""Flash temperature of a contact in motion."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal, get_args

import numpy as np

from ._arrays import choice, number
from ._core import CaseError

Partition = Literal["mean", "local", "slider", "track"]
Feedback = Literal["none", "mean"]


@dataclass(frozen=True)
class Flash:
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

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of `[flash]`."""
        keys: dict[str, Any] = {
            "conductivity": _of_bodies("conductivity", self.conductivity),
            "diffusivity": _of_bodies("diffusivity", self.diffusivity),
            "hysteresis": bool(self.hysteresis),
            "partition": choice("partition", self.partition, get_args(Partition)),
            "feedback": choice("feedback", self.feedback, get_args(Feedback)),
        }
        given = {"friction": self.friction, "heated_for": self.heated_for}
        return keys | {name: number(name, value) for name, value in given.items() if value is not None}


def _of_bodies(name: str, value: Any) -> float | list[float]:
    """One number for both bodies, or two, of slider and track."""
    if np.ndim(value) == 0:
        return number(name, value)
    if np.shape(value) != (2,):
        raise CaseError(f"{name} is {value!r}, but must be a number, or a pair of them, of slider and track")
    return [number(name, one) for one in value]
