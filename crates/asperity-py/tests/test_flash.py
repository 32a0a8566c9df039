"""Flash temperature from Python."""

import numpy as np
import pytest

import asperity as asp

RUBBER = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)


def roller(cells: int = 256) -> asp.Surface:
    return asp.Surface.cylinder(cells=(cells,), size=(4e-3,), radius=10e-3)


def test_the_heat_is_that_of_friction_and_warms_behind_the_middle():
    given = {"load": 300.0, "velocities": [1e-3, 1.0], "fields": ["pressure", "flash_temperature"]}
    result = asp.steady(roller(), RUBBER, flash=asp.Flash(0.2, 1e-7, friction=0.5, partition="track"), **given)
    np.testing.assert_allclose(result.heat_power, 0.5 * 300.0 * np.array([1e-3, 1.0]), rtol=1e-9)
    np.testing.assert_array_equal(result.heat_share, 0.0)
    warm, pressure = (result.field(name, index=1) for name in ("flash_temperature", "pressure"))
    # The contact moves along +x: what is hottest has been under it the longest.
    assert np.argmax(warm) < np.argmax(pressure)
    # A fast source: T = 2 q sqrt(t/(pi k rho c)) for a band of even heat, within its shape.
    width = (pressure > 0).sum() * 4e-3 / 256
    even = 2 * result.heat_power[1] / width / 0.2 * np.sqrt(1e-7 * width / 1.0 / np.pi)
    assert 0.8 < warm.max() / even < 1.4


def test_shear_stress_over_the_velocity():
    at = {"load": 300.0, "velocities": [1e-2, 1e-1]}
    constant = asp.steady(roller(64), RUBBER, shear_stress=1e5, **at)
    points = asp.steady(roller(64), RUBBER, shear_stress=[(1e-2, 1e5), (1e-1, 2e5)], **at)
    peak = asp.steady(roller(64), RUBBER, shear_stress={"peak": 1e5, "velocity": 1e-2, "width": 1.0}, **at)
    own = constant.friction_coefficient_total - constant.friction_coefficient
    np.testing.assert_allclose(points.friction_coefficient_total - points.friction_coefficient, own * [1, 2], rtol=1e-9)
    np.testing.assert_allclose(peak.friction_coefficient_total - peak.friction_coefficient, own * [1, np.exp(-1)], rtol=1e-9)


def test_the_friction_of_the_surfaces_is_against_motion_and_none_at_rest():
    given = {"load": 300.0, "times": np.linspace(0, 0.02, 21), "start": 0.01, "flash": asp.Flash(0.2, 1e-7, friction=0.5, partition="track")}
    there, back = (asp.slide(roller(64), RUBBER, velocity=v, **given) for v in (0.01, -0.01))
    own = [result.friction_coefficient_total - result.friction_coefficient for result in (there, back)]
    moves = there.time >= 0.01
    np.testing.assert_allclose(own, [0.5 * moves, -0.5 * moves], atol=1e-12)
    # The power of friction is the heat of the surfaces.
    np.testing.assert_allclose(back.heat_power, 0.5 * 300.0 * 0.01 * (there.time > 0.01), rtol=1e-9)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (lambda: {"flash": asp.Flash(0.2, 1e-7)}, "nothing makes heat"),
        (lambda: {"flash": asp.Flash(-0.2, 1e-7, friction=0.5)}, "conductivity"),
        (lambda: {"flash": asp.Flash((0.2, 1.0, 2.0), 1e-7, friction=0.5)}, "pair"),
        (lambda: {"flash": asp.Flash(0.2, 1e-7, friction=0.5)}, "partition"),
        (lambda: {"flash": 0.5}, "asperity.Flash"),
        (lambda: {"shear_stress": {"peak": 1e5}}, "velocity"),
    ],
)
def test_what_cannot_be_is_refused(given, message):
    with pytest.raises(asp.CaseError, match=message):
        asp.steady(roller(64), RUBBER, load=300.0, velocities=[0.1], **given())
