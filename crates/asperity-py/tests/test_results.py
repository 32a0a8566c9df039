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
        assert np.array_equal(getattr(back, name), getattr(result, name), equal_nan=True), name
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
    pytest.importorskip("zarr", minversion="3")
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


CASE = """
[domain]
cells = [40, 32]
size = ["1 mm", "0.8 mm"]
[[surface]]
kind = "sphere"
radius = "10 mm"
[[body]]
poisson = 0.5
hardness = "30 kPa"
material = { model = "zener", shear = "1 MPa", shear_kelvin = "1 MPa", retardation_time = "1 s" }
[load]
control = "load"
history = { kind = "trapezoid", peak = "4 mN", rise = "1 s", hold = "2 s", fall = "1 s" }
[time]
end = "5 s"
steps = 10
[solver]
plasticity = "accumulate"
[output]
fields = ["pressure", "flattening"]
every = 5
quantities = ["contact_stiffness", "contact_spots", "external_work", "elastic_energy", "dissipated_energy", "flattening_work", "spot_histogram", "pressure_histogram"]
"""
ASKED = ["contact_stiffness", "contact_spots", "external_work", "elastic_energy", "dissipated_energy", "flattening_work"]


@pytest.fixture(scope="module")
def flattened():
    surface = asp.Surface.sphere(cells=(40, 32), size=(1e-3, 8e-4), radius=10e-3)
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5, hardness=3e4)
    return asp.solve(
        surface, zener, load=asp.trapezoid(4e-3, rise=1.0, hold=2.0, fall=1.0), times=asp.uniform(5.0, 10), plasticity="accumulate",
        quantities=[*ASKED, "spot_histogram", "pressure_histogram"], fields=["pressure", "flattening"], every=5, progress=False,
    )


def test_quantities_and_flattening_have_the_bits_of_the_case(flattened, tmp_path):
    stored = asp.run(CASE, output=tmp_path / "case.zarr")
    flattened.save(tmp_path / "saved.zarr")
    for other in (stored, asp.open(tmp_path / "saved.zarr")):
        assert other.quantities == flattened.quantities
        for name in [*asp._result.ROW, *ASKED]:
            assert np.array_equal(getattr(other, name), getattr(flattened, name), equal_nan=True), name
        for name in ("spot_histogram", "pressure_histogram"):
            for a, b in zip(other.histogram(name), flattened.histogram(name)):
                assert np.array_equal(a, b), name
        assert np.array_equal(other._stack("flattening"), flattened._stack("flattening"))


def test_quantities_are_physics(flattened):
    assert flattened.field("flattening").max() > 0 and flattened.capped_area.max() > 0
    # Work is what is stored, lost and spent on dents; the trapezoidal rule over 10 steps leaves some percent.
    parts = flattened.elastic_energy + flattened.dissipated_energy + flattened.flattening_work
    assert parts == pytest.approx(flattened.external_work, abs=0.05 * flattened.external_work.max())
    assert flattened.contact_spots[4] == 1 and flattened.contact_spots[-1] == 0
    edges, density = flattened.histogram("pressure_histogram")
    assert edges[-1] == 3e4 and density[4].sum() * (edges[1] - edges[0]) == pytest.approx(1, rel=1e-9)
    edges, spots = flattened.histogram("spot_histogram")
    assert spots.sum(axis=1).tolist() == flattened.contact_spots.tolist() and spots.shape == (len(flattened), len(edges) - 1)


def test_quantities_reach_xarray_and_studies(flattened, tmp_path):
    xarray = pytest.importorskip("xarray")
    ours = flattened.to_xarray()
    assert ours.contact_stiffness.attrs["units"] == "N/m" and ours.pressure_histogram.dims == ("time", "pressure_bin")
    if pytest.importorskip("zarr", minversion="3"):
        flattened.save(tmp_path / "saved.zarr")
        stored = xarray.open_zarr(tmp_path / "saved.zarr").drop_vars("field_step", errors="ignore")
        # In memory the load has a second name, which is no method of datasets.
        for name in ours.drop_vars("normal_load").variables:
            assert np.allclose(ours[name], stored[name], rtol=1e-15, equal_nan=True), name
            assert ours[name].dims == stored[name].dims and ours[name].attrs["units"].replace("^", "") == stored[name].attrs["units"], name
    data = asp.study(CASE, {"load.history.peak": ["2 mN", "4 mN"]})
    assert np.array_equal(data.external_work.isel({"load.history.peak": 1}), flattened.external_work)
    with pytest.raises(AttributeError, match="requested"):
        flattened.rms_gap
    with pytest.raises(AttributeError, match="histogram"):
        flattened.spot_histogram
    with pytest.raises(asp.CaseError, match="gap_histogram"):
        flattened.histogram("gap_histogram")


def test_a_hardness_for_each_cell():
    surface = asp.Surface.sphere(cells=(40, 32), size=(1e-3, 8e-4), radius=10e-3)
    rubber = asp.Elastic(young=3e6, poisson=0.5)
    cells = np.full((40, 32), 5e4)
    cells[20:] = 2e4
    result = asp.solve(surface, rubber, load=3e-3, times=[1.0], hardness=cells, progress=False)
    p = result.field("pressure")
    assert p[20:].max() == 2e4 and 2e4 < p[:20].max() <= 5e4
    for wrong, words in ((cells[:10], "shape"), (np.where(cells > 3e4, np.nan, cells), "hardness"), (-cells, "hardness")):
        with pytest.raises(asp.CaseError, match=words):
            asp.solve(surface, rubber, load=3e-3, times=[1.0], hardness=wrong, progress=False)
    for change, words in (
        (dict(quantities=["stiffness"]), "contact_stiffness"),
        (dict(quantities=["rms_gap", "rms_gap"]), "twice"),
        (dict(quantities=["pressure_histogram"]), "largest pressure"),
        (dict(quantities=["gap_histogram"], bins=0), "bins"),
        (dict(quantities=["gap_histogram"], largest_gap=-1.0), "gap"),
        (dict(plasticity="hard"), "'cap' or 'accumulate'"),
        (dict(plasticity="accumulate"), "hardness|accumulate"),
    ):
        with pytest.raises(asp.CaseError, match=words):
            asp.solve(surface, rubber, load=3e-3, times=[1.0], progress=False, **change)


STRESS = """
[domain]
cells = [20, 16]
size = ["1 mm", "0.8 mm"]
[[surface]]
kind = "sphere"
radius = "5 mm"
[[body]]
poisson = 0.3
material = { model = "elastic", young = "1 GPa" }
[load]
control = "load"
history = { kind = "step", value = "2 N" }
[time]
end = "1 s"
steps = 1
[output]
fields = ["pressure"]
[stress]
depths = ["0 um", "60 um", "150 um"]
yield_stress = "1 MPa"
"""


def test_the_stress_of_a_run_is_that_of_its_pressure(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(STRESS)
    with pytest.warns(asp.ResultWarning, match="yield"):
        result = asp.run(case, output=tmp_path / "out.zarr")
    assert result.max_mises.shape == result.field_times.shape
    assert result.mises_by_depth.shape == (len(result.field_times), 3)
    below = result.stress(depths=[0.0, 60e-6, 150e-6])
    assert np.array_equal(result.mises_by_depth[-1], below.mises.max(axis=(1, 2)))
    found = below.survey(rolling="x")
    assert found["max_mises"] == result.max_mises[-1] and found["max_mises_x"] == result.max_mises_x[-1]
    # The surface bears the pressure; nothing depends on Poisson's ratio there.
    assert np.allclose(below.zz[0], -result.field("pressure"), atol=1e-9 * result.max_pressure[-1])
    assert found["orthogonal_shear_by_depth"].max() <= found["orthogonal_shear"]
    with pytest.raises(asp.CaseError, match="rolling"):
        below.survey(rolling="z")
    for depths, words in [([1e-9], "quarter of a cell"), ([np.nan], "depth"), ([1e-4, 1e-4], "depth is 1e-4 m"), ([], "at least one")]:
        with pytest.raises(asp.CaseError, match=words):
            result.stress(depths=depths)
    with pytest.raises(asp.CaseError, match="body"):
        result.stress(body=1)
    memory = asp.elastic(gap=result.initial_gap, contact_modulus=1e9, load=2.0, size=result.size)
    assert asp.stress(memory.pressure, size=result.size, poisson=0.3).mises.shape == (25, 20, 16)
    with pytest.raises(AttributeError, match="asperity stress"):
        asp.solve(gap=result.initial_gap, material=asp.Elastic(young=1e9, poisson=0.3), size=result.size, load=1.0, times=[1.0]).max_mises


def test_a_bulk_modulus_takes_the_pressures_of_all_rows(tmp_path):
    ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=5e-3)
    resin = asp.Zener(shear=1e9, shear_kelvin=1e9, retardation_time=1.0, bulk_modulus=4e9)
    result = asp.solve(ball, resin, load=1.0, times=asp.uniform(50.0, 25), every=1)
    below = result.stress()
    # At rest it is that of (3 B - 2 G)/(2 (3 B + G)) with G = 0.5 GPa; the solver's tolerance is 1e-6.
    settled = result.stress(poisson=0.44)
    assert np.allclose(below.mises, settled.mises, rtol=0, atol=1e-5 * settled.mises.max())
    # Right after the load it is that of G = 1 GPa.
    first = result.stress(index=0)
    assert np.allclose(first.mises, result.stress(index=0, poisson=10 / 26).mises, rtol=0, atol=1e-12 * first.mises.max())
    assert not np.allclose(first.mises, result.stress(index=0, poisson=0.44).mises, rtol=0, atol=1e-3 * first.mises.max())
    result.save(tmp_path / "resin.zarr")
    assert np.array_equal(asp.open(tmp_path / "resin.zarr").stress().mises, below.mises)
    some = asp.solve(ball, resin, load=1.0, times=asp.uniform(50.0, 25), every=3)
    with pytest.raises(asp.CaseError, match="all rows"):
        some.stress()
    assert some.stress(poisson=0.4).depths[0] == 0.0
    elastic = asp.solve(ball, asp.Elastic(shear=1e9, bulk_modulus=4e9), load=1.0, times=[1.0], every=1)
    assert "0.384615" in repr(elastic.stress())


def test_the_stress_below_a_line(tmp_path):
    # Half width 1, p0 = 1: the largest shear is 0.300 p0 at 0.786 half widths (Johnson 1985, section 4.2).
    cells = 256
    x = (np.arange(cells) + 0.5) * (4.0 / cells) - 2.0
    pressure = np.sqrt(np.maximum(1.0 - x * x, 0.0))
    below = asp.stress(pressure, size=4.0, poisson=0.3)
    assert below.mises.shape == (25, cells) and "a line of 256 cells" in repr(below)
    found = below.survey(threshold=0.4, rolling="x")
    assert found["max_tresca"] == pytest.approx(0.3003, abs=1e-3) and found["max_tresca_depth"] == pytest.approx(0.786, abs=0.03)
    assert "max_mises_y" not in found
    assert np.allclose(below.yy, 0.3 * (below.xx + below.zz), atol=1e-12) and not below.xy.any()
    with pytest.raises(asp.CaseError, match="one length"):
        asp.stress(pressure, size=(1.0, 1.0), poisson=0.3)


def test_a_histogram_that_ends_too_low_says_what_it_leaves_out():
    sphere = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=5e-3)
    body = asp.Elastic(young=1e9, poisson=0.5)

    def solve(**ends):
        return asp.solve(sphere, body, load=0.5, times=[1.0], quantities=["pressure_histogram", "gap_histogram"], bins=7, **ends)

    with pytest.warns(asp.ResultWarning, match="beyond-histogram"):
        low = solve(largest_pressure=1e7)
    found = {finding.text.split()[0]: finding for finding in low.findings if finding.code == "beyond-histogram"}
    pressure = low.field("pressure", time=1.0)
    # The share is counted in the field; sums over seven bins round.
    assert found["pressure_histogram"].value == pytest.approx(np.mean(pressure[pressure > 0] > 1e7), rel=1e-9)
    assert found["pressure_histogram"].limit == 1e7 and "largest_pressure=" in found["pressure_histogram"].text
    assert set(found) == {"pressure_histogram"}
    with pytest.warns(asp.ResultWarning, match="largest_gap="):
        solve(largest_pressure=1e10, largest_gap=1e-6)
    assert not [one for one in solve(largest_pressure=1e10).findings if one.code == "beyond-histogram"]
    with pytest.raises(asp.CaseError, match="largest_pressure"):
        asp.solve(sphere, body, load=0.5, times=[1.0], quantities=["pressure_histogram"])


def test_cycles_of_another_frequency_are_told(recwarn):
    punch = asp.Surface.flat_punch(cells=(16, 16), size=(1e-3, 1e-3), radius=0.3e-3)
    load = asp.sine(mean=0.02, amplitude=0.01, frequency=0.2)
    result = asp.solve(punch, asp.Elastic(young=1e6, poisson=0.5), load=load, times=asp.uniform(10.0, 80), fields=[])
    recwarn.clear()
    assert len(result.cycles(0.2)) == 2 and not recwarn.list
    with pytest.warns(asp.ResultWarning, match=r"cycles of 1.25664 Hz are asked for, but what was prescribed is a sine of 0.2 Hz; an angular frequency"):
        result.cycles(2 * np.pi * 0.2)
    with pytest.warns(asp.ResultWarning, match="cycles of 0.4 Hz are asked for, but what was prescribed is a sine of 0.2 Hz$"):
        result.cycles(0.4)
