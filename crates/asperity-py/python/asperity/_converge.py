"""Answers of a case with their errors."""

from __future__ import annotations

import json
from typing import TypedDict

from . import _core
from ._solve import Case, Changes, overrides, source

__all__ = ["ErrorBar", "converge"]


class ErrorBar(TypedDict, total=False):
    """An answer with its error, all SI; None where a number is not known."""

    #: Name of the answer: `contact_area`, `friction_coefficient`, `leak_rate`, ...
    name: str
    value: float | None
    #: "1" if it has none.
    unit: str
    #: Estimated error: the root of the sum of the squares of the three that follow.
    error: float | None
    #: What the size of the cells causes of it.
    grid: float | None
    #: What the length of the steps causes of it.
    time: float | None
    #: What the tolerance of the solver causes of it.
    solver: float | None
    #: Time [s] or velocity [m/s] of the row that it belongs to.
    at: float | None
    #: Observed order of convergence with the cells, with `refine`.
    order: float
    #: What limits the estimate.
    note: str


def converge(case: Case, *, set: Changes = None, refine: bool = False) -> list[ErrorBar]:
    """The answers of a case (as in :func:`asperity.run`) with their errors, as ``asperity converge`` prints them.

    The case is solved, and again with half and a quarter of the cells along each side, with steps of twice the length and with ten
    times the tolerance (docs/howto/error-bars.md).

    Parameters
    ----------
    case : path of a case file; or its text, or its keys as a dictionary
    set : changed keys of the case
    refine : solve it with twice the cells as well, and extrapolate the answers to vanishing cells

    Raises
    ------
    CaseError : the case is wrong
    ConvergenceError : it was not solved to its tolerance

    Examples
    --------
    >>> import asperity as asp
    >>> case = {
    ...     "domain": {"cells": [32, 32], "size": ["1 mm", "1 mm"]},
    ...     "surface": [{"kind": "sphere", "radius": "10 mm"}],
    ...     "body": [{"poisson": 0.5, "material": {"model": "elastic", "young": "3 MPa"}}],
    ...     "load": {"control": "load", "history": {"kind": "step", "value": "10 mN"}},
    ...     "time": {"end": "1 s", "steps": 1},
    ... }
    >>> bars = {bar["name"]: bar for bar in asp.converge(case)}
    >>> hertz = (9 * 0.01**2 / (16 * 0.01 * 4e6**2)) ** (1 / 3)  # approach of a sphere [m]
    >>> abs(bars["approach"]["value"] - hertz) < bars["approach"]["error"] < 0.05 * hertz
    True
    """
    return list(json.loads(_core.converge(*source(case), overrides(set), refine)))
