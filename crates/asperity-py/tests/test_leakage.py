"""Leakage: closed forms, an independent solution, results and studies."""

from __future__ import annotations

import re
import warnings
from typing import get_args

import asperity as asp
import numpy as np
import pytest

from asperity import _words

CASE = """
title = "seal"
[domain]
cells = [32, 32]
size = ["1 mm", "1 mm"]
boundary = "periodic"
[[surface]]
kind = "wave"
amplitude = "1 um"
wavelength = ["1 mm", "1 mm"]
[[body]]
poisson = 0.5
material = { model = "zener", shear = "1 MPa", shear_kelvin = "3 MPa", retardation_time = "1 s" }
[load]
control = "pressure"
history = { kind = "step", value = "1.8 kPa" }
[time]
end = "10 s"
steps = 4
[solver]
tolerance = 1e-9
[leakage]
pressure_drop = "20 Pa"
viscosity = "1 mPa s"
[output]
every = 2
"""


def network(gap: np.ndarray) -> float:
    """T of a gap with closed sides, unit cells, by dense linear algebra."""
    n, m = gap.shape
    k = np.where(gap > 0, gap, 0.0) ** 3
    matrix, right = np.zeros((n * m, n * m)), np.zeros(n * m)

    def join(a: int, b: int, one: float, other: float) -> None:
        t = 2 * one * other / (one + other) if one > 0 and other > 0 else 0.0
        matrix[[a, b], [a, b]] += t
        matrix[[a, b], [b, a]] -= t

    for i in range(n):
        for j in range(m):
            if i + 1 < n:
                join(i * m + j, (i + 1) * m + j, k[i, j], k[i + 1, j])
            if j + 1 < m:
                join(i * m + j, i * m + j + 1, k[i, j], k[i, j + 1])
    for j in range(m):
        matrix[j, j] += 2 * k[0, j]
        right[j] = 2 * k[0, j]
        matrix[(n - 1) * m + j, (n - 1) * m + j] += 2 * k[-1, j]
    pressure = np.linalg.lstsq(matrix, right, rcond=None)[0]
    return float(np.sum(2 * k[-1] * pressure[-m:]) * n / m)


def test_a_random_map_agrees_with_dense_algebra() -> None:
    rng = np.random.default_rng(3)
    gap = np.where(rng.random((12, 9)) < 0.8, rng.uniform(0.2, 1.0, (12, 9)), 0.0)
    leak = asp.leakage(gap, size=(12.0, 9.0), sides="closed")
    assert leak.percolates and leak.hydraulic_gap**3 == pytest.approx(network(gap), rel=1e-9)
    # The flow in the other direction of the transposed map is the same.
    turned = asp.leakage(gap.T.copy(), size=(9.0, 12.0), sides="closed", direction="y")
    assert turned.hydraulic_gap == pytest.approx(leak.hydraulic_gap, rel=1e-12)
    assert leak.critical_gap <= gap.max() and leak.pressure.shape == gap.shape
    assert np.array_equal(np.isnan(leak.pressure), np.isin(leak.cells, (0, 4)))
    assert leak.leak_rate(pressure_drop=1.0, viscosity=1.0) == pytest.approx(leak.hydraulic_gap**3 * 9 / (12 * 12))


def test_contact_closes_cells_and_both_directions_have_a_tensor() -> None:
    gap = np.full((8, 8), 1e-6)
    contact = np.zeros((8, 8), dtype=bool)
    contact[3] = True
    assert not asp.leakage(gap, contact, size=(1e-4, 1e-4)).percolates
    sealed = asp.leakage(gap, contact, size=(1e-4, 1e-4), direction="both")
    assert sealed.conductance is not None and sealed.conductance[0, 0] == 0.0
    # Seven of eight rows let the fluid pass along y.
    assert sealed.conductance[1, 1] == pytest.approx(7 / 8 * 1e-18)
    assert asp.leakage(gap, contact, size=(1e-4, 1e-4)).gas_leak_rate(inlet=2e5, outlet=1e5, gas="air") == 0.0


def test_the_noise_of_a_contact_is_closed() -> None:
    # Nine tenths of the cells touch, with gaps that are off to both sides, around channels that end.
    errors = 1e-12 * np.random.default_rng(1).uniform(-1, 1, (40, 40))
    gap = errors.copy()
    gap[:36, 3::10] = 1e-6
    leak = asp.leakage(gap, size=(1e-3, 1e-3))
    assert not leak.percolates and leak.open_fraction < 0.1
    assert [finding.code for finding in leak.findings] == ["gaps-below-error"]


def test_wrong_input_is_named() -> None:
    gap = np.full((4, 4), 1e-6)
    leak = asp.leakage(gap, size=(1e-4, 1e-4))
    for wrong, words in [
        (lambda: asp.leakage(np.full((4, 4), np.nan), size=(1, 1)), "cell"),
        (lambda: asp.leakage(gap, np.zeros((3, 4)), size=(1, 1)), "shape"),
        (lambda: asp.leakage(gap, size=(1, 1), direction="z"), "direction is 'z'"),
        (lambda: leak.gas_leak_rate(inlet=1e5, outlet=2e5, gas="air"), "outlet"),
        (lambda: leak.gas_leak_rate(inlet=2e5, outlet=1e5, gas="argon"), "argon"),
        (lambda: leak.gas_leak_rate(inlet=2e5, outlet=1e5), "gas"),
        (lambda: leak.leak_rate(pressure_drop=-1, viscosity=1), "greater than 0"),
    ]:
        with pytest.raises(asp.CaseError, match=words):
            wrong()


def test_a_result_leaks_less_as_it_creeps(tmp_path) -> None:
    pytest.importorskip("xarray")
    case = tmp_path / "seal.toml"
    case.write_text(CASE)
    result = asp.run(case, output=tmp_path / "seal.zarr")
    stored = result.leakage()
    assert stored.leak_rate.attrs["units"] == "m^3/s" and bool((np.diff(stored.leak_rate) <= 0).all())
    again = result.leakage(pressure_drop=20.0, viscosity=1e-3)
    assert np.array_equal(again.leak_rate, stored.leak_rate) and np.array_equal(again.leak_resolved, stored.leak_resolved)
    gas = result.leakage(gas="air", inlet=1.0002e5, outlet=1e5)
    assert gas.leak_rate.attrs["units"] == "kg/s" and "leak_rate_standard" in gas
    with pytest.warns(asp.ResultWarning, match="0.02 of the mean pressure"):
        large = result.leakage(pressure_drop=1e5, viscosity=1e-3, field=True)
    assert not large.leak_resolved.any() and large.fluid_pressure.max() <= 1e5


def test_a_study_over_pressure_holds_the_leaks(tmp_path) -> None:
    pytest.importorskip("xarray")
    data = asp.study(CASE, over={"load.history.value": ["1.2 kPa", "1.8 kPa"]}, workers=1, progress=False)
    rates = data.leak_rate.isel(leak_step=-1)
    assert rates.shape == (2,) and float(rates[1]) < float(rates[0])


def test_a_leak_through_a_windowed_surface_is_told(tmp_path):
    # A groove 0.1 mm wide and 8 um deep across a flat patch of 0.2 mm.
    groove = asp.Surface(np.tile(np.where(abs(np.arange(16) - 7.5) < 4, -8e-6, 0.0), (16, 1)), size=(2e-4, 2e-4))
    rubber = asp.Elastic(young=4.8e6, poisson=0.5)

    def told(surface):
        result = asp.solve(surface, rubber, pressure=1e5, times=[1.0], boundary="periodic", fields=["pressure", "gap"], progress=False)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            leak = result.leakage(pressure_drop=1e3, viscosity=1e-3)
        return leak, [str(one.message) for one in caught if "window-in-leak" in str(one.message)]

    dammed, words = told(groove.window())
    assert not dammed.leak_resolved.values[-1] and len(words) == 1
    # Also with something added to it, and where the surface went through a file.
    groove.window().write(tmp_path / "groove.npz")
    assert len(told(asp.Surface.read(tmp_path / "groove.npz") + groove)[1]) == 1
    open_, words = told(groove.mirrored())
    assert open_.percolates.values[-1] and open_.leak_resolved.values[-1] and words == []


def test_words_of_gases_are_those_of_the_core() -> None:
    leak = asp.leakage(np.full((8, 8), 1e-6), size=(1e-3, 1e-3), sides="closed")
    with pytest.raises(asp.CaseError, match="did you mean 'helium'"):
        leak.gas_leak_rate(inlet=2e5, outlet=1e5, gas="helim")
    with pytest.raises(asp.CaseError, match="did you mean 'slip'"):
        leak.gas_leak_rate(inlet=2e5, outlet=1e5, gas="helium", rarefaction="slp")
    for name, words in (("gas", _words.Gas), ("rarefaction", _words.Rarefaction)):
        with pytest.raises(asp.CaseError) as told:
            leak._solved({"inlet": 2e5, "outlet": 1e5, "gas": "air", name: "none"})
        assert set(re.findall("`([a-z]+)`", str(told.value))) == {"none", *get_args(words)}


def test_a_line_has_no_leak_and_a_pressure_is_no_gap() -> None:
    line = asp.solve(asp.Surface.cylinder(cells=32, size=1e-3, radius=1e-2), asp.Elastic(young=1e6, poisson=0.5), load=1.0, times=[1.0], fields=["pressure", "gap"])
    with pytest.raises(asp.CaseError, match="through a line contact nothing flows"):
        line.leakage()
    with pytest.warns(asp.ResultWarning, match=r"the gap is up to 1e\+05 m wide on a domain of 0.001 m"):
        asp.leakage(np.full((8, 8), 1e5), np.full((8, 8), False), size=(1e-3, 1e-3), sides="closed")
