"""Force curves: modulus and work of adhesion, and curves from the files of instruments."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from . import _core, _html
from ._arrays import Counts, Floats, choice, columns, number
from ._core import CaseError
from ._paragraphs import of_force_fit
from ._sealed import ReadOnlyArrays
from ._segments import Kind, Segment, found
from ._words import Branch, Control, Interface, Model, Weights
from .plot import recorded

if TYPE_CHECKING:
    from matplotlib.axes import Axes  # type: ignore[import-not-found,import-untyped,unused-ignore]

#: A value, and the lower and upper end of its 95 % interval. The value is NaN where the record does not determine it: the ends
#: are more than a factor of 10 apart.
Interval = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class ForceFit(ReadOnlyArrays):
    """Modulus and work of adhesion of a force curve. Made by :func:`fit_indentation` with a `model`."""

    #: "hertz", "dmt", "jkr" or "maugis".
    model: str
    #: Young's modulus [Pa] and work of adhesion [J/m2] (0 for Hertz), as (value, low, high).
    young: Interval
    work: Interval
    #: Maugis' lambda, 0.1 and less for DMT and 5 and more for JKR, and the range [m] of the attraction; None for other models.
    transition: Interval | None
    range: Interval | None
    #: The transition from DMT (0) to JKR (1) as alpha of Carpick, Ogletree and Salmeron; None for other models.
    alpha: float | None
    #: Depth of first touch [m], load of the free sphere there [N] and the slope of that load over the depth [N/m], as (value, low, high).
    touch: Interval
    baseline: Interval
    tilt: Interval
    #: Load at pull-off of the model [N], and smallest load of the record, both without the baseline.
    pull_off_force: float
    smallest_load: float
    #: Tabor's number: from `transition`, or from the range that was given, else 0.3 nm.
    tabor: float
    #: Largest radius of the contact [m].
    contact_radius: float
    #: Numbers of the rows that were fitted, load [N] and depth [m] that were measured there, and the load of the model.
    rows: Counts
    load: Floats
    depth: Floats
    predicted: Floats
    #: Root mean square of the distance from the curve, each channel over its range.
    relative_rms: float
    #: Near 2 for independent errors; well below where the model bends away from the record.
    durbin_watson: float
    #: What should be known before the numbers are believed.
    notes: list[str]

    def plot(self, *, ax: Axes | None = None, **style: Any) -> Axes:
        """Load over depth, from the load of the free sphere and the depth of first touch: the record as points, the model as a line, which
        takes the further arguments."""
        depth = self.depth - self.touch[0]
        free = self.baseline[0] + self.tilt[0] * depth
        return recorded(("depth", "m", depth), "load", self.load - free, self.predicted - free, ax, style)

    def methods(self, *, bibtex: bool = False) -> str:
        """A paragraph on what was fitted, for the methods section of a paper; with `bibtex` the entry to cite."""
        return of_force_fit(self, bibtex)

    def _lines(self) -> list[tuple[str, Interval]]:
        lines = [("E [Pa]", self.young), ("work of adhesion [J/m2]", self.work)]
        if self.transition is not None and self.range is not None:
            lines += [("lambda", self.transition), ("range [m]", self.range)]
        return lines

    def __repr__(self) -> str:
        told = ", ".join(f"{name} {value:.4g} ({low:.4g} to {high:.4g})" for name, (value, low, high) in self._lines())
        return f"<ForceFit {self.model} of {len(self.rows)} rows: {told}>"

    def _repr_html_(self) -> str:
        return table(self._lines())


def table(lines: list[tuple[str, Interval]]) -> str:
    """Names and intervals as a notebook shows them."""
    rows = [(name, *(f"{x:.5g}" if x == x else "not determined" for x in values)) for name, values in lines]
    return _html.table(rows, ("", "value", "95 % from", "to"))


def fit_force_curve(load: Any, depth: Any, size: float, poisson: float, model: str, how: dict[str, Any]) -> ForceFit:
    """What :func:`fit_indentation` does with a `model`."""
    loads, depths = columns(load=load, depth=depth)
    choice("branch", how["branch"], Branch)
    if how["control"] is not None:
        choice("control", how["control"], Control)
    choice("weights", how["weights"], Weights)
    spring, of_spring = cantilever(*(how[name] for name in ("spring_constant", "spring_constant_uncertainty", "sensitivity_uncertainty")))
    thin = sample(how["thickness"], how["interface"], poisson)
    of_size = share("radius", how["radius_uncertainty"], None if how["radius"] is None else size)
    shares = of_size, share("thickness", how["thickness_uncertainty"], thin and thin[0]), *of_spring
    reach = None if how["range"] is None else number("range", how["range"])
    found = _core.fit_force_curve(loads, depths, how["indenter"], size, thin, model, how["branch"], how["control"], how["weights"], reach, spring, *shares)
    modulus = interval(found.pop("contact_modulus"), 1.0 - poisson**2)
    own = {name: found[name] and interval(found[name]) for name in ("work", "transition", "range", "touch", "baseline", "tilt")}
    rows = np.asarray(found["rows"], dtype=np.int64)
    return ForceFit(**{**found, **own, "rows": rows, "load": loads[rows], "depth": depths[rows]}, young=modulus)


def sample(thickness: Any, interface: Any, poisson: float) -> tuple[float, float, str] | None:
    """Thickness, Poisson's ratio and interface of a thin sample; None for a half-space."""
    choice("interface", interface, Interface)
    if thickness is None and interface != "bonded":
        raise CaseError("interface is that of a thin sample to its base: give its thickness too")
    return None if thickness is None else (number("thickness", thickness), poisson, interface)


def interval(told: tuple[float, float, float, bool], factor: float = 1.0) -> Interval:
    """What the core tells of a number and its interval, times a factor; NaN where the record does not determine it."""
    value, low, high, determined = told
    return (factor * value if determined else float("nan"), factor * low, factor * high)


def share(what: str, uncertainty: Any, value: float | None) -> float:
    """The standard uncertainty of a quantity over its value; 0 where none is stated."""
    name = f"{what}_uncertainty"
    stated = number(name, uncertainty)
    if stated and not value:
        raise CaseError(f"{name} is that of {what}: give {what} too")
    return stated / value if value else 0.0


def cantilever(spring_constant: Any, spring_constant_uncertainty: Any, sensitivity_uncertainty: Any) -> tuple[float | None, tuple[float, float]]:
    """The spring constant, and the uncertainties of the scales of load and deflection."""
    spring = None if spring_constant is None else number("spring_constant", spring_constant)
    if spring is None and sensitivity_uncertainty:
        raise CaseError("sensitivity_uncertainty changes the deflection: give spring_constant too")
    return spring, (share("spring_constant", spring_constant_uncertainty, spring), number("sensitivity_uncertainty", sensitivity_uncertainty))


@dataclass(frozen=True, eq=False)
class ForceCurve(ReadOnlyArrays):
    """Approach and retraction of a sphere, in the order of the measurement. Made by :func:`read_force_curves`, or with
    :meth:`from_deflection`.

    Examples
    --------
    >>> import asperity as asp, numpy as np
    >>> height = np.linspace(-1e-6, 1e-6, 5)
    >>> curve = asp.ForceCurve.from_deflection(height, [0.0, 0.0, 0.0, 2.0, 4.0], spring_constant=0.5, sensitivity=50e-9)
    >>> curve.force[-1], round(curve.depth[-1] * 1e9)                 # 4 V are 200 nm, 100 nN
    (np.float64(1e-07), 800)
    """

    #: Load [N]; pressing is positive.
    force: Floats
    #: Depth [m]: height less deflection, deeper is larger. Its zero is that of the instrument; the fit finds the first touch.
    depth: Floats
    #: Deflection of the cantilever [m]; None where the file holds no spring constant.
    deflection: Floats | None = None
    #: Way of the cantilever's base towards the sample [m].
    height: Floats | None = None
    #: What the file says, by its words in SI units: "spring constant" [N/m], "sensitivity" [m/V], "grid index x", ...
    metadata: dict[str, Any] = field(default_factory=dict)
    #: Time of each row [s]; None where it is not known.
    time: Floats | None = None
    #: Approach, holds and retraction in the order of the measurement; empty where they are not known.
    segments: tuple[Segment, ...] = ()

    def __post_init__(self) -> None:
        given = {name: value for name in ("force", "depth", "deflection", "height") if (value := getattr(self, name)) is not None}
        if not len(given["force"]):
            raise CaseError("a force curve holds one point at least")
        # A record may hold gaps, but no column may be shorter than another.
        self.__dict__.update(zip(given, columns(**given)))
        super().__post_init__()

    @classmethod
    def from_deflection(
        cls, height: Any, deflection: Any, /, *, spring_constant: float, sensitivity: float | None = None,
        time: Any = None, metadata: dict[str, Any] | None = None
    ) -> ForceCurve:
        """From the way of the cantilever's base towards the sample [m] and the deflection.

        Parameters
        ----------
        height : [m], larger towards the sample
        deflection : [m], or [V] where `sensitivity` is given; positive when pressing
        spring_constant : of the cantilever [N/m]
        sensitivity : of the deflection [m/V]
        time : of each row [s]
        metadata : to keep with the curve
        """
        way, bent, *times = columns(height=height, deflection=deflection, **({} if time is None else {"time": time}))
        stiffness = number("spring_constant", spring_constant)
        scale = 1.0 if sensitivity is None else number("sensitivity", sensitivity)
        for what, value in (("spring_constant", stiffness), ("sensitivity", scale)):
            if not 0.0 < value < float("inf"):
                raise CaseError(f"{what} is {value}, but must be finite and greater than 0")
        bent = scale * bent
        told = {"spring constant": stiffness, **({} if sensitivity is None else {"sensitivity": scale}), **(metadata or {})}
        clock = times[0] if times else None
        return cls(stiffness * bent, way - bent, bent, way, told, clock, found(way, bent, clock, [(0, len(way))]))

    def select(self, *kinds: Kind) -> ForceCurve:
        """The rows of the segments of these kinds, in the order of the measurement: ``curve.select("approach", "hold")``.

        Raises
        ------
        CaseError : another word, or a curve without such a segment
        """
        for kind in kinds:
            choice("kind of a segment", kind, Kind)
        chosen = [segment for segment in self.segments if segment.kind in kinds]
        if not chosen:
            own = ", ".join(segment.kind for segment in self.segments) or "no segments that are known"
            raise CaseError(f"select: the curve has no segment of the kind {' or '.join(kinds) or '(none is named)'}: it has {own}")
        rows = np.concatenate([np.arange(segment.start, segment.stop) for segment in chosen])
        ends = np.cumsum([segment.stop - segment.start for segment in chosen]).tolist()
        moved = tuple(replace(segment, start=start, stop=stop) for segment, start, stop in zip(chosen, [0, *ends], ends))
        picked: dict[str, Any] = {name: None if (of := getattr(self, name)) is None else of[rows] for name in ("force", "depth", "deflection", "height", "time")}
        return ForceCurve(**picked, segments=moved, metadata=dict(self.metadata))

    def __repr__(self) -> str:
        return f"<ForceCurve of {len(self.force)} points, loads {self.force.min():.4g} to {self.force.max():.4g} N>"


def of_model(curve: ForceCurve, model: str, branch: str) -> tuple[Floats | None, Floats, Floats, str | None]:
    """Time, load and depth of the rows that a model takes, and the channel that the test controlled."""
    if model in get_args(Model):
        kind: Kind = "approach" if branch == "approach" else "retract"
        own = curve.select(kind) if curve.segments else curve
        return None, own.force, own.depth, None
    if curve.time is None:
        raise CaseError(f"the curve has no times, which the model {model!r} needs: give them as ForceCurve(..., time=)")
    kinds = [segment.kind for segment in curve.segments]
    if "approach" not in kinds:
        return curve.time, curve.force, curve.depth, None
    first = kinds.index("approach")
    last = kinds.index("retract", first) if "retract" in kinds[first:] else len(kinds)
    rows = slice(curve.segments[first].start, curve.segments[last - 1].stop)
    clamps = [segment.clamp for segment in curve.segments[first:last] if segment.clamp]
    given = "load" if "force" in clamps else "depth"
    return curve.time[rows] - curve.time[rows.start], curve.force[rows], curve.depth[rows], given
