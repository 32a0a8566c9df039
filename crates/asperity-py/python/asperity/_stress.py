"""The stress below the surface."""

from __future__ import annotations

import functools
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._columns import dataset, variable
from ._core import CaseError
from ._findings import warn_caller
from ._paragraphs import of_stress
from ._sealed import Sealed
from ._states import HasState, refuse_beside, said
from ._surface import SurfaceLike, _parts
from ._words import Boundary

if TYPE_CHECKING:
    import xarray
from ._arrays import Floats, Scalar, Size, array, as_plane, cells_of, centres, choice, field, frozen, number, plain, size_of


def _lazily(name: str, words: str) -> functools.cached_property[Floats]:
    """A field of a stress, which is computed when it is first asked for."""
    made = functools.cached_property(lambda stress: stress._field(name))
    made.__doc__ = words
    return made


#: Fields of a dataset.
_FIELDS = ("xx", "yy", "zz", "xy", "xz", "yz", "mises", "tresca", "tension")


def _lower(words: str) -> str:
    """A sentence as the name of an array."""
    return (words if words.startswith("von") else words[0].lower() + words[1:]).rstrip(".")


class Stress(Sealed):
    """Stress below a pressure: fields of shape (depth, x, y), of a line contact (depth, x), in Pa, tension positive, z into the body.

    A field is computed when it is first asked for, and kept; all arrays are read-only.
    """

    #: Depths [m].
    depths: Floats

    def __init__(
        self, pressure: Floats, size: Sequence[float], depths: str | Sequence[float], poisson: float | None, boundary: str,
        transverse: tuple[Floats, float] | None = None, tractions: list[Floats] | None = None
    ) -> None:
        # Fields are computed later: the array of the caller may have changed until then.
        self._pressure, self._poisson = np.array(pressure), poisson
        # Where the Poisson's ratio changes with time: see `changing`.
        confined = None if transverse is None else (as_plane(transverse[0]), transverse[1])
        self._given = as_plane(self._pressure), list(size), boundary, poisson or 0.0, confined, tractions
        self._core = _core.Stress(*self._given)
        below = self._core.automatic_depths() if isinstance(depths, str) and depths == "auto" else depths
        if isinstance(below, str):
            raise CaseError(f'depths is {depths!r}, but must be "auto" or numbers in m')
        self._hold(depths=np.array(np.atleast_1d(array("depths", below))))
        if self.depths.ndim != 1 or self.depths.size == 0:
            raise CaseError("depths must be one row of numbers in m, at least one")
        # Errors come here and not with the first field.
        self._core.check_depths(self.depths.tolist())

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "_core"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        super().__setstate__(state)
        self._core = _core.Stress(*self._given)

    def _field(self, name: str) -> Floats:
        found = self._core.field(name, self.depths.tolist())
        return frozen(found[:, :, 0] if self._pressure.ndim == 1 else found)

    xx = _lazily("xx", "Normal stress along x.")
    yy = _lazily("yy", "Normal stress along y.")
    zz = _lazily("zz", "Normal stress along z; minus the pressure at the surface.")
    xy = _lazily("xy", "Shear stress in the plane.")
    xz = _lazily("xz", "Shear stress on planes parallel to the surface, along x.")
    yz = _lazily("yz", "Shear stress on planes parallel to the surface, along y.")
    mises = _lazily("mises", "von Mises stress.")
    tresca = _lazily("tresca", "Largest shear stress, half the difference of the largest and the least principal stress.")
    tension = _lazily("tension", "Largest principal stress.")
    pressure = _lazily("pressure", "Minus the mean of the normal stresses.")

    def survey(self, threshold: float | None = None, *, rolling: str | None = None) -> dict[str, Any]:
        """Maxima, refined between the depths, with their places: `max_mises`, `max_mises_depth`, `max_mises_x`, `max_mises_y`,
        the same for `tresca` and `tension`; `mises_by_depth`, `tresca_by_depth`, `tension_by_depth`; with a threshold [Pa] the
        `stressed_volume` [m^3] (of a line contact the area of the section [m^2]) in which the von Mises stress exceeds it; and for a contact that rolls along "x" or "y" the
        largest range of the shear stress on planes parallel to the surface along that direction, `orthogonal_shear`,
        `orthogonal_shear_depth` and `orthogonal_shear_by_depth` (Lundberg and Palmgren 1947).

        Warns where the maximum may lie between the depths or below them, or lies nearer to the surface than two cells.
        """
        limit = None if threshold is None else number("threshold", threshold)
        found = self._core.survey(self.depths.tolist(), limit, rolling)
        if (unseen := found.pop("unseen")) is not None:
            above, below = unseen
            place = f"below {above:.4g} m" if below == np.inf else f"between {above:.4g} and {below:.4g} m"
            warn_caller(f"the von Mises stress may be larger {place}: give more depths there", UserWarning)
        if found.pop("unresolved"):
            warn_caller("the largest von Mises stress lies less than two cells below the surface: the grid is too coarse for it", UserWarning)
        return {name: np.asarray(value) if isinstance(value, list) else value for name, value in found.items()}

    def to_xarray(self, *names: str) -> xarray.Dataset:
        """Fields over depth and cells as xarray.Dataset, by default the six components, `mises`, `tresca` and `tension`, named
        `stress_xx`, ..., `stress_mises`: beside those of a result in ``result.to_xarray().merge(below.to_xarray())``.

        >>> import asperity as asp
        >>> ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=20e-3)
        >>> result = asp.solve(ball, asp.Elastic(young=1e6, poisson=0.3), load=1e-3, times=[1.0])
        >>> whole = result.to_xarray().merge(result.stress(depths=[0.0, 1e-4]).to_xarray("zz", "mises"))
        >>> whole.stress_mises.dims, whole.stress_zz.attrs["units"], whole.pressure.dims
        (('depth', 'x', 'y'), 'Pa', ('field_time', 'x', 'y'))
        """
        for name in names:
            choice("the field", name, list(_FIELDS))
        known = {name: str(vars(Stress)[name].__doc__) for name in _FIELDS}
        axes = ("x", "y")[: self._pressure.ndim]
        data = {
            f"stress_{name}": variable(("depth", *axes), getattr(self, name), "Pa", _lower(known[name]))
            for name in names or _FIELDS
        }
        places = {axis: variable(axis, centres(n, length), "m", axis) for axis, n, length in zip(axes, self._pressure.shape, self._given[1])}
        return dataset(data, {"depth": variable("depth", self.depths, "m", "depth below the surface"), **places})

    def methods(self, *, bibtex: bool = False) -> str:
        """A paragraph on what was computed, for the methods section of a paper; with `bibtex` the entry to cite."""
        return of_stress(self, bibtex)

    def __repr__(self) -> str:
        ratio = "changing with time" if self._poisson is None else f"{self._poisson:g}"
        cells, deepest = cells_of(self._pressure), self.depths[-1]
        return f"<Stress: {cells}, {len(self.depths)} depths to {deepest:.4g} m, Poisson's ratio {ratio}>"


def stress(
    pressure: SurfaceLike | HasState, *, size: Size = None, poisson: Scalar | None = None, depths: str | Sequence[float] = "auto",
    boundary: Boundary | None = None, tractions: Sequence[Any] | None = None
) -> Stress:
    """The stress below a pressure on a half-space.

    With a Poisson's ratio that is constant in time the stress of a viscoelastic body depends on the pressure of the moment
    alone, so any pressure of a result will do. The modulus does not enter.

    Parameters
    ----------
    pressure : an :class:`ElasticContact`, a :class:`Result` (its last fields) or a :class:`Step`, with its size, boundary and tractions, or
        the pressure [Pa], array (nx, ny), or (n,) of a line contact (plane strain)
    size : lengths of the domain along x and y [m], of a line its length; an xarray array with coordinates needs none
    poisson : Poisson's ratio of the body, 0 to 0.5; results and rows know that of their first body
    depths : depths below the surface [m], rising, each 0 or at least a quarter of a cell; "auto" takes 0 and 24 depths from
        half a cell to the width of the contact (periodic: to half of the shorter side)
    boundary : "free" or "periodic" (uniform pressure without lateral strain); a bare array without it is taken as free, with a warning
    tractions : tangential tractions along x and y [Pa] with which the other body acts on this one, two arrays like the pressure

    Raises
    ------
    CaseError : the input is wrong

    Examples
    --------
    Under a Hertz contact the largest shear stress is 0.31 p0 at a depth of 0.48 a, for a Poisson's ratio of 0.3.

    >>> import asperity as asp
    >>> sphere = asp.Surface.sphere(cells=(64, 64), size=(1e-3, 1e-3), radius=5e-3)
    >>> hertz = asp.elastic(sphere, 1e9, load=1.0)
    >>> below = asp.stress(hertz, poisson=0.3)
    >>> found = below.survey()
    >>> p0 = hertz.pressure.max()
    >>> bool(abs(found["max_tresca"] / p0 - 0.31) < 0.01)
    True
    >>> below.zz.shape
    (25, 64, 64)
    >>> bool((asp.stress(hertz.pressure, size=hertz.size, poisson=0.3, boundary="free").zz == below.zz).all())
    True
    """
    if isinstance(pressure, HasState):
        refuse_beside("stress", pressure, {"size": size, "boundary": boundary, "tractions": tractions})
        return of_state(pressure, poisson, depths)
    edges = choice("boundary", said("stress", "boundary", boundary, "free", '"free" or "periodic"'), Boundary)
    if poisson is None:
        raise CaseError("poisson is missing: give the Poisson's ratio of the body, as in poisson=0.3")
    values, extent, _ = _parts(pressure, size, "pressure")
    p = field("pressure", values, line=True)
    shear = None if tractions is None else [as_plane(field("traction", _parts(q, size, "traction")[0], line=True)) for q in tractions]
    if shear is not None and (len(shear) != 2 or any(q.shape != as_plane(p).shape for q in shear)):
        raise CaseError(f"tractions are two arrays of shape {p.shape}, along x and y")
    return Stress(p, size_of("pressure", p, extent), depths, number("poisson", poisson), edges, tractions=shear)


def of_state(held: Any, poisson: Scalar | None, depths: str | Sequence[float]) -> Stress:
    """The stress below a contact, a row, or the last fields of a result."""
    if hasattr(held, "field_times"):
        found: Stress = held.stress(depths=depths, poisson=poisson)
        return found
    state = held._state()
    if state.no_stress is not None:
        raise CaseError(state.no_stress)
    ratio = poisson if poisson is not None else state.poisson[0] if state.poisson else None
    if ratio is None:
        raise CaseError(f"the {type(held).__name__} does not say the Poisson's ratio of the body, or it changes with time: give it, as in poisson=0.3")
    shear = None if state.tractions is None else [as_plane(q) for q in state.tractions]
    return Stress(state.pressure, list(state.size), depths, number("poisson", ratio), state.boundary, tractions=shear)


def changing(setup: dict[str, Any], body: int, rows: tuple[list[int], list[float]], pressures: Floats, size: Sequence[float], depths: Any) -> Stress:
    """The stress at the last of the times below pressures [Pa] of shape (time, x, y) or (time, x), from the beginning of a run on,
    of a body whose Poisson's ratio changes with time; `setup` is that of the result, `rows` their stages and times."""
    stack = plain(pressures if pressures.ndim == 3 else pressures[:, :, np.newaxis])
    creep, controls = json.dumps(setup["poisson_creep"][body]), json.dumps(setup["stage_controls"])
    transverse, confined = _core.stress_transverse(creep, controls, *rows, stack)
    last = plain(pressures[-1])
    return Stress(last, size, depths, None, setup.get("boundary", "free"), (transverse.reshape(last.shape), confined))
