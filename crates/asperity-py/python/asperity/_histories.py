"""Prescribed histories, stages, and time grids."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ._arrays import AnyArray, ArrayLike, Floats, Scalar, choice, count, either, in_hertz, line, number, points
from ._core import CaseError, waitable
from ._declared import Table
from ._parameters import call, parameters
from ._sampled import as_points
from ._sealed import Named
from ._units import has_unit, is_labelled, unit_among

__all__ = ["History", "Stage", "Times", "adaptive", "hold", "listed", "log", "ramp", "ramp_to", "sampled", "sine", "step", "table", "trapezoid", "triangle", "uniform"]


#: What the numbers of a history, or of a list of times, are called in a case.
_NUMBERS = {
    "step": ("value",),
    "ramp": ("value", "duration"),
    "ramp-to": ("value", "duration"),
    "triangle": ("peak", "rise", "fall"),
    "trapezoid": ("peak", "rise", "hold", "fall"),
    "sine": ("mean", "amplitude", "frequency"),
    "uniform": ("end", "steps"),
    "log": ("end", "steps", "first"),
    "adaptive": ("end", "tolerance", "first"),
}


class _Made(Named):
    """What is made of a kind and its numbers."""

    kind: str
    numbers: tuple[float, ...]

    @property
    def _parameters(self) -> dict[str, Any]:
        return dict(zip(_NUMBERS.get(self.kind, ()), self.numbers))


@dataclass(frozen=True)
class History(_Made):
    """A load [N], mean pressure [Pa] or approach [m] over time; made by :func:`step`, :func:`ramp` and so on."""

    kind: str
    numbers: tuple[float, ...]
    points: tuple[tuple[float, float], ...] = ()
    #: SI unit of its values, where they were given with one.
    unit: str | None = None
    #: Of a function: the largest distance of its table that was found.
    error: float | None = None

    #: Value of a step, or at the end of a ramp, and its duration [s].
    value, duration = parameters(float, 2)
    #: Largest value of a triangle or trapezoid, and how long [s] it rises, holds and falls.
    peak, rise, hold, fall = parameters(float, 4)
    #: Mean, amplitude and frequency [Hz] of a sine.
    mean, amplitude, frequency = parameters(float, 3)

    @property
    def end(self) -> float:
        """The time from which on the value stays the same [s]: 0 of a step, infinite of a sine."""
        if self.kind in ("sine", "table"):
            return math.inf if self.kind == "sine" else self.points[-1][0]
        return float(sum(value for name, value in self._parameters.items() if name in ("duration", "rise", "hold", "fall")))

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of a `history`."""
        kind = {"kind": "ramp", "from": "current"} if self.kind == "ramp-to" else {"kind": self.kind}
        points = {"points": [list(point) for point in self.points]} if self.kind == "table" else {}
        return {**kind, **self._parameters, **points}

    def __repr__(self) -> str:
        if self.points:
            several = f"{len(self.points)} points from {self.points[0]} to {self.points[-1]}"
            return f"{self.kind}({several if len(self.points) > 4 else list(self.points)})"
        return call(self.kind.replace("-", "_"), self._parameters, 0 if self.kind == "sine" else 1)


@dataclass(frozen=True)
class Times(_Made):
    """The times to solve for; made by :func:`uniform`, :func:`log` or :func:`listed`."""

    kind: str
    numbers: tuple[float, ...]

    #: Number of steps of uniform and logarithmic times.
    (steps,) = parameters(int, 1)
    #: First instant [s] of logarithmic times, or the longest first step of adaptive ones; and the relative error of the stress that these aim at.
    first, tolerance = parameters(float, 2)

    @property
    def end(self) -> float:
        """The last time [s]."""
        return self.numbers[-1 if self.kind == "list" else 0]

    @property
    def _marks(self) -> Floats:
        """The times of the steps [s]; of adaptive ones, which are not known yet, as many equal ones as a function is looked at in."""
        if self.kind == "list":
            return np.array(self.numbers)
        if self.kind == "log" and self.steps > 1:
            return np.geomspace(self.first, self.end, self.steps)
        steps = _LOOKS if self.kind == "adaptive" else self.steps
        return self.end * (np.arange(1, steps + 1) / steps)

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of `[time]`."""
        return {"times": list(self.numbers)} if self.kind == "list" else {**self._parameters, "spacing": self.kind}

    def __repr__(self) -> str:
        if self.kind == "list":
            several = f"{len(self.numbers)} times from {self.numbers[0]:g} to {self.numbers[-1]:g} s"
            return f"listed({several if len(self.numbers) > 4 else list(self.numbers)})"
        return call(self.kind, self._parameters, 1 if self.kind == "adaptive" else 2)


#: What the values of a history may be: a load, a load per length, a pressure, an approach or path, a velocity.
_UNITS = ("N", "N/m", "Pa", "m", "m/s")


def _history(kind: str, values: dict[str, Any], **times: Any) -> History:
    """A history of values by the words for them, and of times [s]. Where values carry a unit, all of them but zeros do."""
    unit = unit_among("the value of a history", list(values.values()), _UNITS)
    for name, value in values.items():
        if unit is not None and not has_unit(value) and number(name, value, unit) != 0.0:
            raise CaseError(f"{name} is {value!r} without a unit, but other values of the history are in {unit}")
    numbers = [number(name, value, unit or "") for name, value in values.items()]
    return History(kind, (*numbers, *(number(name, time) for name, time in times.items())), unit=unit)


def step(value: Scalar) -> History:
    """The value from t = 0+ on."""
    return _history("step", {"value of the step": value})


def ramp(value: Scalar, *, duration: Scalar) -> History:
    """Linear from 0 to `value` during `duration` [s], then held."""
    return _history("ramp", {"value of the ramp": value}, duration=duration)


def triangle(peak: Scalar, *, rise: Scalar, fall: Scalar) -> History:
    """Linear from 0 to `peak` during `rise` [s] and back to 0 during `fall` [s], then 0."""
    return _history("triangle", {"peak": peak}, rise=rise, fall=fall)


def trapezoid(peak: Scalar, *, rise: Scalar, hold: Scalar, fall: Scalar) -> History:
    """As :func:`triangle`, with `hold` [s] at the peak."""
    return _history("trapezoid", {"peak": peak}, rise=rise, hold=hold, fall=fall)


def sine(*, mean: Scalar, amplitude: Scalar, frequency: Scalar) -> History:
    """mean + amplitude sin(2 pi frequency t), the frequency in Hz (a quantity may be in rad/s or rpm)."""
    return _history("sine", {"mean": mean, "amplitude": amplitude}, frequency=in_hertz("frequency", frequency))


def table(pairs: Sequence[tuple[float, float]] | AnyArray) -> History:
    """Linear between (time [s], value) points; two points at one time are a jump; held after the last. A one-dimensional array of xarray with
    its coordinate, or a series of pandas with its index, has the times of its values."""
    pairs = _timed(pairs)
    several = isinstance(pairs, (list, tuple)) and all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs)
    ends = [pair[1] for pair in pairs] if several else []
    unit = unit_among("the value of a history", ends, _UNITS)
    return History("table", (), tuple(points("points of the table", pairs, ("s", unit or ""))), unit=unit)


def _timed(given: Any) -> Any:
    """The points of a labelled list of values; anything else as it is."""
    if is_labelled(given) and given.ndim == 1:
        (name,) = given.dims
        if name not in getattr(given, "coords", {}):
            raise CaseError(f"the table has no times: give its dimension {name!r} a coordinate [s]")
        return [(time, given[n]) for n, time in enumerate(line("time", given.coords[name]))]
    if hasattr(given, "index") and hasattr(given, "to_numpy") and given.ndim == 1:
        return [*zip(line("time", given.index.to_numpy()).tolist(), given.to_numpy().tolist())]
    return given


#: A function of time [s].
Function = Callable[[float], Any]

#: Steps in which a function is looked at first, where the run has no times of its own before it begins.
_LOOKS = 64
#: Distance of the table of a function, relative to its largest value.
_TOLERANCE = 1e-3


def sampled(function: Function, *, end: float, breaks: Sequence[float] = (), tolerance: float = _TOLERANCE) -> History:
    """A history from a function of time [s] between 0 and `end` [s], as a table; held after the end.

    The distance of the table from the function is at most `tolerance` times the largest value: `error` of the history is the largest that
    was found. `breaks` are the times [s] at which the function has a jump or a kink. The points of the table become steps of the run.
    A pulse shorter than a 250th of the whole may be missed: name its edges as breaks.

    ``load=function`` of :func:`solve` makes such a table from the times of the run; a :class:`Stage`, :meth:`March.prescribe` and
    everything else takes the history made here.

    >>> import asperity as asp, math
    >>> beat = asp.sampled(lambda t: 1.0 + 0.5 * math.sin(t) * math.sin(10 * t), end=6.0)
    >>> beat.error < 1.5e-3, beat.end
    (True, 6.0)
    """
    last = number("end", end)
    if not (math.isfinite(last) and last > 0.0):
        raise CaseError(f"end is {last} s, but must be a time after 0 s")
    return _of_function("value", function, np.linspace(0.0, last, _LOOKS + 1)[1:], breaks, number("tolerance", tolerance), "")


def _of_function(what: str, function: Any, marks: Floats, breaks: Sequence[float], tolerance: float, unit: str) -> History:
    if not callable(function):
        raise CaseError(f"function is {function!r}, but must be a function of time")
    found, error = as_points(what, function, marks, breaks, tolerance, unit)
    return History("table", (), found, error=error)


def hold() -> History:
    """The value that the quantity has when the stage starts; for a :class:`Stage`."""
    return History("hold", ())


def ramp_to(value: Scalar, *, duration: Scalar) -> History:
    """Linear from the value that the quantity has when the stage starts to `value` during `duration` [s], then held; for a
    :class:`Stage`."""
    return _history("ramp-to", {"value of the ramp": value}, duration=duration)


def _event_units(load_unit: str) -> dict[str, str]:
    """What a stage can wait for, with its SI unit; the unit of a load tells a line contact."""
    numbers = {name: on_line if load_unit == "N/m" else unit for name, unit, on_line in waitable()}
    return {"approach": "m", "load": load_unit, "pressure": "Pa", **numbers}


@dataclass(frozen=True, kw_only=True, repr=False)
class Stage(Table):
    """A part of a programme: what is prescribed, on a clock that starts with it, and when it ends.

    Parameters
    ----------
    load, pressure, approach : what is prescribed [N], [Pa] or [m], exactly one of them: a history, or a number for a step
    duration : the stage lasts no longer than this [s]; the last stage may last to the end of the run
    until : what ends it: a number of the rows with its value, as in {"contact_fraction": 0.1} or ("approach", 2e-6), crossed from
        either side, in SI units ("pressure" is the mean pressure), or "contact-lost". A jump reaches only the value at which it ends; what
        it passes is waited for from where the number is after it. Without `duration` the event must happen before the run ends.
    after_jump : the event of `until` counts only after the jump with which the stage begins, even where the jump ends at the value itself
    times : times of the stage, measured from its start; default: those of the run

    Examples
    --------
    Press, hold the approach reached, retract until contact is lost:

    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    >>> result = asp.solve(sphere, zener, times=asp.adaptive(20.0, first=1e-2), stages=[
    ...     asp.Stage(load=asp.ramp(2e-3, duration=1.0), until=("approach", 2e-6), duration=1.0),
    ...     asp.Stage(approach=asp.hold(), duration=5.0),
    ...     asp.Stage(approach=asp.ramp_to(-5e-6, duration=2.0), until="contact-lost"),
    ... ])
    >>> held = result.load[result.stage == 1]
    >>> bool(held[-1] < held[0]), result.contact_area[-1].item()
    (True, 0.0)
    """

    load: History | Scalar | None = None
    pressure: History | Scalar | None = None
    approach: History | Scalar | None = None
    duration: float | None = None
    until: Literal["contact-lost"] | tuple[str, Any] | dict[str, Any] | None = None
    after_jump: bool = False
    times: Times | ArrayLike | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        # Values of its own, which compare and do not follow an array that changes.
        if self.times is not None:
            object.__setattr__(self, "times", as_times(self.times))
        if self.until is None or self.until == "contact-lost":
            return
        pair = next(iter(self.until.items())) if isinstance(self.until, dict) and len(self.until) == 1 else self.until
        if not isinstance(pair, (tuple, list)) or len(pair) != 2:
            raise CaseError(f"until is {self.until!r}, but must be 'contact-lost' or one number of the rows with its value, as in {{'load': 0.1}}")
        choice("the event of until", pair[0], tuple(_event_units("N")))
        object.__setattr__(self, "until", tuple(pair))

    def _given(self, load_unit: str) -> dict[str, Any]:
        """The keys of one of the `stages`; the unit of a load is N, or N/m of a line contact."""
        keys = self._keys
        prescribed = {name: keys.pop(name, None) for name in ("load", "pressure", "approach")}
        keys |= control_keys(prescribed, "a stage needs", load_unit)
        if isinstance(self.until, tuple):
            event, limit = self.until
            keys["until"] = {event: number(f"until {event}", limit, _event_units(load_unit)[event])}
        if "times" in keys:
            keys["time"] = as_times(keys.pop("times"))._keys
        return keys


def control_keys(prescribed: dict[str, Any], otherwise: str, load_unit: str) -> dict[str, Any]:
    """The keys of the one quantity that is prescribed; the unit of a load is N, or N/m of a line contact."""
    control, value = one_of(prescribed, otherwise)
    return {"control": control, "history": as_history(control, value, load_unit if control == "load" else None)._keys}


def one_of(alternatives: dict[str, Any], otherwise: str) -> tuple[str, Any]:
    """The one of the alternatives that is given; `otherwise` begins the message of the error."""
    given = [(name, value) for name, value in alternatives.items() if value is not None]
    if len(given) != 1:
        raise CaseError(f"{otherwise} {either(alternatives)}, exactly one of them; given: {' and '.join(name for name, _ in given) or 'none'}")
    return given[0]


def uniform(end: Scalar, steps: int) -> Times:
    """`steps` equal steps to `end` [s]."""
    return Times("uniform", (number("end", end), count("number of steps", steps)))


def log(end: Scalar, steps: int, *, first: Scalar) -> Times:
    """`steps` times in geometric progression from `first` to `end` [s]."""
    return Times("log", (number("end", end), count("number of steps", steps), number("first instant", first)))


def adaptive(end: Scalar, *, tolerance: Scalar = 1e-3, first: Scalar | None = None) -> Times:
    """Steps to `end` [s] as long as their error allows.

    `tolerance` is the relative error of the stress that the steps aim at, and that the `time_error` of each row stays within. The first
    step, also after each break of the history, is no longer than `first` [s], a thousandth of `end` by default.

    >>> import asperity as asp, numpy as np
    >>> sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    >>> result = asp.solve(sphere, zener, load=asp.ramp(1e-3, duration=1.0), times=asp.adaptive(5.0))
    >>> float(result.time[-1]), bool(np.max(result.time_error) < 1e-3)
    (5.0, True)
    """
    last = number("end", end)
    return Times("adaptive", (last, number("tolerance", tolerance), number("first step", 1e-3 * last if first is None else first)))


def listed(instants: ArrayLike) -> Times:
    """The times after 0 [s], increasing; a 0 at their beginning is the start, which each run has."""
    given = [float(t) for t in line("times", instants)]
    return Times("list", tuple(given[1:] if len(given) > 1 and given[0] == 0.0 else given))


def as_history(what: str, value: Any, unit: str | None = None, *, over: Times | None = None, breaks: Sequence[float] = ()) -> History:
    """A history of what is prescribed, in the SI unit `unit`, by default that of the parameter; a number is a step, a function is
    sampled `over` the times of the run."""
    unit = {"load": "N", "pressure": "Pa", "approach": "m", "path": "m", "velocity": "m/s"}[what] if unit is None else unit
    if callable(value):
        if over is None:
            raise CaseError(f"{what} is a function: make a history of it, {what}=asperity.sampled(function, end=...)")
        return _of_function(what, value, over._marks, breaks, _TOLERANCE, unit)
    if _is_table(value):
        value = table(value)
    if not isinstance(value, History):
        return History("step", (number(what, value, unit),), unit=unit if has_unit(value) else None)
    if value.unit not in (None, unit):
        raise CaseError(f"{what} is a history in {value.unit}, but must be in {unit}")
    return value


def _is_table(value: Any) -> bool:
    """Whether it is what :func:`table` takes: points, or values with their times."""
    if isinstance(value, (list, tuple)):
        return len(value) > 0 and all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in value)
    return (isinstance(value, np.ndarray) and value.ndim == 2) or (_timed(value) is not value and np.size(value) > 1)


def as_times(value: Times | ArrayLike) -> Times:
    """A time grid; a sequence or an array holds the times."""
    return value if isinstance(value, Times) else listed(value)
