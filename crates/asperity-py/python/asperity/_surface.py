"""Surfaces: heights over a rectangle, or along a line."""

from __future__ import annotations

import functools
import json
import os
import re
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field as dataclass_field
from typing import TYPE_CHECKING, Any, Protocol, Union

import numpy as np

from . import _core, _foreign, _html
from ._arrays import AnyArray, AnyPath, ArrayLike, Floats, Scalar, Size, along, angle, as_plane, cell_counts, cells_of, centres, count, counts, field, frozen, in_order, lengths, number, numbers_of, pair
from ._arrays import pitch_of, size_of
from ._core import CaseError
from ._findings import findings_of, warn, warn_caller
from ._grid import OnGrid
from ._histories import one_of
from ._parameters import call, parameters
from ._steps import Operation, operations, with_steps
from ._sealed import Named, ReadOnlyArrays
from ._spoken import spoken
from ._units import carries, factor_of, has_unit, is_angle, is_labelled, variable_of
from ._words import Axis, Edge, Fill, Form, Resampling, Window
from .plot import SurfacePlots


if TYPE_CHECKING:
    import xarray


class Labelled(Protocol):
    """An array of xarray."""

    @property
    def dims(self) -> tuple[Hashable, ...]: ...


class Topography(Protocol):
    """A topography of SurfaceTopography."""

    @property
    def physical_sizes(self) -> Any: ...


#: What adds to a surface; of numbers only the 0 with which sum() begins.
Summand = Union["Surface", AnyArray, Labelled, Topography, int]
#: What a surface is given as: one of this package, heights as an array, an array of xarray, a topography of SurfaceTopography.
SurfaceLike = Union["Surface", ArrayLike, Labelled, Topography]


@dataclass(frozen=True, eq=False)
class Autocorrelation(ReadOnlyArrays):
    """f(tx, ty) = <z(x, y) z(x + tx, y + ty)>/<z^2>, z about its mean."""

    #: f at the lags `x`, `y`, shape (nx, ny); 1 where both are 0.
    values: Floats
    #: Lags along x and y [m].
    x: Floats
    y: Floats
    #: Sal: shortest lag at which f falls to 0.2 [m]; None where it does not.
    length: float | None
    #: Str: shortest over longest such lag, 1 isotropic, near 0 with a lay.
    texture_aspect_ratio: float | None


@dataclass(frozen=True, eq=False)
class Surface(OnGrid, Named):
    """Heights [m] at the cell centres of a rectangle, shape (nx, ny), or of a line, shape (n,), pointing out of their body.

    A line is for line contacts in plane strain, in which nothing changes along y; its `size` is one length, (L,).

    NaN where a measurement has no value; minus infinity where a punch cannot touch. Made from an array with its `size` [m], from a
    topography of SurfaceTopography, or from an xarray.DataArray with the dimensions x and y (in any order) and their coordinates; the
    attribute `units` of the heights and of each coordinate is honoured, without it they are in m. The numbers are copied, and
    `heights` is read-only.

    Surfaces of the same cells and size add up: a sphere plus roughness, one rough surface against another. A surface times a number
    has scaled heights, and its negative is the replica.

    >>> import asperity as asp, numpy as np
    >>> wave = asp.Surface.wave(cells=(32, 32), size=(1e-3, 1e-3), amplitude=1e-6, wavelength=(1e-3, 5e-4))
    >>> bool(np.allclose(np.asarray(2 * wave - wave), wave.heights)), wave == -(-wave), wave.x.shape
    (True, True, (32,))
    """

    heights: Floats
    size: tuple[float, ...]
    metadata: dict[str, Any] = dataclass_field(default_factory=dict)

    #: What a shape was made with: radius of a sphere, cylinder or punch [m], radii of an ellipsoid [m], slope of a cone or wedge, sides
    #: of a punch [m], amplitude and wavelengths of a wave [m], and the `center` from the middle of the domain [m].
    radius, radius_x, radius_y, slope, amplitude = parameters(float, 5)
    sides, wavelength, center = parameters(list[float], 3)
    #: What self-affine roughness was made with: Hurst exponent, rms gradient or height [m], wavelengths [m], seed.
    hurst, rms_gradient, rms_height, longest, shortest, roll_off = parameters(float, 6)
    (seed,) = parameters(int, 1)

    @property
    def _parameters(self) -> dict[str, Any]:
        """What it was made with; none of heights that were given, or changed."""
        return dict(self.__dict__.get("_made", {}))

    @property
    def _origin(self) -> list[dict[str, Any]]:
        """The parts, as those of a case, that it was made or read from, a file with the steps that were done to it."""
        parts, steps = self.__dict__.get("_from", [{"kind": "array"}]), self.__dict__.get("_steps", [])
        return [with_steps(parts[0], steps)] if steps else list(parts)

    @property
    def _since(self) -> list[str]:
        """The steps of the history that its parts do not say; a file holds the steps before it was written."""
        return [] if self.__dict__.get("_steps") else list(self.__dict__.get("_done", []))

    def _of(self, origin: list[dict[str, Any]], since: Sequence[str] = (), steps: list[Operation] | None = None) -> Surface:
        """The surface itself, of this origin and what was done since, in words and, of a file alone, as steps."""
        of_file = [part["kind"] for part in origin] == ["file"]
        for name, value in (("_from", origin), ("_done", list(since)), ("_steps", steps if of_file else None)):
            object.__setattr__(self, name, value)
        return self

    # Operators of numpy arrays leave a surface to its own.
    __array_ufunc__ = None
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, heights: Any, *, size: Size = None, metadata: dict[str, Any] | None = None) -> None:
        values, size, known = _parts(heights, size)
        values = field("heights", values, line=True)
        object.__setattr__(self, "heights", frozen(np.array(values)))
        object.__setattr__(self, "size", tuple(size_of("heights", self.heights, size)))
        object.__setattr__(self, "metadata", {**known, **(metadata or {})})

    def __reduce__(self) -> tuple[Any, ...]:
        made = {name: self.__dict__[name] for name in ("_made", "_from", "_done", "_steps") if name in self.__dict__} or None
        return functools.partial(Surface, size=self.size, metadata=self.metadata), (self.heights,), made

    @property
    def cells(self) -> tuple[int, ...]:
        """Number of cells along x and y; of a line one number."""
        return self.heights.shape

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> AnyArray:
        """The heights [m]."""
        wanted = np.dtype(np.float64 if dtype is None else dtype)
        if copy is False and wanted != self.heights.dtype:
            raise ValueError(f"the heights are float64: {wanted} needs a copy")
        return self.heights.astype(wanted, copy=bool(copy))

    def __eq__(self, other: object) -> bool:
        """Whether cells, size and all heights are the same; undefined points equal each other."""
        if not isinstance(other, Surface):
            return NotImplemented
        return self.size == other.size and np.array_equal(self.heights, other.heights, equal_nan=True)

    def __add__(self, other: Summand) -> Surface:
        if _is_number(other):
            if other == 0:  # the start of sum()
                return self
            raise CaseError("a number cannot be added to a surface, whose heights are measured from no fixed level: add surfaces")
        try:
            other = self._alike(other)
        except CaseError:
            if isinstance(other, np.ndarray) or carries(other) or is_labelled(other) or hasattr(other, "physical_sizes"):
                raise
            return NotImplemented
        if self.cells != other.cells or not np.allclose(self.size, other.size, rtol=1e-9, atol=0.0):
            both = " and of ".join(f"{one.cells} cells on {one.size} m" for one in (self, other))
            raise CaseError(f"surfaces of {both} cannot be added: they must have the same cells and size")
        # What was measured does not repeat beyond its edges, and the sum neither; a single body stays one with roughness on it.
        known: dict[str, Any] = {key: one.metadata[key] for one in (self, other) for key in ("format", "single") if key in one.metadata}
        if done := [*self.history, *other.history]:
            known["history"] = done
        return Surface(self.heights + other.heights, size=self.size, metadata=known)._of([*self._origin, *other._origin], [*self._since, *other._since])

    def __radd__(self, other: Summand) -> Surface:
        if isinstance(other, np.ndarray):
            # xarray adds the numbers of its array, which may be in micrometres.
            raise CaseError("an array on the left of a surface may have lost its unit: write surface + array")
        return self + other

    def __sub__(self, other: Summand) -> Surface:
        return NotImplemented if _is_number(other) else self + -self._alike(other)

    def _alike(self, other: Any) -> Surface:
        """Another surface; an array has the size of this one."""
        return as_surface(other, self.size if isinstance(other, np.ndarray) or carries(other) else None)

    def __mul__(self, factor: Any) -> Surface:
        if not _is_number(factor) and not carries(factor):
            return NotImplemented
        scale = number("factor of the heights", factor, "")
        if not np.isfinite(scale):
            raise CaseError(f"factor is {scale}, but must be finite")
        return self._changed(self.heights * scale, [f"heights times {scale:g}"])

    __rmul__ = __mul__

    def __truediv__(self, divisor: Any) -> Surface:
        if not _is_number(divisor) and not carries(divisor):
            return NotImplemented
        if (share := number("divisor of the heights", divisor, "")) == 0.0:
            raise CaseError("heights cannot be divided by 0")
        return self * (1.0 / share)

    def __neg__(self) -> Surface:
        return self._changed(-self.heights, ["inverted"], steps=[{"op": "invert"}])

    def _changed(self, heights: Floats, done: list[str], size: Sequence[float] | None = None, steps: list[Operation] | None = None) -> Surface:
        """The surface with other heights, on which this was done, in words and as steps."""
        before = self.__dict__.get("_steps", None if self.__dict__.get("_done") else [])
        changed = Surface(heights, size=self.size if size is None else size, metadata={**self.metadata, "history": [*self.history, *done]})
        parts, words = self.__dict__.get("_from", [{"kind": "array"}]), [*self.__dict__.get("_done", []), *done]
        return changed._of(parts, words, None if before is None or steps is None else [*before, *steps])

    def __pos__(self) -> Surface:
        return self

    def to_xarray(self) -> xarray.DataArray:
        """The heights as xarray.DataArray with coordinates x and y, and units."""
        import xarray

        attributes = {"units": "m", "long_name": "height"}
        return xarray.DataArray(np.array(self.heights), dims=self._axes, coords=self._coordinates, name="heights", attrs=attributes)

    def __repr__(self) -> str:
        known = self._parameters
        if known:
            return call(f"Surface.{known.pop('kind').replace('-', '_')}", {"cells": self.cells, "size": self.size, **known})
        return f"Surface({cells_of(self.heights)}, {' x '.join(f'{length:g} m' for length in self.size)})"

    def gap(self) -> Floats:
        """The undeformed gap against a flat [m]: least value 0, infinite where nothing can touch."""
        return self._compiled.gap().reshape(self.heights.shape)

    @property
    def _compiled(self) -> _core.Heights:
        """The surface as the core takes it."""
        return _core.Heights(as_plane(self.heights), list(self.size))

    @property
    def history(self) -> list[str]:
        """What was done to the heights since they were measured or made, one sentence per step."""
        return list(self.metadata.get("history", []))

    def process(self, *steps: str) -> Surface:
        """The surface after these steps, done in order; they are written as for ``asperity surface process --op``.

        ``level=plane``, ``fill=harmonic share=0.25``, ``crop cells=512,512 from=0,0``, ``filter longest=40um``, ... The
        methods below do the same steps one by one. Each step is recorded in :attr:`history`.

        >>> import asperity as asp, numpy as np
        >>> tilted = asp.Surface(np.add.outer(np.arange(10.0), np.arange(8.0)), size=(10e-6, 8e-6))
        >>> flat = tilted.process("level=plane", "crop size=4um,4um")
        >>> flat.cells, bool(np.all(abs(flat.heights) < 1e-13)), flat.history[1]
        ((4, 4), True, 'crop to 4 x 4 cells from (3, 2)')
        """
        heights, size, done = self._compiled.process([str(step) for step in steps])
        changed = self._changed(heights[:, 0] if self.is_line else heights, done, size, operations([str(step) for step in steps]))
        for step in done:
            if step.startswith("crop"):
                changed.metadata.pop("repeats", None)
            if step.endswith("(mirror)"):
                changed.metadata["repeats"] = True
        return changed

    def level(self, form: Form = "plane") -> Surface:
        """The surface without its least-squares "mean", "plane" or "quadratic" form; "none" leaves it."""
        return self.process(f"level form={form}")

    def outliers(self, threshold: float = 6.0, *, radius: int = 2) -> Surface:
        """Spikes become undefined: points beyond the lines through their neighbours at `radius` cells by more than `threshold`
        robust standard deviations, on the same side in every direction."""
        return self.process(f"outliers threshold={number('threshold of outliers', threshold)!r} radius={count('radius', radius)}")

    def fill(self, method: Fill = "harmonic", *, share: float = 0.25) -> Surface:
        """Undefined points filled: "harmonic" (Laplace's equation) or "nearest"; refused above that share of them."""
        return self.process(f"fill method={method} share={number('share', share)!r}")

    def crop(
        self, *, cells: Sequence[int] | None = None, start: Sequence[int] | None = None, size: Sequence[float] | None = None,
        corner: Sequence[float] | None = None, defined: bool = False
    ) -> Surface:
        """A rectangle of it: `cells` from the cell `start`, or `size` [m] from the `corner` [m], else about the middle;
        or the smallest rectangle that holds every defined point."""
        one_of({"cells": cells, "size": size, "defined=True": defined or None}, "give")
        if defined:
            return self.process("crop defined=true")
        if cells is not None:
            first = "" if start is None else " from={},{}".format(*counts("start", start, 0))
            return self.process("crop cells={},{}".format(*counts("cells", cells)) + first)
        place = "" if corner is None else " corner={!r},{!r}".format(*pair("corner", corner))
        return self.process("crop size={!r},{!r}".format(*pair("size", size)) + place)

    def resample(self, cells: Sequence[int], *, method: Resampling = "band-limited") -> Surface:
        """Other cells over the same rectangle: "band-limited" (by waves; needs every point) or "bilinear"."""
        nx, ny = counts("cells", cells)
        return self.process(f"resample method={method} cells={nx},{ny}")

    def filter(self, *, longest: float | None = None, shortest: float | None = None, edge: Edge = "sharp") -> Surface:
        """Only the wavelengths from `shortest` to `longest` [m]; the edge is "sharp" or "gaussian" (ISO 16610-61).

        The surface is taken as periodic: use that of one that is not :meth:`mirrored`.
        """
        ends = numbers_of({"longest": longest, "shortest": shortest})
        return self.process(" ".join(["filter", *(f"{name}={value!r}" for name, value in ends.items()), f"edge={edge}"]))

    def flip(self, axis: Axis) -> Surface:
        """Mirrored along "x" or "y"."""
        return self.process(f"flip axis={axis}")

    def rotate(self, turns: int = 1, /, *, quarter_turns: int | None = None) -> Surface:
        """Turned by quarter turns of 90 degrees from x towards y; negative ones turn back. More than 3 need the name `quarter_turns`.

        >>> import asperity as asp, numpy as np
        >>> asp.Surface(np.array([[1.0, 2.0], [3.0, 4.0]]), size=(1e-6, 1e-6)).rotate(quarter_turns=1).heights.tolist()
        [[2.0, 4.0], [1.0, 3.0]]
        """
        given: Any = turns if quarter_turns is None else quarter_turns
        # An angle says itself how many they are.
        given = round(angle("quarter_turns", given) / (np.pi / 2), 9) if has_unit(given) and is_angle(given) else given
        whole = count("quarter_turns", given, -(2**31))
        if quarter_turns is None and abs(whole) > 3:
            nearest = f" ({whole} degrees are rotate({whole // 90}))" if whole % 90 == 0 and abs(whole) <= 270 else ""
            raise CaseError(f"rotate turns by quarter turns, and {whole} of them are meant for degrees{nearest}; else write rotate(quarter_turns={whole})")
        return self.process(f"rotate quarter_turns={whole}")

    def invert(self) -> Surface:
        """Heights of the other sign: a replica."""
        return self.process("invert")

    def mirrored(self) -> Surface:
        """The surface and its reflections: twice as long and wide, periodic without a seam; a profile twice as long.

        No height changes. The symmetry is part of the answer: a conductance without a part off the diagonal, the same friction along +x
        and -x, and a lay at an angle to the axes becomes a herringbone.

        >>> import asperity as asp, numpy as np
        >>> part = asp.Surface(np.array([[1.0, 2.0], [3.0, 4.0]]), size=(2e-6, 2e-6))
        >>> whole = part.mirrored()
        >>> whole.heights[0].tolist(), whole.heights[:, 0].tolist(), whole.size
        ([1.0, 2.0, 2.0, 1.0], [1.0, 3.0, 3.0, 1.0], (4e-06, 4e-06))
        """
        return self.process("border method=mirror")

    def window(self, shape: Window = "tukey", *, share: float | None = None) -> Surface:
        """Faded to zero at the edges by a "tukey" window that rises over a `share` of the length (0.1), or a "hann" one.

        The window is 1 in the middle, and no height grows. Its flat border closes every passage across it: a leak through a windowed
        surface is too small or zero (finding ``window-in-leak``), so take :meth:`mirrored` for leaks. For the spectrum of a surface that
        is not periodic see :meth:`power_spectrum`.
        """
        words = f"window shape={shape}"
        return self.process(words if share is None else f"{words} share={number('share', share)!r}")

    def statistics(self, *, periodic: bool | None = None, longest: float | None = None, shortest: float | None = None) -> dict[str, float]:
        """The statistics of ``asperity surface info`` of the heights as they are.

        Parameters
        ----------
        periodic : whether the surface repeats beyond its edges; by default true unless it was read from a file and not mirrored. For
            the waves one that does not repeat is levelled, filled and windowed first.
        longest, shortest : wavelengths [m] between which the Hurst exponent is fitted

        Returns
        -------
        dict : sa, sq, sz, sp, sv, min, max, mean [m], ssk, sku, sdq, sdr (ISO 25178-2); undefined (number of points);
            m0 [m^2], m2, m4 [1/m^2], bandwidth m0 m4/m2^2 (Nayak 1971); lay (whether there is a clear one),
            lay_ratio (rms slope across it over that along it), lay_angle [rad] from x; hurst, hurst_error (one standard
            error), roll_off [m], plateau [m^4], spectrum_misfit of a self-affine spectrum, where one can be fitted (with a
            clear lay: across it)

        Of a profile (of its heights as they are; `longest` is the cut-off of the Gaussian mean line that is subtracted, ISO 16610-21):
        ra, rq, rz, rt [m], rsk, rku, rsm [m] (None where there is no whole element), rdq (ISO 21920-2).

        Warns
        -----
        ResultWarning : the Hurst exponent lies outside of 0 to 1
        """
        if self.is_line:
            if periodic is not None or shortest is not None:
                raise CaseError("a profile has no `periodic` and no `shortest`: give `longest`, the cut-off, or nothing")
            return self._compiled.profile_parameters(None if longest is None else number("longest", longest))
        band = None
        if longest is not None or shortest is not None:
            # Without one of them: from the size of the surface, or down to its cells.
            ends = {"longest": max(self.size), "shortest": 2 * min(length / n for length, n in zip(self.size, self.cells))}
            band = list({**ends, **numbers_of({"longest": longest, "shortest": shortest})}.values())
        found = self._compiled.describe(self._repeats(periodic), band)
        warn(findings_of(json.loads(found.pop("findings", "[]"))))
        return found

    def power_spectrum(self, per_decade: int = 16, *, periodic: bool = True) -> tuple[Floats, Floats]:
        """Wavenumbers [1/m] and radially averaged power spectrum C(q) [m^4]; 0 rings per decade: linear rings.

        The surface is taken as periodic, so that the mean of z^2 is the integral of C d^2q / (2 pi)^2. With ``periodic=False`` it is
        levelled, filled, and multiplied by Hann's window of mean square 1, which keeps the power of the waves; :meth:`window`,
        which is for contacts, does not. Of a profile it is :meth:`power_spectrum_1d`.
        """
        if self.is_line:
            if not periodic:
                raise CaseError("a profile has no `periodic`: its spectrum is that of the profile as it is")
            return self.power_spectrum_1d()
        return self._compiled.power_spectrum(count("per_decade", per_decade, 0, 1000), bool(periodic))

    def power_spectrum_1d(self, direction: Axis = "x") -> tuple[Floats, Floats]:
        """Wavenumbers q > 0 [1/m] and power spectrum C1(q) [m^3] of the profiles along "x" or "y", their mean.

        Of profiles that are taken as periodic and about their own mean, so that the mean of their squares is the integral of
        C1 dq / pi over q > 0 (T. D. B. Jacobs, T. Junge, L. Pastewka, Surf. Topogr. 5 (2017) 013001, where C1 counts both signs of q).

        >>> import asperity as asp, numpy as np
        >>> wave = asp.Surface.wave(cells=64, size=1e-3, amplitude=1e-6, wavelength=2.5e-4)
        >>> q, c = wave.power_spectrum_1d()
        >>> peak = np.argmax(c)
        >>> bool(np.isclose(q[peak], 2 * np.pi / 2.5e-4)), bool(np.isclose(np.sum(c) * q[0] / np.pi, np.var(wave.heights)))
        (True, True)
        """
        if direction not in ("x", "y") or (self.is_line and direction == "y"):
            raise CaseError(f"direction is {direction!r}, but must be {'x of a line' if self.is_line else 'x or y'}")
        z = self._defined("power_spectrum_1d")
        axis = "xy".index(direction)
        n, length = z.shape[axis], self.size[axis]
        amplitudes = np.abs(np.fft.rfft(z, axis=axis)) ** 2 * (length / n**2)
        both = np.moveaxis(amplitudes, axis, 0).reshape(n // 2 + 1, -1).mean(axis=1)
        # The wave of two cells has no partner of the other sign: half of it counts.
        if n % 2 == 0:
            both[-1] *= 0.5
        q: Floats = 2.0 * np.pi / length * np.arange(1, n // 2 + 1)
        return q, both[1:]

    def power_spectrum_2d(self) -> tuple[Floats, Floats, Floats]:
        """Wavenumbers along x and y [1/m], rising, and the power spectrum C(qx, qy) [m^4] of shape (nx, ny).

        The surface is taken as periodic, so that the mean of z^2 (about its mean) is the sum of C dqx dqy / (2 pi)^2.

        >>> import asperity as asp, numpy as np
        >>> rough = asp.Surface.self_affine(cells=(64, 48), size=(1e-3, 1e-3), hurst=0.8, rms_height=1e-6, longest=5e-4, shortest=5e-5)
        >>> qx, qy, c = rough.power_spectrum_2d()
        >>> bool(np.isclose(np.sum(c) * (qx[1] - qx[0]) * (qy[1] - qy[0]) / (2 * np.pi) ** 2, 1e-12))
        True
        """
        self._check_plane("power_spectrum_2d")
        z = self._defined("power_spectrum_2d")
        (nx, ny), (lx, ly) = z.shape, self.size
        power = np.fft.fftshift(np.abs(np.fft.fft2(z - z.mean())) ** 2) * (lx * ly / (nx * ny) ** 2)
        qx, qy = (2.0 * np.pi * np.fft.fftshift(np.fft.fftfreq(n, length / n)) for n, length in ((nx, lx), (ny, ly)))
        return qx, qy, power

    def _defined(self, what: str) -> Floats:
        """The heights, all of which `what` needs."""
        if missing := int(np.count_nonzero(~np.isfinite(self.heights))):
            raise CaseError(f"{what} needs every height, but {missing} of {self.heights.size} points are undefined: fill() them first")
        return self.heights

    def bearing_curve(self, levels: int = 200) -> tuple[Floats, Floats]:
        """Heights [m] and the share of the points at or above each (Abbott and Firestone 1933)."""
        return self._compiled.bearing_curve(count("levels", levels, 2))

    def height_distribution(self, bins: int = 100) -> tuple[Floats, Floats]:
        """Heights [m], the middles of bins, and the density of points there [1/m]."""
        return self._compiled.height_distribution(count("bins", bins))

    def autocorrelation(self, *, periodic: bool | None = None) -> Autocorrelation:
        """The autocorrelation function and the spatial parameters Sal and Str (ISO 25178-2)."""
        self._check_plane("autocorrelation")
        values, length, aspect = self._compiled.autocorrelation(self._repeats(periodic))
        lags: list[Floats] = [np.asarray((np.arange(n) - n // 2) * (side / n), dtype=np.float64) for n, side in zip(self.cells, self.size)]
        return Autocorrelation(values, lags[0], lags[1], length, aspect)

    def _check_plane(self, what: str) -> None:
        """Refuses a line of cells, for which there is no method `what`."""
        if self.is_line:
            raise CaseError(f"{what} is for surfaces over a plane, but this one is a line of {self.cells[0]} cells")

    def _repeats(self, periodic: bool | None) -> bool:
        # A file's surface knows its format; one continued by its reflections repeats.
        known = "repeats" in self.metadata or "format" not in self.metadata
        return known if periodic is None else bool(periodic)

    @property
    def plot(self) -> SurfacePlots:
        """Figures by matplotlib: ``surface.plot.heights()``, ``surface.plot.power_spectrum()``, ..."""
        return SurfacePlots(self)

    def _repr_html_(self) -> str:
        finite = self.heights[np.isfinite(self.heights)]
        rows = [("size", " x ".join(f"{length:g} m" for length in self.size))]
        if finite.size:
            rows.append(("heights", f"{finite.min():.4g} m to {finite.max():.4g} m, Sq {finite.std():.4g} m"))
        if missing := self.heights.size - finite.size:
            rows.append(("undefined", f"{missing} of {self.heights.size} points"))
        rows += [("history" if n == 0 else "", step) for n, step in enumerate(self.history)]
        return f"<b>Surface</b>, {cells_of(self.heights)}{_html.table(rows)}"

    def write(self, path: AnyPath, *, format: str | None = None, force: bool = False) -> None:
        """Writes NPZ, GWY, X3P, SDF, NetCDF or text, selected by the path's extension or by `format`."""
        path = os.fspath(path)
        if not force and os.path.exists(path):
            raise FileExistsError(f"{path} already exists; choose another file or give force=True")
        form = format or os.path.splitext(path)[1].lstrip(".")
        self._check_plane("write")
        self._compiled.write(path, form, self.history)

    @staticmethod
    def read(
        path: AnyPath, *, size: Size = None, height_unit: float | str | None = None,
        channel: str | int | None = None, level: Form | None = None, fill: Fill | None = None, transpose: bool | None = None
    ) -> Surface:
        """Reads a measured surface; the format is found from the content.

        Parameters
        ----------
        path : text of two columns (a profile: position and height, which makes a surface of one dimension), text matrix, CSV, XYZ, NPY, NPZ, NetCDF, HDF5, SDF, X3P, SUR, MNT, GWY, AL3D, OPD, BCR, Nanoscope, MetroPro,
            PLU, IBW, NID, FRT; also packed by gzip. Other formats are read by the package SurfaceTopography where it is
            installed; the metadata say so under "reader".
        size : lengths along x and y [m], or the length of a profile, needed where the file holds none
        height_unit : unit of the numbers in the file, "um" or in m (1e-6), needed if the file does not state it
        channel : which one, by name or number (from 0), where the file holds several; by default the first of heights.
            ``surface.metadata["channels"]`` lists them.
        level, fill : as the methods of that name; by default the heights are as measured, undefined points NaN
        transpose : whether the lines of a text matrix run along y, as ``np.savetxt(path, surface.heights)`` writes them; by default
            they run along x, as instruments write them

        Raises
        ------
        FileNotFoundError : there is no such file; another OSError where it cannot be read
        CaseError : it does not say what is needed, such as its size

        Warns
        -----
        ResultWarning : a text matrix looks as if numpy.savetxt had written it, and `transpose` is not given
        """
        path = os.fspath(path)
        given = None if size is None else list(lengths("size", size))
        unit = None if height_unit is None else factor_of("height_unit", height_unit, "m") if isinstance(height_unit, str) else number("height_unit", height_unit)
        name = None if channel is None else str(channel)
        try:
            found = _core.read_surface(path, given, unit, name)
        except _core.FormatError as error:
            found = _foreign.read(path, given, unit, name, error)
        heights, extent = found.pop("heights"), found.pop("size")
        if transpose is None and len(extent) == 2 and _is_savetxt(path):
            warn_caller(
                f"{path} looks as if numpy.savetxt had written it: its lines are read along x, so that an array with axes (x, y) comes out "
                "transposed. Give transpose=True for such an array, or transpose=False if the lines run along x."
            )
        if transpose and len(extent) != 2:
            raise CaseError("transpose is for surfaces over a plane, but the file holds a profile")
        if transpose:
            # A size that was given is along x and y already.
            heights, extent = np.ascontiguousarray(heights.T), extent if given is not None else extent[::-1]
            found = {**found, "history": [*found.get("history", []), "transposed"]}
        surface = Surface(heights[:, 0] if len(extent) == 1 else heights, size=extent, metadata=found)
        how = {"size": given, "height_unit": _named(unit), "channel": name, "level": level or "none", "fill": fill}
        origin = [{"kind": "file", "path": path, **{key: value for key, value in how.items() if value is not None}}]
        surface = surface if level is None else surface.level(level)
        surface = surface if fill is None else surface.fill(fill)
        # A case reads the lines of a file along x.
        return surface._of(origin, ["transposed"] if transpose else [], None if transpose else [])

    @staticmethod
    def self_affine(
        *, cells: int | Sequence[int], size: Size, hurst: Scalar, longest: Scalar, shortest: Scalar,
        rms_gradient: Scalar | None = None, rms_height: Scalar | None = None, roll_off: Scalar | None = None, seed: int = 0,
        lay_angle: Scalar | None = None, lay_ratio: Scalar | None = None, skewness: Scalar | None = None,
        kurtosis: Scalar | None = None
    ) -> Surface:
        """Self-affine roughness, periodic, the same on every machine for one seed.

        The spectrum is flat from wavelength `longest` to `roll_off` and falls as q^(-2 - 2 hurst) to `shortest` [m].
        The rms gradient, or the rms height [m], is exact. With a lay the waves are `lay_ratio` times longer along the
        direction `lay_angle` [rad from x towards y]; with `skewness` or `kurtosis` the heights are distributed so, exactly,
        and the spectrum is as close as that allows. With one number of cells and one length it is a profile of such a surface,
        whose spectrum falls as q^(-1 - 2 hurst), for a line contact.

        >>> import asperity as asp
        >>> surface = asp.Surface.self_affine(cells=(64, 64), size=(1e-3, 1e-3), hurst=0.8, rms_height=1e-6,
        ...                                   longest=5e-4, shortest=5e-5, seed=1)
        >>> round(surface.statistics()["sq"] * 1e6, 12)
        1.0
        """
        given = dict(hurst=hurst, rms_gradient=rms_gradient, rms_height=rms_height, longest=longest, shortest=shortest, roll_off=roll_off)
        lay = numbers_of({"ratio": lay_ratio}) | ({} if lay_angle is None else {"angle": angle("lay_angle", lay_angle)})
        distribution = numbers_of({"skewness": skewness, "kurtosis": kurtosis})
        if len(lengths("size", size)) == 1 and (lay or distribution):
            raise CaseError("a profile has no lay, and heights of a normal distribution: leave lay, skewness and kurtosis out")
        numbers = {**numbers_of(given), "seed": count("seed", seed, 0, 2**63 - 1)}
        parts = {"lay": {**lay, "angle": f"{lay['angle']!r} rad"} if "angle" in lay else lay, "distribution": distribution}
        made = {**numbers, **{f"lay_{name}": value for name, value in lay.items()}, **distribution}
        return _made("self-affine", cells, size, made, {**numbers, **{name: part for name, part in parts.items() if part}})

    @staticmethod
    def contact_mechanics_challenge(*, cells: Sequence[int], seed: int = 0) -> Surface:
        """The roughness of the Contact Mechanics Challenge (Mueser et al., Tribol. Lett. 65 (2017) 118) on 0.1 mm x 0.1 mm.

        Hurst exponent 0.8, roll-off 20 um, cut-off 0.1 um, rms gradient 1; it needs 2000 cells a side or more.
        """
        keys = {"preset": "contact-mechanics-challenge", "seed": count("seed", seed, 0, 2**63 - 1)}
        return _made("self-affine", cells, (1e-4, 1e-4), None, keys)

    @staticmethod
    def sphere(*, cells: Sequence[int], size: Size, radius: Scalar, center: Sequence[float] = (0.0, 0.0)) -> Surface:
        """A paraboloid of that radius [m]; `center` [m] from the middle of the domain."""
        return _shape("sphere", cells, size, center, {"radius": radius})

    @staticmethod
    def ellipsoid(*, cells: Sequence[int], size: Size, radius_x: Scalar, radius_y: Scalar, center: Sequence[float] = (0.0, 0.0)) -> Surface:
        """A paraboloid of two radii [m]; an infinite one makes a cylinder."""
        return _shape("ellipsoid", cells, size, center, {"radius_x": radius_x, "radius_y": radius_y})

    @staticmethod
    def cylinder(*, cells: int | Sequence[int], size: Size, radius: Scalar, center: float | Sequence[float] = 0.0) -> Surface:
        """A cylinder along y, as a parabola of that radius [m]; `center` [m] along x from the middle of the domain.

        >>> import asperity as asp, numpy as np
        >>> cylinder = asp.Surface.cylinder(cells=512, size=2e-3, radius=10e-3)      # a line contact
        >>> hertz = asp.elastic(cylinder, 1e9, load=20e3)                            # 20 N/mm
        >>> bool(abs(hertz.pressure.max() / np.sqrt(20e3 * 1e9 / (np.pi * 10e-3)) - 1) < 1e-3)
        True
        """
        return _shape("cylinder", cells, size, center, {"radius": radius})

    @staticmethod
    def wedge(*, cells: int | Sequence[int], size: Size, slope: Scalar, center: float | Sequence[float] = 0.0) -> Surface:
        """A wedge along y that rises by `slope` per length; `center` [m] along x from the middle of the domain."""
        return _shape("wedge", cells, size, center, {"slope": slope})

    @staticmethod
    def cone(*, cells: Sequence[int], size: Size, slope: Scalar, center: Sequence[float] = (0.0, 0.0)) -> Surface:
        """A cone that rises by `slope` per length."""
        return _shape("cone", cells, size, center, {"slope": slope})

    @staticmethod
    def flat_punch(
        *, cells: int | Sequence[int], size: Size, radius: Scalar | None = None,
        sides: Size = None, center: float | Sequence[float] = (0.0, 0.0)
    ) -> Surface:
        """A flat circle of that radius, or rectangle of those sides [m]; cells outside cannot touch. On a line of cells a strip of
        half the width `radius`, or of the width `sides`."""
        face = {} if sides is None else {"sides": _along_both("sides", sides, size)}
        return _shape("flat-punch", cells, size, center, {"radius": radius}, face)

    @staticmethod
    def wave(*, cells: int | Sequence[int], size: Size, amplitude: Scalar, wavelength: float | Sequence[float]) -> Surface:
        """A wave of that amplitude and those wavelengths along x and y [m]; an infinite one: a ridge. On a line one wavelength."""
        return _made("wave", cells, size, {**numbers_of({"amplitude": amplitude}), "wavelength": _along_both("wavelength", wavelength, size)})


def _along_both(what: str, value: Any, size: Any) -> list[float]:
    """Lengths along x and y, of a line along x: along y they are infinite there."""
    dimensions = len(lengths("size", size))
    return along(what, value, dimensions, np.inf)[:dimensions]


def _shape(kind: str, cells: Any, size: Any, center: Any, numbers: dict[str, Any], sides: dict[str, list[float]] = {}) -> Surface:
    """A smooth shape at `center` [m] from the middle of the domain."""
    dimensions = len(lengths("size", size))
    # What is straight along y has no place along it.
    straight = kind in ("cylinder", "wedge") and np.size(center) == 1
    place = [*lengths("center", center), 0.0] if straight else along("center", center, dimensions)
    return _made(kind, cells, size, {**numbers_of(numbers), **sides, "center": place[:dimensions]})


def _made(kind: str, cells: Any, size: Any, made: dict[str, Any] | None, keys: dict[str, Any] | None = None) -> Surface:
    """The surface of a case that has these keys; `made` are the parameters that it was made with, by default the same."""
    extent, grid = lengths("size", size), cell_counts("cells", cells)
    if len(grid) != len(extent):
        raise CaseError(f"cells is {grid} and size {extent}, but both must have two numbers, or both one for a line of cells")
    given = {"size" if name == "sides" else name: value for name, value in (keys or made or {}).items()}
    with spoken():
        heights, single = _core.heights({"domain": {"cells": list(grid), "size": list(extent)}, "surface": [{"kind": kind, **given}]})
    surface = Surface(heights.reshape(grid), size=extent, metadata={"single": True} if single else None)
    if made is not None:
        object.__setattr__(surface, "_made", {"kind": kind, **made})
    return surface._of([{"kind": kind, **given}])


def as_surface(value: Any, size: Size) -> Surface:
    """A surface; heights as an array need their size; topographies of SurfaceTopography and xarray are understood."""
    return value if isinstance(value, Surface) and size is None else Surface(value, size=size)


def check_boundary(surface: Surface, boundary: str) -> None:
    """Warns where a topography that says that it repeats is pressed on a free half-space."""
    if surface.metadata.get("repeats") and boundary == "free":
        warn_caller('the topography is periodic, but boundary is "free", so that its edges are edges of the contact: give boundary="periodic", or a topography that is not periodic')


def surface_of(surface: Any, gap: Any, size: Size) -> Surface:
    """The surface that is given by its heights, or by the undeformed gap that it leaves."""
    if (surface is None) == (gap is None):
        raise CaseError("give a surface (its heights), or gap= (the undeformed gap), exactly one of them")
    if gap is None:
        return as_surface(surface, size)
    if isinstance(gap, Surface):
        raise CaseError("gap is a Surface, which holds heights: give it as the surface, or its gap()")
    values, size, _ = _parts(gap, size, "gap")
    values = field("gap", values, line=True)
    if wrong := [value for value in values[np.isnan(values) | (values == -np.inf)][:1]]:
        raise CaseError(f"gap holds {wrong[0]}, but must be finite, or infinite where a cell cannot touch")
    return Surface(-values, size=size)


def per_cell(what: str, value: Any, shape: Surface, unit: str | None = None) -> Floats:
    """Numbers of each cell of the domain of a surface."""
    cells = field(what, value, line=True, unit=unit, size=shape.size)
    if cells.shape != shape.cells:
        raise CaseError(f"{what} has shape {cells.shape}, but must have {shape.cells}: one number for each cell")
    return cells


def _parts(value: Any, size: Any, what: str = "heights") -> tuple[Any, Any, dict[str, Any]]:
    """Heights [m], size [m] and metadata of a surface, or of an object that describes one."""
    if isinstance(value, (str, os.PathLike)):
        raise CaseError(f"the {'surface' if what == 'heights' else what} is the path {os.fspath(value)!r}: read it with asperity.Surface.read({os.fspath(value)!r})")
    value = variable_of(what, value)
    held = getattr(value, "magnitude", None)
    if isinstance(held, Surface):  # a quantity of pint, which multiplies objects of any kind
        return _parts(held * number("factor of the surface", type(value)(1.0, value.units), ""), size, what)
    if isinstance(value, Surface):
        if size is not None and not np.allclose(size_of("heights", value.heights, size), value.size, rtol=1e-9, atol=0.0):
            raise CaseError(f"size is {size!r}, but the surface has the size {value.size} m already")
        return value.heights, value.size, value.metadata
    if hasattr(value, "heights") and hasattr(value, "physical_sizes"):
        return _of_topography(value, size)
    if is_labelled(value):
        return _of_labelled(what, value, size)
    if size is None:
        article = "surface" if what == "heights" else what
        raise CaseError(f"the {article} is an array, so that its size in m is needed: size=(Lx, Ly), or size=(L,) of a line")
    return value, size, {}


def _named(unit: float | None) -> str | None:
    """A unit of heights as a case names it."""
    return None if unit is None else {1.0: "m", 1e-3: "mm", 1e-6: "um", 1e-9: "nm"}.get(unit, f"{unit!r} m")


def _of_topography(topography: Any, size: Any) -> tuple[Any, Any, dict[str, Any]]:
    if getattr(topography, "is_domain_decomposed", False):
        raise CaseError("the topography holds only the part of one process of MPI: gather it first")
    unit = getattr(topography, "unit", None)
    if unit is None:
        raise CaseError("the topography has no unit: give it one, as in topography.to_unit('m') or unit='m'")
    factor = factor_of("topography", unit, "m")
    heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=float), np.nan) * factor
    if not getattr(topography, "is_uniform", True):
        heights, extent, resampled = _even(np.asarray(topography.positions(), dtype=float) * factor, heights, size)
        return heights, extent, {**resampled, **_foreign.told(topography)}
    extent = [float(length) * factor for length in topography.physical_sizes]
    if size is not None and not np.allclose(size_of("heights", heights, size), extent, rtol=1e-6, atol=0.0):
        raise CaseError(f"size is {size!r}, but the topography has the size {tuple(extent)} m: leave size out")
    # What was measured does not repeat beyond its edges.
    known: dict[str, Any] = {"repeats": True} if getattr(topography, "is_periodic", False) else {"format": "SurfaceTopography"}
    return heights, extent, {**known, **_foreign.told(topography)}


#: An unevenly measured profile gets at most this many times as many cells as it has points.
_FINEST = 10


def _even(places: Floats, heights: Floats, size: Any) -> tuple[Floats, list[float], dict[str, Any]]:
    """A profile of heights [m] at rising places [m] on equal cells, linear between the points: cells as long as the shortest distance
    of neighbours, where that makes no more than ten times as many cells as points. They cover the profile from its first to its last point."""
    steps, length = np.diff(places), float(places[-1] - places[0])
    if len(steps) == 0 or not np.all(steps > 0.0):
        raise CaseError("the positions of the line scan must be two at least, and rise")
    if size is not None and not np.allclose(lengths("size", size), [length], rtol=1e-9, atol=0.0):
        raise CaseError(f"size is {size!r} m, but the positions of the line scan tell {length:.6g} m: leave size out")
    finest = int(np.ceil(length / steps.min() * (1.0 - 1e-9)))
    cells = min(finest, _FINEST * len(places))
    pitch = length / cells
    apart = f"{steps.min():.3g} m to {steps.max():.3g} m apart"
    words = f"resampled from {len(places)} points, {apart}, to {cells} cells of {pitch:.3g} m, linear between the points"
    lost = f"; distances below {pitch:.3g} m are not resolved" if cells < finest else ""
    warn_caller(f"the line scan is not evenly spaced: {words}{lost}")
    return np.interp(places[0] + centres(cells, length), places, heights), [length], {"format": "SurfaceTopography", "history": [words]}


def _of_labelled(what: str, given: Any, size: Any) -> tuple[Any, Any, dict[str, Any]]:
    values = in_order(what, given)
    names = [str(name) for name in values.dims]
    if names not in (["x", "y"], ["x"]):
        raise CaseError(f"{what} has the dimensions {tuple(names)}, but must have x and y, or x alone")
    pitches = [pitch_of(what, values, name) for name in names]
    extent = [abs(pitch) * values.sizes[name] for name, pitch in zip(names, pitches) if pitch is not None]
    whole = len(extent) == len(names)
    if size is None and not whole:
        raise CaseError("the array has no coordinates x and y in m, so that its size is needed: size=(Lx, Ly)")
    # Numbers of cells are no places.
    if size is not None and whole and any(abs(pitch or 1.0) != 1.0 for pitch in pitches) and not np.allclose(lengths("size", size), extent, rtol=1e-6, atol=0.0):
        raise CaseError(f"size is {size!r} m, but the coordinates of {what} tell {tuple(extent)} m: leave size out")
    return values, extent if size is None else size, {}


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def _is_savetxt(path: str) -> bool:
    """Whether a text file has the numbers that numpy.savetxt writes by default, "%.18e"."""
    try:
        with open(path, "rb") as file:
            start = file.read(4096)
    except OSError:
        return False
    lines = [one for one in start.splitlines() if not one.startswith(b"#")]
    return bool(lines) and re.match(rb"\s*[-+]?(\d\.\d{18}e[-+]\d{2,3}|nan|inf)([\s,;]|$)", lines[0]) is not None and b"e" in lines[0]
