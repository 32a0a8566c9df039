"""What histories, times, shapes and roughness were made with."""

import copy
import math
import pickle

import numpy as np
import pytest

import asperity as asp


def test_histories_and_times_tell_their_parameters():
    ramp = asp.ramp(2.0, duration=3.0)
    assert (ramp.value, ramp.duration, ramp.end) == (2.0, 3.0, 3.0)
    assert not hasattr(ramp, "peak")
    with pytest.raises(AttributeError, match="made with value, duration"):
        ramp.frequency
    trapezoid = asp.trapezoid(1.0, rise=1.0, hold=2.0, fall=3.0)
    assert (trapezoid.peak, trapezoid.rise, trapezoid.hold, trapezoid.fall, trapezoid.end) == (1.0, 1.0, 2.0, 3.0, 6.0)
    sine = asp.sine(mean=2.0, amplitude=1.0, frequency=5.0)
    assert (sine.mean, sine.amplitude, sine.frequency, sine.end) == (2.0, 1.0, 5.0, math.inf)
    assert asp.step(1.0).end == 0.0 and asp.table([(0, 0), (1, 5), (4, 2)]).end == 4.0
    times = asp.log(10.0, 20, first=0.1)
    assert (times.end, times.steps, times.first) == (10.0, 20, 0.1) and not hasattr(times, "tolerance")
    assert asp.adaptive(5.0).tolerance == 1e-3 and asp.uniform(3.0, 6).steps == 6 and asp.listed([1.0, 2.5]).end == 2.5


@pytest.mark.parametrize(
    "made",
    [
        asp.step(1.0), asp.ramp(2.0, duration=3.0), asp.triangle(1.0, rise=1.0, fall=2.0), asp.trapezoid(1.0, rise=1.0, hold=2.0, fall=3.0),
        asp.sine(mean=2.0, amplitude=1.0, frequency=5.0), asp.table([(0, 0), (1, 5)]), asp.hold(), asp.ramp_to(1.0, duration=2.0),
        asp.uniform(3.0, 6), asp.log(10.0, 20, first=0.1), asp.adaptive(5.0, tolerance=1e-2), asp.listed([1.0, 2.5]),
        asp.Surface.sphere(cells=(8, 6), size=(4e-3, 3e-3), radius=0.02, center=(1e-3, 0.0)),
        asp.Surface.ellipsoid(cells=(8, 8), size=(1e-3, 1e-3), radius_x=0.02, radius_y=math.inf),
        asp.Surface.cylinder(cells=16, size=2e-3, radius=0.01), asp.Surface.cylinder(cells=(8, 8), size=(1e-3, 1e-3), radius=0.01),
        asp.Surface.wedge(cells=16, size=2e-3, slope=0.01), asp.Surface.cone(cells=(8, 8), size=(1e-3, 1e-3), slope=0.1),
        asp.Surface.flat_punch(cells=(8, 8), size=(1e-3, 1e-3), radius=2e-4), asp.Surface.flat_punch(cells=(8, 8), size=(1e-3, 1e-3), sides=(2e-4, 3e-4)),
        asp.Surface.wave(cells=(8, 8), size=(1e-3, 1e-3), amplitude=1e-6, wavelength=(1e-3, math.inf)),
        asp.Surface.self_affine(
            cells=(16, 16), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.1, longest=1e-3, shortest=2e-4, seed=7, lay_angle=0.3, lay_ratio=2.0
        ),
    ],
    ids=lambda made: repr(made)[:40],
)  # fmt: skip
def test_what_is_shown_makes_the_same_again(made):
    again = eval(repr(made), {**vars(asp), "inf": math.inf})
    assert again == made and repr(again) == repr(made)
    assert pickle.loads(pickle.dumps(made)) == made and repr(copy.copy(made)) == repr(made)


def test_shapes_and_roughness_tell_their_parameters_until_they_are_changed():
    kw = dict(cells=(16, 16), size=(1e-3, 1e-3))
    sphere = asp.Surface.sphere(**kw, radius=0.02)
    rough = asp.Surface.self_affine(**kw, hurst=0.8, rms_gradient=0.1, longest=1e-3, shortest=2e-4, seed=7)
    assert (sphere.radius, sphere.center) == (0.02, [0.0, 0.0])
    assert (rough.hurst, rough.rms_gradient, rough.longest, rough.shortest, rough.seed) == (0.8, 0.1, 1e-3, 2e-4, 7)
    for other in (2 * sphere, -sphere, sphere + rough, sphere.crop(cells=(8, 8)), asp.Surface(sphere.heights, size=sphere.size, metadata=sphere.metadata)):
        assert not hasattr(other, "radius") and repr(other).startswith("Surface(")
    assert not hasattr(sphere, "slope")
    with pytest.raises(AttributeError, match="cannot"):
        sphere.radius = 1.0
    assert sphere == asp.Surface.sphere(**kw, radius=0.02) != asp.Surface.sphere(**kw, radius=0.03)
    assert np.array_equal(pickle.loads(pickle.dumps(sphere)).heights, sphere.heights) and pickle.loads(pickle.dumps(sphere)).radius == 0.02
