"""Errors of calls, as those of their cases."""

from __future__ import annotations

import numpy as np
import pytest

import asperity as asp

SIZE = (1e-3, 1e-3)
BALL = asp.Surface.sphere(cells=(32, 32), size=SIZE, radius=10e-3)
RUBBER = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)


def named(bars: list[asp.ErrorBar]) -> dict[str, asp.ErrorBar]:
    return {bar["name"]: bar for bar in bars}


def test_a_result_its_arguments_and_its_case_have_the_same_errors() -> None:
    arguments = dict(surface=BALL, material=RUBBER, load=10e-3, times=asp.uniform(1.0, 20))
    of_result, of_arguments = asp.converge(asp.solve(**arguments)), asp.converge(arguments)
    case = {
        "domain": {"cells": [32, 32], "size": ["1 mm", "1 mm"]},
        "surface": [{"kind": "sphere", "radius": "10 mm"}],
        "body": [{"poisson": 0.5, "material": {"model": "zener", "shear": "1 MPa", "shear_kelvin": "1 MPa", "retardation_time": "1 s"}}],
        "load": {"control": "load", "history": {"kind": "step", "value": "10 mN"}},
        "time": {"end": "1 s", "steps": 20},
    }
    expected = named(asp.converge(case))
    for found in (named(of_result), named(of_arguments)):
        assert found["approach"]["error"] == expected["approach"]["error"] and found["contact_area"]["value"] == expected["contact_area"]["value"]
    assert expected["approach"]["time"] > 0.0


def test_heights_as_an_array_are_resampled() -> None:
    # Of a wave that all grids hold the resampled heights are those of its formula.
    wave = asp.Surface.wave(cells=(32, 32), size=SIZE, amplitude=1e-6, wavelength=(1e-3, 1e-3))
    arguments = dict(material=asp.Elastic(young=3e6, poisson=0.5), pressure=1e4, times=[1.0], boundary="periodic")
    shape = named(asp.converge(asp.solve(wave, **arguments)))["contact_area"]
    array = named(asp.converge(asp.solve(np.array(wave.heights), size=SIZE, **arguments)))["contact_area"]
    assert array["value"] == pytest.approx(shape["value"], rel=1e-12) and array["grid"] == pytest.approx(shape["grid"], rel=1e-6)


def test_a_sweep_over_velocities_has_errors() -> None:
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    swept = asp.steady(wave, RUBBER, pressure=2e4, velocities=[1e-4, 1e-3, 1e-2], boundary="periodic")
    bars = named(asp.converge(swept))
    assert bars["friction_coefficient"]["error"] is not None, bars


def test_what_cannot_be_refined_is_refused() -> None:
    hard = asp.elastic(BALL, 4e6, load=1e-3, hardness=np.full((32, 32), 1e6))
    with pytest.raises(asp.CaseError, match="hardness is an array over the cells"):
        asp.converge(hard)
    march = asp.march(BALL, RUBBER, load=1e-3, times=[1.0, 2.0])
    next(march)
    march.prescribe(load=asp.ramp_to(2e-3, duration=0.5))
    with pytest.raises(asp.CaseError, match="between the rows of a march"):
        asp.converge(march.result())


def test_a_profile_as_an_array_is_resampled_too() -> None:
    x = (np.arange(64) + 0.5) / 64
    profile = asp.Surface(-1e-6 * np.cos(2 * np.pi * x), size=1e-3)
    bars = named(asp.converge(asp.elastic(profile, 4e6, pressure=1e4, boundary="periodic")))
    # Westergaard: mean pressure over that of full contact, pi E* d/L, is the square of the sine of half the contact.
    exact = 2 / np.pi * np.arcsin(np.sqrt(1e4 / (np.pi * 4e6 * 1e-6 / 1e-3))) * 1e-3
    assert abs(bars["contact_area"]["value"] - exact) < bars["contact_area"]["error"]


def test_what_is_no_single_case_is_named() -> None:
    with pytest.raises(asp.CaseError, match=r"ElasticCurve: give it one of its contacts"):
        asp.converge(asp.elastic(BALL, 4e6, load=[1e-3, 2e-3]))
    with pytest.raises(asp.CaseError, match=r"March: give it its result\(\)"):
        asp.converge(asp.march(BALL, RUBBER, load=1e-3, times=[1.0]))
    with pytest.raises(TypeError, match="no argument 'laod'; did you mean 'load'"):
        asp.converge(dict(surface=BALL, material=RUBBER, laod=1e-3, times=[1.0]))
