"""Contacts that slide or roll: in time, and steady over velocities."""

from __future__ import annotations

import difflib
import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, angle, choice, line, number
from ._core import CaseError
from ._histories import History, Times, as_history

if TYPE_CHECKING:
    from ._words import Field, Movement
    from ._layers import Body
    from ._materials import Material
    from ._result import Result

#: What each row of a contact in motion has.
OF_MOTION = (
    "velocity",
    "sliding_distance",
    "friction_force",
    "side_force",
    "friction_coefficient",
    "friction_uncertainty",
    "rolling_moment",
    "dissipated_power",
)


@dataclass(frozen=True)
class Motion:
    """How a contact moves; made by :func:`slide` and :func:`steady`."""

    what: str
    kind: str
    numbers: tuple[float, ...]
    points: tuple[tuple[float, float], ...]
    start: float
    direction: tuple[str, float]
    cells_per_step: float
    shear_stress: float | None
    rolls: bool

    @property
    def steady(self) -> bool:
        """Whether it is a sweep over velocities."""
        return self.what == "steady"

    def parts(self) -> _core._Motion:
        """For the compiled part."""
        history = (self.kind, list(self.numbers))
        return (self.what, history, list(self.points), self.start, self.direction, self.cells_per_step, self.shear_stress, self.rolls)

    def quantities(self, surface: Any, boundary: str) -> list[str]:
        """What its rows have."""
        names = list(OF_MOTION)
        if self.steady:
            names = [name for name in names if name not in ("velocity", "sliding_distance")]
        elif len(surface.size) == 1 and boundary == "free":
            # Energies of a free line contact are known up to a constant.
            names.remove("dissipated_power")
        return names if self.shear_stress is None else [*names, "friction_coefficient_total"]

    def setup(self) -> dict[str, Any]:
        """As in stored results."""
        x, y = {"x": (1.0, 0.0), "y": (0.0, 1.0)}.get(self.direction[0], (np.cos(self.direction[1]), np.sin(self.direction[1])))
        return {"steady": self.steady, "direction": [float(x), float(y)], "rolls": self.rolls, "shear_stress": self.shear_stress}


def _direction(direction: str | float) -> tuple[str, float]:
    if isinstance(direction, str):
        if direction not in ("x", "y"):
            raise CaseError(f"direction is {direction!r}, but must be 'x', 'y' or an angle from x towards y [rad]")
        return direction, 0.0
    return "angle", angle("direction", direction)


def _rolls(kind: str) -> bool:
    return bool(choice("kind", kind, ("slide", "roll")) == "roll")


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
    history = as_history(what, given)
    motion = Motion(
        what=what,
        kind=history.kind,
        numbers=history.numbers,
        points=history.points,
        start=number("start", start),
        direction=_direction(direction),
        cells_per_step=number("cells_per_step", cells_per_step),
        shear_stress=None if shear_stress is None else number("shear_stress", shear_stress),
        rolls=_rolls(kind),
    )
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
    speeds = np.sort(line("velocities", velocities))
    motion = Motion(
        what="steady",
        kind="list",
        numbers=tuple(float(v) for v in speeds),
        points=(),
        start=0.0,
        direction=_direction(direction),
        cells_per_step=1.0,
        shear_stress=None if shear_stress is None else number("shear_stress", shear_stress),
        rolls=_rolls(kind),
    )
    if len(np.unique(speeds)) != len(speeds):
        raise CaseError("velocities holds a velocity twice, but must hold each once")
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
        _motion=motion,
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
