"""Linear viscoelastic materials.

Each is a body: its creep and relaxation functions, Poisson's ratio or a constant bulk modulus, and the hardness at
which the pressure is cut off. Moduli in Pa, compliances in 1/Pa, times in s. A modulus is given as `young` or as
`shear`; Prony series and creep series say which with `modulus=` and `compliance=`.

With a `shift` (:func:`asperity.wlf`, ...) its numbers hold at the reference temperature of the shift, and its times scale with
the temperature of the run, or with its own where `temperature` [K] is given; then its functions are those at that
temperature.

Sources: N. W. Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989); K. L. Johnson, Contact
Mechanics (1985), section 3.2, for the contact compliance.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, array, line, number, points
from ._core import CaseError
from ._sealed import Sealed
from ._shifts import Shift
from ._units import carries, frequency, is_labelled
from ._words import Measure


class Material(Sealed):
    """A deformable body; the base of all models.

    Its functions take a number or an array of any shape and return the same.
    """

    _given: dict[str, Any]

    def __init__(
        self,
        model: str,
        measure: str,
        numbers: Sequence[float],
        terms: Sequence[tuple[float, float]] = (),
        *,
        given: dict[str, Any],
    ) -> None:
        # Plain numbers, so that materials are compared, shown and sent without the package of their units.
        self._given = {
            key: number(key, value) if carries(value) or is_labelled(value) or isinstance(value, (np.ndarray, np.generic)) else value
            for key, value in given.items()
            if value is not None and key not in ("self", "__class__")
        }

        def optional(name: str) -> float | None:
            value = given.get(name)
            return None if value is None else number(name, value)

        name = given.get("name")
        shift = given.get("shift")
        if shift is not None and not isinstance(shift, Shift):
            raise CaseError(f"shift is {shift!r}, but must be one of asperity.wlf, arrhenius or shift_table")
        self._body = _core.Body(
            model,
            measure,
            [float(n) for n in numbers],
            list(terms),
            optional("poisson"),
            optional("bulk_modulus"),
            optional("hardness"),
            type(self).__name__ if name is None else str(name),
            None if shift is None else shift._words,
            optional("temperature"),
        )

    @property
    def _whole(self) -> str:
        """All numbers, as Python takes them."""
        return f"{type(self).__name__}({', '.join(f'{key}={value!r}' for key, value in self._given.items())})"

    def __repr__(self) -> str:
        terms = self._given.get("terms", [])
        if len(terms) <= 3:
            return self._whole
        others = ", ".join(f"{key}={value!r}" for key, value in self._given.items() if key != "terms")
        return f"{type(self).__name__}({others}, {len(terms)} terms from {terms[0]} to {terms[-1]})"

    def _repr_html_(self) -> str:
        import html

        def words(value: Any) -> str:
            if isinstance(value, list):
                return ", ".join(f"({a:g}, {b:g})" for a, b in value[:12]) + (", ..." if len(value) > 12 else "")
            return f"{value:g}" if isinstance(value, float) else str(value)

        rows = "".join(
            f"<tr><th style='text-align:left'>{html.escape(key)}</th><td style='text-align:left'>{html.escape(words(value))}</td></tr>"
            for key, value in self._given.items()
        )
        return f"<b>{type(self).__name__}</b> (SI)<table>{rows}</table>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _make, (type(self), self._given)

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, Material) and self._given == other._given

    __hash__ = None  # type: ignore[assignment]

    def creep_compliance(self, t: npt.ArrayLike) -> Floats:
        """Creep compliance [1/Pa] at times `t` [s], of the modulus that the material was given in.

        >>> import asperity as asp
        >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=2.0, poisson=0.5)
        >>> float(zener.creep_compliance(0.0)), float(zener.creep_compliance(1e9))
        (1e-06, 2e-06)
        """
        return self._curve(self._body.creep, t)

    def relaxation_modulus(self, t: npt.ArrayLike) -> Floats:
        """Relaxation modulus [Pa] at times `t` [s], of the modulus that the material was given in."""
        return self._curve(self._body.relaxation, t)

    def storage_loss(self, omega: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Storage and loss modulus [Pa] at angular frequencies `omega` [rad/s] (quantities may be in Hz or rpm).

        >>> import asperity as asp
        >>> maxwell = asp.Maxwell(shear=1e6, relaxation_time=1.0, poisson=0.5)
        >>> storage, loss = maxwell.storage_loss(1.0)          # both G/2 where omega tau = 1
        >>> round(float(storage)), round(float(loss))
        (500000, 500000)
        """
        at = array("angular frequencies", frequency("angular frequencies", omega, angular=True))
        storage, loss = self._body.complex(line("angular frequencies", at.reshape(-1)))
        return storage.reshape(at.shape), loss.reshape(at.shape)

    def contact_compliance(self, t: npt.ArrayLike) -> Floats:
        """Contact creep compliance C(t) [1/Pa] against a rigid body: 1/E* of an elastic one."""
        return self._curve(self._body.contact_creep, t)

    @property
    def creep_terms(self) -> tuple[float, list[tuple[float, float]], float]:
        """Instantaneous compliance, (compliance, retardation time) of each term, fluidity."""
        return self._body.creep_terms()

    @property
    def error(self) -> float | None:
        """Largest relative error of the Prony sum that stands for a fractional model, in its window; else None."""
        return self._body.error

    @property
    def relaxation_terms(self) -> tuple[float, list[tuple[float, float]]]:
        """Equilibrium modulus, (modulus, relaxation time) of each term."""
        return self._body.relaxation_terms()

    @staticmethod
    def _curve(function: Any, t: npt.ArrayLike) -> Floats:
        at = array("times", t)
        out: Floats = function(line("times", at.reshape(-1)))
        return out.reshape(at.shape)


def _make(kind: type[Material], given: dict[str, Any]) -> Material:
    return kind(**given)


def _modulus(given: dict[str, Any]) -> tuple[str, float]:
    young, shear = given.get("young"), given.get("shear")
    if (young is None) == (shear is None):
        raise CaseError("give young or shear, exactly one of them")
    return ("young", number("young", young)) if shear is None else ("shear", number("shear", shear))


def _second(given: dict[str, Any], measure: str, young: str, shear: str) -> float:
    key, other = (young, shear) if measure == "young" else (shear, young)
    if given.get(key) is None or given.get(other) is not None:
        raise CaseError(f"give {key}, as the other modulus is {measure}")
    return number(key, given[key])


class Elastic(Material):
    """An elastic body of Young's modulus `young` or shear modulus `shear` [Pa]."""

    def __init__(
        self,
        *,
        young: float | None = None,
        shear: float | None = None,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        measure, modulus = _modulus(given)
        super().__init__("elastic", measure, [modulus], given=given)


class Maxwell(Material):
    """Spring and dashpot in series: a fluid. `relaxation_time` [s]."""

    def __init__(
        self,
        *,
        young: float | None = None,
        shear: float | None = None,
        relaxation_time: float,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        measure, modulus = _modulus(given)
        super().__init__("maxwell", measure, [modulus, number("relaxation_time", relaxation_time)], given=given)


class KelvinVoigt(Material):
    """Spring and dashpot in parallel: no instantaneous compliance. `retardation_time` [s]."""

    def __init__(
        self,
        *,
        young: float | None = None,
        shear: float | None = None,
        retardation_time: float,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        measure, modulus = _modulus(given)
        super().__init__("kelvin-voigt", measure, [modulus, number("retardation_time", retardation_time)], given=given)


class Zener(Material):
    """A spring in series with a Kelvin element: the standard linear solid. `retardation_time` [s] of creep."""

    def __init__(
        self,
        *,
        young: float | None = None,
        young_kelvin: float | None = None,
        shear: float | None = None,
        shear_kelvin: float | None = None,
        retardation_time: float,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        measure, modulus = _modulus(given)
        kelvin = _second(given, measure, "young_kelvin", "shear_kelvin")
        super().__init__("zener", measure, [modulus, kelvin, number("retardation_time", retardation_time)], given=given)


class Burgers(Material):
    """A Maxwell and a Kelvin element in series."""

    def __init__(
        self,
        *,
        young: float | None = None,
        young_kelvin: float | None = None,
        shear: float | None = None,
        shear_kelvin: float | None = None,
        relaxation_time: float,
        retardation_time: float,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        measure, modulus = _modulus(given)
        kelvin = _second(given, measure, "young_kelvin", "shear_kelvin")
        times = [number("relaxation_time", relaxation_time), number("retardation_time", retardation_time)]
        super().__init__("burgers", measure, [modulus, times[0], kelvin, times[1]], given=given)


class Prony(Material):
    """E(t) = equilibrium + sum of modulus exp(-t/time), a generalised Maxwell (Wiechert) solid.

    Parameters
    ----------
    equilibrium : modulus after all relaxation [Pa], 0 for a fluid; with `terms` of (modulus [Pa], time [s])
    instantaneous : instead, the modulus at t = 0; with `terms` of (fraction of it, time [s]), as in Abaqus
    modulus : "young" (default) or "shear": what the numbers are

    Examples
    --------
    >>> import asperity as asp
    >>> pmma = asp.Prony(equilibrium=1973e6, terms=[(254.776e6, 8.93), (263.6628e6, 117.96)], poisson=0.38)
    >>> round(float(pmma.relaxation_modulus(0.0)) / 1e6, 2)
    2491.44
    """

    def __init__(
        self,
        *,
        equilibrium: float | None = None,
        instantaneous: float | None = None,
        terms: Sequence[tuple[float, float]],
        modulus: Measure = "young",
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        terms = terms if hasattr(terms, "__len__") else list(terms)
        given = dict(locals())
        if (equilibrium is None) == (instantaneous is None):
            raise CaseError(
                "give equilibrium with terms of (modulus, time), or instantaneous with terms of (fraction, time)"
            )
        pairs = points("terms", terms, ("Pa" if equilibrium is not None else "", "s")) if len(terms) else []
        given["terms"] = pairs
        if equilibrium is not None:
            super().__init__("prony", modulus, [number("equilibrium", equilibrium)], pairs, given=given)
        else:
            first = given["instantaneous"] = number("instantaneous", instantaneous, "Pa")
            super().__init__("prony-instantaneous", modulus, [first], pairs, given=given)


class Creep(Material):
    """D(t) = instantaneous + sum of compliance (1 - exp(-t/time)) + fluidity t, a generalised Kelvin solid.

    `terms` are (compliance [1/Pa], retardation time [s]); `fluidity` in 1/(Pa s).
    """

    def __init__(
        self,
        *,
        instantaneous: float,
        terms: Sequence[tuple[float, float]] = (),
        fluidity: float = 0.0,
        compliance: Measure = "young",
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        terms = terms if hasattr(terms, "__len__") else list(terms)
        given = dict(locals())
        pairs = points("terms", terms, ("1/Pa", "s")) if len(terms) else []
        given["terms"] = pairs
        given["instantaneous"] = number("instantaneous", instantaneous, "1/Pa")
        numbers = [given["instantaneous"], number("fluidity", fluidity)]
        super().__init__("creep", compliance, numbers, pairs, given=given)


class Springpot(Material):
    """Creep (t/time)^order / (modulus Gamma(1 + order)), between spring and dashpot.

    As a Prony sum with a relative error of creep and relaxation below `tolerance` over `window` = (first, last) time [s];
    take the shortest step and the end of the run. The error that it has is :attr:`error`.

    >>> import asperity as asp
    >>> clay = asp.Springpot(shear=1e6, time=1.0, order=0.3, window=(1e-2, 1e3), poisson=0.5)
    >>> round(float(clay.creep_compliance(10.0) / clay.creep_compliance(1.0)) / 10**0.3, 2), clay.error < 1e-3
    (1.0, True)
    """

    def __init__(
        self,
        *,
        young: float | None = None,
        shear: float | None = None,
        time: float,
        order: float,
        window: tuple[float, float],
        tolerance: float = 1e-3,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        measure, modulus = _modulus(given)
        numbers = [modulus, number("time", time), number("order", order), *_windowed(given), number("tolerance", tolerance)]
        super().__init__("springpot", measure, numbers, given=given)


class FractionalMaxwell(Material):
    """A spring and a springpot in series, as a Prony sum; see :class:`Springpot`."""

    def __init__(
        self,
        *,
        young: float | None = None,
        shear: float | None = None,
        time: float,
        order: float,
        window: tuple[float, float],
        tolerance: float = 1e-3,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        measure, modulus = _modulus(given)
        numbers = [modulus, number("time", time), number("order", order), *_windowed(given), number("tolerance", tolerance)]
        super().__init__("fractional-maxwell", measure, numbers, given=given)


class FractionalZener(Material):
    """A spring in parallel with a fractional Maxwell element, as a Prony sum; see :class:`Springpot`."""

    def __init__(
        self,
        *,
        young_equilibrium: float | None = None,
        young_instantaneous: float | None = None,
        shear_equilibrium: float | None = None,
        shear_instantaneous: float | None = None,
        time: float,
        order: float,
        window: tuple[float, float],
        tolerance: float = 1e-3,
        poisson: float | None = None,
        bulk_modulus: float | None = None,
        hardness: float | None = None,
        name: str | None = None,
        shift: Shift | None = None,
        temperature: float | None = None,
    ) -> None:
        given = dict(locals())
        pairs = {
            "young": (young_equilibrium, young_instantaneous),
            "shear": (shear_equilibrium, shear_instantaneous),
        }
        whole = [measure for measure, pair in pairs.items() if None not in pair]
        some = [measure for measure, pair in pairs.items() if pair != (None, None)]
        if len(whole) != 1 or some != whole:
            raise CaseError("give equilibrium and instantaneous modulus, both as young_ or both as shear_")
        equilibrium, instantaneous = pairs[whole[0]]
        numbers = [
            number("equilibrium modulus", equilibrium),
            number("instantaneous modulus", instantaneous),
            number("time", time),
            number("order", order),
            *_windowed(given),
            number("tolerance", tolerance),
        ]
        super().__init__("fractional-zener", whole[0], numbers, given=given)


def _windowed(given: dict[str, Any]) -> tuple[float, float]:
    """The window [s], which is plain numbers in `given` then."""
    try:
        first, last = given["window"]
    except (TypeError, ValueError):
        raise CaseError(f"window is {given['window']!r}, but must be (first, last) time in s") from None
    window = number("first time of the window", first), number("last time of the window", last)
    given["window"] = window
    return window
