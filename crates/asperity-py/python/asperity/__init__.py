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

from . import compat
from ._core import CaseError, ConvergenceError, __version__
from ._cite import cite
from ._contact import ConvergenceHistory, ElasticContact, ElasticCurve, elastic
from ._findings import Finding, ResultWarning
from ._fit import Fit, fit_creep, fit_dma, fit_file, fit_relaxation
from ._histories import (
    History,
    Stage,
    Times,
    adaptive,
    hold,
    listed,
    log,
    ramp,
    ramp_to,
    sine,
    step,
    table,
    trapezoid,
    triangle,
    uniform,
)
from ._indentation import IndentationFit, fit_indentation
from ._leakage import Leakage, leakage
from ._layers import Body, Layer, layer_compliance
from ._materials import (
    Burgers,
    Creep,
    Elastic,
    FractionalMaxwell,
    FractionalZener,
    KelvinVoigt,
    Material,
    Maxwell,
    Prony,
    Springpot,
    Zener,
)
from ._motion import rubber_friction, slide, steady
from ._persson import Magnification, PerssonFriction, persson_friction
from ._result import Cycle, Result, open as open
from ._shifts import Shift, arrhenius, shift_table, wlf
from ._solve import March, Step, check, march, run, solve
from ._stress import Stress, stress
from ._study import study
from ._surface import Autocorrelation, Surface
from ._threads import set_threads, threads

__all__ = [
    "Autocorrelation",
    "Body",
    "Burgers",
    "CaseError",
    "ConvergenceError",
    "ConvergenceHistory",
    "Creep",
    "Cycle",
    "Elastic",
    "ElasticContact",
    "ElasticCurve",
    "Finding",
    "Fit",
    "FractionalMaxwell",
    "FractionalZener",
    "History",
    "IndentationFit",
    "KelvinVoigt",
    "Leakage",
    "Layer",
    "Magnification",
    "March",
    "Material",
    "Maxwell",
    "PerssonFriction",
    "Prony",
    "Result",
    "ResultWarning",
    "Shift",
    "Springpot",
    "Stage",
    "Step",
    "Stress",
    "Surface",
    "Times",
    "Zener",
    "__version__",
    "adaptive",
    "arrhenius",
    "check",
    "cite",
    "compat",
    "elastic",
    "fit_creep",
    "fit_dma",
    "fit_file",
    "fit_indentation",
    "fit_relaxation",
    "hold",
    "leakage",
    "layer_compliance",
    "listed",
    "log",
    "march",
    "persson_friction",
    "rubber_friction",
    "slide",
    "steady",
    "ramp",
    "ramp_to",
    "run",
    "set_threads",
    "shift_table",
    "sine",
    "solve",
    "step",
    "stress",
    "study",
    "table",
    "threads",
    "trapezoid",
    "triangle",
    "uniform",
    "wlf",
]
