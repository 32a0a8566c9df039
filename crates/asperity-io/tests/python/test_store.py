"""Reads a result of the store with xarray and zarr-python and compares it, bit by bit, with what was
written: raw files beside the result, named as the arrays. Run with `-W error`: a warning is a failure.

ASPERITY_RESULT  the result (a directory)
ASPERITY_STATUS  the status that it must have
ASPERITY_FIELDS  the names of its fields
"""

import os
import pathlib
import sys
import tempfile

import numpy as np
import xarray as xr
import zarr

result = pathlib.Path(os.environ["ASPERITY_RESULT"])
status = os.environ["ASPERITY_STATUS"]
fields = os.environ["ASPERITY_FIELDS"].split()
beside = result.parent
nx, ny, rows, maps = 300, 257, 7, 4


def written(name, dtype="<f8"):
    return np.fromfile(beside / name, dtype=dtype)


def same(a, b):
    """Same type, shape and bits, NaN included."""
    a = np.ascontiguousarray(a)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


for options in ({}, {"chunks": None}, {"consolidated": True}):
    ds = xr.open_zarr(result, **options)
    assert dict(ds.sizes) == {"time": rows, "field_time": maps, "x": nx, "y": ny}, ds.sizes
    assert set(ds.coords) == {"time", "field_time", "x", "y"}
    per_step = """load approach contact_area contact_area_corrected contact_fraction capped_area mean_pressure
        max_pressure mean_gap iterations convolutions residual certificate time_error stage""".split()
    assert set(ds.data_vars) == {*per_step, *fields, "initial_gap", "field_step"}
    for name in per_step:
        assert ds[name].dims == ("time",), name
    for name in fields:
        assert ds[name].dims == ("field_time", "x", "y"), name
    assert ds.initial_gap.dims == ("x", "y")
    for name, array in ds.variables.items():
        assert array.attrs["units"] and array.attrs["long_name"], name

    assert same(ds.time.values, written("time")) and ds.time.dtype == np.float64
    assert ds.time.values[4] == ds.time.values[5]  # a jump
    assert same(ds.residual.values, written("residual"))
    assert ds.iterations.dtype == np.int64 and list(ds.iterations.values) == list(range(rows))
    assert list(ds.field_step.values) == [3, 4, 5, 6]
    assert same(ds.field_time.values, ds.time.values[3:])
    assert same(ds.initial_gap.values, written("initial_gap").reshape(nx, ny))
    assert np.isinf(ds.initial_gap.values).any()
    assert same(ds.pressure.values[-1], written("pressure").reshape(nx, ny))
    assert same(ds.gap.values[-1], written("gap").reshape(nx, ny))
    contact = ds.contact.values[-1]
    assert same(contact, written("contact", "u1").reshape(nx, ny))
    assert set(np.unique(contact)) == {0, 1, 2}
    (lx, ly) = ds.attrs["size"]
    assert np.array_equal(ds.x.values, (np.arange(nx) + 0.5) * (lx / nx))
    assert np.array_equal(ds.y.values, (np.arange(ny) + 0.5) * (ly / ny))
    assert ds.attrs["format"] == "asperity-result" and ds.attrs["schema"] == 2
    assert ds.attrs["status"] == status, ds.attrs["status"]
    assert ds.attrs["title"] == 'rough "sphere" \u00b5m' and "[domain]" in ds.attrs["case"]
    assert ds.attrs["work_convolutions"] == sum(2 * n + 1 for n in range(rows))
    nearest = ds.pressure.isel(field_time=-1).sel(x=lx / 2, y=ly / 2, method="nearest")
    assert np.isfinite(float(nearest))

# The attributes pass on to NetCDF.
with tempfile.TemporaryDirectory() as scratch:
    small = ds.drop_vars("contact")  # classic NetCDF has no unsigned bytes
    small.to_netcdf(f"{scratch}/result.nc", engine="scipy")
    with xr.open_dataset(f"{scratch}/result.nc", engine="scipy") as back:
        assert same(back.pressure.values.astype("<f8"), small.pressure.values)

# Each array for itself, without the group's document.
group = zarr.open_group(result, mode="r", use_consolidated=False)
if status == "complete":
    assert set(group.array_keys()) == set(ds.variables)
    assert group["load"].shape == (rows,)
    assert same(group["pressure"][maps - 1], written("pressure").reshape(nx, ny))
assert zarr.open_array(result, path="initial_gap", mode="r").shape == (nx, ny)
