"""Linear viscoelastic materials.

Each is a body: its creep and relaxation functions, Poisson's ratio or a constant bulk modulus, and the hardness at
which the pressure is cut off. Moduli in Pa, compliances in 1/Pa, times in s. A modulus is given as `young` or as
`shear`; Prony series and creep series say which with `modulus=` and `compliance=`.

With a `shift` (:func:`asperity.wlf`, ...) its numbers hold at the reference temperature of the shift, and its times scale with
the temperature of the run, or with its own where `temperature` [K] is given; then its functions are those at that
temperature. `window` are the first and last time [s] for which the material is known, at its reference temperature, as of the
data that it was fitted to: a run that needs other times gets the finding "beyond-material-data".

Sources: N. W. Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989); K. L. Johnson, Contact
Mechanics (1985), section 3.2, for the contact compliance.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any


from . import _core, _html
from ._arrays import ArrayLike, Floats, array, choice, each, line, number, points
from ._core import CaseError
from ._declared import check
from ._findings import warn_caller
from ._parameters import call
from ._sealed import Sealed
from ._spoken import spoken
from ._shifts import Shift
from ._units import frequency
from ._words import Measure

if TYPE_CHECKING:
    from ._fit import Fit

__all__ = ["Burgers", "Creep", "Elastic", "FractionalMaxwell", "FractionalZener", "KelvinVoigt", "Material", "Maxwell", "PowerLaw", "Prony", "Springpot", "StandardLinearSolid", "Zener"]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Material(Sealed):
    """A deformable body; the base of all models.

    Its functions take a number or an array of any shape and return the same.
    """

    poisson: float | None = None
    bulk_modulus: float | None = None
    hardness: float | None = None
    name: str | None = None
    shift: Shift | None = None
    temperature: float | None = None
    window: tuple[float, float] | None = None

    #: The keys of a `[[body]]`, and what the core makes of them.
    _keys: dict[str, Any] = field(init=False)
    _body: _core.Body = field(init=False)

    def __post_init__(self) -> None:
        if self.shift is not None and not isinstance(self.shift, Shift):
            raise CaseError(f"shift is {self.shift!r}, but must be one of asperity.wlf, arrhenius or shift_table")
        # Plain numbers, so that materials are compared, shown and sent without the package of their units.
        check(self)
        if self.window is not None:
            self._hold(window=_window(self.window))
        own = {key: value for key, value in self._given.items() if key in _OF_BODY}
        keys = {**own, "name": str(own.get("name", type(self).__name__)), "material": self._material()}
        with spoken():
            self._hold(_keys=keys, _body=_core.Body(keys))

    @property
    def _given(self) -> dict[str, Any]:
        """What it was made with: the numbers of its model first."""
        names = [one.name for one in fields(self) if one.init]
        names.sort(key=lambda name: name in Material.__dataclass_fields__)
        return {name: value for name in names if (value := getattr(self, name)) is not None}

    def _material(self) -> dict[str, Any]:
        """The keys of its `material`."""
        own = {key: value for key, value in self._given.items() if key not in _OF_BODY}
        if self.shift is not None:
            own["shift"] = self.shift._keys
        # The name of a model in a case is that of its class here: "kelvin-voigt" of KelvinVoigt, and of a user's subclass of it.
        name = next(kind.__name__ for kind in type(self).__mro__ if kind.__module__ == __name__)
        return {"model": re.sub("(?<=[a-z])(?=[A-Z])", "-", name).lower(), **own}

    @property
    def _whole(self) -> str:
        """All numbers, as Python takes them."""
        return call(type(self).__name__, self._given)

    def __repr__(self) -> str:
        terms = self._given.get("terms", [])
        if len(terms) <= 3:
            return self._whole
        others = call(type(self).__name__, {key: value for key, value in self._given.items() if key != "terms"})
        return f"{others[:-1]}, {len(terms)} terms from {terms[0]} to {terms[-1]})"

    def _repr_html_(self) -> str:
        def words(value: Any) -> str:
            if isinstance(value, list):
                return ", ".join(f"({a:g}, {b:g})" for a, b in value[:12]) + (", ..." if len(value) > 12 else "")
            return f"{value:g}" if isinstance(value, float) else str(value)

        rows = [(key, words(value)) for key, value in self._given.items()]
        return f"<b>{type(self).__name__}</b> (SI){_html.table(rows)}"

    def __reduce__(self) -> tuple[Any, ...]:
        made = {"_fit": self.fit} if self.fit is not None else None
        return functools.partial(type(self), **self._given), (), made

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, Material) and self._given == other._given

    __hash__ = None  # type: ignore[assignment]

    @property
    def fit(self) -> Fit | None:
        """The fit that it comes from; None of one that was given by its numbers."""
        return self.__dict__.get("_fit")

    @property
    def measure(self) -> Measure:
        """"young" or "shear": the modulus that the material was given in."""
        return self._body.measure

    def _of(self, measure: Measure | None) -> str:
        return str(choice("measure", self.measure if measure is None else measure, Measure))

    def creep_compliance(self, t: ArrayLike, *, measure: Measure | None = None) -> Floats:
        """Creep compliance [1/Pa] at times `t` [s] of the modulus `measure`, "young" or "shear"; by default the one that the material was
        given in (:attr:`measure`).

        >>> import asperity as asp
        >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=2.0, poisson=0.5)
        >>> float(zener.creep_compliance(0.0)), float(zener.creep_compliance(1e9))
        (1e-06, 2e-06)
        """
        return each(lambda times: self._body.creep(times, self._of(measure)), "times", t)

    def relaxation_modulus(self, t: ArrayLike, *, measure: Measure | None = None) -> Floats:
        """Relaxation modulus [Pa] at times `t` [s]: Young's modulus with ``measure="young"``, the shear modulus with "shear"; by default the
        one that the material was given in (:attr:`measure`). The pulse at t = 0 with which a body without instantaneous compliance
        (:class:`KelvinVoigt`) answers a step of the strain is left out.

        >>> import asperity as asp
        >>> rubber = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=2.0, poisson=0.5)
        >>> rubber.measure, float(rubber.relaxation_modulus(0.0)), round(float(rubber.relaxation_modulus(0.0, measure="young")))
        ('shear', 1000000.0, 3000000)
        """
        return each(lambda times: self._body.relaxation(times, self._of(measure)), "times", t)

    def storage_loss(self, omega: ArrayLike, *, measure: Measure | None = None) -> tuple[Floats, Floats]:
        """Storage and loss modulus [Pa] at angular frequencies `omega` [rad/s], 2 pi times those in Hz (quantities may be in either, or in
        rpm), of the modulus `measure`,
        as :meth:`relaxation_modulus`.

        >>> import asperity as asp
        >>> maxwell = asp.Maxwell(shear=1e6, relaxation_time=1.0, poisson=0.5)
        >>> storage, loss = maxwell.storage_loss(1.0)          # both G/2 where omega tau = 1
        >>> round(float(storage)), round(float(loss))
        (500000, 500000)
        """
        at = array("angular frequencies", frequency("angular frequencies", omega, angular=True))
        storage, loss = self._body.complex(line("angular frequencies", at.reshape(-1)), self._of(measure))
        return storage.reshape(at.shape), loss.reshape(at.shape)

    #: Short for `creep_compliance` and `relaxation_modulus`.
    creep, relaxation = creep_compliance, relaxation_modulus

    def storage(self, omega: ArrayLike, *, measure: Measure | None = None) -> Floats:
        """The storage modulus [Pa] at angular frequencies `omega` [rad/s], 2 pi times those in Hz, as :meth:`storage_loss`."""
        return self.storage_loss(omega, measure=measure)[0]

    def loss(self, omega: ArrayLike, *, measure: Measure | None = None) -> Floats:
        """The loss modulus [Pa] at angular frequencies `omega` [rad/s], 2 pi times those in Hz, as :meth:`storage_loss`.

        >>> import asperity as asp
        >>> zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=2.0, poisson=0.5)
        >>> float(zener.loss(1.0) / zener.storage(1.0)) > 0.3, zener.shear, float(zener.relaxation(0.0))
        (True, 1000000.0, 1000000.0)
        """
        return self.storage_loss(omega, measure=measure)[1]

    def contact_compliance(self, t: ArrayLike) -> Floats:
        """Contact creep compliance C(t) [1/Pa] against a rigid body: 1/E* of an elastic one."""
        return each(self._body.contact_creep, "times", t)

    @property
    def creep_terms(self) -> tuple[float, list[tuple[float, float]], float]:
        """Instantaneous compliance, (compliance, retardation time) of each term, fluidity."""
        return self._body.creep_terms()

    @property
    def error(self) -> float | None:
        """Largest relative error of the Prony sum that stands for a fractional model, in its window; else None."""
        return None

    @property
    def relaxation_terms(self) -> tuple[float, list[tuple[float, float]]]:
        """Equilibrium modulus, (modulus, relaxation time) of each term."""
        return self._body.relaxation_terms()


#: What is said of the body, beside its material.
_OF_BODY = ("name", "poisson", "bulk_modulus", "hardness")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class _OneModulus(Sealed):
    """A model with one modulus."""

    young: float | None = None
    shear: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class _KelvinModuli(Sealed):
    """A model with a spring, and a Kelvin element."""

    young: float | None = None
    young_kelvin: float | None = None
    shear: float | None = None
    shear_kelvin: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class _EndModuli(Sealed):
    """A model given by its moduli after all relaxation and at once."""

    young_equilibrium: float | None = None
    young_instantaneous: float | None = None
    shear_equilibrium: float | None = None
    shear_instantaneous: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Elastic(Material, _OneModulus):
    """An elastic body of Young's modulus `young` or shear modulus `shear` [Pa]."""


    def _material(self) -> dict[str, Any]:
        own = super()._material()
        measure = "shear" if self.young is None else "young"
        if not {"shift", "temperature"} & own.keys() or {"young", "shear"} <= own.keys() or not own.get(measure):
            return own
        # A temperature changes its modulus: the case has this as creep without terms.
        modulus = own.pop(measure)
        return {**own, "model": "creep", "compliance": measure, "instantaneous": 1.0 / modulus}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Maxwell(Material, _OneModulus):
    """Spring and dashpot in series: a fluid. `relaxation_time` [s]."""

    relaxation_time: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class KelvinVoigt(Material, _OneModulus):
    """Spring and dashpot in parallel: no instantaneous compliance. `retardation_time` [s]."""

    retardation_time: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Zener(Material, _KelvinModuli):
    """A spring in series with a Kelvin element: the standard linear solid. `retardation_time` [s] of creep."""

    retardation_time: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandardLinearSolid(Material, _EndModuli):
    """A spring in parallel with a Maxwell element: the solid of `Zener`, given by the moduli after all relaxation and at once and
    the `relaxation_time` [s] of a relaxation test."""

    relaxation_time: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Burgers(Material, _KelvinModuli):
    """A Maxwell and a Kelvin element in series."""

    relaxation_time: float
    retardation_time: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
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

    equilibrium: float | None = None
    instantaneous: float | None = None
    terms: Sequence[tuple[float, float]]
    modulus: Measure = "young"

    def __post_init__(self) -> None:
        self._hold(terms=_pairs(self.terms, ("" if self.equilibrium is None else "Pa", "s")))
        if self.instantaneous is not None:
            self._hold(instantaneous=number("instantaneous", self.instantaneous, "Pa"))
        super().__post_init__()

    def _material(self) -> dict[str, Any]:
        return {**super()._material(), "terms": _terms("fraction" if self.equilibrium is None else "modulus", self.terms)}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Creep(Material):
    """D(t) = instantaneous + sum of compliance (1 - exp(-t/time)) + fluidity t, a generalised Kelvin solid.

    `terms` are (compliance [1/Pa], retardation time [s]); `fluidity` in 1/(Pa s).
    """

    instantaneous: float
    terms: Sequence[tuple[float, float]] = ()
    fluidity: float = 0.0
    compliance: Measure = "young"

    def __post_init__(self) -> None:
        self._hold(terms=_pairs(self.terms, ("1/Pa", "s")), instantaneous=number("instantaneous", self.instantaneous, "1/Pa"))
        super().__post_init__()

    def _material(self) -> dict[str, Any]:
        return {**super()._material(), "terms": _terms("compliance", self.terms)}


def _window(value: Any) -> tuple[float, float]:
    """The first and last time [s]."""
    try:
        first, last = value
    except (TypeError, ValueError):
        raise CaseError(f"window is {value!r}, but must be (first, last) time in s") from None
    return number("first time of the window", first), number("last time of the window", last)


def _pairs(terms: Sequence[tuple[float, float]], units: tuple[str, str]) -> list[tuple[float, float]]:
    """The terms of a series."""
    listed = terms if hasattr(terms, "__len__") else list(terms)
    found = points("terms", listed, units) if len(listed) else []
    if _look_swapped(found, units[0]):
        amount = "modulus [Pa]" if units[0] == "Pa" else "compliance [1/Pa]"
        (value, time), what = found[0], amount.split()[0]
        warn_caller(f"terms are ({amount}, time [s]): the first has the {what} {value:g} {units[0]} and the time {time:g} s. Exchange them if that is not meant [unlikely-unit]")
    return found


def _look_swapped(terms: list[tuple[float, float]], unit: str) -> bool:
    """Whether the terms would be usual ones if amount and time were exchanged: a modulus in Pa is a large number, a compliance a small one,
    and a time lies between."""
    far = 1e3
    if unit == "Pa":
        return bool(terms) and all(time > far * abs(value) for value, time in terms)
    return unit == "1/Pa" and bool(terms) and all(abs(value) > far * time for value, time in terms)


def _terms(amount: str, terms: Sequence[tuple[float, float]]) -> list[dict[str, float]]:
    """The keys of the terms."""
    return [{amount: value, "time": time} for value, time in terms]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class _Summed(Material):
    """A model that becomes a Prony sum."""

    window: tuple[float, float]
    tolerance: float = 1e-3

    #: The sum of its model alone.
    _sum: _core.Body = field(init=False)

    def _model(self) -> dict[str, Any]:
        """The keys of its `material` in a case."""
        return super()._material()

    def _material(self) -> dict[str, Any]:
        own = self._model()
        if "window" not in own:
            raise CaseError(
                f"window of {type(self).__name__} is not given: it becomes a sum of exponentials that holds from the first to the last time of a"
                " window; give window=(first, last) in s, from the shortest step of the run to its end"
            )
        # The sum stands for the model where it was fitted.
        known: dict[str, Any] = {key: own.pop(key) for key in ("window", "shift", "temperature") if key in own}
        if "window" not in known:
            name = type(self).__name__
            raise CaseError(f"{name} needs window=(first, last), the times [s] over which it becomes a sum: the shortest step and the end of the run")
        self._hold(_sum=_core.Body({"poisson": 0.5, "material": own}, known["window"]))
        instantaneous, terms, fluidity = self._sum.creep_terms()
        series = {"instantaneous": instantaneous, "terms": _terms("compliance", terms), "fluidity": fluidity}
        return {"model": "creep", "compliance": "young" if any(key.startswith("young") for key in own) else "shear", **series, **known}

    @property
    def error(self) -> float | None:
        """Largest relative error of the Prony sum, in its window."""
        return self._sum.error


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class _Fractional(_Summed):
    """A model of a time and an order."""

    time: float
    order: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Springpot(_Fractional, _OneModulus):
    """Creep (t/time)^order / (modulus Gamma(1 + order)), between spring and dashpot.

    As a Prony sum with a relative error of creep and relaxation below `tolerance` over `window` = (first, last) time [s];
    take the shortest step and the end of the run. The error that it has is :attr:`error`.

    >>> import asperity as asp
    >>> clay = asp.Springpot(shear=1e6, time=1.0, order=0.3, window=(1e-2, 1e3), poisson=0.5)
    >>> round(float(clay.creep_compliance(10.0) / clay.creep_compliance(1.0)) / 10**0.3, 2), clay.error < 1e-3
    (1.0, True)
    """


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FractionalMaxwell(_Fractional, _OneModulus):
    """A spring and a springpot in series, as a Prony sum; see :class:`Springpot`."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FractionalZener(_Fractional, _EndModuli):
    """A spring in parallel with a fractional Maxwell element, as a Prony sum; see :class:`Springpot`."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class PowerLaw(_Summed, _OneModulus):
    """Relaxation modulus (t/time)^-alpha, `young` or `shear` [Pa] at `time` [s]: cells and soft glasses; what :func:`fit_indentation` with
    ``model="power-law"`` gives.

    The :class:`Springpot` of order `alpha`, between 0 and 1, whose modulus is larger by Gamma(1 - alpha). As a Prony sum over `window`.

    >>> import asperity as asp
    >>> cell = asp.PowerLaw(young=1e3, alpha=0.2, window=(1e-3, 1e2), poisson=0.5)
    >>> [round(float(cell.relaxation_modulus(t)), -1) for t in (0.01, 1.0, 32.0)]     # a factor of 2 in a factor of 32
    [2510.0, 1000.0, 500.0]
    """

    alpha: float
    time: float = 1.0

    def __post_init__(self) -> None:
        alpha = number("alpha", self.alpha)
        if not 0.0 < alpha < 1.0:
            raise CaseError(f"alpha is {self.alpha}, but must be greater than 0 (an elastic body) and less than 1 (a liquid)")
        super().__post_init__()

    def _model(self) -> dict[str, Any]:
        own = super()._model()
        alpha = own.pop("alpha")
        for measure in {"young", "shear"} & own.keys():
            own[measure] *= math.gamma(1.0 - alpha)
        return {**own, "model": "springpot", "order": alpha}
