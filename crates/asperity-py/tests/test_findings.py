"""Findings in Python: attributes of results, and warnings."""

import json
import warnings

import numpy as np
import pytest

import asperity as asp

CASE = {
    "domain": {"cells": [32, 32], "size": ["2 mm", "2 mm"]},
    "surface": [{"kind": "sphere", "radius": "10 mm"}],
    "body": [{"poisson": 0.5, "material": {"model": "elastic", "shear": "2 MPa"}}],
    "load": {"control": "load", "history": {"kind": "step", "value": "2 N"}},
    "time": {"end": "1 s", "steps": 1},
}


def sphere(load):
    surface = asp.Surface.sphere(cells=(32, 32), size=(2e-3, 2e-3), radius=10e-3)
    return asp.solve(surface, asp.Elastic(shear=2e6, poisson=0.5), load=load, times=[1.0], fields=[], progress=False)


def test_a_sound_result_has_no_findings():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = sphere(0.1)
    assert result.findings == [] and result.attributes["findings"] == []


def test_a_contact_at_the_border_warns_and_is_kept(tmp_path):
    with pytest.warns(asp.ResultWarning, match="contact-at-border"):
        result = sphere(2.0)
    (found,) = result.findings
    assert found.code == found["code"] == "contact-at-border"
    assert (found.severity, found.rows, found.value) == ("warning", [0, 1], 2e-3)
    # Hertz: a^3 = 3 R W / (4 E*) with E* = 8 MPa; room for 2.5 radii.
    assert abs(found.limit / (2.5 * (0.75 * 10e-3 * 2.0 / 8e6) ** (1 / 3)) - 1) < 0.01
    with pytest.raises(AttributeError, match="it has code"):
        found.colour
    result.save(tmp_path / "a.zarr")
    assert asp.open(tmp_path / "a.zarr").findings == result.findings
    result.report(tmp_path / "a.html")
    assert "contact-at-border" in (tmp_path / "a.html").read_text(encoding="utf-8")


def test_a_case_warns_as_the_command_does(tmp_path):
    assert [found["code"] for found in asp.check(CASE)["findings"]] == ["contact-at-border"]
    with pytest.warns(asp.ResultWarning, match="contact-at-border"):
        result = asp.run(CASE, output=tmp_path / "a.zarr", progress=False)
    assert [found.code for found in result.findings] == ["contact-at-border"]
    with warnings.catch_warnings():
        warnings.simplefilter("error", asp.ResultWarning)
        light = asp.run(CASE, set={"load.history.value": "0.1 N"}, output=tmp_path / "b.zarr", progress=False)
        with pytest.raises(asp.ResultWarning):
            asp.run(CASE, output=tmp_path / "c.zarr", progress=False)
    assert light.findings == []


def test_a_march_knows_its_findings_so_far():
    surface = asp.Surface.sphere(cells=(32, 32), size=(2e-3, 2e-3), radius=10e-3)
    run = asp.march(surface, asp.Elastic(shear=2e6, poisson=0.5), load=asp.ramp(2.0, duration=1.0), times=[0.01, 1.0])
    codes = []
    for _ in run:
        codes.append([found.code for found in run.findings])
    assert codes[0] == [] and "contact-at-border" in codes[-1]


def test_a_hurst_exponent_outside_of_its_range_warns():
    heights = np.zeros((64, 64))
    heights[30, 31] = 1e-6
    with pytest.warns(asp.ResultWarning, match="hurst-out-of-range"):
        statistics = asp.Surface(heights, size=(1e-3, 1e-3)).statistics()
    assert not 0 < statistics["hurst"] <= 1 and "findings" not in statistics


def test_a_dataset_holds_findings_as_text():
    pytest.importorskip("xarray")
    with pytest.warns(asp.ResultWarning):
        data = sphere(2.0).to_xarray()
    assert json.loads(data.attrs["findings"])[0]["code"] == "contact-at-border"
