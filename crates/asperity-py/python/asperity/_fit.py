"""Materials from measured curves.

A passive material has non-negative weights only, so a fit is a non-negative least squares of relative residuals on a
logarithmic grid of times; terms that the data do not call for are then merged and left out. Curves at several
temperatures become a master curve first (J. D. Ferry, Viscoelastic Properties of Polymers, 1980, chapter 11).
"""

from __future__ import annotations

import html
import json
import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal

import numpy as np

from . import _core, _html
from ._arrays import AnyPath, ArrayLike, Floats, count, line, number, pair, plain
from ._core import CaseError
from ._declared import arguments_of, check
from ._findings import Finding, findings_of, warn
from ._materials import _OF_BODY, Creep, Material, Prony
from ._paragraphs import of_fit
from ._sealed import ReadOnlyArrays
from ._shifts import Shift, made
from ._words import LongTime, Measure, Moduli, Vertical
from .plot import fitted
from ._units import bare, frequency as angular_frequency, has_unit

#: Temperatures closer than this belong to one sweep [K], and those of one sweep spread by no more.
_SAME, _SPREAD = 1.0, 3.0
_LABELS = {"relaxation": ("relaxation modulus",), "creep": ("creep compliance",), "dma": ("storage modulus", "loss modulus")}


@dataclass(frozen=True, eq=False)
class Fit(ReadOnlyArrays):
    """A Prony series fitted to measured curves, and its misfit.

    Made by :func:`fit_relaxation`, :func:`fit_creep`, :func:`fit_dma` and :func:`fit_file`.
    """

    #: "relaxation", "creep" or "dma": what was measured.
    kind: Literal["relaxation", "creep", "dma"]
    #: "young" or "shear": what the numbers are.
    modulus: Measure
    #: (modulus [Pa], relaxation time [s]) or, of creep data, (compliance [1/Pa], retardation time [s]).
    terms: tuple[tuple[float, float], ...]
    #: Modulus after all relaxation [Pa]; None of creep data.
    equilibrium: float | None
    #: Instantaneous compliance [1/Pa] and fluidity [1/(Pa s)] of creep data; else None.
    instantaneous: float | None
    fluidity: float | None
    #: Largest and root mean square of |fit/data - 1|.
    max_misfit: float
    rms_misfit: float
    #: (rms, largest) misfit of each curve, fitted or not: "storage" and "loss" of a DMA.
    misfits: dict[str, tuple[float, float]]
    #: Where the largest is: time [s] or angular frequency [rad/s].
    worst: float
    #: Relative scatter of the data (standard deviation).
    noise: float
    #: Relative standard deviations of weight and time of each term; infinite where the data show nothing of it.
    uncertainty: list[tuple[float, float]]
    #: First and last (reduced) time that the data cover [s].
    window: tuple[float, float]
    #: How times depend on temperature, given or estimated.
    shift: Shift | None
    #: Rms distance of an estimated law from the estimated factors [decades of a_T]; None if no law was estimated.
    shift_rms: float | None
    #: (temperature [K], log10 a_T, standard deviation [decades]) of each sweep whose factor was estimated.
    shift_factors: list[tuple[float, float, float]]
    #: (temperature [K], b_T, relative standard deviation) of each sweep, where vertical shifts were asked for: its moduli are those
    #: at the reference temperature over b_T.
    vertical_factors: list[tuple[float, float, float]]
    #: Temperatures of the sweeps [K].
    temperatures: list[float]
    #: What was assumed.
    notes: list[str]
    #: Where the fit may be off: scatter of the data, misfit, uncertain shift factors, a header that names another modulus.
    findings: list[Finding]
    #: Reduced times [s] or angular frequencies [rad/s] of the points, at the reference temperature.
    x: Floats
    #: The measured curves at `x`: modulus [Pa] or compliance [1/Pa]; storage and loss of a DMA.
    curves: tuple[Floats, ...]
    #: The material as a block of a case file.
    case_block: str
    _body: dict[str, Any]

    @property
    def material(self) -> Material:
        """The material with the Poisson's ratio (or bulk modulus, hardness, name) that was given to the fit."""
        if self._body.get("poisson") is None and self._body.get("bulk_modulus") is None:
            raise CaseError("the fit knows no Poisson's ratio: give poisson or bulk_modulus to the fit, or take fit.with_body(poisson=...) as the material")
        return self.with_body(**self._body)

    def with_body(
        self, *, poisson: float | None = None, bulk_modulus: float | None = None, hardness: float | None = None,
        name: str | None = None, temperature: float | None = None
    ) -> Material:
        """The material with this Poisson's ratio or bulk modulus [Pa], hardness [Pa], and constant temperature [K]; it knows the times
        that the data cover."""
        given = dict(poisson=poisson, bulk_modulus=bulk_modulus, hardness=hardness, name=name, temperature=temperature)
        rest: dict[str, Any] = {**given, "terms": self.terms, "shift": self.shift, "window": self.window}
        made: Material
        if self.equilibrium is not None:
            made = Prony(equilibrium=self.equilibrium, modulus=self.modulus, **rest)
        else:
            assert self.instantaneous is not None and self.fluidity is not None
            made = Creep(instantaneous=self.instantaneous, fluidity=self.fluidity, compliance=self.modulus, **rest)
        made._hold(_fit=self)
        return made

    def curve(self, x: ArrayLike) -> tuple[Floats, ...]:
        """The fitted curves at reduced times [s], or angular frequencies [rad/s] of a DMA."""
        # The functions of a material do not depend on Poisson's ratio.
        material = self.with_body(poisson=0.5)
        if self.kind == "relaxation":
            return (material.relaxation_modulus(x),)
        if self.kind == "creep":
            return (material.creep_compliance(x),)
        return material.storage_loss(x)

    def table(self) -> dict[str, Floats]:
        """Points, fit, and relative misfit as columns: ``pandas.DataFrame(fit.table())`` shows them."""
        axis = "angular_frequency" if self.kind == "dma" else "time"
        out = {axis: self.x}
        for label, data, fitted in zip(_LABELS[self.kind], self.curves, self.curve(self.x)):
            key = label.replace(" ", "_")
            out |= {key: data, f"{key}_fitted": fitted, f"{key}_misfit": fitted / data - 1.0}
        return out

    def plot(self, *, ax: Any = None) -> Any:
        """Points and fitted curves over reduced time or angular frequency, on logarithmic axes."""
        return fitted(self, ax)

    def methods(self, *, bibtex: bool = False) -> str:
        """A paragraph on what was fitted, for the methods section of a paper; with `bibtex` the entry to cite."""
        return of_fit(self, bibtex)

    def __repr__(self) -> str:
        first, last = self.window
        return (
            f"<Fit of {len(self.x)} {self.kind} points: {len(self.terms)} terms, misfit {100 * self.rms_misfit:.2g} % rms, "
            f"{100 * self.max_misfit:.2g} % at most; {first:.3g} s to {last:.3g} s>"
        )

    def _repr_html_(self) -> str:
        weight = "modulus [Pa]" if self.equilibrium is not None else "compliance [1/Pa]"
        both = zip(self.terms, self.uncertainty)
        rows = [(f"{w:.6g}", f"{t:.6g}", f"{100 * a:.2g} %", f"{100 * b:.2g} %") for (w, t), (a, b) in both]
        return f"<p>{html.escape(repr(self).strip('<>'))}</p>{_html.table(rows, (weight, 'time [s]', '± weight', '± time'))}"


@dataclass(kw_only=True)
class OfBody:
    """What is said of the body; all arguments are checked as they are declared."""

    poisson: float | None = None
    bulk_modulus: float | None = None
    hardness: float | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        check(self)


@dataclass(kw_only=True)
class Options(OfBody):
    """How a material is fitted; :func:`fit_relaxation` describes the fields."""

    modulus: Measure | None = "young"
    shift: Shift | str | None = None
    reference: float | None = None
    vertical: Vertical | None = None
    window: Sequence[float] | None = None
    per_decade: float = 3.0
    margin: float = 1.0
    long_time: LongTime = "free"
    max_misfit: float = 0.1
    max_terms: int | None = None
    misfit: float | None = None

    def keys(self, kind: str | None) -> dict[str, Any]:
        """The options as the core takes them, for curves of that kind."""
        as_given = ("modulus", "vertical", "per_decade", "margin", "long_time", "max_misfit", "max_terms", "misfit")
        given = {name: getattr(self, name) for name in as_given}
        return {**given, "shift": self._shift_keys(), "window": self._window(kind), "moduli": "both", "loss_weight": 1.0}

    def _shift_keys(self) -> dict[str, Any] | None:
        estimated = isinstance(self.shift, str) and self.shift == "estimated"
        if self.shift is not None and not estimated and not isinstance(self.shift, Shift):
            raise CaseError(f"shift is {self.shift!r}, but must be one of asperity.wlf, arrhenius, shift_table, or 'estimated'")
        if estimated and self.reference is None:
            raise CaseError("shift is 'estimated', so that a reference temperature in K is needed: reference=...")
        if self.reference is not None and not estimated:
            raise CaseError("reference goes with shift='estimated'; other shifts have their own")
        if isinstance(self.shift, Shift):
            return self.shift._keys
        return {"model": "estimated", "reference": self.reference} if estimated else None

    def _window(self, kind: str | None) -> list[float] | None:
        """The ends of the window [s], of a DMA [rad/s]; with a unit only where the kind is known."""
        given: Any = self.window
        if has_unit(given) and kind is not None:
            given = angular_frequency("window", given, angular=True) if kind == "dma" else bare("window", given, "s")
        return None if given is None else list(pair("window", given))

    def fit_of(self, found: dict[str, Any]) -> Fit:
        """The fit of these numbers of the core."""
        body = {key: getattr(self, key) for key in _OF_BODY}
        lists = {key: tuple(found[key]) for key in ("terms", "curves")}
        findings = findings_of(json.loads(found["findings"]))
        warn(findings)
        return Fit(**{**found, **lists, "findings": findings, "shift": made(found["shift"])}, _body=body)


@dataclass(kw_only=True)
class Points(Options):
    """A fit to points, each of which may have its temperature."""

    temperature: Any = None

    def fit(self, kind: str, x: Any, values: list[Any]) -> Fit:
        """The fit of curves over times [s] or angular frequencies [rad/s]."""
        at = line("frequency" if kind == "dma" else "time", x)
        curves = [line(label, value) for label, value in zip(_LABELS[kind], values)]
        for label, curve in zip(_LABELS[kind], curves):
            if len(curve) != len(at):
                raise CaseError(f"{label} has {len(curve)} values for {len(at)} points")
        for label, column in (("frequency" if kind == "dma" else "time", at), *zip(_LABELS[kind], curves)):
            if (wrong := np.flatnonzero(~np.isfinite(column))).size:
                first = wrong[0]
                more = f" ({wrong.size} of {len(column)} are not finite)" if wrong.size > 1 else ""
                raise CaseError(f"{label} of point {first + 1} is {column[first]}, but must be a number{more}: leave such points out, as in values[numpy.isfinite(values)]")
        sweeps = _sweeps(at, curves, self.temperature)
        if len(sweeps) > 1 and self.shift is None:
            known = ", ".join(f"{kelvin:.2f} K" for kelvin, _, _ in sweeps[:20])
            raise CaseError(
                f"the data hold {len(sweeps)} temperatures ({known}); state how times depend on temperature: "
                "shift=asperity.wlf(c1=..., c2=..., reference=...), or shift='estimated' with reference=..."
            )
        try:
            return self.fit_of(_core.fit(kind, sweeps, self.keys(kind)))
        except CaseError as error:
            # Arrays have no columns to name.
            error.args = (re.sub(r"; name it: .*", "", str(error)), *error.args[1:])
            raise


@dataclass(kw_only=True)
class Spectra(Options):
    """A fit that may be one of storage and loss modulus; :func:`fit_dma` describes the fields."""

    moduli: Moduli = "both"
    loss_weight: float = 1.0

    def keys(self, kind: str | None) -> dict[str, Any]:
        return {**super().keys(kind), "moduli": self.moduli, "loss_weight": self.loss_weight}


@dataclass
class OfCurve(Points):
    """The arguments of :func:`fit_relaxation` and :func:`fit_creep`."""

    time: Any
    values: Any


@dataclass
class OfDma(Points, Spectra):
    """The arguments of :func:`fit_dma`."""

    frequency: Any
    storage: Any
    loss: Any
    _: KW_ONLY
    angular: bool = False


@dataclass
class OfFile(Spectra):
    """The arguments of :func:`fit_file`."""

    path: AnyPath
    _: KW_ONLY
    kind: str | None = None
    sheet: str | None = None
    segment: int | None = None
    columns: Mapping[str, str | int] | None = None
    units: Mapping[str, str] | None = None
    modulus: Measure | None = None


@arguments_of(OfCurve)
def fit_relaxation(given: OfCurve) -> Fit:
    """Fits a relaxation modulus.

    Parameters
    ----------
    time : times since the step [s]; those of one temperature in order
    values : relaxation modulus [Pa] at these times
    temperature : temperature of each point [K], where there are several
    modulus : "young" or "shear": what the values are
    shift : how times depend on temperature, or "estimated": from the overlap of the sweeps, about `reference` [K]
    vertical : how moduli depend on temperature besides: "density" (as density times absolute temperature, rubbers) or "free" (one
        factor b_T per sweep, estimated); they do not if not given
    poisson, bulk_modulus, hardness, name : of the body, for :attr:`Fit.material`
    window : first and last (reduced) time that is fitted [s]
    per_decade : times per decade that the fit begins with
    margin : decades of times beyond the data
    long_time : "free", "solid" (no flow) or "fluid" (no modulus is left)
    max_misfit : largest mean relative misfit of neighbours before the data are refused
    max_terms : most terms; by default as many as the data call for
    misfit : rms misfit to be held by as few terms as possible

    Raises
    ------
    CaseError : naming the point: times out of order or twice, values that no passive material has

    Examples
    --------
    >>> import asperity as asp, numpy as np
    >>> t = np.geomspace(0.1, 100, 40)
    >>> fit = asp.fit_relaxation(t, 1e6 + 2e6 * np.exp(-t / 10), poisson=0.5)
    >>> fit.max_misfit < 1e-4, round(fit.terms[0][1], 3)
    (True, 10.0)
    >>> round(float(fit.material.relaxation_modulus(0.0)), -3)
    3000000.0
    """
    return given.fit("relaxation", given.time, [given.values])


@arguments_of(OfCurve)
def fit_creep(given: OfCurve) -> Fit:
    """Fits a creep compliance [1/Pa]; the parameters are those of :func:`fit_relaxation`.

    >>> import asperity as asp, numpy as np
    >>> t = np.geomspace(0.1, 100, 40)
    >>> fit = asp.fit_creep(t, 1e-6 + 2e-6 * (1 - np.exp(-t / 10)), modulus="shear")
    >>> round(fit.instantaneous * 1e6, 3), [(round(c * 1e6, 3), round(s, 2)) for c, s in fit.terms]
    (1.0, [(2.0, 10.0)])
    """
    return given.fit("creep", given.time, [given.values])


@arguments_of(OfDma)
def fit_dma(given: OfDma) -> Fit:
    """Fits storage and loss modulus [Pa] over frequency [Hz], or [rad/s] with ``angular=True``, by one spectrum; frequencies with a
    unit are converted. :meth:`Material.storage_loss`, `storage` and `loss` take [rad/s], as `Fit.x` has them.

    `window` is in rad/s; `moduli` is "both", "storage" or "loss", the ones that are fitted (measured ones often contradict
    each other: then the storage modulus is usual, and :attr:`Fit.misfits` says how far off the other is); `loss_weight` is the
    weight of a residual of the loss modulus. The other parameters are those of :func:`fit_relaxation`.

    The fit holds at the strain of the DMA. A filled rubber is linear up to about 0.2 %; beyond, it is softer and loses more (Payne
    effect), which no linear material has.

    >>> import asperity as asp, numpy as np
    >>> rubber = asp.Prony(equilibrium=1e6, terms=[(5e6, 0.01), (2e6, 1.0)], poisson=0.5)
    >>> f = np.geomspace(0.01, 100, 41)
    >>> fit = asp.fit_dma(f, *rubber.storage_loss(2 * np.pi * f), poisson=0.5)
    >>> len(fit.terms), fit.max_misfit < 1e-3
    (2, True)

    There and back: what was given at f [Hz] is that of the material at 2 pi f [rad/s].

    >>> storage, loss = rubber.storage_loss(2 * np.pi * f)
    >>> bool(np.allclose(fit.material.storage(2 * np.pi * f), storage, rtol=1e-3))
    True
    >>> same = asp.fit_dma(2 * np.pi * f, storage, loss, angular=True, poisson=0.5)
    >>> bool(np.allclose(same.material.loss(2 * np.pi * f), loss, rtol=1e-3))
    True
    """
    at = angular_frequency("frequency", given.frequency, angular=True)
    # Converted where it carries a unit; a plain number is what `angular` says.
    omega = line("frequency", at) * (1.0 if given.angular or has_unit(given.frequency) else 2.0 * math.pi)
    return given.fit("dma", omega, [given.storage, given.loss])


@arguments_of(OfFile)
def fit_file(given: OfFile) -> Fit:
    """Fits a text table of a relaxation test, a creep test or a DMA, as ``asperity material fit`` does.

    Parameters that are not listed are those of :func:`fit_dma` and :func:`fit_relaxation`; `window` in s, or rad/s of a DMA.

    Parameters
    ----------
    path : table or spreadsheet (.xls, .xlsx) with one point per line; quantities and units are found from its header
    kind : "relaxation", "creep" or "dma", if the header does not state it
    columns : names or numbers (from 1) of columns by quantity: time, modulus, compliance, frequency, storage, loss,
        tan_delta, temperature
    units : units by quantity, which go before those of the header
    sheet : sheet of a spreadsheet; by default the first one that names such columns
    segment : which of several steps or sweeps below each other to read, from 1; by default all, as one
    modulus : "young" or "shear": what the values are; by default what the header says (E or D, G or J), or else "young"
    shift : without it, sweeps at several temperatures are shifted as the file says, or by an estimate about the temperature that is
        nearest to 20 degC (`notes` say so)

    Raises
    ------
    CaseError : naming the line of the file
    OSError : the file cannot be read
    """
    places = {role: at if isinstance(at, str) else count(f"column of {role}", at) for role, at in (given.columns or {}).items()}
    segment = None if given.segment is None else count("segment", given.segment)
    units = dict(given.units or {})
    found = _core.fit_file(os.fspath(given.path), given.kind, places, units, given.sheet, segment, given.keys(given.kind))
    return given.fit_of(found)


#: Points per decade of time at which a function is looked at.
_PER_DECADE = 20


@dataclass
class OfFunction(OfBody):
    """The arguments of :func:`Relaxation` and :func:`CreepFunction`."""

    function: Callable[[float], Any]
    _: KW_ONLY
    window: Sequence[float]
    modulus: Measure = "young"
    shift: Shift | None = None
    temperature: float | None = None
    per_decade: float = 3.0
    max_misfit: float = 0.01

    def material(self, kind: str) -> Material:
        """The material with this function of time."""
        label, function = _LABELS[kind][0], self.function
        if not callable(function):
            raise CaseError(f"the {label} is {function!r}, but must be a function of time in s; measured points go to asperity.fit_{kind}")
        first, last = pair("window", bare("window", self.window, "s"))
        if not 0.0 < first < last < math.inf:
            raise CaseError(f"window is {self.window!r}, but must be (first, last) time in s, both greater than 0")
        times = np.geomspace(first, last, max(3, math.ceil(_PER_DECADE * math.log10(last / first)) + 1))
        unit = "Pa" if kind == "relaxation" else "1/Pa"
        values = np.array([number(f"{label} at {time:g} s", function(float(time)), unit) for time in times])
        curve = OfCurve(times, values, modulus=self.modulus, shift=self.shift, per_decade=self.per_decade, max_misfit=self.max_misfit)
        fit = curve.fit(kind, times, [values])
        if fit.max_misfit > self.max_misfit:
            raise CaseError(
                f"the {label} is {100 * fit.max_misfit:.2g} % off its Prony series at {fit.worst:g} s, more than max_misfit, {100 * self.max_misfit:g} %: "
                "a passive material relaxes by decaying exponentials only; give a larger per_decade, a shorter window or a larger max_misfit"
            )
        return fit.with_body(**{name: getattr(self, name) for name in (*_OF_BODY, "temperature")})


@arguments_of(OfFunction)
def Relaxation(given: OfFunction) -> Material:
    """A material of any relaxation function of time, as a Prony series that is fitted to it.

    Parameters
    ----------
    function : relaxation modulus [Pa] at a time [s]
    window : first and last time [s] for which it holds: the shortest step of the run and its end, or less and more. A run that
        needs other times gets the finding "beyond-material-data"
    modulus : "young" or "shear": what the function gives
    poisson, bulk_modulus, hardness, name, shift, temperature : of the body, as for any material
    max_misfit : largest relative distance of the series from the function; what has no such series is refused
    per_decade : times per decade that the fit begins with

    Returns
    -------
    A :class:`Prony` material. Its `fit` says how close it is: ``material.fit.max_misfit``

    Raises
    ------
    CaseError : no sum of decaying exponentials with positive weights is that close, as of a modulus that grows

    Examples
    --------
    >>> import asperity as asp, numpy as np
    >>> stretched = asp.Relaxation(lambda t: 1e6 + 9e6 * np.exp(-np.sqrt(t / 2.0)), window=(1e-3, 1e3), poisson=0.5)
    >>> stretched.fit.max_misfit < 1e-3, bool(abs(float(stretched.relaxation(2.0)) / (1e6 + 9e6 * np.exp(-1)) - 1) < 1e-3)
    (True, True)
    """
    return given.material("relaxation")


@arguments_of(OfFunction)
def CreepFunction(given: OfFunction) -> Material:
    """A material of any creep function of time [1/Pa]; the parameters are those of :func:`Relaxation`, and what is made is a
    :class:`Creep` material.

    >>> import asperity as asp
    >>> andrade = asp.CreepFunction(lambda t: 1e-9 * (1.0 + 0.3 * t ** (1 / 3)), window=(1e-2, 1e4), poisson=0.3)
    >>> andrade.fit.max_misfit < 1e-4, abs(float(andrade.creep(1000.0)) / 4e-9 - 1) < 1e-4
    (True, True)
    """
    return given.material("creep")


def _sweeps(x: Floats, curves: list[Floats], temperature: Any) -> list[tuple[float | None, Floats, list[Floats]]]:
    """The points by temperature, the coldest first; a sweep that goes down is turned."""
    groups: list[tuple[float | None, Any]] = []
    if temperature is None or np.ndim(temperature) == 0:
        groups.append((None if temperature is None else number("temperature", temperature), np.arange(len(x))))
    else:
        kelvin = line("temperature", temperature)
        if len(kelvin) != len(x):
            raise CaseError(f"temperature has {len(kelvin)} values for {len(x)} points")
        order = np.argsort(kelvin, kind="stable")
        for rows in np.split(order, np.flatnonzero(np.diff(kelvin[order]) > _SAME) + 1):
            held = kelvin[rows]
            if np.ptp(held) > _SPREAD:
                raise CaseError(
                    f"the temperatures from {held.min():g} K to {held.max():g} K follow each other within {_SAME:g} K; "
                    "sweeps at held temperatures are needed"
                )
            groups.append((float(held.mean()), np.sort(rows)))
    turned = [(mean, rows[::-1] if len(rows) > 1 and np.all(np.diff(x[rows]) < 0) else rows) for mean, rows in groups]
    return [(mean, plain(x[rows]), [plain(curve[rows]) for curve in curves]) for mean, rows in turned]
