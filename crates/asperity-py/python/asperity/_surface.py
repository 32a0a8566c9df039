"""Surfaces: heights over a rectangle."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field as dataclass_field
from typing import Any

import numpy as np

from . import _core
from ._arrays import Floats, count, counts, field, number, pair
from ._core import CaseError


@dataclass(frozen=True, eq=False)
class Surface:
    """Heights [m] at the cell centres of a rectangle, shape (nx, ny), pointing out of their body.

    NaN where a measurement has no value; minus infinity where a punch cannot touch. Surfaces of the same cells and
    size add up: a sphere plus roughness, one rough surface against another.
    """

    heights: Floats
    size: tuple[float, float]
    metadata: dict[str, Any] = dataclass_field(default_factory=dict)

    def __init__(self, heights: Any, *, size: Sequence[float], metadata: dict[str, Any] | None = None) -> None:
        object.__setattr__(self, "heights", field("heights", heights))
        object.__setattr__(self, "size", pair("size", size))
        object.__setattr__(self, "metadata", dict(metadata or {}))

    @property
    def cells(self) -> tuple[int, int]:
        """Number of cells along x and y."""
        nx, ny = self.heights.shape
        return nx, ny

    def __add__(self, other: Surface) -> Surface:
        if not isinstance(other, Surface):
            return NotImplemented
        if self.cells != other.cells or self.size != other.size:
            raise CaseError(
                f"surfaces of {self.cells} cells on {self.size} m and of {other.cells} cells on {other.size} m "
                "cannot be added: they must have the same cells and size"
            )
        return Surface(self.heights + other.heights, size=self.size)

    def __repr__(self) -> str:
        nx, ny = self.cells
        return f"Surface({nx} x {ny} cells, {self.size[0]:g} m x {self.size[1]:g} m)"

    def gap(self) -> Floats:
        """The undeformed gap against a flat [m]: least value 0, infinite where nothing can touch."""
        return _core.gap(self.heights, list(self.size))

    def level(self, form: str = "plane") -> Surface:
        """The surface without its least-squares "mean", "plane" or "quadratic" form."""
        return Surface(_core.level(self.heights, form), size=self.size, metadata=self.metadata)

    def statistics(self) -> dict[str, float]:
        """Parameters of ISO 25178 (sa, sq, ssk, sku, sz, sdq, sdr), spectral moments, extremes, undefined points."""
        return _core.statistics(self.heights, list(self.size))

    def power_spectrum(self, per_decade: int = 16) -> tuple[Floats, Floats]:
        """Wavenumbers [1/m] and radially averaged power spectrum C(q) [m^4]; 0 rings per decade: linear rings.

        The surface is taken as periodic, so that the mean of z^2 is the integral of C d^2q / (2 pi)^2.
        """
        return _core.power_spectrum(self.heights, list(self.size), count("per_decade", per_decade, 0))

    def write(self, path: str | os.PathLike[str], *, format: str | None = None, force: bool = False) -> None:
        """Writes NPZ, GWY, X3P, SDF, NetCDF or text, as the path's ending or `format` says."""
        path = os.fspath(path)
        if not force and os.path.exists(path):
            raise FileExistsError(f"{path} is there already; name another file or give force=True")
        _core.write_surface(path, self.heights, list(self.size), format or os.path.splitext(path)[1].lstrip("."))

    @staticmethod
    def read(
        path: str | os.PathLike[str],
        *,
        size: Sequence[float] | None = None,
        height_unit: float | None = None,
        channel: str | int | None = None,
    ) -> Surface:
        """Reads a measured surface; the format is found from the content.

        `size` [m] and `height_unit` [m] are needed where the file holds none; `channel` by name or number.
        """
        found = _core.read_surface(
            os.fspath(path),
            None if size is None else list(pair("size", size)),
            None if height_unit is None else number("height_unit", height_unit),
            None if channel is None else str(channel),
        )
        heights, extent = found.pop("heights"), found.pop("size")
        return Surface(heights, size=extent, metadata=found)

    @staticmethod
    def self_affine(
        *,
        cells: Sequence[int],
        size: Sequence[float],
        hurst: float,
        longest: float,
        shortest: float,
        rms_gradient: float | None = None,
        rms_height: float | None = None,
        roll_off: float | None = None,
        seed: int = 0,
    ) -> Surface:
        """Isotropic Gaussian roughness, periodic, the same on every machine for one seed.

        The spectrum is flat from wavelength `longest` to `roll_off` and falls as q^(-2 - 2 hurst) to `shortest` [m].
        The rms gradient, or the rms height [m], is exact.

        >>> import asperity as asp
        >>> surface = asp.Surface.self_affine(cells=(64, 64), size=(1e-3, 1e-3), hurst=0.8, rms_height=1e-6,
        ...                                   longest=5e-4, shortest=5e-5, seed=1)
        >>> round(surface.statistics()["sq"] * 1e6, 12)
        1.0
        """
        extent = pair("size", size)
        heights = _core.self_affine(
            counts("cells", cells),
            list(extent),
            number("hurst", hurst),
            None if rms_gradient is None else number("rms_gradient", rms_gradient),
            None if rms_height is None else number("rms_height", rms_height),
            number("longest", longest),
            number("shortest", shortest),
            None if roll_off is None else number("roll_off", roll_off),
            count("seed", seed, 0),
        )
        return Surface(heights, size=extent)

    @staticmethod
    def sphere(
        *, cells: Sequence[int], size: Sequence[float], radius: float, center: Sequence[float] = (0.0, 0.0)
    ) -> Surface:
        """A paraboloid of that radius [m]; `center` [m] from the middle of the domain."""
        return _shape("sphere", [number("radius", radius)], center, cells, size)

    @staticmethod
    def ellipsoid(
        *,
        cells: Sequence[int],
        size: Sequence[float],
        radius_x: float,
        radius_y: float,
        center: Sequence[float] = (0.0, 0.0),
    ) -> Surface:
        """A paraboloid of two radii [m]; an infinite one makes a cylinder."""
        radii = [number("radius_x", radius_x), number("radius_y", radius_y)]
        return _shape("ellipsoid", radii, center, cells, size)

    @staticmethod
    def cone(
        *, cells: Sequence[int], size: Sequence[float], slope: float, center: Sequence[float] = (0.0, 0.0)
    ) -> Surface:
        """A cone that rises by `slope` per length."""
        return _shape("cone", [number("slope", slope)], center, cells, size)

    @staticmethod
    def flat_punch(
        *,
        cells: Sequence[int],
        size: Sequence[float],
        radius: float | None = None,
        sides: Sequence[float] | None = None,
        center: Sequence[float] = (0.0, 0.0),
    ) -> Surface:
        """A flat circle of that radius, or rectangle of those sides [m]; cells outside cannot touch."""
        if (radius is None) == (sides is None):
            raise CaseError("give radius or sides, one of them")
        numbers = [number("radius", radius)] if sides is None else list(pair("sides", sides))
        return _shape("flat-punch", numbers, center, cells, size)

    @staticmethod
    def wave(
        *, cells: Sequence[int], size: Sequence[float], amplitude: float, wavelength: Sequence[float]
    ) -> Surface:
        """A wave of that amplitude and those wavelengths along x and y [m]; an infinite one: a ridge."""
        x, y = pair("wavelength", wavelength)
        return _shape("wave", [number("amplitude", amplitude), x, y], (0.0, 0.0), cells, size)


def _shape(kind: str, numbers: list[float], center: Sequence[float], cells: Sequence[int], size: Sequence[float]) -> Surface:
    extent = pair("size", size)
    heights = _core.shape(kind, numbers, list(pair("center", center)), counts("cells", cells), list(extent))
    return Surface(heights, size=extent)


def as_surface(value: Any, size: Sequence[float] | None) -> Surface:
    """A surface; heights as an array need their size; topographies of SurfaceTopography and xarray are understood."""
    if isinstance(value, Surface):
        return value
    if hasattr(value, "heights") and hasattr(value, "physical_sizes"):
        return _from_surface_topography(value, size)
    if hasattr(value, "coords") and hasattr(value, "dims"):
        return _from_xarray(value, size)
    if size is None:
        raise CaseError("the surface is an array, so that its size in m is needed: size=(Lx, Ly)")
    return Surface(value, size=size)


def _from_surface_topography(topography: Any, size: Sequence[float] | None) -> Surface:
    units = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "um": 1e-6, "nm": 1e-9, "pm": 1e-12, "Å": 1e-10}
    unit = getattr(topography, "unit", None)
    if unit not in units:
        raise CaseError(f"the unit of the topography is {unit!r}, but must be one of {', '.join(units)}")
    factor = units[unit]
    extent = [length * factor for length in topography.physical_sizes] if size is None else size
    return Surface(np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan) * factor, size=extent)


def _from_xarray(array: Any, size: Sequence[float] | None) -> Surface:
    if tuple(array.dims) == ("y", "x"):
        array = array.transpose("x", "y")
    if tuple(array.dims) != ("x", "y"):
        raise CaseError(f"the array has dimensions {tuple(array.dims)}, but must have x and y")
    if size is None:
        try:
            axes = [np.asarray(array.coords[name], dtype=float) for name in ("x", "y")]
            size = [(axis[-1] - axis[0]) / (len(axis) - 1) * len(axis) for axis in axes]
        except (KeyError, ZeroDivisionError, IndexError):
            raise CaseError("the array has no coordinates x and y in m, so that its size is needed: size=(Lx, Ly)") from None
    return Surface(np.asarray(array), size=size)
