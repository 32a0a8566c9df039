"""What is dropped silently at the border to numpy and xarray elsewhere: masks, units, places, later changes."""

import copy
import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import asperity as asp

SIZE = (1e-3, 1e-3)


@pytest.fixture(scope="module")
def ball():
    return asp.Surface.sphere(cells=(24, 24), size=SIZE, radius=20e-3)


@pytest.fixture(scope="module")
def zener():
    return asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)


@pytest.fixture(scope="module")
def strip():
    return asp.Surface.cylinder(cells=(64,), size=(1e-3,), radius=20e-3)


def test_masked_values_are_refused_where_they_have_no_meaning(ball, zener):
    masked = np.ma.masked_array([1.0, 2.0, 3.0], [False, True, False])
    for wrong in (
        lambda: asp.elastic(ball, 4e6, load=masked),
        lambda: asp.elastic(ball, 4e6, load=np.ma.masked),
        lambda: asp.solve(ball, zener, load=1e-3, times=masked),
        lambda: asp.table(np.ma.masked_array([[0.0, 0.0], [1.0, 5.0]], [[0, 0], [0, 1]])),
        lambda: asp.steady(ball, zener, load=1e-3, velocities=masked, boundary="periodic"),
    ):
        with pytest.raises(asp.CaseError, match="masked"):
            wrong()
    # An undefined height is one that was not measured.
    heights = np.ma.masked_array(ball.heights, ball.heights < -5e-6)
    assert np.isnan(asp.Surface(heights, size=SIZE).heights).sum() == heights.mask.sum() > 0


def test_a_material_keeps_the_numbers_that_it_was_made_of(zener):
    modulus = np.array(1e6)
    body = asp.Elastic(young=modulus, poisson=0.5)
    modulus[...] = 64e6
    for other in (body, copy.deepcopy(body), pickle.loads(pickle.dumps(body))):
        assert "young=1000000.0" in repr(other) and other.contact_compliance(0.0) == 0.75e-6
    for change in (lambda: setattr(zener, "shear", 64e6), lambda: setattr(zener, "hardness", 1e3), lambda: delattr(zener, "_body")):
        with pytest.raises(AttributeError):
            change()
    t = np.geomspace(0.1, 100, 30)
    assert isinstance(asp.fit_relaxation(t, zener.relaxation_modulus(t), poisson=0.5).terms, tuple)


def test_stages_compare_and_do_not_follow_an_array(ball, zener):
    times = np.array([1.0, 2.0])
    one, other = (asp.Stage(load=1e-3, duration=2.0, times=times) for _ in range(2))
    assert one == other and hash(one) == hash(other)
    times[...] = 0.5
    assert asp.solve(ball, zener, stages=[one], times=[2.0]).time.tolist() == [0.0, 1.0, 2.0]


def test_variables_and_histories_of_xarray_keep_their_units(ball, zener):
    xr = pytest.importorskip("xarray")
    heights = asp.Surface(xr.Variable(("y", "x"), ball.heights.T * 1e6, {"units": "um"}), size=SIZE).heights
    assert np.allclose(heights, ball.heights, rtol=1e-12)
    load = xr.DataArray(2.0, attrs={"units": "mN"})
    for given in (load, asp.step(load), asp.ramp(load, duration=1.0)):
        assert np.isclose(asp.solve(ball, zener, load=given, times=[1.0]).load[-1], 2e-3, rtol=1e-12)
    # xarray drops the unit of its array where it adds.
    microns = (ball.to_xarray() * 1e6).assign_attrs(units="um")
    assert np.allclose((ball + microns).heights, 2 * ball.heights, rtol=1e-12)
    with pytest.raises(asp.CaseError, match="surface \\+ array"):
        microns + ball


def test_a_size_that_contradicts_coordinates_is_refused(ball):
    xr = pytest.importorskip("xarray")
    for coords in ({"x": ball.x, "y": ball.y}, ball.to_xarray().coords):
        with pytest.raises(asp.CaseError, match="leave size out"):
            asp.Surface(xr.DataArray(ball.heights, dims=("x", "y"), coords=coords), size=(2e-3, 2e-3))
    # Numbers of the cells are no places.
    counted = xr.DataArray(ball.heights, dims=("x", "y"), coords={"x": np.arange(24), "y": np.arange(24)})
    assert asp.Surface(counted, size=SIZE).size == SIZE


def test_loads_of_lines_are_per_length(strip, ball):
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    elastic = asp.Elastic(young=3e6, poisson=0.5)
    line, plane = 2.0 * u.N / u.m, 2.0 * u.mN
    for load in (line, asp.step(line), asp.ramp(2e-3 * u.N / u.mm, duration=1.0)):
        assert np.isclose(asp.solve(strip, elastic, load=load, times=[1.0]).load[-1], 2.0, rtol=1e-12)
        with pytest.raises(asp.CaseError, match="must be in N"):
            asp.solve(ball, elastic, load=load, times=[1.0])
    stage = asp.Stage(load=asp.ramp(line, duration=1.0), until=("load", 1.0 * u.N / u.m), duration=1.0)
    assert np.isclose(asp.solve(strip, elastic, stages=[stage], times=[1.0]).load[-1], 1.0, rtol=1e-6)
    given = dict(material=elastic, times=[1.0])
    data = asp.study(dict(surface=strip, **given), over={"load": [line]}, progress=False)
    assert np.isclose(data["load"].values[0, -1], 2.0, rtol=1e-12)
    for surface, load in ((strip, plane), (ball, line)):
        with pytest.raises(asp.CaseError, match="load is in"):
            asp.study(dict(surface=surface, **given), over={"load": [load]}, progress=False)
    with pytest.raises(asp.CaseError, match="plain number"):
        ball.outliers(6.0 * u.Pa)


def test_a_result_that_was_replaced_is_not_mixed_with_the_new_one(ball, zener, tmp_path):
    path = tmp_path / "a.zarr"
    first = asp.solve(ball, zener, load=1e-3, times=[1.0], output=path)
    second = asp.solve(ball, zener, load=2e-3, times=[1.0], output=path, force=True)
    for use in (lambda: first.field("pressure"), lambda: first.initial_gap, lambda: first.save(tmp_path / "b.zarr")):
        with pytest.raises(OSError, match="open it again"):
            use()
    assert np.isclose(second.field("pressure").sum() * (1e-3 / 24) ** 2, 2e-3, rtol=1e-5)


def test_a_kernel_of_complex_numbers_is_refused(ball):
    for kernel in (lambda qx, qy: 1e-5 + 5e-6j + 0 * qx, np.full((13, 13), 1e-5 + 1e-6j)):
        with pytest.raises(asp.CaseError, match="real numbers"):
            asp.elastic(ball, 4e6, pressure=1e3, boundary="periodic", kernel=kernel)


def test_threads_that_share_a_march_take_turns(ball, zener):
    run = asp.march(ball, zener, load=1e-3, times=asp.uniform(1.0, 20))
    with ThreadPoolExecutor(4) as pool:
        assert sum(pool.map(lambda _: sum(1 for _ in run), range(4))) == 21
    assert np.array_equal(run.result().time, asp.solve(ball, zener, load=1e-3, times=asp.uniform(1.0, 20)).time)


def test_an_evolution_on_drawn_axes_keeps_their_scale(ball, zener):
    pytest.importorskip("matplotlib").use("Agg")
    slow = asp.solve(ball, zener, load=1e-3, times=asp.uniform(1.0, 10))
    decades = asp.solve(ball, zener, load=1e-3, times=asp.log(100.0, 20, first=1e-3))
    axes = slow.plot.evolution()
    decades.plot.evolution(axes=axes)
    assert {ax.get_xscale() for ax in axes.ravel()} == {"linear"}
    assert {ax.get_xscale() for ax in decades.plot.evolution().ravel()} == {"log"}
