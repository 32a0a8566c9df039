"""Force curves: modulus and work of adhesion, and curves from the files of instruments."""

from __future__ import annotations

import errno
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core, _html
from ._arrays import AnyPath, Counts, Floats, NotThere, choice, columns, number
from ._core import CaseError
from ._paragraphs import of_force_fit
from ._sealed import ReadOnlyArrays
from ._words import Branch, Control
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
    #: Depth of first touch [m] and load of the free sphere [N], as (value, low, high).
    touch: Interval
    baseline: Interval
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
        along, baseline = ("depth", "m", self.depth - self.touch[0]), self.baseline[0]
        return recorded(along, "load", self.load - baseline, self.predicted - baseline, ax, style)

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
    spring, of_spring = cantilever(*(how[name] for name in ("spring_constant", "spring_constant_uncertainty", "sensitivity_uncertainty")))
    shares = share("radius", how["radius_uncertainty"], None if how["radius"] is None else size), *of_spring
    reach = None if how["range"] is None else number("range", how["range"])
    found = _core.fit_force_curve(loads, depths, how["indenter"], size, model, how["branch"], how["control"], reach, spring, *shares)
    modulus = interval(found.pop("contact_modulus"), 1.0 - poisson**2)
    own = {name: found[name] and interval(found[name]) for name in ("work", "transition", "range", "touch", "baseline")}
    rows = np.asarray(found["rows"], dtype=np.int64)
    return ForceFit(**{**found, **own, "rows": rows, "load": loads[rows], "depth": depths[rows]}, young=modulus)


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
        metadata: dict[str, Any] | None = None
    ) -> ForceCurve:
        """From the way of the cantilever's base towards the sample [m] and the deflection.

        Parameters
        ----------
        height : [m], larger towards the sample
        deflection : [m], or [V] where `sensitivity` is given; positive when pressing
        spring_constant : of the cantilever [N/m]
        sensitivity : of the deflection [m/V]
        metadata : to keep with the curve
        """
        way, bent = columns(height=height, deflection=deflection)
        stiffness = number("spring_constant", spring_constant)
        scale = 1.0 if sensitivity is None else number("sensitivity", sensitivity)
        for what, value in (("spring_constant", stiffness), ("sensitivity", scale)):
            if not 0.0 < value < float("inf"):
                raise CaseError(f"{what} is {value}, but must be finite and greater than 0")
        bent = scale * bent
        told = {"spring constant": stiffness, **({} if sensitivity is None else {"sensitivity": scale}), **(metadata or {})}
        return cls(stiffness * bent, way - bent, bent, way, told)

    def __repr__(self) -> str:
        return f"<ForceCurve of {len(self.force)} points, loads {self.force.min():.4g} to {self.force.max():.4g} N>"


def read_force_curves(path: AnyPath) -> list[ForceCurve]:
    """The force curves of a file of an atomic force microscope or a nanoindenter, by the package `afmformats`.

    JPK, Asylum Research, NT-MDT, AFM workshop, Optics11 and other files; a map gives one curve per pixel, with "grid index x" and
    "grid index y" in its `metadata`. The spring constant is the one that the file states.

    Parameters
    ----------
    path : of the file

    Raises
    ------
    ImportError : without the package: ``pip install 'asperity[afm]'``
    FileNotFoundError : there is no such file
    CaseError : a format that the package does not know, a file that it cannot read, or no curve with force and height
    """
    try:
        import afmformats  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ImportError:
        raise ImportError("files of force curves are read by afmformats: pip install 'asperity[afm]'") from None
    name = os.fspath(path)
    if not os.path.exists(name):
        raise NotThere(errno.ENOENT, "the file does not exist; check its name and folder", name)
    try:
        found = [_curve(data) for data in afmformats.load_data(name)]
    # Any reader fails in its own way on a damaged file, and the package's own errors are no Exceptions.
    except (Exception, afmformats.errors.AFMFileFormatError, afmformats.errors.MissingMetaDataError, afmformats.meta.MetaDataMissingError) as error:
        raise CaseError(f"{name}: afmformats {afmformats.__version__} cannot read it: {error}") from error
    curves = [curve for curve in found if curve is not None]
    if not curves:
        raise CaseError(f"{name} holds no curve of force over height or tip position")
    return curves


def _curve(data: Any) -> ForceCurve | None:
    """A curve of afmformats, whose heights and tip positions grow away from the sample."""
    metadata = {key: data.metadata[key] for key in data.metadata}
    if "force" not in data:
        return None
    force = np.array(data["force"], dtype=float)
    heights = (np.array(data[name], dtype=float) for name in ("height (measured)", "height (piezo)") if name in data)
    away = next(heights, None)
    height = None if away is None else -away
    stiffness = metadata.get("spring constant")
    deflection = force / stiffness if stiffness is not None and np.isfinite(stiffness) and stiffness > 0 else None
    # Where the file states the position of the tip, it counts: formats differ in the sign of their heights.
    if "tip position" in data:
        return ForceCurve(force, -np.array(data["tip position"], dtype=float), deflection, height, metadata)
    if height is not None and deflection is not None:
        return ForceCurve(force, height - deflection, deflection, height, metadata)
    return None
