"""Whole seals: how much leaks across a contact that the fluid opens, and when it opens."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arrays import AnyPath, Floats
from ._columns import dataset, variable
from ._command import answered
from ._findings import Finding, findings_of, warn
from ._methods import of_seal
from ._sealed import Sealed
from ._solve import Case, Changes, overrides, source

if TYPE_CHECKING:
    import xarray

__all__ = ["Seal", "Spread", "seal"]

#: Usual units of a leak, and their names in the answer.
_USUAL = {"ml/year": "ml_per_year", "mbar l/s": "mbar_l_per_s", "sccm": "sccm", "g/year": "g_per_year"}


class Spread(NamedTuple):
    """A number of all seeds: NaN where it is not known or has no bound."""

    mean: float
    least: float
    largest: float


class Seal(Sealed):
    """A whole seal: numbers as attributes, SI."""

    #: Leak of the whole seal [m^3/s; of a gas kg/s].
    leak: Spread
    #: The least and the largest mean leak that the pressures of the sweep allow; NaN where it has no bound.
    leak_bounds: tuple[float, float]
    #: The leak per metre of its length.
    leak_per_metre: Spread
    #: The leak of the contact that the fluid does not open.
    leak_one_way: Spread
    #: The leak in usual units: "ml/year" of a liquid; "mbar l/s" (at 0 degC), "sccm" and "g/year" of a gas.
    usual: dict[str, Spread]
    #: Largest inlet pressure at which the seal is tight for certain [Pa]; None unless that is known of every seed.
    opening_pressure: Spread | None
    #: Of each seed: "tight", "leaks", "lifted" or "unknown".
    states: list[str]
    #: Pressures [Pa] at inlet and outlet, counted as the contact pressure is.
    inlet: float
    outlet: float
    #: Places across the seal [m] from the inlet, the contact pressure there [Pa], and the pressure of the fluid [Pa], shape (seeds, places).
    x: Floats
    contact_pressure: Floats
    fluid_pressure: Floats

    def __init__(self, found: dict[str, Any], given: tuple[str, Sequence[str]]) -> None:
        self._found, self._case = found, given
        spreads = {name: found[f"seal_{name}"] and _spread(found[f"seal_{name}"]) for name in ("leak", "leak_per_metre", "leak_one_way", "opening_pressure")}
        usual = {unit: _spread(found[f"seal_leak_{name}"]) for unit, name in _USUAL.items() if f"seal_leak_{name}" in found}
        low, high = _numbers(found["seal_leak_bounds"])
        self._hold(**spreads, leak_bounds=(float(low), float(high)), usual=usual, inlet=found["inlet"], outlet=found["outlet"], states=[seed["state"] for seed in found["seeds"]])
        pressures = _numbers([seed["seal_pressure"] for seed in found["seeds"]])
        self._hold(x=np.array(found["x"]), contact_pressure=np.array(found["contact_pressure"]), fluid_pressure=pressures)

    @property
    def findings(self) -> list[Finding]:
        """What must be known before the numbers are used (docs/findings.md)."""
        return findings_of(self._found["findings"], of_case=True)

    @property
    def answers(self) -> list[dict[str, Any]]:
        """The answers, each with `name`, `value`, `unit`, and `valid`: False and `why` where a finding takes it back (docs/results.md)."""
        answers: list[dict[str, Any]] = self._found["answers"]
        return answers

    @property
    def answer(self) -> dict[str, Any]:
        """All numbers, as ``asperity seal --json`` prints them."""
        return self._found

    def methods(self, *, bibtex: bool = False, case: bool = True) -> str:
        """A paragraph on what was computed for the methods section of a paper, with `case` the case, which :func:`seal` computes again, and
        with `bibtex` the entries of what it cites."""
        warned = sorted({finding["code"] for finding in self.findings if finding["severity"] == "warning"})
        return of_seal(self._found, warned, self._case, bibtex, case)

    def __repr__(self) -> str:
        state = "/".join(sorted(set(self.states)))
        return f"<Seal: {state}, leak {self.leak.mean:.3g} {self._found['unit'].replace('m3', 'm^3')}>"

    def to_xarray(self) -> xarray.Dataset:
        """The leak over `inlet` pressure and `time`, the pressures over `x`, and the conductance of the patch over `pressure`: with the
        dimension `seed` where they differ from seed to seed."""
        found, unit = self._found, self._found["unit"].replace("m3", "m^3")
        seeds = found["seeds"]

        def over(dim: str) -> dict[str, Any]:
            """The leak over the inlet pressure, or the time."""
            rows = found[f"by_{dim}"]
            of_seeds = {f"leak_{dim}{end}": [row["seal_leak"][name] for row in rows] for end, name in (("", "mean"), ("_least", "least"), ("_largest", "largest"))}
            leaks = {**of_seeds, f"leak_{dim}_one_way": [row["one_way"] for row in rows]}
            return {name: variable(dim, _numbers(values), unit, "leak of the seal") for name, values in leaks.items()}

        conductance = _numbers([[point["conductance"] for point in seed["seal_sweep"]] for seed in seeds])
        columns = {
            **over("inlet"),
            **over("time"),
            "contact_pressure": variable("x", self.contact_pressure, "Pa", "contact pressure"),
            "fluid_pressure": variable(("seed", "x"), self.fluid_pressure, "Pa", "pressure of the fluid"),
            "conductance": variable(("seed", "pressure", "time"), conductance, "m^3", "hydraulic gap of the patch, cubed"),
        }
        coordinates = {
            "inlet": variable("inlet", [row["inlet"] for row in found["by_inlet"]], "Pa", "pressure at the inlet"),
            "time": variable("time", found["time"], "s", "time"),
            "x": variable("x", self.x, "m", "place across the seal"),
            "pressure": variable("pressure", [point["pressure"] for point in seeds[0]["seal_sweep"]], "Pa", "mean pressure on the patch"),
            "seed": [-1 if seed["seed"] is None else seed["seed"] for seed in seeds],
        }
        return dataset(columns, coordinates)


def seal(
    case: Case, *, set: Changes = None,
    directory: AnyPath | None = None, jobs: int | None = None, threads: int | None = None, progress: bool = True
) -> Seal:
    """A whole seal of which the case is a patch, as ``asperity seal`` computes it: with the same numbers and the same folder.

    Each finding of severity "warning" is a :class:`ResultWarning`.

    Parameters
    ----------
    case : path of a case file with ``[seal]`` and ``[leakage]``; or its text, or its keys as a dictionary, with a `directory`, from which
        the files that it names count
    set : changed keys of the case
    directory : the folder of the sweep and the answers; the case's name with -seal if not given. A folder that holds the same sweep goes on
        with it
    jobs : runs of the patch side by side at most; as many as threads and memory allow if not given
    threads : of all runs together
    progress : tell on stderr how far the sweep is

    Raises
    ------
    CaseError : the case or the folder is wrong
    RuntimeError : a run of the patch failed

    Examples
    --------
    >>> import asperity as asp, tempfile
    >>> case = {
    ...     "domain": {"cells": [2, 64], "size": ["0.3 um", "10 um"], "boundary": "periodic"},
    ...     "surface": [{"kind": "wave", "amplitude": "0.1 um", "wavelength": ["inf", "10 um"]}],
    ...     "body": [{"poisson": 0.5, "material": {"model": "elastic", "young": "0.75 MPa"}}],
    ...     "load": {"control": "pressure", "history": {"kind": "step", "value": "10 kPa"}},
    ...     "time": {"end": "1 s", "steps": 1},
    ...     "leakage": {"pressure_drop": "10 kPa", "viscosity": "1 mPa s"},
    ...     "seal": {"profile": "uniform", "peak": "20 kPa", "width": "1 mm", "length": "0.1 m", "pressures": 8},
    ... }
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     found = asp.seal(case, directory=folder, progress=False)
    >>> found.states, found.leak.mean > 2 * found.leak_one_way.mean
    (['leaks'], True)
    """
    changes = overrides(set)
    changed = [word for key in changes for word in ("--set", key)]
    answer = answered("seal", case, directory, changed, not progress, jobs=jobs, threads=threads)
    path, text = source(case)
    found = Seal(answer, (Path(path).read_text(encoding="utf-8") if text is None else text, changes))
    warn(found.findings)
    return found


def _numbers(values: Any) -> Floats:
    """Numbers, NaN for None."""
    return np.array(values, dtype=float)


def _spread(spread: Mapping[str, float | None]) -> Spread:
    return Spread(*(np.nan if spread[name] is None else float(spread[name] or 0.0) for name in Spread._fields))
