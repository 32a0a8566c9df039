"""Persson's theory of rubber friction, for comparison (docs/sliding.md)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._arrays import ArrayLike, Floats, Scalar, array, choice, direction_of, line, number
from ._core import CaseError
from ._materials import Material
from ._sealed import ReadOnlyArrays, Sealed
from ._surface import SurfaceLike, as_surface
from ._words import Correction


@dataclass(frozen=True, eq=False)
class Magnification(ReadOnlyArrays):
    """Friction and contact as waves of shorter and shorter wavelength are seen; arrays of one length."""

    #: Wave number up to which waves are seen [rad/m].
    wave_number: Floats
    #: Share of the nominal area in contact.
    contact_fraction: Floats
    #: Friction coefficient of these waves; the last is that of all.
    friction_coefficient: Floats

    @property
    def magnification(self) -> Floats:
        """Wave number over that of the longest waves."""
        return np.asarray(self.wave_number / self.wave_number[0])


class PerssonFriction(Sealed):
    """What :func:`persson_friction` finds: arrays over the velocities."""

    #: Velocities [m/s], as given.
    velocity: Floats
    #: Friction coefficient: positive against the motion, in either direction.
    friction_coefficient: Floats
    #: Share of the nominal area in contact.
    contact_fraction: Floats

    def __init__(self, theory: _core.Persson, velocity: Floats) -> None:
        self._theory = theory
        friction, contact = theory.sweep(velocity)
        self._hold(velocity=np.array(velocity), friction_coefficient=friction, contact_fraction=contact)

    def magnification(self, velocity: float) -> Magnification:
        """Friction and contact over the magnification, at one velocity [m/s]."""
        return Magnification(*self._theory.magnification(number("velocity", velocity)))

    def __repr__(self) -> str:
        highest = int(np.argmax(self.friction_coefficient))
        mu, at = self.friction_coefficient[highest], self.velocity[highest]
        return f"<PerssonFriction: {len(self.velocity)} velocities, largest friction coefficient {mu:.4g} at {at:.4g} m/s>"


def persson_friction(
    surface: SurfaceLike, material: Material, *, pressure: Scalar, velocities: ArrayLike, correction: Correction = "yang-persson",
    direction: str | float = "x", temperature: float | None = None, size: Sequence[float] | None = None
) -> PerssonFriction:
    """Friction and contact area of a rigid rough surface that slides over a viscoelastic body, by Persson's theory.

    An estimate from the power spectrum alone, for comparison. It is exact in full contact, and loses its meaning where the
    motion shrinks the contact (docs/sliding.md). Each wave of the surface counts with its own direction. Level a measured
    surface, and continue it by its reflections (``surface.level().mirrored()``), or its borders count as steps.

    Parameters
    ----------
    surface : heights of the rigid surface, which repeat (a Surface; an array needs `size`)
    material : of the body over which it slides
    pressure : nominal pressure [Pa]
    velocities : [m/s]; the sign does not matter
    correction : of the strain in partial contact: "yang-persson", S = 1/2 + P^2/2 (Yang and Persson 2008), or "none", S = 1
        (Persson 2001)
    direction : of sliding: "x", "y", or the angle from x towards y [rad]
    temperature : of the contact [K], for a material with a shift; default: the reference temperature of the shift
    size : lengths along x and y [m], where the surface is an array

    Raises
    ------
    CaseError : the input is wrong: the surface is flat or has undefined points, the material is a fluid, ...

    Examples
    --------
    Fully pressed, a sine has the friction stress (q h)^2/4 E''(q v).

    >>> import asperity as asp, numpy as np
    >>> length, height, velocity = 1e-3, 1e-6, 0.1
    >>> sine = asp.Surface.wave(cells=(64, 2), size=(length, length / 32), amplitude=height, wavelength=(length, np.inf))
    >>> rubber = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1e-3, poisson=0.5)
    >>> found = asp.persson_friction(sine, rubber, pressure=1e6, velocities=[velocity])
    >>> q = 2 * np.pi / length
    >>> loss = 4 * rubber.storage_loss(q * velocity)[1]                     # E* = 4 G where incompressible
    >>> bool(np.isclose(found.friction_coefficient[0] * 1e6, (q * height) ** 2 / 4 * loss, rtol=1e-9))
    True
    """
    if not isinstance(material, Material):
        raise CaseError(f"material is {material!r}, but must be a material, such as asperity.Prony(...)")
    shape = as_surface(surface, size)
    speeds = line("velocities", np.atleast_1d(array("velocities", velocities)))
    if speeds.size == 0:
        raise CaseError("velocities is empty, but must hold one velocity at least, in m/s")
    keys: dict[str, Any] = {"body": [material._keys]}
    if temperature is not None:
        keys["temperature"] = {"history": {"kind": "constant", "value": number("temperature", temperature)}}
    corrected = choice("correction", correction, Correction) != "none"
    theory = _core.Persson(shape.heights, list(shape.size), keys, number("pressure", pressure), direction_of(direction), corrected)
    return PerssonFriction(theory, speeds)
