"""Contacts that slide and roll."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import asperity as asp


def parabola(cells: int, length: float, radius: float) -> asp.Surface:
    x = (np.arange(cells) + 0.5) * length / cells - 0.5 * length
    return asp.Surface(-(x**2) / (2 * radius), size=length)


def zener(k: float) -> asp.Zener:
    # Contact compliance 1/k at once and 1 relaxed, retardation time 1: E* = 4 G for an incompressible body.
    return asp.Zener(shear=0.25 * k, shear_kelvin=0.25 / (1 - 1 / k), retardation_time=1.0, poisson=0.5)


# Hunter 1961: (k, v lambda / relaxed half-width, friction coefficient, half-width).
@pytest.mark.parametrize(("k", "v", "mu", "half"), [(2, 1.0, 0.19684337986, 0.803402693617), (10, 1.0, 0.463905752676, 0.600918754559)])
def test_a_rolling_cylinder_loses_what_hunter_says(k: float, v: float, mu: float, half: float) -> None:
    result = asp.steady(parabola(400, 3.0, 1.0), zener(k), load=0.25 * np.pi, velocities=[v], kind="roll", tolerance=1e-8)
    # 50 to 100 cells to the half-width.
    assert result.friction_coefficient[0] == pytest.approx(mu, rel=5e-4)
    assert result.contact_area[0] == pytest.approx(2 * half, abs=2 * 3.0 / 400)
    assert result.dissipated_power[0] == pytest.approx(result.friction_force[0] * v, rel=1e-2)
    assert result.units("friction_force") == "N/m" and result.is_sweep


def test_a_sweep_has_velocities_in_place_of_times() -> None:
    result = asp.steady(parabola(64, 3.0, 1.0), zener(4), load=0.2, velocities=[1.0, 0.1, 10.0], fields=["pressure", "gap"])
    assert result.velocity.tolist() == [0.1, 1.0, 10.0]
    assert result.field_velocities.tolist() == [0.1, 1.0, 10.0]
    with pytest.raises(AttributeError, match="velocity"):
        result.time
    assert result.field("pressure", velocity=0.9, method="nearest").shape == (64,)
    with pytest.raises(asp.CaseError, match="velocity="):
        result.field("pressure", time=1.0)
    data = result.to_xarray()
    assert data.friction_coefficient.dims == ("velocity",) and data.pressure.dims == ("field_velocity", "x")
    assert "v = 10 m/s" in repr(result)


def test_a_case_file_gives_the_same_numbers(tmp_path: object) -> None:
    case = {
        "domain": {"cells": [32, 24], "size": ["1 mm", "0.75 mm"], "boundary": "periodic"},
        "surface": [{"kind": "wave", "amplitude": "1 um", "wavelength": ["1 mm", "0.75 mm"]}],
        "body": [{"poisson": 0.5, "material": {"model": "zener", "shear": "1 MPa", "shear_kelvin": "0.2 MPa", "retardation_time": "10 ms"}}],
        "load": {"control": "pressure", "history": {"kind": "step", "value": "2 kPa"}},
        "motion": {"shear_stress": "1 kPa", "steady": {"velocities": ["1 mm/s", "100 mm/s"]}},
    }
    stored = asp.run(case, output=f"{tmp_path}/sweep.zarr")
    wave = asp.Surface.wave(cells=(32, 24), size=(1e-3, 0.75e-3), amplitude=1e-6, wavelength=(1e-3, 0.75e-3))
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    here = asp.steady(wave, rubber, pressure=2e3, velocities=[1e-3, 0.1], boundary="periodic", shear_stress=1e3)
    assert stored.is_sweep and stored.velocity.tolist() == [1e-3, 0.1]
    # The wave is evaluated as a shape there, and is a field of heights here.
    np.testing.assert_allclose(stored.friction_coefficient, here.friction_coefficient, rtol=1e-5)
    np.testing.assert_allclose(asp.rubber_friction(here, shear_stress=1e3), here.friction_coefficient_total, rtol=1e-12)
    assert stored.to_xarray().friction_force.dims == ("velocity",)


def test_a_shift_of_the_temperature_is_a_shift_of_the_velocity() -> None:
    rough = asp.Surface.self_affine(cells=(48, 48), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.1, longest=5e-4, shortest=1e-4, seed=1)
    terms = [(2e6, 10.0**k) for k in range(-6, 1)]
    rubber = asp.Prony(equilibrium=1e6, terms=terms, poisson=0.49, shift=asp.wlf(c1=8.86, c2=101.6, reference=293.15))
    factor = 10 ** (-8.86 * 20 / (101.6 + 20))

    def sweep(temperature: float, velocities: list[float]) -> asp.Result:
        return asp.steady(rough, rubber, pressure=1e5, velocities=velocities, boundary="periodic", temperature=temperature, tolerance=1e-9)

    cold, warm = sweep(293.15, [1e-3, 1e-2]), sweep(313.15, [1e-3 / factor, 1e-2 / factor])
    np.testing.assert_allclose(cold.friction_coefficient, warm.friction_coefficient, rtol=1e-6)


def test_sliding_starts_and_turns_back() -> None:
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    there = asp.table([(0.0, 0.05), (0.1, 0.05), (0.1001, -0.05), (0.2, -0.05)])
    result = asp.slide(wave, rubber, pressure=20e3, velocity=there, times=[0.2], start=0.05, boundary="periodic", fields=["pressure"])
    at = lambda t: int(np.argmin(np.abs(result.time - t)))  # noqa: E731
    assert result.friction_force[at(0.14)] > 0 > result.friction_force[at(0.19)]
    assert result.friction_force[at(0.04)] == pytest.approx(0.0, abs=1e-9 * result.load[0])
    assert (np.abs(np.diff(result.sliding_distance)) <= 1e-3 / 32 * (1 + 1e-9)).all()
    # In the frame of the contact the pressure stays by the crest.
    crest = result.field("pressure", time=0.1, method="nearest").argmax(axis=0)
    assert (np.abs(crest - 16) < 8).all()


def test_what_cannot_be_is_refused() -> None:
    rough = parabola(32, 3.0, 1.0)
    for message, options in {
        "velocity or path": {},
        "instantaneous compliance": {"velocities": [1.0]},
        "direction": {"velocity": 1.0, "direction": "z"},
    }.items():
        with pytest.raises(asp.CaseError, match=message):
            if "velocities" in options:
                asp.steady(rough, asp.KelvinVoigt(shear=1.0, retardation_time=1.0, poisson=0.5), load=0.1, **options)
            else:
                asp.slide(rough, zener(4), load=0.1, times=[1.0], **options)
    with pytest.raises(asp.CaseError, match="track"):
        asp.slide(rough, zener(4), load=0.1, times=[10.0], velocity=1.0)


def test_a_study_of_sweeps_is_a_master_curve():
    surface = asp.Surface.self_affine(
        cells=(24, 24), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.05, longest=5e-4, roll_off=5e-4, shortest=2e-4, seed=2
    )
    rubber = asp.Zener(shear=10e6, shear_kelvin=1e6, retardation_time=0.01, poisson=0.5, shift=asp.wlf(c1=8.86, c2=101.6, reference=293.15))
    given = dict(surface=surface, material=rubber, pressure=20e3, velocities=[1e-3, 1e-2, 1e-1], boundary="periodic")
    kelvin = [283.15, 293.15]
    data = asp.study(given, over={"temperature": kelvin}, workers=1)
    assert (data.status == "complete").all(), data.error.values
    assert data.velocity.dims == ("step",) and list(data.velocity.values) == [1e-3, 1e-2, 1e-1]
    assert data.velocity.attrs["units"] == "m/s" and "time" not in data.coords
    # A sweep at another temperature is the same sweep at velocities a_T times as high.
    factor = float(asp.wlf(c1=8.86, c2=101.6, reference=293.15).factor(283.15))
    shifted = asp.steady(**{**given, "velocities": [v * factor for v in given["velocities"]]}, temperature=293.15, progress=False)
    found = data.friction_coefficient.sel(temperature=283.15).values
    # The tolerance of the solver.
    assert np.allclose(found, shifted.friction_coefficient, rtol=1e-4)


def test_a_study_of_slides_runs_in_time():
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    given = dict(surface=wave, material=rubber, pressure=20e3, times=[0.01], boundary="periodic")
    data = asp.study(given, over={"velocity": [0.01, 0.05]}, workers=1)
    assert (data.status == "complete").all(), data.error.values
    travelled = data.sliding_distance.values[:, -1]
    last = [row[np.isfinite(row)][-1] for row in data.sliding_distance.values]
    assert np.allclose(last, [1e-4, 5e-4], rtol=1e-12), travelled


def test_a_sweep_takes_the_body_that_stands_still_relaxed() -> None:
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    track = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    slider = asp.Zener(shear=5e6, shear_kelvin=5e6, retardation_time=1.0, poisson=0.5)
    given = dict(pressure=20e3, velocities=[0.05], boundary="periodic")
    found = asp.steady(wave, (track, slider), **given)
    relaxed = asp.steady(wave, (track, asp.Elastic(shear=2.5e6, poisson=0.5)), **given)
    assert found.friction_coefficient[0] == pytest.approx(relaxed.friction_coefficient[0], rel=1e-9)
    with pytest.raises(asp.CaseError, match="motion"):
        asp.slide(wave, (track, slider), pressure=20e3, velocity=0.05, times=[0.01], boundary="periodic")


def test_a_single_shape_that_meets_its_own_track_is_told() -> None:
    # It travels round the domain of 1 mm in 0.01 s, and the body remembers it for 1 s.
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=1.0, poisson=0.5)
    ball = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=10e-3)
    rough = ball + asp.Surface.wave(cells=(32, 32), size=(1e-3, 1e-3), amplitude=1e-9, wavelength=(5e-4, 5e-4))
    for surface, told in [(ball, True), (rough, True), (2.0 * ball, True), (asp.Surface(rough.heights, size=rough.size), False)]:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", asp.ResultWarning)
            found = asp.steady(surface, rubber, load=1e-3, velocities=[0.1], boundary="periodic")
        assert ("own-track" in [finding["code"] for finding in found.findings]) is told


@pytest.mark.parametrize("angle", [30, -90.0, 7, np.int64(45)])
def test_degrees_are_no_radians(angle) -> None:
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    with pytest.raises(asp.CaseError, match=r"direction is .* rad, more than a whole turn: .* degrees are .* rad"):
        asp.steady(wave, zener(2.0), pressure=2e4, velocities=[0.01], boundary="periodic", direction=angle)


def test_a_sweep_has_stress_and_leak_of_each_velocity() -> None:
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    sweep = asp.steady(wave, asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5), pressure=2e3, velocities=[0.01, 0.1], boundary="periodic", fields=["pressure", "gap"])
    below = sweep.stress(velocity=0.01, depths=[1e-4])
    # A wave of pressure decays as (1 + q z) exp(-q z) with the depth.
    q = 2.0 * np.pi / 1e-3
    spectrum = np.fft.fft(sweep.field("pressure", velocity=0.01)[:, 0]) * (1 + q * 1e-4 * np.minimum(np.arange(32), 32 - np.arange(32)))
    spectrum *= np.exp(-q * 1e-4 * np.minimum(np.arange(32), 32 - np.arange(32)))
    exact = -np.fft.ifft(spectrum).real
    assert np.allclose(below.zz[0][:, 0], exact, rtol=0.0, atol=1e-9 * abs(exact).max())
    pytest.importorskip("xarray")
    whole = sweep.leakage(direction="y")
    one = sweep.leakage(direction="y", velocity=0.1)
    assert one.leak_velocity.values.tolist() == [0.1] and one.hydraulic_gap.item() == whole.hydraulic_gap.values[1]
    with pytest.raises(asp.CaseError, match="velocity= is for a sweep"):
        sweep.stress(time=1.0)
    for course in ([(1e-3, 1e3), (1.0, 1e4)], {"peak": 1e4}):
        with pytest.raises(asp.CaseError, match="shear_stress is one number"):
            asp.rubber_friction(sweep, shear_stress=course)


def test_the_stress_of_a_contact_in_motion_leaves_its_friction_out(recwarn) -> None:
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    given = dict(pressure=2e4, velocities=[0.01], boundary="periodic")
    bare = asp.steady(wave, rubber, **given)
    recwarn.clear()
    plain = bare.stress(depths=[1e-5])
    assert not recwarn.list
    rubbed = asp.steady(wave, rubber, **given, shear_stress=1e4)
    with pytest.warns(UserWarning, match="the friction of the surfaces in motion is not in it"):
        assert np.array_equal(rubbed.stress(depths=[1e-5]).mises, plain.mises)
