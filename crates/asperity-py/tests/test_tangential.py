"""Friction and tangential loads from Python."""

import numpy as np
import pytest

import asperity as asp

SIZE = (0.4e-3, 0.4e-3)


def ball() -> asp.Surface:
    return asp.Surface.sphere(cells=(32, 32), size=SIZE, radius=10e-3)


STEEL = asp.Elastic(young=210e9, poisson=0.3)


def pushed(**given):
    shake = asp.tangential(force=(asp.triangle(peak=10.0, rise=1.0, fall=1.0), 2.0))
    arguments = {"load": 50.0, "times": asp.uniform(2.0, 4), "friction": 0.5, "tangential": shake, **given}
    return asp.solve(ball(), arguments.pop("bodies", [STEEL, STEEL]), **arguments)


def test_rows_hold_two_components(tmp_path):
    result = pushed()
    assert result.tangential_force.shape == (5, 2)
    np.testing.assert_allclose(result.tangential_force[:, 0], [0, 5, 10, 5, 0], atol=1e-9)
    np.testing.assert_allclose(result.tangential_force[:, 1], 2.0)
    assert "contact" in result.fields and "traction_y" in result.fields
    # The traction is the force, and friction holds it.
    cell = SIZE[0] * SIZE[1] / 32**2
    q = np.hypot(result.field("traction_x"), result.field("traction_y"))
    np.testing.assert_allclose(result.field("traction_y").sum() * cell, 2.0)
    assert (q <= 0.5 * result.field("pressure") * (1 + 1e-9)).all()
    data = result.to_xarray()
    assert data.tangential_force.dims == ("time", "axis") and data.axis.values.tolist() == [0.0, 1.0]
    result.save(tmp_path / "r.zarr")
    again = asp.open(tmp_path / "r.zarr")
    np.testing.assert_array_equal(again.tangential_displacement, result.tangential_displacement)
    assert again.to_xarray().equals(data)
    xarray = pytest.importorskip("xarray")
    assert xarray.open_zarr(tmp_path / "r.zarr").tangential_force.dims == ("time", "axis")


def test_a_map_of_coefficients_is_that_of_one_coefficient():
    mu = np.full((32, 32), 0.5)
    one, many = pushed(), pushed(friction=asp.Friction(mu, shear_limit=1e12))
    np.testing.assert_array_equal(one.slip_area, many.slip_area)
    np.testing.assert_array_equal(one.field("traction_x"), many.field("traction_x"))


def test_the_stress_is_that_below_both_tractions():
    result = pushed()
    tractions = [result.field("traction_x"), result.field("traction_y")]
    both = asp.stress(result.field("pressure"), size=SIZE, poisson=0.3, depths=[0.0, 20e-6], tractions=tractions)
    np.testing.assert_allclose(both.xz[0], -tractions[0], atol=1e-6 * np.abs(tractions[0]).max())
    np.testing.assert_array_equal(result.stress(depths=[0.0, 20e-6]).mises, both.mises)
    # The other body feels the opposite.
    other = result.stress(depths=[0.0, 20e-6], body=1)
    np.testing.assert_allclose(other.xz[0], tractions[0], atol=1e-6 * np.abs(tractions[0]).max())


def test_steps_of_a_march_have_vectors():
    march = asp.march(
        ball(), STEEL, load=50.0, times=asp.uniform(1.0, 2), friction=0.5, tangential=asp.tangential(displacement=asp.ramp(1e-7, duration=1.0))
    )
    last = list(march)[-1]
    np.testing.assert_allclose(last.tangential_displacement, [1e-7, 0.0], atol=1e-20)
    assert last.field("slip_path").shape == (32, 32) and last.field("friction_work").min() >= 0.0


@pytest.mark.parametrize(
    "given, words",
    [
        ({"friction": None}, "friction"),
        ({"friction": -0.1}, "friction"),
        ({"friction": np.ones((3, 3))}, "shape"),
        ({"tangential": 3.0}, "tangential is 3.0"),
        ({"tangential": None}, "tangential"),
        ({"times": asp.adaptive(1.0)}, "steps"),
    ],
)
def test_what_makes_no_sense_is_refused(given, words):
    with pytest.raises(asp.CaseError, match=words):
        pushed(**given)


def test_a_force_beyond_friction_is_an_error():
    with pytest.raises(asp.CaseError, match="5 N more"):
        pushed(tangential=asp.tangential(force=asp.ramp(30.0, duration=1.0)))


def coupled(force, mean="full", bodies=asp.Elastic(young=210e9, poisson=0.1), **given):
    given = {"boundary": "periodic", **given}
    friction = asp.Friction(0.5, coupling=mean)
    return pushed(tangential=asp.tangential(force=force), bodies=bodies, friction=friction, **given)


def test_pressure_and_tractions_act_on_each_other():
    ahead, back = coupled(asp.ramp(15.0, duration=1.0)), coupled(asp.ramp(-15.0, duration=1.0))
    p, q = ahead.field("pressure"), ahead.field("traction_x")
    # The solver's tolerance, in pressures and in tractions of the largest one.
    np.testing.assert_allclose(p, back.field("pressure")[::-1], atol=1e-4 * p.max())
    np.testing.assert_allclose(q, -back.field("traction_x")[::-1], atol=1e-4 * q.max())
    # A traction lowers the surface ahead of it and lifts it behind: there it presses more.
    x = np.arange(32)[:, None] - 15.5
    assert (p * x).sum() / p.sum() < -0.1
    # Pushed along y it is the same, turned.
    aside = coupled((0.0, asp.ramp(15.0, duration=1.0)))
    np.testing.assert_allclose(p, aside.field("pressure").T, atol=1e-4 * p.max())
    # Bodies of like materials do not act on each other.
    alike = [STEEL, STEEL]
    ramp = asp.ramp(15.0, duration=1.0)
    np.testing.assert_array_equal(
        coupled(ramp, bodies=alike).field("traction_x"), coupled(ramp, "neglect", bodies=alike).field("traction_x")
    )
    assert [f.code for f in coupled(ramp, "neglect").findings if "coupling" in f.code] == ["normal-coupling"]
    assert all("coupling" not in finding.code for finding in ahead.findings)


def test_bodies_that_creep_differently_are_not_coupled():
    rubber = asp.StandardLinearSolid(young_instantaneous=9e9, young_equilibrium=1e9, relaxation_time=1.0, poisson=0.3)
    with pytest.raises(asp.CaseError, match="creep differently"):
        coupled(1.0, bodies=[rubber, STEEL])


def held(peak):
    return pushed(tangential=asp.tangential(force=asp.ramp(peak, duration=2.0)))


def test_studies_keep_both_components():
    pytest.importorskip("xarray")
    made = asp.study(held, {"peak": [1.0, 2.0]})
    assert made.tangential_force.dims[-1] == "axis" and made.sizes["axis"] == 2


def test_a_pair_a_function_and_points_are_courses():
    given = dict(load=10.0, times=asp.uniform(1.0, 2), friction=0.3)

    def force(course):
        return asp.solve(ball(), [STEEL, STEEL], tangential=asp.tangential(force=course), **given).tangential_force

    assert np.allclose(force(np.array([1.0, 0.5])), [[1.0, 0.5]] * 3, rtol=1e-12)
    # Rounding of y, which is held at 0.
    ramp = force(asp.ramp(1.0, duration=1.0))
    for same in (lambda t: t, [(0, 0), (1, 1)], np.array([[0.0, 0.0], [1.0, 1.0]])):
        assert np.allclose(force(same), ramp, rtol=1e-12, atol=1e-15)
    both = force((lambda t: t, 0.5 * np.float32(1.0)))
    assert np.allclose(both, [[0.0, 0.5], [0.5, 0.5], [1.0, 0.5]], rtol=1e-12, atol=1e-15)
    told = asp.solve(ball(), [STEEL, STEEL], tangential=asp.tangential(force=lambda t: t * t), **given).methods(case=False)
    assert "The tangential force is prescribed along x (table, " in told and "The force along x is a function of time, taken at" in told
    # Breaks belong to whatever is a function.
    broken = asp.solve(ball(), [STEEL, STEEL], tangential=asp.tangential(force=lambda t: max(0.0, t - 0.3)), breaks=[0.3], **given)
    assert broken.time.tolist() == [0.0, 0.3, 0.5, 1.0]


def test_forces_carry_units():
    u = pytest.importorskip("pint", reason="pint is not installed").UnitRegistry()
    given = dict(load=10.0, times=[1.0], friction=0.3)
    for pair in ((1 * u.N, 500 * u.mN), u.Quantity([1.0, 0.5], "N"), [1 * u.N, 0.5]):
        result = asp.solve(ball(), [STEEL, STEEL], tangential=asp.tangential(force=pair), **given)
        assert np.allclose(result.tangential_force[-1], [1.0, 0.5], rtol=1e-12)
