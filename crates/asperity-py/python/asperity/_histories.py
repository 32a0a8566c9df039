"""What is prescribed over time, and the instants that are solved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ._arrays import count, line, number, points

__all__ = ["History", "Times", "adaptive", "listed", "log", "ramp", "sine", "step", "table", "trapezoid", "triangle", "uniform"]


@dataclass(frozen=True)
class History:
    """A load [N], mean pressure [Pa] or approach [m] over time; made by :func:`step`, :func:`ramp` and so on."""

    kind: str
    numbers: tuple[float, ...]
    points: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
class Times:
    """The instants that are solved; made by :func:`uniform`, :func:`log` or :func:`listed`."""

    kind: str
    numbers: tuple[float, ...]


def step(value: float) -> History:
    """The value from t = 0+ on."""
    return History("step", (number("value of the step", value),))


def ramp(value: float, *, duration: float) -> History:
    """Linear from 0 to `value` during `duration` [s], then held."""
    return History("ramp", (number("value of the ramp", value), number("duration", duration)))


def triangle(peak: float, *, rise: float, fall: float) -> History:
    """Linear from 0 to `peak` during `rise` [s] and back to 0 during `fall` [s], then 0."""
    return History("triangle", (number("peak", peak), number("rise", rise), number("fall", fall)))


def trapezoid(peak: float, *, rise: float, hold: float, fall: float) -> History:
    """As :func:`triangle`, with `hold` [s] at the peak."""
    return History("trapezoid", (number("peak", peak), number("rise", rise), number("hold", hold), number("fall", fall)))


def sine(*, mean: float, amplitude: float, frequency: float) -> History:
    """mean + amplitude sin(2 pi frequency t), the frequency in Hz."""
    return History("sine", (number("mean", mean), number("amplitude", amplitude), number("frequency", frequency)))


def table(pairs: Sequence[tuple[float, float]]) -> History:
    """Linear between (time [s], value) points; two points at one time are a jump; held after the last."""
    return History("table", (), tuple(points("points of the table", pairs)))


def uniform(end: float, steps: int) -> Times:
    """`steps` equal steps to `end` [s]."""
    return Times("uniform", (number("end", end), float(count("number of steps", steps))))


def log(end: float, steps: int, *, first: float) -> Times:
    """`steps` instants in geometric progression from `first` to `end` [s]."""
    return Times("log", (number("end", end), float(count("number of steps", steps)), number("first instant", first)))


def adaptive(end: float, *, tolerance: float = 1e-3, first: float) -> Times:
    """Steps to `end` [s] as long as their local error allows.

    `tolerance` is the largest error that one step may add, relative to the largest approach so far; `first` [s] the length of the
    first step, after each break of the history as well. Each row has its estimate as `time_error`.

    >>> import asperity as asp, numpy as np
    >>> sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    >>> result = asp.solve(sphere, zener, load=asp.ramp(1e-3, duration=1.0), times=asp.adaptive(5.0, first=1e-3))
    >>> float(result.time[-1]), bool(np.nanmax(result.time_error) < 1e-3)
    (5.0, True)
    """
    return Times("adaptive", (number("end", end), number("tolerance", tolerance), number("first step", first)))


def listed(instants: Sequence[float]) -> Times:
    """The instants after 0 themselves [s], increasing."""
    return Times("list", tuple(float(t) for t in line("times", instants)))


def as_history(what: str, value: History | float) -> History:
    """A history; a number is a step."""
    return value if isinstance(value, History) else step(number(what, value))


def as_times(value: Times | Sequence[float]) -> Times:
    """A time grid; a sequence is the instants."""
    return value if isinstance(value, Times) else listed(value)
