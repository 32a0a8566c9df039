"""Wear from Python."""

import numpy as np
import pytest

import asperity as asp

SIZE = (0.6e-3, 0.6e-3)
STEEL = asp.Elastic(young=210e9, poisson=0.3)


def ball(cells: int = 32) -> asp.Surface:
    return asp.Surface.sphere(cells=(cells, cells), size=SIZE, radius=10e-3)


def test_the_worn_volume_is_that_of_archard_and_that_of_the_depths():
    wear = asp.Wear((1e-15, 3e-15), velocity=asp.ramp(0.2, duration=100.0), depth_limit=1e-6)
    result = asp.solve(ball(), STEEL, load=10.0, times=asp.uniform(100.0, 10), wear=wear, fields=["wear_depth", "counterbody_wear_depth", "undeformed_gap"])
    # k W s; sums of some hundred cells
    np.testing.assert_allclose(result.wear_volume[-1], 4e-15 * 10.0 * 10.0, rtol=1e-12)
    np.testing.assert_allclose(result.wear_distance[-1], 10.0, rtol=1e-12)
    np.testing.assert_allclose(result.counterbody_wear_volume, 0.75 * result.wear_volume, rtol=1e-12)
    cell = SIZE[0] * SIZE[1] / 32**2
    depths = [result.field(name) for name in ("wear_depth", "counterbody_wear_depth")]
    np.testing.assert_allclose([cell * depth.sum() for depth in depths], [1e-13, 3e-13], rtol=1e-12)
    np.testing.assert_allclose(result.field("undeformed_gap") - result.initial_gap, depths[0] + depths[1], atol=1e-20)
    assert "Archard" in result.methods()


def test_a_number_is_a_coefficient_and_a_map_is_a_factor():
    one = asp.solve(ball(), STEEL, load=10.0, times=[100.0], wear=asp.Wear(2e-15, velocity=0.1))
    many = asp.solve(ball(), STEEL, load=10.0, times=[100.0], wear=asp.Wear(1e-15, velocity=0.1, map=np.full((32, 32), 2.0)))
    np.testing.assert_allclose(one.wear_depth_max, many.wear_depth_max, rtol=1e-6)
    slid = asp.tangential(displacement=asp.ramp(1e-4, duration=1.0))
    fretted = asp.solve(ball(), STEEL, load=10.0, times=asp.uniform(1.0, 4), friction=0.1, tangential=slid, wear=1e-13)
    # All slips but for the displacement that friction holds, some 1e-7 m.
    assert fretted.wear_volume[-1] == pytest.approx(1e-13 * 10.0 * 1e-4, rel=1e-2)


@pytest.mark.parametrize(
    ("wear", "message"),
    [
        (lambda: asp.Wear(-1e-15, velocity=0.1), "coefficient"),
        (lambda: asp.Wear(0.0, velocity=0.1), "greater than 0"),
        (lambda: asp.Wear(1e-15), "how far the surfaces slide"),
        (lambda: asp.Wear((1e-15, 1e-15, 1e-15), velocity=1.0), "pair"),
        (lambda: asp.Wear(1e-15, velocity=0.1, map=np.ones((3, 3))), "shape"),
        (lambda: asp.Wear(1e-15, velocity=0.1, cycles_per_step=100.0), "cycles"),
        (lambda: asp.Wear(1e-15, velocity=0.1, threshold=-1.0), "threshold"),
    ],
)
def test_what_cannot_be_is_refused(wear, message):
    with pytest.raises(asp.CaseError, match=message):
        asp.solve(ball(), STEEL, load=10.0, times=[1.0], wear=wear())


def test_a_velocity_with_a_unit_is_a_plain_number():
    u = pytest.importorskip("pint", reason="pint is not installed").UnitRegistry()
    assert asp.Wear(1e-15, velocity=100 * u.mm / u.s) == asp.Wear(1e-15, velocity=0.1)
    with pytest.raises(asp.CaseError, match="velocity is in meter"):
        asp.Wear(1e-15, velocity=1 * u.m)
    told = asp.solve(ball(), STEEL, load=1.0, times=[1.0], wear=asp.Wear(1e-15, velocity=0.1)).methods(case=False)
    assert "The velocity of the wear is prescribed (step, value 100 mm/s)." in told


def test_numbers_in_other_units_are_told(recwarn):
    asp.Wear((1e-15, 1e-11), velocity=0.1)
    asp.Flash((0.2, 400.0), (1e-7, 1e-3), friction=0.3)
    assert not recwarn.list
    with pytest.warns(asp.ResultWarning, match=r"the coefficient of wear is 1e-06 m2/N"):
        asp.Wear((1e-15, 1e-6), velocity=0.1)
    with pytest.warns(asp.ResultWarning, match=r"the diffusivity is 0.2 m2/s, .*: the conductivity"):
        asp.Flash(1e-7, 0.2, friction=0.3)
