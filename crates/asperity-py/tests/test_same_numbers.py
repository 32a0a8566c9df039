"""The command, the library and numbers from Python are one path: the same case gives the same bits."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import asperity as asp

DOMAIN = {"cells": [24, 24], "size": [1e-3, 1e-3]}
PERIODIC = {**DOMAIN, "boundary": "periodic"}
SPHERE = {"kind": "sphere", "radius": 0.01}
ROUGH = {"kind": "self-affine", "hurst": 0.8, "rms_gradient": 0.05, "longest": 5e-4, "shortest": 1e-4, "seed": 3}
ZENER = {"model": "zener", "shear": 1e6, "shear_kelvin": 2e5, "retardation_time": 0.01}
PRONY = {"model": "prony", "modulus": "young", "equilibrium": 1973e6, "terms": [{"modulus": 254.776e6, "time": 8.93}, {"modulus": 263.6628e6, "time": 117.96}]}


def step(value):
    return {"kind": "step", "value": value}


def sphere():
    return asp.Surface.sphere(**DOMAIN, radius=0.01)


def rough():
    return asp.Surface.self_affine(**DOMAIN, **{key: value for key, value in ROUGH.items() if key != "kind"})


def zener():
    return asp.Zener(shear=1e6, shear_kelvin=2e5, retardation_time=0.01, poisson=0.5)


def prony():
    return asp.Prony(equilibrium=1973e6, terms=[(254.776e6, 8.93), (263.6628e6, 117.96)], poisson=0.38, hardness=300e6)


def layers():
    return asp.Body(layers=[asp.Layer(thickness=3e-4, material=zener())], base="rigid")


OUTPUT = {"fields": ["pressure"], "every": 1}
#: A case, and the same run from Python.
CASES = {
    "a step on a sphere": (
        {
            "domain": DOMAIN,
            "surface": [SPHERE],
            "body": [{"poisson": 0.5, "material": ZENER}],
            "load": {"control": "load", "history": step(1e-3)},
            "time": {"end": 0.05, "steps": 5},
        },
        lambda: asp.solve(sphere(), zener(), load=1e-3, times=asp.uniform(0.05, 5), every=1),
    ),
    "a rough, periodic contact under a pressure": (
        {
            "domain": PERIODIC,
            "surface": [ROUGH],
            "body": [{"poisson": 0.38, "hardness": 300e6, "material": PRONY}],
            "load": {"control": "pressure", "history": {"kind": "ramp", "value": 1e6, "duration": 1.0}},
            "time": {"end": 500.0, "steps": 6, "spacing": "log", "first": 0.1},
        },
        lambda: asp.solve(rough(), prony(), pressure=asp.ramp(1e6, duration=1.0), times=asp.log(500.0, 6, first=0.1), boundary="periodic", every=1),
    ),
    "a motion": (
        {
            "domain": PERIODIC,
            "surface": [ROUGH],
            "body": [{"poisson": 0.5, "material": ZENER}],
            "load": {"control": "pressure", "history": step(2e4)},
            "motion": {"velocity": 0.02},
            "time": {"end": 0.02, "steps": 4},
        },
        lambda: asp.slide(rough(), zener(), pressure=2e4, velocity=0.02, times=asp.uniform(0.02, 4), boundary="periodic", every=1),
    ),
    "a sweep over velocities": (
        {
            "domain": PERIODIC,
            "surface": [ROUGH],
            "body": [{"poisson": 0.5, "material": ZENER}],
            "load": {"control": "pressure", "history": step(2e4)},
            "motion": {"steady": {"velocities": [1e-3, 1e-2, 1e-1]}},
        },
        lambda: asp.steady(rough(), zener(), pressure=2e4, velocities=[1e-3, 1e-2, 1e-1], boundary="periodic", every=1),
    ),
    "layers": (
        {
            "domain": DOMAIN,
            "surface": [SPHERE],
            "body": [{"base": "rigid", "layer": [{"thickness": 3e-4, "poisson": 0.5, "material": ZENER}]}],
            "load": {"control": "approach", "history": {"kind": "table", "points": [[0.0, 0.0], [0.01, 1e-6], [0.04, 1.1e-6]]}},
            "time": {"times": [0.005, 0.02, 0.04]},
        },
        lambda: asp.solve(sphere(), layers(), approach=asp.table([(0.0, 0.0), (0.01, 1e-6), (0.04, 1.1e-6)]), times=[0.005, 0.02, 0.04], every=1),
    ),
}


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(one)}" for key, one in value.items()) + " }"
    return "[" + ", ".join(map(toml, value)) + "]" if isinstance(value, list) else json.dumps(value)


@pytest.mark.filterwarnings("ignore::asperity.ResultWarning")
@pytest.mark.parametrize("name", CASES)
def test_the_same_bits_from_the_command_the_library_and_python(name, tmp_path):
    keys, from_python = CASES[name]
    keys = {**keys, "output": OUTPUT}
    (tmp_path / "case.toml").write_text("".join(f"{key} = {toml(value)}\n" for key, value in keys.items()))
    command = [os.environ["ASPERITY_COMMAND"]] if "ASPERITY_COMMAND" in os.environ else [sys.executable, "-m", "asperity"]
    subprocess.run([*command, "run", "--quiet", "-o", tmp_path / "command.zarr", tmp_path / "case.toml"], check=True)
    first = asp.open(tmp_path / "command.zarr")
    for other in (asp.run(keys, output=tmp_path / "library.zarr", progress=False), from_python()):
        for column in [name for name in dir(first) if name in asp._columns.ROW or name in asp._columns.QUANTITIES]:
            assert np.array_equal(getattr(first, column), getattr(other, column), equal_nan=True), column
        assert np.array_equal(first.field_times, other.field_times) if "time" in dir(first) else True
        for index in range(len(first)):
            assert np.array_equal(first.field("pressure", index=index), other.field("pressure", index=index))
