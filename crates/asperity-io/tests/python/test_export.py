"""Reads exports with the programs that they are for and compares them, bit by bit, with what was written:
raw files beside them, named as the arrays. Run with `-W error`: a warning is a failure. VTK, which is large, is left
out with a message where it is not installed.

ASPERITY_EXPORTS  directory with out.nc, out.h5, out.npz, out.pvd, out.csv, and empty.nc, empty.h5, empty.npz
"""

import csv
import json
import os
import pathlib
import sys
import warnings
import xml.etree.ElementTree

import numpy as np

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of the imports, not of the files
    import h5netcdf  # noqa: F401
    import h5py
    import netCDF4  # noqa: F401
    import scipy  # noqa: F401
    import xarray as xr

here = pathlib.Path(os.environ["ASPERITY_EXPORTS"])
nx, ny, rows, maps = 37, 11, 7, 4
title = 'rough "sphere" \u00b5m'


def written(name, shape, dtype="<f8"):
    return np.fromfile(here / name, dtype=dtype).reshape(shape)


def same(a, b):
    """Same shape and bits, NaN included, in native byte order."""
    a = np.ascontiguousarray(a)
    a = a.astype(a.dtype.newbyteorder("="))
    return a.shape == b.shape and a.dtype.itemsize == b.dtype.itemsize and a.tobytes() == b.tobytes()


time, residual = written("time", rows), written("residual", rows)
initial_gap = written("initial_gap", (nx, ny))
pressure = written("pressure", (maps, nx, ny))
contact = written("contact", (maps, nx, ny), "u1")
case = (here / "case").read_text(encoding="utf-8")


def check(get):
    """`get(name)` is the array of that name."""
    assert same(get("time"), time)
    assert same(get("residual"), residual)
    assert same(get("initial_gap"), initial_gap)
    assert same(get("pressure"), pressure)
    assert same(np.asarray(get("contact")).astype("u1"), contact)
    assert list(np.asarray(get("convolutions"))) == [2 * n + 1 for n in range(rows)]
    assert list(np.asarray(get("field_step"))) == [0, 2, 4, 6]
    assert np.array_equal(np.asarray(get("field_time")), time[::2])


# numpy
with np.load(here / "out.npz") as npz:
    check(lambda name: npz[name])
    attributes = json.loads(npz["attributes"].item())
    assert attributes["title"] == title and attributes["case"] == case
    assert attributes["units"]["pressure"] == "Pa"
with np.load(here / "empty.npz") as npz:
    assert npz["pressure"].shape == (0, nx, ny) and npz["load"].shape == (1,)

# xarray, by each of its readers
for file, engine in (
    ("out.nc", "netcdf4"),
    ("out.nc", "scipy"),
    ("out.h5", "netcdf4"),
    ("out.h5", "h5netcdf"),
):
    with xr.open_dataset(here / file, engine=engine) as ds:
        assert dict(ds.sizes) == {"time": rows, "field_time": maps, "x": nx, "y": ny}, ds.sizes
        assert set(ds.coords) == {"time", "field_time", "x", "y"}, (file, engine)
        assert ds.pressure.dims == ("field_time", "x", "y")
        assert ds.pressure.attrs == {"units": "Pa", "long_name": "contact pressure"}, ds.pressure.attrs
        check(lambda name: ds[name].values)
        assert ds.attrs["title"] == title
        assert ds.attrs["case"] == case
        assert list(ds.attrs["cells"]) == [nx, ny] and ds.attrs["schema"] == 2
    with xr.open_dataset(here / file.replace("out", "empty"), engine=engine) as ds:
        assert ds.pressure.shape == (0, nx, ny) and ds["load"].shape == (1,)

# h5py
with h5py.File(here / "out.h5") as h5:
    check(lambda name: h5[name][...])
    assert h5["pressure"].attrs["units"] == "Pa"
    assert h5.attrs["title"] == title and h5.attrs["case"] == case
    assert [dimension[0].name for dimension in h5["gap"].dims] == ["/field_time", "/x", "/y"]

# VTK, the reader of ParaView
try:
    from vtk.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader
except ImportError:
    print("left out: the reader of VTK, which is not installed", file=sys.stderr)
else:
    states = xml.etree.ElementTree.parse(here / "out.pvd").findall("Collection/DataSet")
    assert [float(state.get("timestep")) for state in states] == list(time[::2])

    def read(path):
        reader = vtkXMLImageDataReader()
        assert reader.CanReadFile(str(path))
        reader.SetFileName(str(path))
        reader.Update()
        assert reader.GetErrorCode() == 0
        return reader.GetOutput()

    for n, state in enumerate(states):
        image = read(here / state.get("file"))
        assert image.GetDimensions() == (nx + 1, ny + 1, 1)
        assert image.GetNumberOfCells() == nx * ny
        data = image.GetCellData()
        p = vtk_to_numpy(data.GetArray("pressure")).reshape(ny, nx).T
        assert same(p, pressure[n])
        assert same(vtk_to_numpy(data.GetArray("contact")).reshape(ny, nx).T, contact[n])
        array = data.GetArray("pressure")
        assert array.GetInformation().Get(array.UNITS_LABEL()) == "Pa"
    gap = vtk_to_numpy(read(here / "out" / "initial_gap.vti").GetCellData().GetArray("initial_gap"))
    gap = gap.reshape(ny, nx).T
    finite = np.isfinite(initial_gap)
    assert same(gap[finite], initial_gap[finite]) and np.isnan(gap[~finite]).all()

# spreadsheets
with open(here / "out.csv", newline="", encoding="utf-8") as file:
    table = list(csv.DictReader(file))
assert same(np.array([float(row["time [s]"]) for row in table]), time)
assert [int(row["convolutions"]) for row in table] == [2 * n + 1 for n in range(rows)]
