"""Studies in the folder that the command reads and writes."""

import os
import subprocess
import sys

import numpy as np
import pytest

import asperity as asp

pytest.importorskip("xarray")

CASE = """
domain = { cells = [32, 32], size = ["1 mm", "1 mm"] }
surface = [{ kind = "sphere", radius = "20 mm" }]
body = [{ poisson = 0.5, material = { model = "elastic", young = "3 MPa" } }]
load = { control = "load", history = { kind = "step", value = "1 mN" } }
time = { end = "1 s", steps = 1 }
output = { fields = [] }
"""


def test_the_folder_is_that_of_the_command(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    folder = tmp_path / "loads"
    vary = {"load.history.value": ["1 mN", "2 mN"], "surface.0.radius": "10 mm:20 mm:3"}
    data = asp.study(tmp_path / "case.toml", vary=vary, directory=folder)
    assert dict(data.sizes) == {"load.history.value": 2, "surface.0.radius": 3}
    assert data["load.history.value"].attrs["units"] == "N" and (data.status == "done").all()
    np.testing.assert_array_equal(data["surface.0.radius"], [10e-3, 15e-3, 20e-3])
    one = asp.run(tmp_path / "case.toml", output=tmp_path / "one.zarr", set={"load.history.value": "2 mN", "surface.0.radius": "15 mm"})
    of_one = data.isel({"load.history.value": 1, "surface.0.radius": 1})
    assert float(of_one.approach) == one.approach[-1]
    assert float(asp.open(of_one.path.item()).load[-1]) == 2e-3
    # The command finds everything done, and so does a second call.
    words = [sys.executable, "-m", "asperity", "study", "status", str(folder)]
    assert "6 done of 6 runs" in subprocess.run(words, capture_output=True, encoding="utf-8", timeout=60).stdout
    before = {name: os.stat(folder / name / "zarr.json").st_mtime_ns for name in os.listdir(folder) if name.startswith("value-")}
    again = asp.study(tmp_path / "case.toml", vary=vary, directory=folder)
    assert again.equals(data)
    assert before == {name: os.stat(folder / name / "zarr.json").st_mtime_ns for name in before}
    with pytest.raises(asp.CaseError, match="choose another folder"):
        asp.study(tmp_path / "case.toml", over={"load.history.value": ["1 mN"]}, folder=folder)


def test_the_dataset_on_disk_is_the_same(tmp_path):
    xarray, zarr = pytest.importorskip("xarray"), pytest.importorskip("zarr", minversion="3")
    assert zarr
    data = asp.study(CASE, vary={"load.history.value": ["1 mN", 2e-3], "output.fields": [[], ["gap"]]}, directory=tmp_path / "s", zip=True)
    stored = xarray.open_zarr(tmp_path / "s" / "study.zarr")
    assert stored.approach.dims == ("run",)
    np.testing.assert_array_equal(stored.approach, data.approach)
    np.testing.assert_array_equal(stored["load.history.value"], [1e-3, 2e-3])
    assert list(stored["output.fields"].values) == ["[]", '["gap"]']
    assert list(stored.status.values) == ["done", "done"]


def test_each_run_has_its_errors_and_findings_and_a_large_table_does_not_stop_it(tmp_path):
    xarray = pytest.importorskip("xarray")
    # 80 runs: their table as JSON is longer than a pipe holds.
    vary = {"load.history.value": [f"{n} mN" for n in range(1, 81)]}
    data = asp.study(CASE, vary=vary, directory=tmp_path / "s", error_bars=True)
    one = asp.open(data.path[3].item())
    bars = {bar["name"]: bar["error"] for bar in one.error_bars}
    assert float(data.contact_area_error[3]) == bars["contact_area"] > 0.0
    assert int(data.findings[3]) == len(one.findings)
    assert data.finding_codes[3].item() == " ".join(sorted({finding["code"] for finding in one.findings}))
    stored = xarray.open_zarr(tmp_path / "s" / "study.zarr")
    for name in ("contact_area_error", "findings", "finding_codes"):
        np.testing.assert_array_equal(stored[name], data[name])
    with pytest.raises(asp.CaseError, match="error_bars"):
        asp.study(CASE, {"load.history.value": ["1 mN"]}, error_bars=True)


def test_what_is_wrong_is_an_error_of_the_case(tmp_path):
    with pytest.raises(asp.CaseError, match="load.history.value is"):
        asp.study(CASE, vary={"load.history.value": ["1 m"]}, directory=tmp_path / "s")
    with pytest.raises(asp.CaseError, match="needs a folder"):
        asp.study(CASE, vary={"load.history.value": ["1 mN"]})
    with pytest.raises(asp.CaseError, match="leave out over"):
        asp.study(CASE, over={}, vary={}, directory=tmp_path / "s")
