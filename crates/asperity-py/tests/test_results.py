"""Results in memory: stored, reported, shown."""

import copy

import numpy as np
import pytest

import asperity as asp


@pytest.fixture(scope="module")
def result():
    surface = asp.Surface.sphere(cells=(40, 32), size=(1e-3, 8e-4), radius=10e-3)
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5, hardness=5e4)
    fields = ["pressure", "gap", "displacement", "contact"]
    return asp.solve(surface, zener, load=2e-3, times=asp.uniform(5.0, 10), fields=fields, every=3, title="A <ball>", progress=False)


def test_a_saved_result_is_the_same(result, tmp_path):
    path = tmp_path / "ball.zarr"
    result.save(path)
    back = asp.open(path)
    for name in asp._result.ROW:
        assert np.array_equal(getattr(back, name), getattr(result, name)), name
    for name in result.fields:
        assert np.array_equal(back._stack(name), result._stack(name)), name
    assert np.array_equal(back.field_times, result.field_times) and np.array_equal(back.initial_gap, result.initial_gap)
    assert back.size == result.size and back.attributes["title"] == "A <ball>" and back.attributes["status"] == "complete"
    with pytest.raises(OSError, match="already|exists"):
        result.save(path)
    result.save(path, force=True)
    # And a copy of one on disk.
    asp.open(path).save(tmp_path / "copy.zarr")
    assert np.array_equal(asp.open(tmp_path / "copy.zarr")._stack("contact"), result._stack("contact"))
    with pytest.raises(OSError):
        result.save(tmp_path / "nowhere" / "ball.zarr")


def test_xarray_opens_what_was_saved(result, tmp_path):
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("zarr")
    result.save(tmp_path / "ball.zarr")
    data = xarray.open_zarr(tmp_path / "ball.zarr")
    assert np.array_equal(data.pressure, result.to_xarray().pressure) and data.approach.attrs["units"] == "m"


def test_a_result_in_memory_is_reported(result, tmp_path):
    page = tmp_path / "ball.html"
    result.report(page)
    text = page.read_text()
    assert text.startswith("<!doctype html>") or text.lower().startswith("<!doctype html")
    # The title is text, and the material's curves and the hardness are told.
    assert "A &lt;ball&gt;" in text and "A <ball>" not in text
    with pytest.raises(OSError):
        result.report(page)
    result.report(page, force=True)
    assert not [path for path in tmp_path.iterdir() if path.suffix == ".zarr"]
    bare = asp.solve(asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=1e-2), asp.Elastic(young=1e6, poisson=0.5), load=1e-3, times=[1.0], fields=[], progress=False)
    bare.report(tmp_path / "bare.html")
    assert (tmp_path / "bare.html").stat().st_size > 1000


def test_results_and_contacts_are_copied_and_shown(result):
    for way in (copy.copy, copy.deepcopy):
        again = way(result)
        assert np.array_equal(again.approach, result.approach) and np.array_equal(again.field("gap"), result.field("gap"))
    assert "A &lt;ball&gt;" in result._repr_html_()
    contact = asp.elastic(asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=1e-2), 1e6, load=1e-3)
    assert "certified" in repr(contact) and "<table>" in contact._repr_html_()
    assert np.array_equal(copy.deepcopy(contact).pressure, contact.pressure)
