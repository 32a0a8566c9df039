"""What is given in other forms means the same, or is refused: units of frequencies, coordinates of arrays, times from 0."""

import numpy as np
import pytest

import asperity as asp

ZENER = asp.Zener(shear=1e6, shear_kelvin=2e6, retardation_time=2.0, poisson=0.5)
TURN = 2 * np.pi


class Quantity:
    """A number with a unit, as far as asperity uses those of pint; an angle is a plain number in rad."""

    # Kind and factor to the SI unit.
    UNITS = {
        "hertz": ("1/s", 1.0), "kilohertz": ("1/s", 1e3), "revolutions_per_minute": ("1/s", TURN / 60), "radian / second": ("1/s", 1.0),
        "degree": ("dimensionless", np.pi / 180), "percent": ("dimensionless", 0.01), "degree_Celsius": ("K", 1.0), "delta_degree_Celsius": ("K", 1.0),
        "micrometer": ("m", 1e-6), "millinewton": ("N", 1e-3), "second": ("s", 1.0), "kilopascal": ("Pa", 1e3), "dimensionless": ("dimensionless", 1.0),
    }  # fmt: skip

    def __init__(self, value, units):
        self.value, self.units = value, units

    magnitude = property(lambda self: self.value)

    def m_as(self, wanted):
        kind, factor = self.UNITS[self.units]
        if kind != {"rad/s": "1/s"}.get(wanted, wanted):
            raise ValueError(f"Cannot convert from '{self.units}' to '{wanted}'")
        return self.value * factor + (273.15 if self.units == "degree_Celsius" else 0.0)

    def __array__(self, dtype=None, copy=None):
        # As those of pint in a list: without the unit they are not plain numbers.
        raise TypeError("the unit would be lost")


Q = Quantity


@pytest.fixture
def xarray():
    return pytest.importorskip("xarray")


def test_frequencies_are_cycles_or_angular_by_their_unit(xarray):
    omega = np.geomspace(0.01, 100, 40)
    moduli = ZENER.storage_loss(omega)
    plain = asp.fit_dma(omega / TURN, *moduli, poisson=0.5)
    labelled = [xarray.DataArray(omega / scale, attrs={"units": unit}) for scale, unit in ((1, "rad/s"), (TURN, "Hz"), (TURN / 60, "rpm"))]
    for given in (Q(omega, "radian / second"), Q(omega / TURN, "hertz"), Q(omega / TURN * 60, "revolutions_per_minute"), *labelled):
        for angular in (False, True):
            fit = asp.fit_dma(given, *moduli, poisson=0.5, angular=angular)
            # The relaxation time of this solid is that of its retardation times G1/(G0 + G1).
            assert fit.terms[0][1] == pytest.approx(plain.terms[0][1], rel=1e-9) == pytest.approx(4 / 3, rel=1e-4)
        assert np.allclose(ZENER.storage_loss(given), moduli, rtol=1e-12)
    # A plain number is angular where the function says so.
    assert np.array_equal(ZENER.storage_loss(xarray.DataArray(omega)), moduli)
    for given in (Q(TURN, "radian / second"), Q(60.0, "revolutions_per_minute"), Q(1.0, "hertz"), Q(1e-3, "kilohertz"), 1.0):
        assert asp.sine(mean=1.0, amplitude=0.5, frequency=given).numbers == pytest.approx((1.0, 0.5, 1.0), rel=1e-15)
    ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=20e-3)
    result = asp.solve(ball, ZENER, load=asp.sine(mean=1e-3, amplitude=5e-4, frequency=1.0), times=asp.uniform(2.0, 40), fields=[])
    assert len(result.cycles(Q(TURN, "radian / second"))) == len(result.cycles(Q(60.0, "revolutions_per_minute"))) == len(result.cycles(1.0)) == 2
    with pytest.raises(asp.CaseError, match="1/s"):
        asp.sine(mean=1.0, amplitude=0.5, frequency=Q(1.0, "micrometer"))


def test_an_angle_is_no_slope_and_a_temperature_no_difference():
    grid = dict(cells=(8, 8), size=(1e-3, 1e-3))
    with pytest.raises(asp.CaseError, match="slope is in degree.*tangent"):
        asp.Surface.cone(**grid, slope=Q(45.0, "degree"))
    with pytest.raises(asp.CaseError, match="rms_gradient is in degree"):
        asp.Surface.self_affine(**grid, hurst=0.8, rms_gradient=Q(10.0, "degree"), longest=1e-3, shortest=3e-4)
    assert asp.Surface.cone(**grid, slope=Q(50.0, "percent")) == asp.Surface.cone(**grid, slope=0.5)
    with pytest.raises(asp.CaseError, match="difference"):
        asp.wlf(c1=8.86, c2=Q(101.6, "degree_Celsius"), reference=293.15)
    shift = asp.wlf(c1=8.86, c2=Q(101.6, "delta_degree_Celsius"), reference=Q(20.0, "degree_Celsius"))
    assert shift.numbers == pytest.approx((8.86, 101.6, 293.15))


def test_pint_at_the_borders():
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    assert asp.sine(mean=1, amplitude=1, frequency=60 * u.rpm).numbers[2] == pytest.approx(1.0)
    assert asp.sine(mean=1, amplitude=1, frequency=TURN * u("rad/s")).numbers[2] == pytest.approx(1.0)
    assert np.allclose(ZENER.storage_loss(1 * u.Hz), ZENER.storage_loss(TURN))
    for wrong in (lambda: asp.Surface.cone(cells=(8, 8), size=(1.0, 1.0), slope=45 * u.degree),
                  lambda: asp.wlf(c1=8.86, c2=u.Quantity(101.6, "degC"), reference=293.15)):  # fmt: skip
        with pytest.raises(asp.CaseError):
            wrong()
    assert asp.wlf(c1=8.86, c2=101.6 * u.delta_degC, reference=293.15).numbers[1] == pytest.approx(101.6)
    ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    assert ball * (50 * u.percent) == ball * 0.5
    assert np.allclose(asp.Surface((50 * u.percent) * ball).heights, 0.5 * ball.heights, rtol=1e-15)
    for wrong in (lambda: ball * (2 * u.um), lambda: asp.elastic((2 * u.um) * ball, 1e6, load=1e-3)):
        with pytest.raises(asp.CaseError):
            wrong()
    assert asp.table([(0 * u.s, 0 * u.N), (1 * u.s, 1 * u.mN)]).points == ((0.0, 0.0), (1.0, pytest.approx(1e-3)))


def test_points_and_scales_take_quantities():
    assert asp.table([(Q(0.0, "second"), Q(0.0, "millinewton")), (Q(1.0, "second"), Q(1.0, "millinewton"))]).points == ((0.0, 0.0), (1.0, 1e-3))
    ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    shifted = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5, shift=asp.wlf(c1=8.86, c2=101.6, reference=293.15))
    given = dict(load=1e-3, times=[1.0], fields=[])
    warm = asp.solve(ball, shifted, temperature=[(Q(0.0, "second"), Q(30.0, "degree_Celsius"))], **given)
    assert np.array_equal(warm.approach, asp.solve(ball, shifted, temperature=[(0.0, 303.15)], **given).approach)
    half = ball * Q(50.0, "percent")
    assert half == ball / 2 == ball / Q(200.0, "percent")
    # pint multiplies whatever it finds, and holds it.
    assert np.allclose(asp.Surface(Q(ball, "percent")).heights, 0.01 * ball.heights, rtol=1e-15)
    for wrong in (lambda: ball * Q(2.0, "micrometer"), lambda: asp.Surface(Q(ball, "micrometer"))):
        with pytest.raises(asp.CaseError, match="micrometer"):
            wrong()


def test_a_dataset_is_a_surface_where_it_holds_one_map(xarray):
    ball = asp.Surface.sphere(cells=(8, 6), size=(1e-3, 1e-3), radius=1e-2)
    data = ball.to_xarray().to_dataset(name="z")
    assert np.allclose(asp.Surface(data).heights, ball.heights) and asp.Surface(data).cells == (8, 6)
    with pytest.raises(asp.CaseError, match="holds z, noise"):
        asp.Surface(data.assign(noise=data.z))


def test_times_may_begin_with_the_start():
    assert asp.listed(np.linspace(0, 1, 5)) == asp.listed([0.25, 0.5, 0.75, 1.0])
    ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    result = asp.solve(ball, ZENER, load=1e-3, times=np.linspace(0, 1, 5), fields=[])
    assert result.time.tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    with pytest.raises(asp.CaseError):
        asp.solve(ball, ZENER, load=1e-3, times=[0.0])


@pytest.fixture(scope="module")
def rough():
    return asp.Surface.self_affine(cells=(32, 24), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.05, longest=5e-4, shortest=1e-4, seed=1)


def test_falling_coordinates_are_turned_everywhere(rough, xarray):
    def labelled(values):
        data = xarray.DataArray(values, dims=("x", "y"), coords={"x": rough.x, "y": rough.y})
        # The same map with its first cell last, and its dimensions the other way round.
        return data, data[::-1], data[:, ::-1].T

    given = dict(boundary="periodic", load=1e-2)
    soft = np.full(rough.cells, 5e5)
    soft[:16] = 1e4
    hard = asp.elastic(rough, 4e6, hardness=soft, **given)
    for same in labelled(soft):
        assert np.array_equal(asp.elastic(rough, 4e6, hardness=same, **given).pressure, hard.pressure)
    plain = asp.elastic(rough, 4e6, **given)
    below = asp.stress(plain.pressure, size=rough.size, depths=[5e-5], poisson=0.5)
    for same in labelled(plain.pressure):
        # The size follows from the coordinates.
        assert np.allclose(asp.stress(same, depths=[5e-5], poisson=0.5).mises, below.mises, rtol=1e-9, atol=1e-9 * below.mises.max())
        assert asp.elastic(rough, 4e6, start=same, **given).iterations < plain.iterations
    leak = asp.leakage(plain.gap, plain.pressure > 0, size=rough.size)
    for gap, contact in zip(labelled(plain.gap), labelled(plain.pressure > 0)[::-1]):
        same = asp.leakage(gap, contact)
        assert same.hydraulic_gap == pytest.approx(leak.hydraulic_gap, rel=1e-9) and same.open_fraction == leak.open_fraction


def test_coordinates_of_another_size_are_refused(rough, xarray):
    wide = xarray.DataArray(np.full(rough.cells, 1e5), dims=("x", "y"), coords={"x": 2 * rough.x, "y": rough.y})
    for call in (
        lambda: asp.elastic(rough, 4e6, hardness=wide, load=1e-2, boundary="periodic"),
        lambda: asp.elastic(rough, 4e6, start=wide, load=1e-2, boundary="periodic"),
        lambda: asp.solve(rough, ZENER, hardness=wide, load=1e-2, times=[1.0], boundary="periodic"),
        lambda: asp.leakage(rough.gap(), wide > 0, size=rough.size),
    ):
        with pytest.raises(asp.CaseError, match="coordinate x of .* spans 0.002 m"):
            call()
    with pytest.raises(asp.CaseError, match="size"):
        asp.stress(np.ones((8, 8)), poisson=0.3)


def test_a_kernel_has_units(rough, xarray):
    waves = [TURN * np.arange(n // 2 + 1) / 1e-3 for n in rough.cells]
    with np.errstate(divide="ignore"):
        half_space = 2 / np.hypot(*np.meshgrid(*waves, indexing="ij"))
    given = dict(pressure=1e4, boundary="periodic")
    plain = asp.elastic(rough, 4e6, kernel=half_space, **given)
    data = xarray.DataArray(half_space * 1e6, dims=("qx", "qy"), attrs={"units": "um"})
    for same in (Q(half_space * 1e6, "micrometer"), data, data.T):
        assert asp.elastic(rough, 4e6, kernel=same, **given).approach == pytest.approx(plain.approach, rel=1e-9)
    with pytest.raises(asp.CaseError, match="kernel"):
        asp.elastic(rough, 4e6, kernel=Q(half_space, "second"), **given)


def test_messages_say_plain_numbers_and_units():
    with pytest.raises(asp.CaseError) as told:
        asp.uniform(1.0, np.float64(2.5))
    assert "np." not in str(told.value)
    with pytest.raises(asp.CaseError, match="heights is in dimensionless, but must be in m"):
        asp.Surface(Q(np.zeros((4, 4)), "dimensionless"), size=(1.0, 1.0))
    with pytest.raises(FileNotFoundError, match="nope.toml"):
        asp.run("nope.toml")


def test_degrees_celsius_for_kelvin_warn(recwarn):
    with pytest.warns(asp.ResultWarning, match="20 °C is 293.15 K"):
        shift = asp.wlf(c1=8.86, c2=101.6, reference=20.0)
    with pytest.warns(asp.ResultWarning, match="reference is 25 K"):
        asp.arrhenius(activation_energy=1e5, reference=25.0)
    material = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5, shift=shift)
    ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    with pytest.warns(asp.ResultWarning, match="temperature is 25 K"):
        asp.solve(ball, material, load=1e-3, times=[1.0], temperature=25.0)
    recwarn.clear()
    asp.wlf(c1=8.86, c2=101.6, reference=Q(20.0, "degree_Celsius"))
    assert not recwarn.list


def test_the_window_of_a_fit_has_units():
    omega = np.geomspace(0.01, 100, 40)
    moduli = ZENER.storage_loss(omega)
    plain = asp.fit_dma(omega, *moduli, angular=True, window=(0.1, 10.0))
    same = asp.fit_dma(omega, *moduli, angular=True, window=(Q(0.1, "radian / second"), Q(10.0 / TURN, "hertz")))
    assert same.terms == plain.terms and len(same.x) == len(plain.x) < 40
    with pytest.raises(asp.CaseError, match="window"):
        asp.fit_dma(omega, *moduli, window=(Q(0.1, "second"), Q(1.0, "second")))
    relaxed = asp.fit_relaxation(omega, ZENER.relaxation_modulus(omega), window=(Q(0.1, "second"), Q(10.0, "second")))
    assert len(relaxed.x) == len(plain.x)


def test_a_case_that_holds_itself_is_refused():
    case, stages = {}, []
    case["domain"] = case
    stages.append(stages)
    for given in [case, {"load": {"stages": stages}}]:
        with pytest.raises(asp.CaseError, match="deep"):
            asp.check(given)


def test_points_are_a_table_wherever_a_history_is_taken(tmp_path):
    ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    given = dict(times=[0.5, 1.0], fields=[])
    table = asp.solve(ball, ZENER, load=asp.table([(0.0, 0.0), (1.0, 1e-3)]), **given).load
    for points in ([(0, 0), (1, 1e-3)], ((0.0, 0.0), [1.0, 1e-3]), np.array([[0.0, 0.0], [1.0, 1e-3]], dtype=">f4")):
        assert np.allclose(asp.solve(ball, ZENER, load=points, **given).load, table, rtol=1e-6)
    with pytest.raises(asp.CaseError, match="load is"):
        asp.solve(ball, ZENER, load=[0.0, 1e-3], **given)


def test_a_case_that_is_not_there_is_an_os_error(tmp_path):
    pytest.importorskip("xarray")
    for missing in (
        lambda: asp.study("none.toml", over={"load.history.value": ["1 N"]}),
        lambda: asp.study("none.toml", vary={"load.history.value": ["1 N"]}, directory=tmp_path),
        lambda: asp.converge("none.toml"),
        lambda: asp.check("none.toml"),
    ):
        with pytest.raises(FileNotFoundError, match="none.toml"):
            missing()


def test_an_angle_says_itself_how_many_quarter_turns_it_is():
    u = pytest.importorskip("pint", reason="pint is not installed").UnitRegistry()
    ball = asp.Surface(np.arange(12.0).reshape(3, 4) * 1e-9, size=(3e-3, 4e-3))
    for angle, turns in ((90 * u.deg, 1), (np.pi * u.rad, 2), (-90 * u.deg, -1)):
        assert ball.rotate(angle) == ball.rotate(turns)
    with pytest.raises(asp.CaseError, match="whole number"):
        ball.rotate(45 * u.deg)


def test_a_study_takes_columns():
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    pytest.importorskip("xarray")
    ball = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    loads = [1e-3, 2e-3]
    for values in (pandas.Series(loads), iter(loads)):
        data = asp.study(dict(surface=ball, material=ZENER, times=[1.0]), {"load": values}, progress=False, workers=1)
        assert data["load_given"].values.tolist() == loads
