"""Contacts that slide or roll: in time, and steady over velocities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ._core import CaseError
from ._declared import arguments_of
from ._arrays import ArrayLike, Floats, direction_of, line, number
from ._flash import Flash
from ._histories import Function, History, one_of
from ._problem import InTime, Run, table_keys
from ._result import Result
from ._solve import solved
from ._units import has_unit
from ._words import Movement


def _shear(given: Any) -> Any:
    """The key `shear_stress`."""
    if isinstance(given, dict):
        return {name: number(f"shear_stress {name}", value) for name, value in given.items()}
    # Pairs may hold quantities, of which numpy makes no array.
    listed = isinstance(given, (list, tuple)) and all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in given)
    if listed or (not has_unit(given) and np.ndim(given) == 2):
        return {"points": [[number("velocity", v), number("shear_stress", stress)] for v, stress in given]}
    return number("shear_stress", given)


@dataclass(kw_only=True)
class Moving(Run):
    """A contact that moves."""

    direction: str | float = "x"
    kind: Movement = "slide"
    shear_stress: float | Sequence[tuple[float, float]] | dict[str, float] | None = None
    flash: Flash | None = None

    def motion_keys(self) -> dict[str, Any]:
        """The keys of `[motion]` that say how it moves."""
        direction = direction_of(self.direction)
        keys = {"direction": direction if isinstance(direction, str) else f"{direction!r} rad", "kind": self.kind}
        return keys if self.shear_stress is None else {**keys, "shear_stress": _shear(self.shear_stress)}

    def flash_keys(self) -> dict[str, Any]:
        """The table `[flash]`, where it is given."""
        return table_keys(self, "flash", Flash, "flash")


@dataclass(kw_only=True)
class Slide(Moving, InTime):
    """The arguments of :func:`asperity.slide`."""

    velocity: History | Function | float | None = None
    path: History | Function | None = None
    start: float = 0.0
    cells_per_step: float = 1.0

    alternatives: ClassVar[list[tuple[str, ...]]] = [*Moving.alternatives, ("velocity", "path")]

    def course_keys(self) -> dict[str, Any]:
        what, course = one_of({"velocity": self.velocity, "path": self.path}, "give")
        motion = {what: self.history_keys(what, course), "start": self.start, "cells_per_step": self.cells_per_step, **self.motion_keys()}
        return {**super().course_keys(), "motion": motion, **self.flash_keys()}


@dataclass(kw_only=True)
class Steady(Moving):
    """The arguments of :func:`asperity.steady`."""

    velocities: ArrayLike

    def course_keys(self) -> dict[str, Any]:
        return {"motion": {"steady": {"velocities": line("velocities", self.velocities).tolist()}, **self.motion_keys()}, **self.flash_keys()}


@arguments_of(Slide)
def slide(given: Slide) -> Result:
    """A contact that moves in time: `surface` slides over the viscoelastic body, or rolls.

    Parameters
    ----------
    surface, material, times, load, pressure : as in :func:`solve`; the load or the pressure may have any history. Steps end besides
        wherever the surface has moved by whole cells
    velocity : of the surface over the body [m/s]: a number, or a history such as ``asp.table([(0, 0), (1, 0.01)])``
    path : instead, its position over time [m], a history that begins with 0
    start : the motion begins then [s]
    direction : "x", "y", or on periodic domains an angle from x towards y [rad]
    kind : "slide", or "roll": the contact moves over both bodies
    cells_per_step : cells that the surface moves in a step, at most
    shear_stress : on the area in contact [Pa], for `friction_coefficient_total`: a number; (velocity [m/s], stress) points, linear in the
        logarithm of the velocity; or a dict with `peak`, `velocity` and `width` (decades), peak exp(-(log10(v/velocity)/width)^2), which
        shifts with the temperature of the material
    flash : how warm friction makes the surfaces, asperity.Flash
    wear : what sliding takes off the surfaces, asperity.Wear, or a coefficient [m2/N]
    gap, size, boundary, hardness, temperature, quantities, fields, every, ... : as in :func:`solve`

    Returns
    -------
    Result with `velocity` [m/s], `sliding_distance` [m], `friction_force`, `side_force` [N], `friction_coefficient`,
    `friction_uncertainty`, `rolling_moment` [N m] and `dissipated_power` [W] of each row (docs/sliding.md); fields are in the frame of
    the contact

    Examples
    --------
    >>> import asperity as asp
    >>> wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    >>> rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    >>> result = asp.slide(wave, rubber, pressure=20e3, velocity=0.05, times=[0.06], boundary="periodic")
    >>> held = asp.steady(wave, rubber, pressure=20e3, velocities=[0.05], boundary="periodic")
    >>> bool(abs(result.friction_coefficient[-1] / held.friction_coefficient[0] - 1) < 0.01)
    True
    >>> bool(abs(result.sliding_distance[-1] - 3e-3) < 1e-12)
    True
    """
    return solved(given)


@arguments_of(Steady)
def steady(given: Steady) -> Result:
    """Steady states of motion: friction over the velocity.

    Parameters
    ----------
    surface, material : as in :func:`solve`
    velocities : of the surface over the body [m/s], each once; they are solved and returned in rising order
    load, pressure : held [N], [Pa], one of them
    direction, kind, shear_stress, flash : as in :func:`slide`
    fields, every, progress, on_step : as in :func:`solve`
    gap, size, boundary, hardness, temperature, tolerance, ... : as in :func:`solve`

    Returns
    -------
    Result with `velocity` in place of `time`, and of each velocity `friction_force`, `side_force` [N], `friction_coefficient`,
    `friction_uncertainty`, `rolling_moment` [N m], `dissipated_power` [W] and the numbers of any other contact

    Examples
    --------
    >>> import asperity as asp, numpy as np
    >>> roller = asp.Surface(-(np.linspace(-1, 1, 129) ** 2) * 50e-6, size=2e-3)
    >>> rubber = asp.Zener(shear=10e6, shear_kelvin=2e6, retardation_time=0.01, poisson=0.5)
    >>> result = asp.steady(roller, rubber, load=300.0, velocities=np.geomspace(1e-3, 10, 5))
    >>> int(np.argmax(result.friction_coefficient))     # most is lost while the material relaxes under the contact
    2
    """
    return solved(given)


def rubber_friction(result: Result, *, shear_stress: float) -> Floats:
    """Friction coefficient with an adhesive share: that of the loss in the bulk, and `shear_stress` [Pa] on the area in contact,
    `friction_coefficient + shear_stress * contact_area / load`; nothing is added where there is no load, and the share is negative where
    the velocity is.

    >>> import asperity as asp
    >>> wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    >>> rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    >>> result = asp.steady(wave, rubber, pressure=20e3, velocities=[0.05], boundary="periodic")
    >>> added = asp.rubber_friction(result, shear_stress=10e3) - result.friction_coefficient
    >>> bool(abs(added[0] - 0.5 * result.contact_fraction[0]) < 1e-12)
    True
    """
    if isinstance(shear_stress, (list, tuple, dict)) or np.ndim(shear_stress) > 0:
        raise CaseError("shear_stress is one number [Pa] here: one that depends on the velocity is given to asperity.slide or asperity.steady, as shear_stress=")
    load, force = result.load, number("shear_stress", shear_stress) * result.contact_area
    share = np.divide(force, load, out=np.zeros_like(load), where=load > 0)
    return np.asarray(result.friction_coefficient + np.where(result.velocity < 0, -share, share))
