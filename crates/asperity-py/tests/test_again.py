"""What a result says of its methods is enough to do it again: the case in its text gives the same numbers."""

from __future__ import annotations

import copy
import pickle
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import asperity as asp

SIZE = (1e-3, 1e-3)
BALL = asp.Surface.sphere(cells=(24, 24), size=SIZE, radius=20e-3)
ROUGH = asp.Surface.self_affine(cells=(24, 24), size=SIZE, hurst=0.8, rms_gradient=0.01, longest=5e-4, shortest=2e-4, roll_off=4e-4, seed=3)
WAVE = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
LINE = asp.Surface.cylinder(cells=64, size=2e-3, radius=10e-3)
ZENER = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5, name="rubber")
PRONY = asp.Prony(equilibrium=2e6, terms=[(1e6, 0.5), (2e6, 5.0)], poisson=0.45)
STEEL = asp.Elastic(young=210e9, poisson=0.3)

#: Results, and words of their paragraph.
RUNS: dict[str, tuple[Callable[[], asp.Result], list[str]]] = {
    "rough": (
        lambda: asp.solve(BALL + ROUGH, PRONY, load=asp.triangle(peak=5e-3, rise=1.0, fall=2.0), times=asp.uniform(4.0, 4)),
        ["a sphere (radius 20 mm) plus self-affine roughness (Hurst exponent 0.8, rms gradient 0.01, longest 500 µm, shortest 200 µm, roll-off 400 µm, seed 3)",
         "terms [(modulus 1 MPa, time 500 ms), (modulus 2 MPa, time 5 s)]", "The load was prescribed (triangle, peak 5 mN, rise 1 s, fall 2 s)."],
    ),
    "hard": (
        lambda: asp.solve(BALL, STEEL, approach=asp.ramp(1e-6, duration=1.0), times=asp.log(2.0, 4, first=0.1), hardness=1e9, plasticity="accumulate"),
        ["young 210 GPa", "cut off at the hardness, 1 GPa", "The approach was prescribed (ramp, value 1 µm, duration 1 s)."],
    ),
    "line": (lambda: asp.solve(LINE, PRONY, load=asp.sine(mean=100.0, amplitude=50.0, frequency=0.5), times=asp.uniform(2.0, 40)), ["a cylinder (radius 10 mm)", "mean 100 N/m"]),
    "layer": (
        lambda: asp.solve(BALL, asp.Body(layers=[asp.Layer(thickness=1e-4, material=ZENER)], base="rigid"), load=1e-3, times=[0.1, 1.0]),
        ["a layer of"],
    ),
    "stages": (
        lambda: asp.solve(BALL, PRONY, stages=[asp.Stage(load=asp.ramp(1e-3, duration=1.0), duration=1.0), asp.Stage(approach=asp.hold())], times=asp.uniform(3.0, 6)),
        ["2 stages prescribed in turn load, approach."],
    ),
    "adhesion": (
        lambda: asp.solve(BALL, PRONY, approach=asp.ramp(5e-7, duration=1.0), times=asp.uniform(1.0, 3), adhesion=asp.Adhesion(work=0.01, range=5e-6)),
        ["10 mJ/m²", "range 5 µm"],
    ),
    "friction": (
        lambda: asp.solve(BALL, STEEL, load=10.0, times=asp.uniform(1.0, 2), friction=asp.Friction(0.3, shear_limit=1e9), tangential=asp.tangential(force=asp.ramp(1.0, duration=1.0))),
        ["coefficient 0.3"],
    ),
    "slide": (
        lambda: asp.slide(WAVE, ZENER, pressure=2e4, velocity=0.05, times=[0.02], boundary="periodic", wear=asp.Wear(1e-15), flash=asp.Flash(0.2, 1e-7, friction=0.5, partition="track", heated_for=1.0)),
        ["the coefficient 1e-15 m²/N", "conductivity 0.2 W/(m K)", "friction 0.5"],
    ),
    "steady": (lambda: asp.steady(WAVE, ZENER, pressure=2e4, velocities=[1e-3, 1e-2], boundary="periodic", shear_stress=1e4), ["the shear stress 10 kPa"]),
    "function": (
        lambda: asp.solve(BALL, PRONY, load=lambda t: 1e-3 * t, times=asp.uniform(2.0, 4), fields=[]),
        ["The load was prescribed. The load is a function of time"],
    ),
    "contact": (lambda: asp.elastic(BALL, 2e6, load=1e-3, tolerance=1e-8, method="polonsky-keer", hardness=1e4).to_result(), ["The contact modulus is 2 MPa."]),
}


def again(text: str, folder: object) -> asp.Result:
    return asp.run(text.split("SI units:\n\n")[1].split("\n\n@")[0], output=f"{folder}/again.zarr", progress=False)


@pytest.mark.parametrize("name", RUNS)
def test_the_text_of_a_result_runs_it_again(name: str, tmp_path) -> None:
    run, expected = RUNS[name]
    result = run()
    text = result.methods()
    for words in expected:
        assert words in text, (words, text)
    same = again(result.methods(bibtex=True), tmp_path)
    # A single contact has one row; the case of it is held to a time.
    rows = slice(None) if name != "contact" else slice(0, 1)
    for column in ("approach", "load", "contact_area", "max_pressure"):
        ours, theirs = getattr(result, column), getattr(same, column)[rows]
        # A surface of known shape is shifted exactly, an array by its waves; a single contact goes by other moduli to the same E*.
        assert np.allclose(ours, theirs, rtol={"slide": 1e-7, "steady": 1e-7, "contact": 1e-7}.get(name, 0.0), atol=0.0), column
    result.save(tmp_path / "stored.zarr")
    assert asp.open(tmp_path / "stored.zarr").methods() == text and "case in full" not in result.methods(case=False)


def test_an_infinite_wavelength_goes_through_a_file(tmp_path) -> None:
    contact = asp.elastic(WAVE, 1e6, pressure=1e4, boundary="periodic")
    contact.save(tmp_path / "wave.zarr")
    text = asp.open(tmp_path / "wave.zarr").methods()
    assert text == contact.methods() and again(text, tmp_path).approach[0] == pytest.approx(contact.approach, rel=1e-7)


def test_a_file_is_named(tmp_path) -> None:
    ROUGH.write(tmp_path / "rough.npz")
    read = asp.Surface.read(tmp_path / "rough.npz")
    result = asp.solve(read + BALL, PRONY, load=1e-3, times=[1.0])
    assert f"heights of a file (path {tmp_path}/rough.npz, level none)" in result.methods()
    assert np.array_equal(again(result.methods(), tmp_path).approach, result.approach)


def changed_march() -> asp.Result:
    march = asp.march(BALL, PRONY, load=1e-3, times=[1.0, 2.0])
    next(march)
    march.prescribe(load=asp.ramp_to(2e-3, duration=0.5))
    return march.result()


#: Results whose case lacks something, and how it is named.
LACKING: dict[str, tuple[Callable[[], asp.Result], str]] = {
    "heights": (lambda: asp.solve(np.array(BALL.heights), PRONY, size=SIZE, load=1e-3, times=[1.0]), "The heights were given as an array"),
    "hardness": (lambda: asp.solve(BALL, PRONY, load=1e-3, times=[1.0], hardness=np.full((24, 24), 1e9)), "The hardness of each cell was given as an array."),
    "steps": (lambda: asp.solve(2.0 * BALL, PRONY, load=1e-3, times=[1.0]), "What was done to the heights: heights times 2."),
    "prescribed": (changed_march, "From row 1 on was prescribed: load, ramp, from current, value 2 mN, duration 500 ms."),
    "wear": (
        lambda: asp.solve(BALL, STEEL, load=1e-3, times=[1.0], wear=asp.Wear(1e-15, velocity=0.1, map=np.ones((24, 24)))),
        "The coefficients of [wear] were given as an array.",
    ),
}


@pytest.mark.parametrize("name", LACKING)
def test_a_case_that_lacks_something_does_not_run(name: str, tmp_path) -> None:
    run, words = LACKING[name]
    text = run().methods()
    assert "The case but for what it leaves out" in text and f'"{words}' in text and "in full" not in text, text
    with pytest.raises(asp.CaseError, match="left_out"):
        again(text, tmp_path)


def test_times_of_fields_are_rows_again(tmp_path) -> None:
    result = asp.solve(BALL, PRONY, load=asp.ramp(1e-3, duration=1.0), times=asp.uniform(2.0, 4), field_times=[0.3, 1.1])
    same = again(result.methods(), tmp_path)
    assert 0.3 in same.time and np.array_equal(same.time, result.time) and np.array_equal(same.approach, result.approach)


@pytest.mark.parametrize("given", [dict(load=[1e-3, 2e-3, 1.5e-3]), dict(pressure=[1e2, 1e3]), dict(approach=[1e-7])])
def test_a_curve_runs_again(given: dict[str, list[float]], tmp_path) -> None:
    curve = asp.elastic(BALL, 4e6, **given)
    text = curve.methods()
    assert ("was prescribed in 3 contacts, 1 mN to 1.5 mN." in text) == ("load" in given)
    same = again(text, tmp_path)
    # Each contact is solved to 1e-6 of the mean displacement, from another start in a case.
    assert np.allclose(same.approach[: len(curve)], curve.approach, rtol=1e-5, atol=0.0)
    assert np.allclose(same.load[: len(curve)], curve.load, rtol=1e-5, atol=0.0)
    assert "The load is 2 mN." in asp.elastic(BALL, 4e6, load=2e-3).methods()


def test_the_words_of_a_case_file_are_kept(tmp_path) -> None:
    stored = asp.run("examples/hertz.toml", set={"domain.cells": [24, 24]}, output=tmp_path / "hertz.zarr")
    text = stored.methods()
    # The words are read from the case by Python's own reader of TOML, from 3.11 on.
    assert ("The surface is a sphere (radius 10 mm)" in text or sys.version_info < (3, 11)) and "[domain]" in text
    assert np.array_equal(again(text, tmp_path).approach, stored.approach)


def measured(folder: Path, **given: object) -> asp.Surface:
    """A tilted map with a spike and a hole, from a file."""
    heights = np.array(ROUGH.heights) + np.linspace(0.0, 1e-6, 24)[:, None]
    heights[3, 4], heights[10, 10] = np.nan, 1e-3
    asp.Surface(heights, size=SIZE).write(folder / "measured.npz")
    return asp.Surface.read(folder / "measured.npz", **given)


#: What may be done to a map from a file.
PREPARED: dict[str, Callable[[Path], asp.Surface]] = {
    "read": lambda folder: measured(folder, level="quadratic", fill="nearest"),
    "spikes": lambda folder: measured(folder).level("plane").outliers(6.0, radius=3).fill("harmonic", share=0.5).level("mean"),
    "crop": lambda folder: measured(folder, fill="harmonic").crop(cells=(16, 12), start=(2, 3)).crop(size=(5e-4, 4e-4)).window("tukey", share=0.2),
    "band": lambda folder: measured(folder, level="plane", fill="harmonic").mirrored().filter(shortest=1.5e-4, edge="gaussian").resample((36, 40)),
    "turned": lambda folder: -measured(folder, level="plane", fill="harmonic").flip("y").rotate(1),
    "words": lambda folder: measured(folder).process("fill method=harmonic", "level form=plane", "invert"),
    "sum": lambda folder: measured(folder, fill="nearest").level("plane") + ROUGH,
    "copy": lambda folder: copy.deepcopy(pickle.loads(pickle.dumps(measured(folder, fill="nearest").level("plane")))).flip("x"),
}


@pytest.mark.parametrize("name", PREPARED)
def test_what_was_done_to_a_file_is_done_again(name: str, tmp_path) -> None:
    surface = PREPARED[name](tmp_path)
    result = asp.solve(surface, STEEL, pressure=1e4, times=[1.0], boundary="periodic", fields=[])
    text = result.methods()
    assert "case in full" in text and "The heights went through: " in text and "process" not in text.split("\n")[0]
    assert np.array_equal(again(text, tmp_path).approach, result.approach)


@pytest.mark.parametrize(
    "change", [lambda s: 2.0 * s, lambda s: (2.0 * s).level("plane"), lambda s: s.process("level=plane"), lambda s: (s + s).level("plane"), lambda s: pickle.loads(pickle.dumps(3.0 * s))]
)
def test_what_a_file_cannot_say_is_left_out(change, tmp_path) -> None:
    surface = change(measured(tmp_path, fill="nearest"))
    text = asp.solve(surface, STEEL, pressure=1e4, times=[1.0], boundary="periodic", fields=[]).methods()
    assert "What was done to the heights: " in text
    with pytest.raises(asp.CaseError, match="left_out"):
        again(text, tmp_path)


def test_a_map_in_another_unit_and_order_is_read_again(tmp_path) -> None:
    np.savetxt(tmp_path / "z.txt", 1e6 * ROUGH.heights)
    given = dict(size=SIZE, height_unit="um")
    surface = asp.Surface.read(tmp_path / "z.txt", **given, transpose=False)
    assert np.array_equal(surface.heights, asp.Surface.read(tmp_path / "z.txt", size=SIZE, height_unit=1e-6, transpose=False).heights)
    result = asp.solve(surface, STEEL, pressure=1e4, times=[1.0], boundary="periodic", fields=[])
    assert 'height_unit = "um"' in result.methods() and np.array_equal(again(result.methods(), tmp_path).approach, result.approach)
    turned = asp.Surface.read(tmp_path / "z.txt", **given, transpose=True)
    assert np.allclose(turned.heights, ROUGH.heights, rtol=1e-12)
    told = asp.solve(turned, STEEL, pressure=1e4, times=[1.0], boundary="periodic", fields=[]).methods()
    assert "What was done to the heights: transposed." in told
    with pytest.raises(asp.CaseError, match="height_unit is in N"):
        asp.Surface.read(tmp_path / "z.txt", size=SIZE, height_unit="N")
