"""Units that come along are honoured or refused, never dropped."""

import numpy as np
import pytest

import asperity as asp

STEEL = asp.Elastic(young=1e8, poisson=0.3)


class Quantity:
    """A number with a unit, as far as asperity uses those of pint: `m_as`, `units`, and numpy drops the unit."""

    FACTORS = {"um": ("m", 1e-6), "mm": ("m", 1e-3), "kN": ("N", 1e3), "MPa": ("Pa", 1e6), "ms": ("s", 1e-3), "percent": ("dimensionless", 0.01)}

    def __init__(self, value, units):
        self.value, self.units = value, units

    def m_as(self, wanted):
        unit, factor = self.FACTORS[self.units]
        if unit != wanted:
            raise ValueError(f"Cannot convert from '{self.units}' to '{wanted}'")
        return self.value * factor

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.value, dtype=dtype)

    def __float__(self):
        return float(self.value)


def sphere(**change):
    return asp.Surface.sphere(**{**dict(cells=(24, 20), size=(1e-3, 1e-3), radius=5e-3), **change})


def test_quantities_are_converted_wherever_a_number_is_taken():
    q = Quantity
    surface = sphere(size=(q(1000, "um"), q(1, "mm")), radius=q(5, "mm"))
    assert np.allclose(surface.size, (1e-3, 1e-3), rtol=1e-15) and np.allclose(surface.heights, sphere().heights, rtol=1e-12)
    plain = asp.solve(sphere(), STEEL, load=1.0, times=[0.5], hardness=4e6)
    for same in (
        asp.solve(sphere(), asp.Elastic(young=q(100, "MPa"), poisson=0.3), load=q(0.001, "kN"), times=[q(500, "ms")], hardness=q(4, "MPa")),
        asp.solve(sphere(), STEEL, load=asp.step(q(0.001, "kN")), times=q(np.array([500.0]), "ms"), hardness=q(np.full((24, 20), 4.0), "MPa")),
        asp.solve(q(sphere().heights * 1e6, "um"), STEEL, size=(1e-3, 1e-3), load=asp.table([(0, q(0.001, "kN"))]), times=[0.5], hardness=4e6),
    ):
        assert np.allclose(same.approach, plain.approach, rtol=1e-9) and np.allclose(same.load, plain.load, rtol=1e-12)
        assert same.max_pressure[-1] == pytest.approx(plain.max_pressure[-1], rel=1e-9)
    contact = asp.elastic(sphere(), q(100, "MPa"), load=q(0.001, "kN"))
    assert contact.load == pytest.approx(1.0, rel=1e-9)
    curve = asp.elastic(sphere(), 1e8, load=q(np.array([0.0005, 0.001]), "kN"))
    assert curve.load == pytest.approx([0.5, 1.0], rel=1e-9)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda q: sphere(radius=q(1, "kN")),
        lambda q: sphere(size=(q(1, "MPa"), 1e-3)),
        lambda q: asp.Elastic(young=q(1, "mm"), poisson=0.3),
        lambda q: asp.Elastic(young=1e6, poisson=q(1, "mm")),
        lambda q: asp.solve(sphere(), STEEL, load=q(1, "MPa"), times=[1.0]),
        lambda q: asp.solve(sphere(), STEEL, approach=asp.step(q(1, "kN")), times=[1.0]),
        lambda q: asp.solve(sphere(), STEEL, load=1.0, times=[q(1, "mm")]),
        lambda q: asp.solve(sphere(), STEEL, load=1.0, times=[1.0], hardness=q(np.ones((24, 20)), "mm")),
        lambda q: asp.solve(sphere(), STEEL, load=1.0, times=[1.0], tolerance=q(1e-6, "mm")),
        lambda q: asp.Surface(q(np.zeros((4, 4)), "kN"), size=(1e-3, 1e-3)),
        lambda q: asp.sine(mean=q(1, "kN"), amplitude=0.5, frequency=1.0),
        lambda q: asp.stress(np.ones((8, 8)), size=(1e-3, 1e-3), poisson=0.3, depths=[q(1, "kN")]),
    ],
)
def test_a_quantity_of_another_kind_is_refused(wrong):
    with pytest.raises(asp.CaseError):
        wrong(Quantity)


def test_pint_is_understood():
    pint = pytest.importorskip("pint")
    u = pint.UnitRegistry()
    with pytest.raises(asp.CaseError, match="newton|must be in m"):
        sphere(radius=5 * u.N)
    result = asp.solve(
        sphere(size=(1000 * u.um, 1 * u.mm), radius=5 * u.mm), asp.Elastic(young=100 * u.MPa, poisson=0.3), load=0.001 * u.kN,
        times=np.array([0.25, 0.5]) * u.s, field_times=[500 * u.ms],
    )
    assert result.load[-1] == pytest.approx(1.0, rel=1e-9) and result.time[-1] == 0.5
    layer = asp.wlf(c1=8.86, c2=101.6 * u.kelvin, reference=u.Quantity(20, "degC"))
    assert layer.numbers[2] == pytest.approx(293.15)
    assert asp.slide(sphere(), STEEL, load=1.0, velocity=1 * u.mm / u.s, times=[0.05]).velocity[-1] == pytest.approx(1e-3)
    for name in [*asp._columns.ROW, *asp._columns.QUANTITIES]:
        u.Quantity(1.0, result.units(name))
    xarray = pytest.importorskip("xarray")
    data = result.to_xarray()
    assert isinstance(data, xarray.Dataset)
    for name in data.variables:
        u.Quantity(1.0, data[name].attrs["units"])
    assert u.Quantity(float(data.contact_area[-1]), data.contact_area.attrs["units"]).to("mm^2").magnitude > 0


def labelled(surface, units="m", factor=1.0, axes="m", axis_factor=1.0):
    data = pytest.importorskip("xarray").DataArray(
        surface.heights * factor, dims=("x", "y"), coords={"x": surface.x * axis_factor, "y": surface.y * axis_factor}, attrs={"units": units}
    )
    for name in "xy":
        data.coords[name].attrs["units"] = axes
    return data


def test_units_and_order_of_a_labelled_array_count():
    surface = sphere()
    plain = asp.elastic(surface, 1e8, load=1.0)
    array = labelled(surface, "um", 1e6, "mm", 1e3)
    for given in (array, array.T, array.isel(x=slice(None, None, -1)), labelled(surface, "micrometer", 1e6)):
        same = asp.Surface(given)
        assert same.cells == (24, 20) and np.allclose(same.size, surface.size, rtol=1e-12)
        assert np.allclose(same.heights, surface.heights, rtol=0, atol=1e-18)
        assert asp.elastic(given, 1e8, load=1.0).approach == pytest.approx(plain.approach, rel=1e-9)
        assert asp.solve(given, STEEL, load=1.0, times=[1.0]).cells == (24, 20)
    hard = pytest.importorskip("xarray").DataArray(np.full((20, 24), 3.0), dims=("y", "x"), attrs={"units": "MPa"})
    assert asp.elastic(surface, 1e8, load=2.0, hardness=hard).max_pressure == 3e6
    with pytest.raises(asp.CaseError, match="N"):
        asp.Surface(labelled(surface, "N"))
    with pytest.raises(asp.CaseError, match="not understood"):
        asp.Surface(labelled(surface, "furlong"))
    with pytest.raises(asp.CaseError, match="evenly"):
        asp.Surface(array.assign_coords(x=np.geomspace(1, 2, 24)))
    with pytest.raises(asp.CaseError, match="size"):
        asp.elastic(array, 1e8, load=1.0, size=(1.0, 1.0))
    with pytest.raises(asp.CaseError, match="dimensions"):
        asp.Surface(array.expand_dims(time=2))


def test_slips_of_units_warn():
    rough = asp.Surface.self_affine(cells=(64, 64), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.1, longest=5e-4, shortest=6e-5)
    with pytest.warns(asp.ResultWarning, match="unlikely-unit"):
        asp.elastic(rough.heights * 1e6, 1e8, size=rough.size, pressure=1e5, boundary="periodic")
    with pytest.warns(asp.ResultWarning, match="large-strain"):
        asp.elastic(rough, 100.0, pressure=1e5, boundary="periodic")
    with pytest.warns(asp.ResultWarning, match="large-strain"):
        asp.solve(rough, asp.Elastic(young=100.0, poisson=0.5), pressure=1e4, times=[1.0], boundary="periodic")
