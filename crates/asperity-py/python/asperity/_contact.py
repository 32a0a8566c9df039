"""One elastic contact."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import Floats, as_plane, cells_of, count, field, number, size_of
from ._surface import as_surface


@dataclass(frozen=True, eq=False)
class ElasticContact:
    """The solution of one elastic contact, fields of shape (nx, ny), of a line contact (n,)."""

    #: Pressure [Pa], positive in compression.
    pressure: Floats
    #: Normal displacement [m].
    displacement: Floats
    #: Gap of the deformed surfaces [m]; below zero where the pressure is cut off.
    gap: Floats
    #: Load [N]; of a line contact per length [N/m].
    load: float
    #: Approach [m]; of a free line contact measured from the end of the domain.
    approach: float
    #: Area of the cells with pressure [m^2]; of a line contact its length [m].
    contact_area: float
    #: Largest violation of the contact conditions over the mean displacement.
    residual: float
    #: Certified relative error of the pressure in the energy norm.
    certificate: float
    #: Iterations and convolutions that it took.
    iterations: int
    convolutions: int

    def _repr_html_(self) -> str:
        on_line = self.pressure.ndim == 1
        lines = [
            ("load", f"{self.load:.6g} {'N/m' if on_line else 'N'}"),
            ("approach", f"{self.approach:.6g} m"),
            ("contact length" if on_line else "contact area", f"{self.contact_area:.6g} {'m' if on_line else 'm²'}"),
            ("largest pressure", f"{self.pressure.max():.6g} Pa"),
            ("certified error", f"{self.certificate:.1e}"),
        ]
        rows = "".join(f"<tr><th style='text-align:left'>{a}</th><td>{b}</td></tr>" for a, b in lines)
        return f"<b>Elastic contact</b>, {cells_of(self.pressure)}<table>{rows}</table>"

    def __repr__(self) -> str:
        load, area = ("N/m", "length") if self.pressure.ndim == 1 else ("N", "area")
        return (
            f"<ElasticContact: {cells_of(self.pressure)}, load {self.load:.4g} {load}, approach {self.approach:.4g} m, "
            f"{area} {self.contact_area:.4g} {'m' if area == 'length' else 'm^2'}, certified error {self.certificate:.1e}>"
        )


def elastic(
    gap: Any,
    contact_modulus: float,
    *,
    load: float | None = None,
    approach: float | None = None,
    size: float | Sequence[float] | None = None,
    hardness: float | npt.ArrayLike | None = None,
    boundary: str = "free",
    method: str = "projected-cg",
    tolerance: float = 1e-6,
    max_iterations: int = 5000,
) -> ElasticContact:
    """Solves one elastic contact.

    Parameters
    ----------
    gap : undeformed gap [m] as array (nx, ny), infinite where nothing can touch; or a Surface. An array (n,) is a line contact in
        plane strain: nothing changes along y, and the load is per length [N/m]
    contact_modulus : E* [Pa], (1 - nu1^2)/E1 + (1 - nu2^2)/E2 = 1/E*
    load, approach : normal load [N] or approach [m], exactly one of them
    size : lengths of the domain along x and y [m], of a line its length, where the gap is an array
    hardness : largest pressure [Pa], of all cells or as array (nx, ny)
    boundary : "free" or "periodic"
    method : "projected-cg" or "polonsky-keer"

    Raises
    ------
    CaseError : the input is wrong, or the load is more than the hardness can carry
    ConvergenceError : not solved to the tolerance; carries the best pressure as `best`

    Examples
    --------
    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(128, 128), size=(1e-3, 1e-3), radius=5e-3)
    >>> hertz = asp.elastic(sphere, 1e9, load=1.0)
    >>> exact = (9 * 1.0**2 / (16 * 5e-3 * 1e9**2)) ** (1 / 3)
    >>> abs(hertz.approach / exact - 1) < 1e-3
    True
    """
    if hasattr(gap, "heights"):
        surface = as_surface(gap, size)
        gap, size = surface.gap(), surface.size
    elif size is None:
        raise _core.CaseError("the gap is an array, so that its size in m is needed: size=(Lx, Ly)")
    h0 = field("gap", gap, line=True)
    cells = field("hardness", hardness, line=True) if hardness is not None and np.ndim(hardness) == h0.ndim else None
    out = _core.elastic(
        as_plane(h0),
        size_of("gap", h0, size),
        number("contact_modulus", contact_modulus),
        None if load is None else number("load", load),
        None if approach is None else number("approach", approach),
        math.inf if hardness is None or cells is not None else number("hardness", hardness),
        None if cells is None else as_plane(cells),
        boundary,
        method,
        number("tolerance", tolerance),
        count("max_iterations", max_iterations),
    )
    for name in ("pressure", "displacement"):
        out[name] = out[name].reshape(h0.shape)
    return ElasticContact(gap=h0 + out["displacement"] - out["approach"], **out)
