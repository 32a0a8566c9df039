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
Field = Literal["pressure", "gap", "displacement", "contact", "flattening"]
Quantity = Literal[
    "contact_stiffness",
    "contact_spots",
    "largest_spot",
    "mean_spot",
    "contact_perimeter",
    "contact_percolation",
    "gap_percolation",
    "rms_gap",
    "contact_eccentricity",
    "elastic_energy",
    "dissipated_energy",
    "flattening_work",
    "external_work",
    "load_power",
    "spot_histogram",
    "pressure_histogram",
    "gap_histogram",
    "velocity",
    "sliding_distance",
    "friction_force",
    "side_force",
    "friction_coefficient",
    "friction_coefficient_total",
    "friction_uncertainty",
    "rolling_moment",
    "dissipated_power",
]
