"""Bodies of layers: a tread on its belt, a gasket on its flange, a gel on glass, a coating on steel (docs/layers.md)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._arrays import ArrayLike, Floats, check_length, each, number
from ._core import CaseError
from ._declared import Table
from ._fit import Fit
from ._materials import Material
from ._words import Interface


@dataclass(frozen=True, kw_only=True, repr=False)
class Layer(Table):
    """A layer of a body.

    `thickness` in m; `material` as of a half-space, with `poisson` instead of its own where given; `interface` to what lies
    below: "bonded", or "slip" (it slides without friction).
    """

    thickness: float
    material: Material
    poisson: float | None = None
    interface: Interface = "bonded"

    def __post_init__(self) -> None:
        super().__post_init__()
        if isinstance(self.material, Fit):
            made = self.material.material if self.poisson is None else self.material.with_body(poisson=self.poisson)
            object.__setattr__(self, "material", made)
        if not isinstance(self.material, Material):
            raise CaseError(f"material of a layer is {self.material!r}, but must be a material, such as asperity.Elastic(...)")
        check_length("thickness of a layer", self.thickness)

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of a `[[body.layer]]`."""
        whole = self.material._keys
        lateral = {key: value for key, value in whole.items() if key in ("poisson", "bulk_modulus") and self.poisson is None}
        return {**super()._keys, **lateral, "material": whole["material"]}


@dataclass(frozen=True, kw_only=True, repr=False)
class Body(Table):
    """A body of layers.

    `layers` from the surface down, on a `base`: "rigid", or the material of a half-space. `hardness` [Pa] cuts off the pressure
    on the surface. Layers (and the base, and a second body) may creep differently (docs/layers.md).

    >>> import asperity as asp
    >>> gel = asp.Elastic(young=10e3, poisson=0.49)
    >>> sample = asp.Body(layers=[asp.Layer(thickness=5e-6, material=gel)], base="rigid")
    >>> sphere = asp.Surface.sphere(cells=(64, 64), size=(8e-6, 8e-6), radius=10e-6)
    >>> thin, thick = (asp.solve(sphere, body, approach=0.2e-6, times=[1.0]).load[-1] for body in (sample, gel))
    >>> bool(1.3 < thin / thick < 1.6)                         # the glass below stiffens the gel
    True
    """

    layers: Sequence[Layer]
    base: Material | str = "rigid"
    hardness: float | None = None
    name: str | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "layers", tuple(self.layers))
        if not self.layers or not all(isinstance(layer, Layer) for layer in self.layers):
            raise CaseError("layers is a list of asperity.Layer, one at least, from the surface down")
        if isinstance(self.base, Fit):
            object.__setattr__(self, "base", self.base.material)
        if not isinstance(self.base, Material) and self.base != "rigid":
            raise CaseError(f"base is {self.base!r}, but must be 'rigid', or the material of the half-space below")

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of a `[[body]]`."""
        layers = {"layer": [layer._keys for layer in self.layers]}
        base = {key: value for key, value in self.base._keys.items() if key not in ("name", "hardness")} if isinstance(self.base, Material) else {"base": "rigid"}
        hardness = {"hardness": self.layers[0].material.hardness} if self.layers[0].material.hardness is not None else {}
        own = {key: value for key, value in super()._keys.items() if key in ("name", "hardness")}
        return {**base, **layers, **hardness, **own}


def materials_of(body: Material | Body) -> list[Material]:
    """The materials of a body, those of its layers first."""
    if isinstance(body, Material):
        return [body]
    base = [body.base] if isinstance(body.base, Material) else []
    return [*(layer.material for layer in body.layers), *base]


def layer_compliance(q: ArrayLike, body: Material | Body, *, time: float = 0.0) -> Floats:
    """C(q) [m/Pa]: the displacement of the surface under a wave of pressure of unit amplitude.

    `q` are wave numbers [rad/m], of any shape; with a `time` [s] after 0 the pressure is held since 0. The half-space that
    yields as much has the contact modulus 2/(q C).

    >>> import asperity as asp
    >>> rubber = asp.Elastic(shear=1e6, poisson=0.5)
    >>> gasket = asp.Body(layers=[asp.Layer(thickness=2e-3, material=rubber)])
    >>> q = 50.0                                                # long waves: d^3 q^2/(3 G)
    >>> round(float(asp.layer_compliance(q, gasket) / (2e-3**3 * q**2 / 3e6)), 2)
    0.98
    """
    if not isinstance(body, (Material, Body)):
        raise CaseError(f"body is {body!r}, but must be an asperity.Body or a material")
    keys, instant = {"body": [body._keys]}, number("time", time)

    def compliance(waves: Floats) -> Floats:
        if not (np.isfinite(waves) & (waves > 0.0)).all():
            raise CaseError("wave numbers must be finite and greater than 0 rad/m")
        return _core.layer_compliance(waves, keys, instant)

    return each(compliance, "wave numbers", q)
