"""Whole seals: the numbers of the command, and what one patch says of many in series."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import asperity as asp
from asperity._given import change

#: Valleys along the flow on a body of E* = 1 MPa: the pressure 31.4 kPa closes them.
CASE = {
    "domain": {"cells": [2, 64], "size": ["0.3125 um", "10 um"], "boundary": "periodic"},
    "surface": [{"kind": "wave", "amplitude": "0.1 um", "wavelength": ["inf", "10 um"]}],
    "body": [{"poisson": 0.5, "material": {"model": "elastic", "young": "0.75 MPa"}}],
    "load": {"control": "pressure", "history": {"kind": "step", "value": "10 kPa"}},
    "time": {"end": "1 s", "steps": 1},
    "solver": {"tolerance": 1e-9},
    "leakage": {"pressure_drop": "10 kPa", "viscosity": "1 mPa s"},
    "seal": {"profile": "hertz", "peak": "20 kPa", "width": "1 mm", "length": "0.1 m", "pressures": 8},
}


def test_a_seal_has_the_numbers_of_the_command(tmp_path):
    pytest.importorskip("xarray")
    seal = asp.seal(CASE, directory=tmp_path / "seal", progress=False)
    words = [sys.executable, "-m", "asperity", "seal", tmp_path / "seal" / "case.toml", "-o", tmp_path / "seal", "--json", "-q"]
    told = subprocess.run(words, capture_output=True, encoding="utf-8", timeout=120)
    assert seal.answer == json.loads(told.stdout)
    assert seal.leak == asp.Spread(**seal.answer["seal_leak"]) and seal.leak.least == seal.leak.mean > 0
    assert seal.usual == {"ml/year": asp.Spread(**seal.answer["seal_leak_ml_per_year"])}
    assert seal.leak_per_metre.mean == pytest.approx(10 * seal.leak.mean, rel=1e-14)  # rounding
    assert (seal.states, seal.inlet, seal.outlet) == (["leaks"], 10e3, 0)
    assert seal.fluid_pressure.shape == (1, seal.x.size) and (np.diff(seal.fluid_pressure) <= 0).all()
    assert "leaks" in repr(seal) and any(found.code == "seal-never-tight" for found in seal.findings)
    again = asp.seal(seal.methods().split("SI units:\n\n")[1], directory=tmp_path / "again", progress=False)
    assert again.answer == seal.answer
    data = seal.to_xarray()
    # A patch that is tight nowhere needs no pressures where it closes, a quarter of the eight; up to eight are added until the leak stands.
    assert 6 <= data.sizes["pressure"] <= 14 and dict(data.sizes, pressure=6) == {"inlet": 24, "time": 2, "x": 400, "seed": 1, "pressure": 6}
    low, high = seal.leak_bounds
    assert low <= seal.leak.mean <= high <= 1.1 * low
    assert seal.answers[0] == {"name": "seal_leak", "value": seal.leak.mean, "unit": "m3/s"}
    assert float(data.leak_time[-1]) == seal.leak.mean and data.leak_inlet.attrs["units"] == "m^3/s"
    # The conductance of valleys falls with the pressure, and the leak grows with the inlet pressure.
    assert (np.diff(data.conductance.isel(seed=0, time=-1)) < 0).all() and (np.diff(data.leak_inlet) > 0).all()
    with pytest.raises(AttributeError):
        seal.leak = 0.0


def test_another_length_and_pressure_take_the_same_runs_and_a_lifted_seal_has_no_number(tmp_path):
    seal = asp.seal(CASE, directory=tmp_path / "seal", progress=False)
    before = {run: os.stat(run / "zarr.json").st_mtime_ns for run in (tmp_path / "seal/sweep").glob("value-*.zarr")}
    twice = asp.seal(CASE, directory=tmp_path / "seal", set={"seal.length": "0.2 m", "leakage.viscosity": "2 mPa s"}, progress=False)
    assert twice.leak.mean == pytest.approx(seal.leak.mean, rel=1e-14)  # rounding
    wide = asp.seal(CASE, directory=tmp_path / "seal", set={"seal.width": "2 mm"}, progress=False)
    assert wide.leak.mean == pytest.approx(0.5 * seal.leak.mean, rel=1e-9)  # the march arrives within 1e-12 of the drop
    tenth = asp.seal(CASE, directory=tmp_path / "seal", set={"leakage.pressure_drop": "11 kPa"}, progress=False)
    # The sweep may have got further pressures for it.
    assert tenth.leak.mean == pytest.approx(seal.answer["leak_growth"] * seal.leak.mean, rel=0.05)
    with pytest.warns(asp.ResultWarning, match="lifts"):
        lifted = asp.seal(CASE, directory=tmp_path / "seal", set={"leakage.pressure_drop": "20 kPa"}, progress=False)
    assert lifted.answers[0]["why"] == "seal-lifted: the fluid lifts the seal" and lifted.answers[0]["valid"] is False
    assert lifted.states == ["lifted"] and np.isnan(lifted.leak.mean) and lifted.usual.keys() == {"ml/year"}
    assert before and before == {run: os.stat(run / "zarr.json").st_mtime_ns for run in before}


def test_what_is_wrong_is_told():
    with pytest.raises(asp.CaseError, match="directory="):
        asp.seal(CASE)
    with pytest.raises(FileNotFoundError, match="none.toml"):
        asp.seal("none.toml")


def test_one_patch_leaks_as_several_in_series_within_the_scatter_of_the_seeds():
    """A uniform pressure at the ends of each patch of a series can only raise the flow (Dirichlet's principle)."""
    size, cells = 1e-4, 128
    one, four = [], []
    for seed in (1, 2, 3, 4):
        surface = asp.Surface.self_affine(
            cells=(cells, cells), size=(size, size), hurst=0.8, longest=size / 4, shortest=size / 12, rms_gradient=0.1, seed=seed
        )
        contact = asp.elastic(surface, 1e7, pressure=0.1e6, boundary="periodic", tolerance=1e-7)
        for leaks, times in ((one, 1), (four, 4)):
            gap, touches = (np.tile(field, (times, 1)) for field in (contact.gap, contact.pressure > 0))
            leaks.append(asp.leakage(gap, contact=touches, size=(times * size, size), sides="periodic").hydraulic_gap ** 3)
    assert (np.array(four) <= np.array(one) * (1 + 1e-9)).all()
    assert abs(np.mean(four) / np.mean(one) - 1) < np.std(one, ddof=1) / np.mean(one)


def test_the_methods_of_a_seal_name_what_was_changed(tmp_path):
    pytest.importorskip("tomllib", reason="Python before 3.11 reads no TOML")
    short = {**CASE, "domain": {**CASE["domain"], "cells": [2, 16]}}
    changes = {"seal.length": "0.2 m", "solver.tolerance": 1e-7, "surface.0.amplitude": "0.12 um"}
    text = asp.seal(short, directory=tmp_path / "short", progress=False, set=changes).methods(bibtex=True)
    for words in (
        "a patch of 2 x 16 cells on 0.3125 um x 10 um",
        "a wave (amplitude 0.12 um, wavelength [inf, 10 um])",
        "has the profile hertz (length 0.2 m, peak 20 kPa, pressures 8, width 1 mm)",
        "body 1: young 0.75 MPa, Poisson's ratio 0.5",
        "pressure drop 10 kPa, viscosity 1 mPa s",
        "the liquid flows from 10 kPa to 0 Pa",
        'length = "0.2 m"',
        "tolerance = 0.0000001",
        "case in full",
        "@software",
    ):
        assert words in text, (words, text)


def test_changes_find_their_place_in_a_case():
    pytest.importorskip("tomllib", reason="Python before 3.11 reads no TOML")
    case = {"surface": [{"kind": "sphere"}], "load": {"control": "load"}, "title": "a"}
    words = ["surface[0].radius=1 mm", "surface.0.center=[0, 1]", "load.history.value=0.1", "time.end=2 s", "title.x=1", "surface.3.radius=1 mm"]
    assert change(case, words) == ["title.x=1", "surface.3.radius=1 mm"]
    assert case == {
        "surface": [{"kind": "sphere", "radius": "1 mm", "center": [0, 1]}],
        "load": {"control": "load", "history": {"value": 0.1}}, "time": {"end": "2 s"}, "title": "a",
    }
