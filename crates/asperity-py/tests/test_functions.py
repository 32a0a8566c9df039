"""Histories and materials from functions of time."""

import json
import math
import pickle

import numpy as np
import pytest

import asperity as asp

BALL = asp.Surface.sphere(cells=(24, 24), size=(1e-3, 1e-3), radius=20e-3)
ZENER = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)


def solve(**given):
    return asp.solve(BALL, ZENER, fields=[], **given)


def haversine(t):
    return 1e-3 * math.sin(t) ** 2


def test_steps_that_are_short_enough_stay_as_they_are_and_have_the_values_of_the_function():
    result = solve(load=haversine, times=asp.uniform(3.0, 100))
    # No step was added: a chord of 0.03 s is off by 0.03^2/8 x 2 = 2.3e-4 of the largest value, 1 mN.
    assert len(result) == 101
    # A prescribed load is held to rounding.
    assert np.allclose(result.load, [haversine(t) for t in result.time], rtol=1e-12, atol=1e-18)
    told = json.loads(result.attributes["setup"])["sampled"]["load"]
    assert told["points"] == 101 and 0.5 * 2.3e-7 < told["error"] < 2.3e-7


@pytest.mark.parametrize("times", [asp.uniform(3.0, 4), asp.log(3.0, 5, first=1e-3), asp.listed([1.0, 3.0]), asp.adaptive(3.0, tolerance=1e-2)])
def test_steps_that_are_too_long_are_halved_until_the_table_is_close(times):
    result = solve(load=haversine, times=times)
    dense = np.linspace(0.0, 3.0, 20001)
    error = np.abs(np.interp(dense, result.time, result.load) - 1e-3 * np.sin(dense) ** 2).max()
    # A thousandth of the largest value at the quarters of each step: a parabola is highest at its middle, a cubic no more than 1.15
    # times as high elsewhere.
    assert error < 1.15e-6
    # Steps of (8e-3/2)^(1/2) = 0.063 s hold a thousandth, so that 3 s need 48 at least, and halving takes twice as many at most.
    assert 30 < len(result) < 110 or times.kind == "adaptive"


def test_jumps_and_kinks_are_breaks():
    result = solve(pressure=lambda t: 1e3 if t < 1.0 else 2e3, times=asp.uniform(3.0, 4), breaks=[1.0])
    assert result.time.tolist() == [0.0, 0.75, 1.0, 1.0, 1.5, 2.25, 3.0]
    assert np.allclose(result.mean_pressure, [1e3, 1e3, 1e3, 2e3, 2e3, 2e3, 2e3], rtol=1e-12, atol=0)
    # The same where the function has its new value only after the jump, and where it jumps at the start.
    late = solve(pressure=lambda t: 0.0 if t == 0 else 1e3 if t <= 1.0 else 2e3, times=asp.uniform(3.0, 4), breaks=[1.0])
    assert np.array_equal(late.mean_pressure, result.mean_pressure) and np.array_equal(late.time, result.time)
    table = solve(pressure=asp.table([(0, 1e3), (1, 1e3), (1, 2e3), (3, 2e3)]), times=asp.uniform(3.0, 4))
    # The solver's tolerance: a table with fewer points has other starts of its solves.
    assert np.allclose(table.approach, result.approach, rtol=1e-5, atol=0)
    kinked = solve(load=lambda t: 1e-3 * min(t, 1.0), times=[0.9, 3.0], breaks=[1.0])
    assert kinked.time.tolist() == [0.0, 0.9, 1.0, 3.0]
    with pytest.raises(asp.CaseError, match=r"pressure goes from 1000 to 2000 between .* breaks=\["):
        solve(pressure=lambda t: 1e3 if t < 1.0 else 2e3, times=asp.uniform(3.0, 4))


def test_a_history_is_sampled_for_stages_motion_and_other_uses():
    swing = asp.sampled(lambda t: 1e-3 * math.cos(t), end=1.5, tolerance=1e-2)
    dense = np.linspace(0.0, 1.5, 10001)
    error = np.abs(np.interp(dense, *zip(*swing.points)) - 1e-3 * np.cos(dense)).max()
    # Looked at in other places, the parabolas of the error are the same.
    assert 0.99 * swing.error < error < 1.15e-5 and swing.end == 1.5 and len(swing.points) == 65
    assert pickle.loads(pickle.dumps(swing)) == swing
    staged = solve(stages=[asp.Stage(load=swing, duration=1.0), asp.Stage(approach=asp.hold())], times=asp.uniform(2.0, 10))
    assert staged.load[staged.stage == 0][-1] == pytest.approx(1e-3 * math.cos(1.0), rel=1e-4)
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, math.inf))
    moved = asp.slide(wave, ZENER, pressure=20e3, velocity=lambda t: 1e-3 * t, times=[0.25, 0.5], boundary="periodic", fields=[])
    # The distance of a velocity that grows evenly, exact in a table.
    assert moved.sliding_distance[-1] == pytest.approx(0.5e-3 * 0.25, rel=1e-9)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (dict(load=lambda t: math.nan), "load is nan at 0 s"),
        (dict(load=lambda t: "1 N"), "load at 0 s is '1 N'"),
        (dict(load=lambda t: 1e-3, breaks=[5.0]), "breaks holds 5 s, but must hold times between 0 s and the end, 3 s"),
        (dict(load=asp.step(1e-3), breaks=[1.0]), "breaks goes with a load that is a function"),
        (dict(load=lambda t: -1e-3 * t), "must be a force not less than 0"),
        (dict(stages=[asp.Stage(load=haversine, duration=1.0)]), r"load=asperity.sampled\(function, end=...\)"),
    ],
)
def test_functions_that_cannot_be_are_refused(given, words):
    with pytest.raises(asp.CaseError, match=words):
        solve(**given, times=asp.uniform(3.0, 4))


def test_a_function_is_no_load_of_a_steady_state_or_between_rows():
    with pytest.raises(asp.CaseError, match="sampled"):
        asp.steady(BALL, ZENER, load=haversine, velocities=[1e-3])
    run = asp.march(BALL, ZENER, load=1e-3, times=[1.0, 2.0])
    next(run)
    with pytest.raises(asp.CaseError, match="sampled"):
        run.prescribe(load=haversine)
    with pytest.raises(asp.CaseError, match="end is 0.0 s"):
        asp.sampled(haversine, end=0.0)
    with pytest.raises(asp.CaseError, match="must be a function"):
        asp.sampled(1.0, end=1.0)


def test_any_relaxation_or_creep_function_becomes_a_material():
    def stretched(t):
        return 1e6 + 9e6 * math.exp(-math.sqrt(t / 2.0))

    material = asp.Relaxation(stretched, window=(1e-3, 1e3), poisson=0.4, hardness=1e8, name="glass")
    dense = np.geomspace(1e-3, 1e3, 777)
    misfit = np.abs(material.relaxation(dense) / [stretched(t) for t in dense] - 1).max()
    # Twenty points to a decade show the misfit of three terms to a decade: between them it is a little larger only.
    assert material.fit.max_misfit <= misfit * 1.01 and misfit < 1.2 * material.fit.max_misfit < 1e-3
    assert isinstance(material, asp.Prony) and material.window == (1e-3, 1e3) and (material.hardness, material.name) == (1e8, "glass")
    assert pickle.loads(pickle.dumps(material)).fit.max_misfit == material.fit.max_misfit
    shear = asp.Relaxation(stretched, window=(1e-3, 1e3), modulus="shear", poisson=0.5)
    assert float(shear.relaxation(2.0, measure="young")) == pytest.approx(3 * stretched(2.0), rel=1e-3)

    andrade = asp.CreepFunction(lambda t: 1e-9 * (1 + 0.3 * t ** (1 / 3)), window=(1e-2, 1e4), poisson=0.3)
    assert isinstance(andrade, asp.Creep) and andrade.fit.max_misfit < 1e-4
    # Under a constant load the contact is the elastic one of the compliance (1 - nu^2) D(t), to the solver's tolerance and the misfit.
    result = asp.solve(BALL, andrade, load=1.0, times=[8.0, 1000.0], fields=[])
    for row, compliance in [(1, 1.6e-9), (2, 4.0e-9)]:
        elastic = asp.elastic(BALL, 1 / ((1 - 0.3**2) * compliance), load=1.0)
        assert result.approach[row] == pytest.approx(elastic.approach, rel=2e-4)
    # A run beyond the window says so, as after a fit to data.
    late = asp.solve(BALL, andrade, load=1.0, times=[1e6], fields=[])
    assert "beyond-material-data" in [finding.code for finding in late.findings]
    assert ZENER.fit is None


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: asp.Relaxation(lambda t: 1e6 * (1 + t), window=(1e-3, 1e2), poisson=0.5), "does not rise"),
        (lambda: asp.Relaxation(lambda t: 1e6 if t < 1 else 5e5, window=(1e-3, 1e2), poisson=0.5), "within 1 % of a passive material"),
        (lambda: asp.Relaxation(lambda t: 1e6 / t**0.7, window=(1e-3, 1e3), poisson=0.5, max_misfit=1e-3), "within 0.1 % of a passive"),
        (lambda: asp.CreepFunction(lambda t: 1e-6 * t**1.5, window=(1e-3, 1e2), poisson=0.5), "passive material"),
        (lambda: asp.CreepFunction(lambda t: 1e-6, window=(1.0, 0.1), poisson=0.5), "window"),
        (lambda: asp.Relaxation([1.0, 2.0], window=(1.0, 2.0), poisson=0.5), "asperity.fit_relaxation"),
        (lambda: asp.Relaxation(lambda t: 1e6, window=(1.0, 2.0)), "poisson"),
    ],
)
def test_functions_of_no_passive_material_are_refused(make, words):
    with pytest.raises(asp.CaseError, match=words):
        make()


def test_labelled_values_are_a_table_of_their_times():
    xr = pytest.importorskip("xarray")
    minutes = ("time", [0.0, 1.0, 2.0], {"units": "min"})
    measured = xr.DataArray([0.0, 1.0, 2.0], dims="time", coords={"time": minutes}, attrs={"units": "mN"})
    expected = asp.table([(0.0, 0.0), (60.0, 1e-3), (120.0, 2e-3)])
    assert repr(asp.table(measured)) == repr(expected)
    found = asp.solve(BALL, asp.Elastic(young=1e6, poisson=0.5), load=measured, times=[30.0, 120.0], fields=[])
    assert found.load == pytest.approx([0.0, 0.5e-3, 1e-3, 2e-3])
    with pytest.raises(asp.CaseError, match="load is a history in|must be in m"):
        asp.solve(BALL, asp.Elastic(young=1e6, poisson=0.5), approach=measured, times=[30.0, 120.0])
    with pytest.raises(asp.CaseError, match="no times"):
        asp.table(xr.DataArray([0.0, 1.0]))
    pd = pytest.importorskip("pandas")
    assert asp.table(pd.Series([0.0, 1e-3, 2e-3], index=[0.0, 60.0, 120.0])) == expected
    with pytest.raises(asp.CaseError, match="datetime"):
        asp.table(pd.Series([0.0, 1e-3], index=pd.to_datetime(["2020-01-01", "2020-01-02"])))
    with pytest.raises(asp.CaseError, match="pairs of numbers"):
        asp.table(pd.DataFrame(np.zeros((2, 3))))
