"""Bodies of layers."""

import pickle

import numpy as np
import pytest

import asperity as asp


def rubber(shear: float = 1e6, time: float = 2.0, **more):
    return asp.Zener(shear=shear, shear_kelvin=2 * shear, retardation_time=time, **{"poisson": 0.45, **more})


def tread(thickness: float = 5e-3, **more):
    return asp.Body(layers=[asp.Layer(thickness=thickness, material=rubber())], **more)


def coated():
    return tread(base=asp.Elastic(young=1e9, poisson=0.3))


def sphere():
    return asp.Surface.sphere(cells=(64, 64), size=(20e-3, 20e-3), radius=50e-3)


def test_compliance_has_its_limits():
    body = tread()
    q = np.array([[1e-2, 1e5]])
    long, short = asp.layer_compliance(q, body)[0]
    # d (1 - 2 nu)/(2 G (1 - nu)) and (1 - nu)/(G q); terms of order (q d)^2.
    assert abs(long / (5e-3 * 0.1 / (2e6 * 0.55)) - 1) < 1e-6
    assert abs(short / (0.55 / (1e6 * 1e5)) - 1) < 1e-12
    # A Kelvin element of twice the stiffness: half as much more after all creep.
    assert abs(asp.layer_compliance(10.0, body, time=1e6) / asp.layer_compliance(10.0, body) - 1.5) < 1e-9
    half_space = asp.layer_compliance(q, rubber())
    assert np.allclose(half_space, 0.55 / (1e6 * q), rtol=1e-12)


def test_a_layer_on_a_rigid_base_is_stiffer_and_creeps_like_its_law():
    run = dict(load=asp.step(1.0), times=asp.uniform(8.0, 4))
    layer, half_space = asp.solve(sphere(), tread(), **run), asp.solve(sphere(), rubber(), **run)
    assert (layer.approach < 0.9 * half_space.approach).all()
    assert (np.diff(layer.contact_area) >= 0).all()
    pair = asp.solve(sphere(), [tread(), tread()], **run)
    assert (pair.approach > layer.approach).all()


def test_a_layer_of_the_material_of_its_base_is_a_half_space():
    same = tread(base=rubber())
    run = dict(approach=1e-4, times=[1.0])
    loads = [asp.solve(sphere(), body, **run).load for body in (same, rubber())]
    # The tolerance of the solver.
    assert np.allclose(*loads, rtol=1e-5)


def test_a_coating_on_an_elastic_base_creeps_differently_at_every_wave():
    q = [1e-3, 1e5]
    rise = asp.layer_compliance(q, coated(), time=1e6) / asp.layer_compliance(q, coated())
    # Long waves see the elastic base, short ones the rubber, which creeps by half.
    assert abs(rise[0] - 1) < 1e-3 and abs(rise[1] - 1.5) < 1e-9
    result = asp.solve(sphere(), coated(), load=asp.step(1.0), times=asp.uniform(8.0, 4))
    assert result.attributes["layer_separable"] == 0 and 0 < result.attributes["layer_misfit"] < 1e-3
    assert (np.diff(result.approach) > 0).all()
    # The layer on a rigid base: a base some 400 times as stiff.
    rigid = asp.solve(sphere(), tread(), load=asp.step(1.0), times=asp.uniform(8.0, 4))
    assert np.allclose(result.approach, rigid.approach, rtol=2e-2)
    assert (result.approach > rigid.approach).all()


def test_hardness_and_pickles():
    body = tread(hardness=1e5)
    result = asp.solve(sphere(), body, load=5.0, times=[1.0])
    assert result.max_pressure.max() == 1e5
    assert pickle.loads(pickle.dumps(body)) == body
    assert "thickness=0.005" in repr(body)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: asp.Layer(thickness=0.0, material=rubber()), "greater than 0 m"),
        (lambda: asp.Layer(thickness=float("nan"), material=rubber()), "greater than 0 m"),
        (lambda: asp.Layer(thickness=1e-3, material=1.0), "must be a material"),
        (lambda: asp.Layer(thickness=1e-3, material=rubber(), interface="glued"), "'bonded' or 'slip'"),
        (lambda: asp.Body(layers=[]), "one at least"),
        (lambda: asp.Body(layers=[asp.Layer(thickness=1e-3, material=rubber())], base="hard"), "'rigid'"),
        (lambda: asp.layer_compliance(0.0, tread()), "greater than 0"),
        (lambda: asp.layer_compliance(1.0, "rubber"), "asperity.Body"),
        (lambda: asp.layer_compliance(1.0, tread(base=asp.Maxwell(shear=1e6, relaxation_time=1.0, poisson=0.4))), "flows"),
        (lambda: asp.solve(sphere(), coated(), load=1.0, times=[1.0], scheme="constant"), "creep differently"),
        (
            lambda: asp.steady(sphere(), coated(), load=1.0, velocities=[0.1], boundary="periodic"),
            "layers that creep differently",
        ),
        (lambda: asp.solve(sphere(), tread(thickness=1e-6), load=1.0, times=[1.0]), "thickness of this layer"),
    ],
)
def test_wrong_bodies_are_told(make, words):
    with pytest.raises(asp.CaseError, match=words):
        make()
