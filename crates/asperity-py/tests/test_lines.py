"""Line contacts: surfaces, contacts and results of one dimension."""

import json

import numpy as np
import pytest

import asperity as asp

RADIUS, MODULUS, LOAD = 10e-3, 1e9, 2e3
HALF_WIDTH = np.sqrt(4 * LOAD * RADIUS / (np.pi * MODULUS))  # Hertz, Johnson (1985), eq. 4.43


def cylinder(cells: int = 256) -> asp.Surface:
    return asp.Surface.cylinder(cells=cells, size=4 * HALF_WIDTH, radius=RADIUS)


def test_a_profile_has_one_dimension() -> None:
    surface = cylinder()
    assert surface.is_line and surface.heights.shape == (256,) and surface.cells == (256,)
    assert surface.size == (4 * HALF_WIDTH,)
    assert surface.gap().shape == (256,) and surface.gap().min() == 0
    same = asp.Surface(surface.heights, size=4 * HALF_WIDTH)
    assert np.array_equal((surface + same).heights, 2 * surface.heights)
    assert "a line of 256 cells" in repr(-surface) and repr(surface).startswith("Surface.cylinder(cells=(256,)")
    rough = asp.Surface.self_affine(cells=256, size=1e-3, hurst=0.8, rms_height=1e-6, longest=5e-4, shortest=5e-5, seed=1)
    assert rough.heights.shape == (256,)
    assert rough.heights.std() == pytest.approx(1e-6, rel=1e-9)  # the rms height is exact
    for make in (
        lambda: asp.Surface.wedge(cells=(64,), size=(1e-3,), slope=0.1),
        lambda: asp.Surface.flat_punch(cells=64, size=1e-3, sides=0.5e-3),
        lambda: asp.Surface.flat_punch(cells=64, size=1e-3, radius=0.25e-3),
        lambda: asp.Surface.wave(cells=64, size=1e-3, amplitude=1e-6, wavelength=0.5e-3),
    ):
        assert make().heights.shape == (64,)


def test_lines_and_planes_are_not_mixed() -> None:
    with pytest.raises(asp.CaseError, match="size is"):
        asp.Surface(np.zeros(8), size=(1e-3, 1e-3))
    with pytest.raises(asp.CaseError, match="size is"):
        asp.Surface(np.zeros((8, 8)), size=1e-3)
    with pytest.raises(asp.CaseError, match="both must have"):
        asp.Surface.cylinder(cells=8, size=(1e-3, 1e-3), radius=1.0)
    with pytest.raises(asp.CaseError, match="cylinder"):
        asp.Surface.sphere(cells=8, size=1e-3, radius=1.0)
    with pytest.raises(asp.CaseError, match="over a plane"):
        cylinder().autocorrelation()
    plane = asp.Surface.cylinder(cells=(8, 4), size=(1e-3, 1e-3), radius=1.0)
    assert np.all(plane.heights == plane.heights[:, :1])


def test_elastic_is_the_line_contact_of_hertz() -> None:
    contact = asp.elastic(cylinder(), MODULUS, load=LOAD, tolerance=1e-9)
    assert contact.pressure.shape == contact.gap.shape == contact.displacement.shape == (256,)
    assert contact.load == pytest.approx(LOAD, rel=1e-12)
    assert contact.pressure.max() == pytest.approx(2 * LOAD / (np.pi * HALF_WIDTH), rel=3e-4)  # second order in the cell
    assert contact.contact_area == pytest.approx(2 * HALF_WIDTH, abs=2 * 4 * HALF_WIDTH / 256)  # a cell at each end
    assert np.abs(contact.gap[contact.pressure > 0]).max() < 1e-8 * contact.approach  # the tolerance
    assert "N/m" in repr(contact) and "length" in repr(contact)
    with pytest.raises(asp.CaseError, match="periodic"):
        asp.elastic(cylinder(), MODULUS, approach=1e-6)
    # The march solves the same contact, displacements from the same place.
    result = asp.solve(cylinder(), asp.Elastic(young=0.75 * MODULUS, poisson=0.5), load=LOAD, times=[1.0], tolerance=1e-9)
    assert result.approach[-1] == pytest.approx(contact.approach, rel=1e-6)


def test_a_result_has_fields_over_x(tmp_path) -> None:
    rubber = asp.Zener(shear=1e8, shear_kelvin=1e8, retardation_time=1.0, poisson=0.5)
    names = ["pressure", "gap", "displacement", "contact"]
    wanted = ["contact_spots", "largest_spot", "contact_perimeter", "spot_histogram"]
    result = asp.solve(cylinder(), rubber, load=0.2 * LOAD, times=asp.uniform(2.0, 4), fields=names, quantities=wanted)
    assert result.is_line and result.cells == (256,) and result.size == (4 * HALF_WIDTH,)
    assert result.x.shape == result.initial_gap.shape == result.field("pressure").shape == (256,)
    assert (result.units("load"), result.units("contact_area"), result.units("contact_perimeter")) == ("N/m", "m", "1")
    assert np.all(result.contact_perimeter == 2)  # two ends
    assert np.allclose(result.largest_spot, result.contact_area, rtol=1e-12)  # one spot
    with pytest.raises(AttributeError, match="no y"):
        result.y
    below = result.stress(index=0)
    assert below.mises.shape == (25, 256)
    path = tmp_path / "line.zarr"
    result.save(path)
    stored = asp.open(path)
    assert stored.is_line and stored.size == result.size
    for name in names:
        assert np.array_equal(stored.field(name), result.field(name))
    assert np.array_equal(stored.initial_gap, result.initial_gap)
    document = json.loads((path / "zarr.json").read_text())["attributes"]
    assert (document["cells"], document["size"]) == ([256], [4 * HALF_WIDTH])
    xarray = pytest.importorskip("xarray")
    for data in (result.to_xarray(), xarray.open_zarr(path)):
        assert data["pressure"].dims == ("field_time", "x") and "y" not in data.coords
        assert data["load"].attrs["units"] == "N/m" and data["contact_area"].attrs["units"] == "m"
    result.report(tmp_path / "line.html")
    assert "N/m" in (tmp_path / "line.html").read_text()


def test_every_figure_of_a_line_contact_is_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    names = ["pressure", "gap", "displacement", "contact"]
    result = asp.solve(cylinder(64), asp.Elastic(young=1e9, poisson=0.3), load=LOAD, times=[1.0], fields=names)
    for draw in ("evolution", "load_displacement", "pressure", "gap", "displacement", "contact", "profile"):
        getattr(result.plot, draw)()
    assert "N/m" in result.plot.load_displacement().get_ylabel()
    cylinder(64).plot.heights()
    cylinder(64).plot.bearing_curve()


def test_a_profile_is_read_levelled_and_described(tmp_path) -> None:
    x = np.arange(2000) * 1e-6
    heights = 2e-6 * np.sin(2 * np.pi * x / 100e-6) + 0.01 * x
    path = tmp_path / "stylus.csv"
    path.write_text("Lateral um, Total Profile nm\n" + "".join(f"{1e6 * a:.3f}, {1e9 * z:.6f}\n" for a, z in zip(x, heights)))
    profile = asp.Surface.read(path, level="plane")
    assert profile.is_line and profile.size == pytest.approx((2e-3,), rel=1e-9)
    found = profile.statistics()
    assert found["rq"] == pytest.approx(2e-6 / np.sqrt(2), rel=2e-3)  # what the straight line takes of the sine
    assert found["rsm"] == pytest.approx(100e-6, rel=2e-3)
    # Half of a wave of the cut-off is left; the ends, a twentieth of the length, keep less.
    assert profile.statistics(longest=100e-6)["rq"] == pytest.approx(0.5 * found["rq"], rel=0.1)
    flat = profile.process("circle radius=10mm")
    assert "circle of radius" in flat.history[-1] and flat.is_line
