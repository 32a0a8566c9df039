"""Contact of rough, linear viscoelastic bodies.

``asp.open`` opens a result; ``from asperity import *`` leaves it out, so that it hides no builtin.

Quantities are SI floats, arrays are numpy float64 with axes (x, y); pressure is positive in compression and the
approach is zero at first touch.

>>> import asperity as asp
>>> sphere = asp.Surface.sphere(cells=(64, 64), size=(2e-3, 2e-3), radius=10e-3)
>>> rubber = asp.Zener(shear=25e6, shear_kelvin=25e6, retardation_time=1.0, poisson=0.5)
>>> result = asp.solve(sphere, rubber, load=asp.step(1.0), times=asp.uniform(10.0, 10))
>>> growth = result.approach[-1] / result.approach[0]      # C(t)^(2/3): doubles the compliance
>>> bool(abs(growth / 2 ** (2 / 3) - 1) < 1e-3)
True
"""

from typing import TYPE_CHECKING

from . import compat as compat
from ._arrays import meant
from ._adhesion import Adhesion as Adhesion
from ._flash import Flash as Flash
from ._fluid import Fluid as Fluid
from ._core import CaseError as CaseError, ConvergenceError as ConvergenceError, __version__ as __version__
from ._cite import cite as cite
from ._contact import (
    ConvergenceHistory as ConvergenceHistory,
    ElasticContact as ElasticContact,
    ElasticCurve as ElasticCurve,
    elastic as elastic,
)
from ._converge import ErrorBar as ErrorBar, converge as converge
from ._findings import Finding as Finding, ResultWarning as ResultWarning
from ._fit import CreepFunction as CreepFunction, Fit as Fit, Relaxation as Relaxation, fit_creep as fit_creep, fit_dma as fit_dma, fit_file as fit_file, fit_relaxation as fit_relaxation
from ._force_curves import ForceCurve as ForceCurve, ForceFit as ForceFit
from ._force_files import read_force_curves as read_force_curves
from ._force_maps import ForceMap as ForceMap, fit_force_map as fit_force_map
from ._histories import *
from ._indentation import IndentationFit as IndentationFit, PowerLawFit as PowerLawFit, fit_indentation as fit_indentation
from ._leakage import Leakage as Leakage, leakage as leakage
from ._layers import Body as Body, Layer as Layer, layer_compliance as layer_compliance
from ._materials import *
from ._motion import rubber_friction as rubber_friction, slide as slide, steady as steady
from ._persson import Magnification as Magnification, PerssonFriction as PerssonFriction, persson_friction as persson_friction
from ._result import Cycle as Cycle, Result as Result, open as open
from ._seal import Seal as Seal, Spread as Spread, seal as seal
from ._segments import Segment as Segment
from ._shifts import Shift as Shift, arrhenius as arrhenius, shift_table as shift_table, wlf as wlf
from ._solve import March as March, Step as Step, check as check, march as march, run as run, solve as solve
from ._stress import Stress as Stress, stress as stress
from ._study import study as study
from ._surface import Autocorrelation as Autocorrelation, Surface as Surface
from ._tangential import Friction as Friction, Tangential as Tangential, tangential as tangential
from ._wear import Wear as Wear
from ._threads import set_threads as set_threads, threads as threads

if not TYPE_CHECKING:  # where it would hide misspelt names

    def __getattr__(name):
        near = "" if name.startswith("_") else meant(name, [*__all__, "open", "plot", "compat"])
        raise AttributeError(f"module 'asperity' has no attribute {name!r}{near}")


__all__ = sorted(name for name in globals() if name == "__version__" or (name[0] != "_" and name not in ("open", "plot", "meant", "TYPE_CHECKING")))
