"""The words that parameters take."""

from __future__ import annotations

from typing import Literal

Boundary = Literal["free", "periodic"]
Method = Literal["projected-cg", "polonsky-keer"]
Scheme = Literal["linear", "constant", "direct"]
Plasticity = Literal["cap", "accumulate"]
Measure = Literal["young", "shear"]
Moduli = Literal["both", "storage", "loss"]
LongTime = Literal["free", "solid", "fluid"]
Vertical = Literal["density", "free"]
Flow = Literal["x", "y", "both"]
Sides = Literal["periodic", "closed"]
Axis = Literal["x", "y"]
Fill = Literal["harmonic", "nearest"]
Edge = Literal["sharp", "gaussian"]
Window = Literal["hann", "tukey"]
Resampling = Literal["band-limited", "bilinear"]
Interface = Literal["bonded", "slip"]
Correction = Literal["yang-persson", "none"]
Movement = Literal["slide", "roll"]
Form = Literal["mean", "plane", "quadratic", "none"]
Coupling = Literal["uniform", "two-way"]
Pockets = Literal["kept", "drained", "sealed", "connected"]
Reference = Literal["outlet", "vacuum"]
AdhesionLaw = Literal["exponential", "dugdale", "linear", "van-der-waals"]
