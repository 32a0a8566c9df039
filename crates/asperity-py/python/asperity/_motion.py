"""Contacts that slide or roll: in time, and steady over velocities."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._arrays import Floats, angle, choice, line, number
from ._core import CaseError
from ._histories import History, Times, as_history

if TYPE_CHECKING:
    from ._words import Field, Movement
    from ._layers import Body
    from ._materials import Material
    from ._result import Result

def _keys(travel: dict[str, Any], direction: str | float, kind: str, shear_stress: float | None) -> dict[str, Any]:
    """The keys of `[motion]`."""
    if isinstance(direction, str) and direction not in ("x", "y"):
        raise CaseError(f"direction is {direction!r}, but must be 'x', 'y' or an angle from x towards y [rad]")
    keys = {
        **travel,
        "direction": direction if isinstance(direction, str) else angle("direction", direction),
        "kind": choice("kind", kind, ("slide", "roll")),
    }
    return keys if shear_stress is None else {**keys, "shear_stress": number("shear_stress", shear_stress)}


def _check_options(function: Callable[..., Any], options: dict[str, Any]) -> None:
    """Refuses options that :func:`solve` does not have, before anything is solved."""
    from ._solve import solve

    known = [name for name in inspect.signature(solve).parameters if name[0] != "_" and name != "approach" and name != "stages"]
    for name in options:
        if name not in known:
            near = difflib.get_close_matches(name, [*known, *inspect.signature(function).parameters], 1)
            raise TypeError(f"{function.__name__}() takes no argument {name!r}" + (f"; did you mean {near[0]!r}?" if near else ""))


def slide(
    surface: Any = None,
    material: Material | Body | Sequence[Material | Body] | None = None,
    *,
    times: Times | npt.ArrayLike,
    load: History | float | None = None,
    pressure: History | float | None = None,
    velocity: History | float | None = None,
    path: History | None = None,
    start: float = 0.0,
    direction: str | float = "x",
    kind: Movement = "slide",
    cells_per_step: float = 1.0,
    shear_stress: float | None = None,
    **options: Any,
) -> Result:
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
    shear_stress : on the area in contact [Pa], for `friction_coefficient_total`
    options : further ones of :func:`solve`: gap, size, boundary, hardness, temperature, quantities, fields, every, ...

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
    from ._solve import solve

    _check_options(slide, options)
    if (velocity is None) == (path is None):
        raise CaseError("give velocity or path, exactly one of them")
    what, given = ("path", path) if velocity is None else ("velocity", velocity)
    travel = {
        what: as_history(what, given)._keys,
        "start": number("start", start),
        "cells_per_step": number("cells_per_step", cells_per_step),
    }
    motion = _keys(travel, direction, kind, shear_stress)
    return solve(surface, material, times=times, load=load, pressure=pressure, _motion=motion, **options)


def steady(
    surface: Any = None,
    material: Material | Body | Sequence[Material | Body] | None = None,
    *,
    velocities: npt.ArrayLike,
    load: float | None = None,
    pressure: float | None = None,
    direction: str | float = "x",
    kind: Movement = "slide",
    shear_stress: float | None = None,
    fields: Sequence[Field] = ("pressure",),
    every: int | None = None,
    progress: bool | None = None,
    on_step: Callable[[Any], object] | None = None,
    **options: Any,
) -> Result:
    """Steady states of motion: friction over the velocity.

    Parameters
    ----------
    surface, material : as in :func:`solve`
    velocities : of the surface over the body [m/s], each once; they are solved and returned in rising order
    load, pressure : held [N], [Pa], one of them
    direction, kind, shear_stress : as in :func:`slide`
    fields, every, progress, on_step : as in :func:`solve`
    options : further ones of :func:`solve`: gap, size, boundary, hardness, temperature, tolerance, ...

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
    from ._solve import solve

    _check_options(steady, options)
    travel = {"steady": {"velocities": line("velocities", velocities).tolist()}}
    return solve(
        surface,
        material,
        times=[1.0],
        load=load,
        pressure=pressure,
        fields=fields,
        every=every,
        progress=progress,
        on_step=on_step,
        _motion=_keys(travel, direction, kind, shear_stress),
        **options,
    )


def rubber_friction(result: Result, *, shear_stress: float) -> Floats:
    """Friction coefficient with an adhesive share: that of the loss in the bulk, and `shear_stress` [Pa] on the area in contact,
    `friction_coefficient + shear_stress * contact_area / load`; 0 where there is no load.

    >>> import asperity as asp
    >>> wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    >>> rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    >>> result = asp.steady(wave, rubber, pressure=20e3, velocities=[0.05], boundary="periodic")
    >>> added = asp.rubber_friction(result, shear_stress=10e3) - result.friction_coefficient
    >>> bool(abs(added[0] - 0.5 * result.contact_fraction[0]) < 1e-12)
    True
    """
    load = np.asarray(result.load)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(load > 0, number("shear_stress", shear_stress) * np.asarray(result.contact_area) / load, 0.0)
    total: Floats = np.asarray(result.friction_coefficient) + share
    return total
