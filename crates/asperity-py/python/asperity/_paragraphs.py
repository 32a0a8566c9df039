"""Paragraphs on methods of leaks, stresses and fits, as :mod:`asperity._methods` writes those of contacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._arrays import cells_of
from ._cite import entries
from ._core import __version__
from ._prefixes import quantity

if TYPE_CHECKING:
    from ._fit import Fit
    from ._force_curves import ForceFit, Interval
    from ._indentation import IndentationFit, PowerLawFit
    from ._leakage import Leakage
    from ._stress import Stress

_MODELS = {
    "hertz": "without adhesion (Hertz)",
    "dmt": "with the adhesion of Derjaguin, Muller and Toporov (DMT)",
    "jkr": "with the adhesion of Johnson, Kendall and Roberts (JKR)",
    "maugis": "with the adhesion of Maugis, between DMT and JKR",
}
_DATA = {"relaxation": "relaxation modulus", "creep": "creep compliance", "dma": "storage and loss modulus"}


def _with(text: str, bibtex: bool) -> str:
    return f"{text}\n\n{entries(['asperity'])}" if bibtex else text


def _warned(codes: list[str]) -> str:
    return f" The program warned of: {', '.join(sorted(set(codes)))}." if codes else ""


def of_leak(leak: Leakage, bibtex: bool) -> str:
    size = " x ".join(quantity(length, "m") for length in leak._size)
    keys = leak._keys
    along = {"x": "along x", "y": "along y", "both": "along x, with the effective conductance of both directions,"}[keys["direction"]]
    closed = "" if not keys["smallest_gap"] else f", nor do gaps below {quantity(keys['smallest_gap'], 'm')}"
    found = f"The hydraulic gap is {quantity(leak.hydraulic_gap, 'm')}, the critical gap {quantity(leak.critical_gap, 'm')}." if leak.percolates else "The seal is tight."
    return _with(
        f"The flow {along} through the gap was computed with asperity {__version__} by Reynolds' equation, with the cube of the gap as mobility, on "
        f"{cells_of(leak._gap)} of {size} with {keys['sides']} sides; cells in contact let nothing through{closed}. {found}"
        + _warned([finding["code"] for finding in leak.findings if finding["severity"] == "warning"]), bibtex
    )


def of_stress(stress: Stress, bibtex: bool) -> str:
    _, size, boundary, _, _, tractions = stress._given
    domain = "a periodic domain" if boundary == "periodic" else "a free surface"
    lengths = " x ".join(quantity(length, "m") for length in size)
    ratio = "a Poisson's ratio that changes with time" if stress._poisson is None else f"the Poisson's ratio {stress._poisson:g}"
    shear = " and the tangential tractions" if tractions is not None else ""
    depths = f"{len(stress.depths)} depths from {quantity(float(stress.depths[0]), 'm')} to {quantity(float(stress.depths[-1]), 'm')}"
    if len(stress.depths) == 1:
        depths = f"the depth {quantity(float(stress.depths[0]), 'm')}"
    return _with(
        f"The stress below the surface of a half-space was computed with asperity {__version__} from the pressure{shear} on {cells_of(stress._pressure)} of "
        f"{domain} of {lengths}, with {ratio}, at {depths}.", bibtex
    )


def of_fit(fit: Fit, bibtex: bool) -> str:
    measure = "Young's" if fit.modulus == "young" else "shear"
    creep = fit.equilibrium is None
    terms = ", ".join(f"({weight:.6g} {'1/Pa' if creep else 'Pa'}, {time:.6g} s)" for weight, time in fit.terms)
    rest = (
        f"the instantaneous compliance {fit.instantaneous:.6g} 1/Pa and the fluidity {fit.fluidity:.6g} 1/(Pa s)" if creep else f"the equilibrium modulus {fit.equilibrium:.6g} Pa"
    )
    shift = f" Times were reduced to one temperature with the shift {fit.shift!r}." if fit.shift is not None else ""
    over = "angular frequencies" if fit.kind == "dma" else "times"
    ends = " to ".join(quantity(float(end), "rad/s" if fit.kind == "dma" else "s") for end in (fit.x.min(), fit.x.max()))
    return _with(
        f"A {'creep' if creep else 'Prony'} series with {len(fit.terms)} term{'s' if len(fit.terms) != 1 else ''} was fitted with asperity {__version__} to "
        f"{len(fit.x)} points of the {_DATA[fit.kind]} ({measure}) at {over} from {ends}.{shift} It has {rest} and the terms {terms}; the rms misfit is "
        f"{100 * fit.rms_misfit:.2g} %, the largest {100 * fit.max_misfit:.2g} %."
        + _warned([finding["code"] for finding in fit.findings if finding["severity"] == "warning"]), bibtex
    )


def of_force_fit(fit: ForceFit, bibtex: bool) -> str:
    numbers = [f"Young's modulus {_told(fit.young, 'Pa')}"]
    if fit.model != "hertz":
        numbers.append(f"the work of adhesion {_told(fit.work, 'J/m2')}")
    return _with(
        f"An elastic half-space {_MODELS[fit.model]} was fitted with asperity {__version__} to {len(fit.rows)} rows of a force curve, with baseline and contact "
        f"point, by the distance of each row from the curve: {' and '.join(numbers)}; the rms distance is {100 * fit.relative_rms:.2g} % of the range.", bibtex
    )


def of_indentation(fit: IndentationFit | PowerLawFit, law: str, numbers: list[tuple[str, Interval, str]], bibtex: bool) -> str:
    told = ", ".join(f"{name} {_told(value, unit)}" for name, value, unit in numbers)
    first, last = (quantity(float(end), "s") for end in fit.window)
    return _with(
        f"{law} was fitted with asperity {__version__} to {len(fit.rows)} rows of an indentation whose {fit.given} was controlled, over times from {first} to "
        f"{last}: {told}; the rms misfit is {100 * fit.relative_rms:.2g} % of the largest value.", bibtex
    )


def _told(interval: Interval, unit: str) -> str:
    """A value with its interval."""
    value, low, high = interval
    if value != value:
        return "not determined"
    return f"{value:.4g}{f' {unit}' if unit else ''} (95 %: {low:.4g} to {high:.4g})"
