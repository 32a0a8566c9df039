"""Units of xarray attributes, as pint, CF and people write them."""

import numpy as np
import pytest

import asperity as asp
from asperity._units import bare

xr = pytest.importorskip("xarray")
SIZE = (1e-3, 1e-3)


def held(value, units):
    return xr.DataArray(value, attrs={"units": units})


@pytest.mark.parametrize(
    ("units", "unit", "factor"),
    [
        ("newton / millimeter ** 2", "Pa", 1e6),
        ("N/mm**2", "Pa", 1e6),
        ("N mm-2", "Pa", 1e6),
        ("megapascal", "Pa", 1e6),
        ("Pascals", "Pa", 1.0),
        ("kilogram / meter / second ** 2", "Pa", 1.0),
        ("psi", "Pa", 6894.757293168361),
        ("pound_force / inch ** 2", "Pa", 4.4482216152605 / 0.0254**2),
        ("1 / megapascal", "1/Pa", 1e-6),
        ("pascal * second", "Pa s", 1.0),
        ("N per mm", "N/m", 1e3),
        ("1/second", "1/s", 1.0),
        ("kilohertz", "1/s", 1e3),
        ("1/inch", "1/m", 1 / 0.0254),
        ("inches", "m", 0.0254),
        ("micrometers", "m", 1e-6),
        ("µm", "m", 1e-6),
        ("hour", "s", 3600.0),
        ("minutes", "s", 60.0),
        ("millisecond", "s", 1e-3),
        ("percent", "", 0.01),
        ("degree", "rad", np.pi / 180),
        ("delta_degree_Celsius", "K", 1.0),
    ],
)
def test_words_and_operators_are_understood(units, unit, factor):
    assert bare("c2" if unit == "K" else "value", held(3.0, units), unit) == pytest.approx(3.0 * factor, rel=1e-14)


@pytest.mark.parametrize(
    ("units", "unit"),
    [("newton / millimeter", "Pa"), ("furlong", "m"), ("degree", ""), ("radian", ""), ("", "m"), ("kelvin", "m"), ("mn", "m"), ("N/(inch m)", "Pa"), ("** 2", "m")],
)
def test_other_units_are_refused(units, unit):
    with pytest.raises(asp.CaseError, match="value"):
        bare("value", held(3.0, units), unit)


def test_what_pint_writes_into_attributes_is_read_back():
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    for text, unit, of in (("MPa", "Pa", "Pa"), ("N/mm**2", "Pa", "Pa"), ("rpm", "1/s", "1/min"), ("g/mol", "kg/mol", "kg/mol"), ("um/s", "m/s", "m/s")):
        quantity = u.Quantity(2.0, text)
        for form in ("", "~", "~P", "C", "P"):
            written = format(quantity.units, form)
            if text == "rpm":
                assert asp._units.frequency("f", held(2.0, written), angular=False) == pytest.approx(2.0 / 60)
            else:
                assert bare("value", held(2.0, written), unit) == pytest.approx(quantity.m_as(of), rel=1e-14)


def test_frequencies_and_angles_with_words():
    assert asp.sine(mean=1.0, amplitude=0.5, frequency=held(np.pi, "radian / second")).numbers[2] == pytest.approx(0.5)
    assert asp.sine(mean=1.0, amplitude=0.5, frequency=held(2.0, "hertz")).numbers[2] == 2.0
    turned = dict(cells=(16, 16), size=SIZE, hurst=0.8, rms_height=1e-6, longest=5e-4, shortest=1.5e-4, lay_ratio=2.0)
    one, other = (asp.Surface.self_affine(**turned, lay_angle=angle) for angle in (held(90.0, "degrees"), np.pi / 2))
    assert one == other


def test_temperatures_are_no_differences():
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    shift = dict(c1=8.86, c2=101.6)
    for reference in (held(20.0, "degC"), held(20.0, "degree_Celsius"), held(20.0, "°C"), held(68.0, "degF"), u.Quantity(20, "degC")):
        assert asp.wlf(**shift, reference=reference).numbers[2] == pytest.approx(293.15, rel=1e-12)
    for reference in (20 * u.delta_degC, held(20.0, "delta_degC")):
        with pytest.raises(asp.CaseError, match="difference"):
            asp.wlf(**shift, reference=reference)
        assert asp.wlf(c1=8.86, c2=reference, reference=293.15).numbers[1] == 20.0
    with pytest.raises(asp.CaseError, match="difference"):
        asp.wlf(c1=8.86, c2=held(20.0, "degC"), reference=293.15)


def test_a_velocity_of_a_field_is_no_time():
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, np.inf))
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    sweep = asp.steady(wave, rubber, pressure=20e3, velocities=[0.05, 0.1], every=1, boundary="periodic")
    assert np.array_equal(sweep.field("pressure", velocity=50 * u.mm / u.s), sweep.field("pressure", index=0))
    with pytest.raises(asp.CaseError, match="velocity is in"):
        sweep.field("pressure", velocity=0.05 * u.s)


def test_a_hardness_lies_where_the_surface_lies():
    ball = asp.Surface.sphere(cells=(16, 16), size=SIZE, radius=20e-3)
    array = ball.to_xarray()
    hard = (xr.zeros_like(array) + 1e5).assign_attrs(units="Pa")
    asp.elastic(array, 4e6, load=1e-3, hardness=hard)
    beside = hard.assign_coords(x=hard.x + 1.0).assign_coords(y=hard.y)
    beside.x.attrs["units"] = "m"
    steel = asp.Elastic(young=1e8, poisson=0.3)
    for solved in (
        lambda: asp.elastic(array, 4e6, load=1e-3, hardness=beside),
        lambda: asp.elastic(array, 4e6, load=1e-3, start=beside),
        lambda: asp.solve(array, steel, load=1e-3, times=[1.0], hardness=beside),
    ):
        with pytest.raises(asp.CaseError, match="begins at 1.00003 m"):
            solved()


def test_sizes_whose_squares_are_no_numbers_are_refused():
    heights = np.zeros((4, 4))
    for size in (0.0, -1.0, 1e-200, 1e200, np.nan, np.inf):
        with pytest.raises(asp.CaseError, match="size is"):
            asp.Surface(heights, size=(size, size))
    with pytest.raises(asp.CaseError, match="thickness"):
        asp.Layer(thickness=1e307, material=asp.Elastic(young=1e6, poisson=0.5))
