"""Datasets and tables: everything in one, with units that other packages read."""

from __future__ import annotations

import numpy as np
import pytest

import asperity as asp

xarray = pytest.importorskip("xarray")
SIZE = (1e-3, 1e-3)


def pressed(**given: object) -> asp.Result:
    surface = asp.Surface.wave(cells=(16, 16), size=SIZE, amplitude=1e-6, wavelength=(1e-3, 1e-3))
    arguments = {"pressure": 2e3, "times": [1.0, 2.0], "boundary": "periodic", "fields": ["pressure", "gap"], **given}
    return asp.solve(surface, asp.Elastic(young=3e6, poisson=0.5), **arguments)


def test_one_dataset_holds_stress_and_leak_too(tmp_path) -> None:
    result = pressed()
    parts = [result.to_xarray(), result.stress(depths=[0.0, 1e-4]).to_xarray(), result.leakage(pressure_drop=1.0, viscosity=1e-3)]
    whole = xarray.merge(parts, combine_attrs="override")
    assert whole.stress_mises.dims == ("depth", "x", "y") and whole.leak_rate.dims == ("leak_time",) and whole.gap.dims == ("field_time", "x", "y")
    # At the surface, to the rounding of transforms there and back.
    assert np.allclose(whole.stress_zz[0], -whole.pressure[-1], rtol=0.0, atol=1e-12 * float(whole.pressure.max()))
    whole.to_netcdf(tmp_path / "whole.nc", engine="h5netcdf")
    single = asp.leakage(result).to_xarray()
    # The same as that of the last fields over time.
    assert float(single.hydraulic_gap) == float(whole.hydraulic_gap[-1]) and single.fluid_pressure.shape == (16, 16)
    with pytest.raises(asp.CaseError, match="the field is 'zx'"):
        result.stress().to_xarray("zx")


def test_the_load_has_a_name_that_is_no_method() -> None:
    data = pressed().to_xarray()
    assert callable(data.load) and np.array_equal(data.normal_load, data["load"]) and data.normal_load.attrs == data["load"].attrs
    surface = asp.Surface.wave(cells=(16, 16), size=SIZE, amplitude=1e-6, wavelength=(1e-3, 1e-3))
    curve = asp.elastic(surface, 1e6, load=[1e-3, 2e-3], boundary="periodic").to_xarray()
    assert np.allclose(curve.normal_load, [1e-3, 2e-3], rtol=1e-12)


def test_units_are_those_of_pint() -> None:
    pint = pytest.importorskip("pint", reason="pint is not installed")
    registry = pint.UnitRegistry()
    result = pressed(quantities=["external_work", "load_power", "contact_stiffness"])
    datasets = [result.to_xarray(), result.stress().to_xarray("mises"), result.leakage(pressure_drop=1.0, viscosity=1e-3), asp.leakage(result).to_xarray()]
    for data in datasets:
        for name, values in data.variables.items():
            if "units" in values.attrs:
                registry.Unit("" if values.attrs["units"] == "1" else values.attrs["units"])
    assert registry.Quantity(1.0, datasets[0].contact_area.attrs["units"]).m_as("mm^2") == pytest.approx(1e6)
    for entries in (asp._columns.COLUMNS, asp._columns.FIELDS, asp._columns.STRESS, asp._columns.LEAKS, asp._columns.GAS_LEAKS):
        for entry in entries.values():
            for unit in (entry.unit, entry.line_unit):
                registry.Unit("" if unit == "1" else unit)


def test_vectors_are_two_columns_of_a_table() -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    ball = asp.Surface.sphere(cells=(32, 32), size=(0.4e-3, 0.4e-3), radius=10e-3)
    steel = asp.Elastic(young=210e9, poisson=0.3)
    pull = asp.tangential(force=(asp.ramp(2.0, duration=1.0), 1.0))
    result = asp.solve(ball, steel, load=50.0, times=[1.0], friction=0.5, tangential=pull)
    table = result.to_dataframe()
    assert np.array_equal(table.tangential_force_x, result.tangential_force[:, 0]) and np.array_equal(table.tangential_force_y, result.tangential_force[:, 1])
    assert table.attrs["units"]["tangential_displacement_y"] == "m" and "tangential_force" not in table
