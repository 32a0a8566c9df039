"""What was computed stays what it was, whatever happens to the arrays that it was computed from."""

import copy
import pickle

import numpy as np
import pytest

import asperity as asp

SIZE = (1e-3, 1e-3)


@pytest.fixture(scope="module")
def ball():
    return asp.Surface.sphere(cells=(24, 24), size=SIZE, radius=20e-3)


def test_stress_and_leakage_do_not_follow_their_input(ball):
    pressure = np.zeros((24, 24))
    found = []
    for load in (1e-3, 2e-3):
        contact = asp.elastic(ball, 4e6, load=load, out=pressure)
        found.append((asp.stress(pressure, size=SIZE, poisson=0.5), asp.stress(contact.pressure.copy(), size=SIZE, poisson=0.5)))
    for reused, own in found:
        assert np.array_equal(reused.mises, own.mises)
    gap = np.tile(1e-6 + 5e-7 * np.sin(np.arange(24.0))[:, None], (1, 24))
    depths = np.array([0.0, 1e-4])
    below, leak = asp.stress(pressure, size=SIZE, poisson=0.5, depths=depths), asp.leakage(gap, size=SIZE)
    gas = dict(inlet=2e5, outlet=1e5, gas="air")
    before = leak.gas_leak_rate(**gas)
    gap *= 3.0
    depths[...] = 0.5
    assert leak.gas_leak_rate(**gas) == before and below.depths.tolist() == [0.0, 1e-4]


def arrays(ball):
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    t = np.geomspace(0.1, 100, 30)
    contact = asp.elastic(ball, 4e6, load=1e-3, history=True)
    wave = asp.Surface.wave(cells=(32, 8), size=(1e-3, 2.5e-4), amplitude=1e-6, wavelength=(1e-3, np.inf))
    theory = asp.persson_friction(wave, zener, pressure=1e5, velocities=np.array([0.1, 0.2]))
    return {
        asp.stress(contact.pressure, size=SIZE, poisson=0.5): ("mises", "zz", "depths"),
        asp.leakage(contact.gap, size=SIZE, direction="both"): ("pressure", "cells", "conductance"),
        contact.history: ("residual", "working_cells", "iteration", "convolutions"),
        ball.autocorrelation(): ("values", "x", "y"),
        asp.fit_relaxation(t, zener.relaxation_modulus(t), poisson=0.5): ("x",),
        theory: ("velocity", "friction_coefficient", "contact_fraction"),
        theory.magnification(0.1): ("wave_number", "friction_coefficient"),
        asp.elastic(ball, 4e6, load=[1e-3, 2e-3]): ("load", "stiffness"),
        asp.march(ball, zener, load=1e-3, times=[1.0]): ("initial_gap",),
    }


def test_arrays_are_read_only_and_attributes_cannot_be_replaced(ball):
    for holder, names in arrays(ball).items():
        holders = [holder]
        if not isinstance(holder, (asp.PerssonFriction, asp.March, asp.ElasticCurve)):
            holders += [copy.deepcopy(holder), pickle.loads(pickle.dumps(holder))]
        for one in holders:
            for name in names:
                with pytest.raises(ValueError, match="read-only"):
                    getattr(one, name)[...] = 0.0
            for change in (lambda: setattr(one, names[0], 0.0), lambda: setattr(one, "other", 0.0), lambda: delattr(one, names[0])):
                with pytest.raises(AttributeError):
                    change()
    t = np.geomspace(0.1, 100, 30)
    with pytest.raises(ValueError, match="read-only"):
        asp.fit_relaxation(t, 1e6 + np.exp(-t) * 1e6).curves[0][...] = 0.0
