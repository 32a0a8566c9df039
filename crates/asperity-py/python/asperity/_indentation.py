"""The material of a half-space, or of a thin sample, from a measured indentation.

Between depth and load stands the exact one-dimensional equivalent of the contact (method of dimensionality reduction), unloading
and loading again included; one channel is taken as given, the other is met by least squares. Intervals are an average over the
numbers of terms that the record allows.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypedDict, get_args, overload

import numpy as np

from . import _core
from ._arrays import Counts, Floats, angle as radians, choice, columns, count, line, number
from ._core import CaseError
from ._findings import warn_caller
from ._force_curves import ForceCurve, ForceFit, Interval, cantilever, fit_force_curve, interval, of_model, sample, share, table
from ._materials import PowerLaw, Prony
from ._paragraphs import of_indentation
from ._sealed import ReadOnlyArrays
from ._words import Branch, Control, Indenter, Interface, LongTime, Model, Weights
from .plot import recorded

if TYPE_CHECKING:
    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from typing_extensions import Unpack


@dataclass(frozen=True, eq=False)
class IndentationFit(ReadOnlyArrays):
    """A material fitted to a record of load and depth; moduli are Young's. Made by :func:`fit_indentation`."""

    #: (modulus [Pa], relaxation time [s]) of each term, each as (value, low, high).
    terms: list[tuple[Interval, Interval]]
    #: Modulus after all relaxation and right after a step [Pa], as (value, low, high).
    equilibrium: Interval
    instantaneous: Interval
    #: Depth of first touch [m], as (value, low, high); 0 where it was not fitted.
    touch: Interval
    #: Load of the free indenter at first touch [N] and its slope over the depth [N/m], from the rows before first touch; 0 where there are none.
    baseline: Interval
    tilt: Interval
    #: "depth" or "load": the channel that the test controlled.
    given: str
    #: Times [s], load [N] and depth [m] of the record, and model of the other channel [N or m], at the rows that were used.
    time: Floats
    load: Floats
    depth: Floats
    predicted: Floats
    #: Numbers of these rows.
    rows: Counts
    #: Root of the mean square of model less measurement [N or m], and the same over the largest value.
    rms: float
    relative_rms: float
    #: Near 2 for independent errors; well below where the model bends away from the record or the noise is not white.
    durbin_watson: float
    #: Probability of each number of terms, from 0 on.
    numbers_of_terms: list[float]
    #: Step and length of the record [s].
    window: tuple[float, float]
    #: What should be known before the numbers are believed.
    notes: list[str]
    #: The material of the best fit, what is not determined included.
    material: Prony

    def plot(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """The channel that was fitted over time: the record as points, the model as a line, which takes the further arguments."""
        name, measured = ("load", self.load) if self.given == "depth" else ("depth", self.depth)
        return recorded(("time", "s", self.time), name, measured, self.predicted, ax, style)

    def methods(self, *, bibtex: bool = False) -> str:
        """A paragraph on what was fitted, for the methods section of a paper; with `bibtex` the entry to cite."""
        numbers = [("E(0)", self.instantaneous, "Pa"), ("E(inf)", self.equilibrium, "Pa")]
        numbers += [(f"E_{n}", modulus, "Pa") for n, (modulus, _) in enumerate(self.terms, 1)]
        numbers += [(f"tau_{n}", time, "s") for n, (_, time) in enumerate(self.terms, 1)]
        return of_indentation(self, f"A Prony series with {len(self.terms)} term{'s' if len(self.terms) != 1 else ''}", numbers, bibtex)

    def __repr__(self) -> str:
        low, high = self.equilibrium[1:]
        return (
            f"<IndentationFit of {len(self.rows)} rows: {len(self.terms)} terms, E(0) {self.instantaneous[0]:.4g} Pa, E(inf) "
            f"{self.equilibrium[0]:.4g} Pa ({low:.4g} to {high:.4g}), misfit {100 * self.relative_rms:.2g} % of the largest value>"
        )

    def _repr_html_(self) -> str:
        lines = [("E(0) [Pa]", self.instantaneous), ("E(inf) [Pa]", self.equilibrium)]
        for n, (modulus, time) in enumerate(self.terms, 1):
            lines += [(f"E_{n} [Pa]", modulus), (f"tau_{n} [s]", time)]
        return table(lines)


@dataclass(frozen=True, eq=False)
class PowerLawFit(ReadOnlyArrays):
    """A power law E(t) = modulus (t/1 s)^-exponent fitted to a record of load and depth; moduli are Young's. Made by
    :func:`fit_indentation` with ``model="power-law"``."""

    #: Relaxation modulus 1 s after a step [Pa], and the exponent (0 of an elastic body, 1 of a liquid), as (value, low, high).
    modulus: Interval
    exponent: Interval
    #: Depth of first touch [m], as (value, low, high); 0 where it was not fitted.
    touch: Interval
    #: Load of the free indenter at first touch [N] and its slope over the depth [N/m], from the rows before first touch; 0 where there are none.
    baseline: Interval
    tilt: Interval
    #: "depth" or "load": the channel that the test controlled.
    given: str
    #: Times [s], load [N] and depth [m] of the record, and model of the other channel [N or m], at the rows that were used.
    time: Floats
    load: Floats
    depth: Floats
    predicted: Floats
    #: Numbers of these rows.
    rows: Counts
    #: Root of the mean square of model less measurement [N or m], and the same over the largest value.
    rms: float
    relative_rms: float
    #: Near 2 for independent errors; well below where the model bends away from the record or the noise is not white.
    durbin_watson: float
    #: Step and length of the record [s].
    window: tuple[float, float]
    #: What should be known before the numbers are believed.
    notes: list[str]
    #: The material of the best fit, over the times of the record.
    material: PowerLaw

    def plot(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """As :meth:`IndentationFit.plot`."""
        name, measured = ("load", self.load) if self.given == "depth" else ("depth", self.depth)
        return recorded(("time", "s", self.time), name, measured, self.predicted, ax, style)

    def methods(self, *, bibtex: bool = False) -> str:
        """A paragraph on what was fitted, for the methods section of a paper; with `bibtex` the entry to cite."""
        return of_indentation(self, "A power law", [("E(1 s)", self.modulus, "Pa"), ("the exponent", self.exponent, "")], bibtex)

    def __repr__(self) -> str:
        told = ", ".join(f"{name} {value:.4g} ({low:.4g} to {high:.4g})" for name, (value, low, high) in self._lines())
        return f"<PowerLawFit of {len(self.rows)} rows: {told}, misfit {100 * self.relative_rms:.2g} % of the largest value>"

    def _lines(self) -> list[tuple[str, Interval]]:
        return [("E(1 s) [Pa]", self.modulus), ("exponent", self.exponent)]

    def _repr_html_(self) -> str:
        return table(self._lines())


class _OfCurve(TypedDict, total=False):
    """What goes with a model of an elastic body alone."""

    branch: Branch
    control: Control | None
    weights: Weights
    range: float | None


class _OfBoth(TypedDict, total=False):
    """What goes with any model."""

    indenter: Indenter
    radius: float | None
    angle: float | None
    spring_constant: float | None
    radius_uncertainty: float
    spring_constant_uncertainty: float
    sensitivity_uncertainty: float
    thickness: float | None
    thickness_uncertainty: float
    interface: Interface


class _OfRecord(TypedDict, total=False):
    """What goes with the relaxation alone."""

    given: str | None
    terms: int | None
    long_time: LongTime
    fit_touch: bool
    hardness: float | None
    name: str | None
    springs: int
    max_misfit: float


class _OfForces(_OfCurve, _OfBoth, total=False):
    """What goes with a model of an elastic body."""


class _OfRelaxation(_OfRecord, _OfBoth, total=False):
    """What goes with the relaxation."""


@overload
def fit_indentation(
    time: Any, load: Any = None, depth: Any = None, /, *, poisson: float, model: Literal["viscoelastic"] = "viscoelastic",
    **how: Unpack[_OfRelaxation]
) -> IndentationFit: ...
@overload
def fit_indentation(
    time: Any, load: Any = None, depth: Any = None, /, *, poisson: float, model: Literal["power-law"], **how: Unpack[_OfRelaxation]
) -> PowerLawFit: ...
@overload
def fit_indentation(
    time: Any, load: Any = None, depth: Any = None, /, *, poisson: float, model: Model, **how: Unpack[_OfForces]
) -> ForceFit: ...
def fit_indentation(
    time: Any, load: Any = None, depth: Any = None, /, *, indenter: str = "sphere", radius: float | None = None, angle: float | None = None, poisson: float,
    given: str | None = None, terms: int | None = None, long_time: LongTime = "free", fit_touch: bool = False,
    thickness: float | None = None, interface: Interface = "bonded", hardness: float | None = None, name: str | None = None,
    springs: int = 150, max_misfit: float = 0.1, model: str = "viscoelastic", branch: str = "retraction",
    control: str | None = None, weights: str = "noise", range: float | None = None, spring_constant: float | None = None, radius_uncertainty: float = 0.0,
    thickness_uncertainty: float = 0.0, spring_constant_uncertainty: float = 0.0, sensitivity_uncertainty: float = 0.0
) -> IndentationFit | PowerLawFit | ForceFit:
    """Fits the relaxation modulus of a half-space, or of a thin sample, to a record of its indentation by a rigid indenter; or, with
    a `model` of an elastic body, its modulus and work of adhesion to a force curve.

    Parameters
    ----------
    time, load, depth : the record [s], [N], [m]; the body is undisturbed before its first row, depths count from first touch. Or a `ForceCurve`
        alone: an elastic model takes the segments of the branch, a relaxation those from the first approach to the last hold before the
        retraction, with a fitted first touch and `given` from what the hold kept
    indenter : "sphere" (a ball, to any depth up to its radius), "paraboloid" (which a ball is near its apex: Hertz), "cone" or "pyramid" (square)
    radius : of the sphere or paraboloid [m]
    angle : of the cone or pyramid [rad], from the axis to the flank of a cone, to a face (not an edge) of a pyramid
    poisson : Poisson's ratio, constant in time
    given : "depth" or "load": the channel that the test controlled; by default the one that fewer straight pieces (ramps and
        holds) describe
    terms : number of terms, 6 at most; by default as many as the record calls for
    long_time : "free", "solid" or "fluid": what happens at times longer than the record
    fit_touch : whether the depth of first touch is fitted too
    thickness : of a thin sample on a rigid base [m], such as a gel or a cell on glass: a half-space would take the stiff base for
        stiff material. By default the body is a half-space; models of adhesion take no other
    interface : of the thin sample to its base: "bonded", or "slip" (it slides without friction)
    hardness, name : of the material
    springs : of the one-dimensional model
    max_misfit : largest rms misfit over the largest value before the record is refused
    model : "viscoelastic" (a Prony series), "power-law" (E(t) = E1 (t/1 s)^-alpha: cells, soft glasses; without `terms` and `long_time`), or
        "hertz", "dmt", "jkr" or "maugis": an elastic half-space with the adhesion of that model, which takes a sphere as a paraboloid. The
        times are then not used and may be None; baseline and contact point are fitted; the options above, those of the indenter and
        `poisson` aside, do not go with it, and `branch`, `control`, `weights` and `range` go with it alone
    branch : "retraction" (from the largest load on) or "approach"
    control : "load" or "displacement", where the sphere comes off; by default that of the spring, where its constant is given, else displacement
    weights : "noise" (a row counts by the noise of both channels, and by the scatter in contact and off it), or "none": all alike, without
        adhesion by their loads alone, as other programs do it
    range : of the attraction [m], for "maugis" in place of a fitted transition, and for Tabor's number of the other models
    spring_constant : of the cantilever whose deflection is the load [N/m]
    radius_uncertainty, thickness_uncertainty, spring_constant_uncertainty : standard uncertainties (one standard deviation) [m], [m],
        [N/m]; the intervals contain them
    sensitivity_uncertainty : standard uncertainty of the deflection's sensitivity over its value

    Returns
    -------
    IndentationFit, PowerLawFit with "power-law", or ForceFit with a `model` of an elastic body

    Raises
    ------
    CaseError : columns of different lengths, times that do not increase, more terms than the record determines, no such material

    Examples
    --------
    >>> import asperity as asp, numpy as np
    >>> t = np.linspace(0.0, 20.0, 201)                     # a step of 1 N on a standard solid: w^(3/2) goes as its creep
    >>> zener = asp.Zener(young=2e6, young_kelvin=2e6, retardation_time=4.0, poisson=0.5)
    >>> depth = (9 / 16 / 0.01 * zener.contact_compliance(t) ** 2) ** (1 / 3)
    >>> fit = asp.fit_indentation(t, np.ones_like(t), depth, radius=0.01, poisson=0.5, given="load")
    >>> round(fit.instantaneous[0] / 2e6, 2), round(fit.equilibrium[0] / 1e6, 2), round(fit.terms[0][1][0], 1)
    (1.0, 1.0, 2.0)

    A gel of 5 um on glass, indented by 0.2 um with a sphere of 10 um: as a half-space it seems half as stiff again.

    >>> gel = asp.Elastic(young=10e3, poisson=0.49)
    >>> sample = asp.Body(layers=[asp.Layer(thickness=5e-6, material=gel)])
    >>> sphere = asp.Surface.sphere(cells=(64, 64), size=(6e-6, 6e-6), radius=10e-6)
    >>> pressed = asp.solve(sphere, sample, approach=asp.ramp(0.2e-6, duration=1.0), times=asp.uniform(1.0, 20))
    >>> record = (pressed.time, pressed.load, pressed.approach)
    >>> thin, thick = (
    ...     asp.fit_indentation(*record, radius=10e-6, poisson=0.49, terms=0, thickness=d).equilibrium[0] for d in (5e-6, None)
    ... )
    >>> round(thin / 10e3, 1), bool(1.3 < thick / 10e3 < 1.6)
    (1.0, True)

    A sphere of 10 um that is pulled off a body of 1 MPa (DMT: 4/3 E* sqrt(R) d^(3/2) - 2 pi R w).

    >>> depth = np.linspace(0.5e-6, -0.2e-6, 200)
    >>> contact = 4 / 3 * (1e6 / 0.75) * np.sqrt(10e-6) * np.maximum(depth, 0.0) ** 1.5 - 2 * np.pi * 10e-6 * 5e-3
    >>> force = np.where(depth > 0.0, contact, 0.0)
    >>> pulled = asp.fit_indentation(None, force, depth, radius=10e-6, poisson=0.5, model="dmt", range=1e-6)
    >>> round(pulled.young[0] / 1e6, 3), round(pulled.work[0] * 1e3, 3)
    (1.0, 5.0)

    A cell under a cone of 35 degrees that goes in with v = 1 um/s: load = (2/pi) tan(35 deg) E1/(1 - nu^2) 2 v^2 t^(2 - a)/((1 - a)(2 - a)).

    >>> t = np.linspace(0.0, 2.0, 201)
    >>> load = 2 / np.pi * np.tan(np.radians(35)) * 1e3 / 0.75 * 2e-12 * t**1.8 / (0.8 * 1.8)
    >>> cell = asp.fit_indentation(t, load, 1e-6 * t, indenter="cone", angle=np.radians(35), poisson=0.5, model="power-law")
    >>> round(cell.modulus[0] / 1e3, 2), round(cell.exponent[0], 2), round(cell.material.alpha, 2)
    (1.0, 0.2, 0.2)
    """
    told = dict(locals())
    usual = {name: one.default for name, one in inspect.signature(fit_indentation).parameters.items()}
    choice("model", model, ("viscoelastic", "power-law", *get_args(Model)))
    nu = number("poisson", poisson)
    if not -1.0 < nu <= 0.5:
        raise CaseError(f"poisson is {poisson}, but must be greater than -1 and not greater than 0.5")
    size = _size(indenter, radius, angle)
    if isinstance(time, ForceCurve):
        if load is not None or depth is not None:
            raise CaseError("load and depth are those of the force curve: leave them out")
        time, load, depth, kept = of_model(time, model, branch)
        fit_touch, given = fit_touch or model not in get_args(Model), given or (None if model in get_args(Model) else kept)
    elif load is None or depth is None:
        raise CaseError("load and depth are missing: give time, load and depth, or a ForceCurve")
    _check_lengths(None if radius is None else size, depth)
    if model in get_args(Model):
        if thickness is not None and model != "hertz":
            raise CaseError(
                f"thickness is {thickness}, but the model {model!r} has the closed form of a half-space, and there is none for adhesion on a thin"
                ' sample: leave it out. The model "hertz" fits an elastic thin sample without adhesion'
            )
        for what in (name for name in _OfRecord.__annotations__ if told[name] != usual[name]):
            raise CaseError(f"{what} goes with the model \"viscoelastic\", but model is {model!r}: leave it out")
        if model != "hertz" and radius is None:
            raise CaseError(f'indenter is {indenter!r}, but the models of adhesion are those of a sphere: use the model "hertz"')
        return fit_force_curve(load, depth, size, nu, model, {name: told[name] for name in _OfForces.__annotations__})
    for what in (name for name in _OfCurve.__annotations__ if told[name] != usual[name]):
        raise CaseError(f"{what} goes with a model of an elastic body: give model, one of {', '.join(get_args(Model))}")
    power_law = model == "power-law"
    for what in (name for name in ("terms", "long_time") if power_law and told[name] != usual[name]):
        raise CaseError(f"{what} goes with the model \"viscoelastic\": a power law has no terms and no end; leave it out")
    times, loads, depths = columns(time=time, load=load, depth=depth)
    most = None if terms is None else count("terms", terms, 0)
    thin = sample(thickness, interface, nu)
    how = given, most, long_time, bool(fit_touch), thin, count("springs", springs), number("max_misfit", max_misfit)
    spring, of_spring = cantilever(spring_constant, spring_constant_uncertainty, sensitivity_uncertainty)
    of_radius = share("radius", radius_uncertainty, None if radius is None else size)
    shares = of_radius, share("thickness", thickness_uncertainty, thin and thin[0]), *of_spring
    found = _core.fit_indentation(times, loads, depths, power_law, indenter, size, *how, shares, spring)
    # E = E* (1 - nu^2)
    factor = 1.0 - nu**2
    rows = np.asarray(found["rows"], dtype=np.int64)
    record = {"rows": rows, "time": times[rows], "load": loads[rows], "depth": depths[rows], **{name: interval(found[name]) for name in ("touch", "baseline", "tilt")}}
    of_body = dict(poisson=nu, hardness=hardness, name=name, window=found["window"])
    if power_law:
        law = PowerLaw(young=factor * found["modulus"][0], alpha=found["exponent"][0], **of_body)
        numbers = {"modulus": interval(found["modulus"], factor), "exponent": interval(found["exponent"])}
        return PowerLawFit(**{**found, **numbers, **record}, material=law)
    own = {name: interval(found[name], factor) for name in ("equilibrium", "instantaneous")}
    fitted = [(interval(modulus, factor), interval(relaxation)) for modulus, relaxation in found["terms"]]
    series = [(factor * modulus[0], relaxation[0]) for modulus, relaxation in found["terms"]]
    material = Prony(equilibrium=factor * found["equilibrium"][0], terms=series, **of_body)
    return IndentationFit(**{**found, **own, **record, "terms": fitted}, material=material)


def _check_lengths(radius: float | None, depth: Any) -> None:
    """Warns of lengths that no indentation has: numbers in nm or um."""
    deepest = np.abs(line("depth", depth)).max(initial=0.0)
    for what, length, most in (("radius", radius or 0.0, 1.0), ("depth", deepest, 0.1)):
        if most < length < np.inf:
            words = f"the {what} is {'up to ' if what == 'depth' else ''}{length:.4g} m: lengths are in m and loads in N [unlikely-unit]"
            warn_caller(words, code="unlikely-unit")


def _size(indenter: str, radius: Any, angle: Any) -> float:
    """Radius [m] or half angle [rad] of the indenter."""
    choice("indenter", indenter, Indenter)
    wanted, size, other, unwanted = ("radius", radius, "angle", angle) if indenter in ("sphere", "paraboloid") else ("angle", angle, "radius", radius)
    if unwanted is not None:
        raise CaseError(f"{other} is {unwanted}, but the indenter {indenter!r} has none: leave it out, or give indenter")
    if size is None:
        raise CaseError(f"{wanted} is missing: the indenter is {indenter!r}")
    return radians("angle", size) if wanted == "angle" else number("radius", size)
