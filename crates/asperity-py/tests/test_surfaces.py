"""Surfaces: each step of a preparation, its record, and the statistics."""

import copy
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import asperity as asp

EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.fixture(scope="module")
def rough():
    return asp.Surface.self_affine(cells=(64, 48), size=(1e-3, 7.5e-4), hurst=0.7, rms_gradient=0.1, longest=5e-4, shortest=6e-5, seed=3)


def test_steps_do_what_numpy_says(rough):
    z = rough.heights
    assert np.array_equal(rough.flip("x").heights, z[::-1]) and np.array_equal(rough.flip("y").heights, z[:, ::-1])
    assert np.array_equal(rough.invert().heights, -z)
    turned = rough.rotate(1)
    assert turned.cells == (48, 64) and turned.size == rough.size[::-1]
    assert np.array_equal(rough.rotate(2).heights, z[::-1, ::-1]) and np.array_equal(turned.rotate(-1).heights, z)
    part = rough.crop(cells=(16, 8), start=(4, 2))
    assert np.array_equal(part.heights, z[4:20, 2:10]) and part.size == pytest.approx((16 * rough.size[0] / 64, 8 * rough.size[1] / 48))
    assert np.array_equal(rough.crop(cells=(16, 8)).heights, z[24:40, 20:28])
    assert rough.crop(size=(5e-4, 3.75e-4), corner=(0.0, 0.0)).cells == (32, 24)
    assert rough.level("mean").heights.mean() == pytest.approx(0, abs=1e-20)
    x = np.arange(64)[:, None] * 1e-8
    assert np.allclose(asp.Surface(z + x, size=rough.size).level("plane").heights, rough.level("plane").heights, atol=1e-18)
    # The surface has no waves beyond its band: a finer grid holds the same ones, and going back gives it back.
    assert np.allclose(rough.resample((128, 96)).resample((64, 48)).heights, z, atol=1e-12 * np.abs(z).max())
    low, high = rough.filter(shortest=1.5e-4), rough.filter(longest=1.5e-4)
    assert low.statistics()["sdq"] < rough.statistics()["sdq"] and np.abs(high.heights).max() < np.abs(z).max()
    # Half a cell from the edge Tukey's window is sin(pi/2 x/(0.1 L))^2 with x = L/128: 0.015, along y 0.027.
    faded = rough.window("tukey", share=0.2).heights
    assert abs(faded[0, 0]) < 1e-3 * np.abs(z).max() and np.array_equal(faded[8:56, 6:42], z[8:56, 6:42])
    assert rough.window() == rough.window("tukey", share=0.1)


def test_a_mirrored_surface_repeats_and_keeps_its_heights(rough):
    z, whole = rough.heights, rough.crop(cells=(20, 12)).mirrored()
    part = z[22:42, 18:30]
    assert whole.cells == (40, 24) and whole.size == pytest.approx((40 * rough.size[0] / 64, 24 * rough.size[1] / 48))
    assert np.array_equal(whole.heights, np.block([[part, part[:, ::-1]], [part[::-1], part[::-1, ::-1]]]))
    assert whole == rough.process("crop cells=20,12", "border=mirror") and "mirror" in whole.history[-1]
    # A surface that was measured does not repeat; with its reflections it does.
    measured = asp.Surface(part, size=(1e-3, 1e-3), metadata={"format": "x3p"})
    assert measured.mirrored().statistics() == measured.mirrored().statistics(periodic=True)
    assert measured.statistics() == measured.statistics(periodic=False)
    profile = asp.Surface(np.arange(5.0), size=(1e-3,)).mirrored()
    assert profile.heights.tolist() == [0, 1, 2, 3, 4, 4, 3, 2, 1, 0] and profile.size == (2e-3,)
    with pytest.raises(asp.CaseError, match="one of the two"):
        rough.process("window=tukey", "border=mirror")


def test_the_spectrum_of_a_surface_that_does_not_repeat_keeps_its_power(rough):
    # A part of a periodic surface. Its spectrum C(q) is that of the whole, on average over waves; about 300 waves between 2e4 and 1e5 per
    # metre, each with a scatter of 100 %, give the sum to 6 %, Hann's window correlates neighbours, so that 9 numbers count as about 2:
    # 12 % is one standard deviation, 3 of them are allowed. The window for contacts loses a factor (3/8)^2 = 0.14.
    whole = asp.Surface.self_affine(cells=(512, 512), size=(1e-3, 1e-3), hurst=0.8, rms_gradient=0.1, longest=1e-4, shortest=1e-5, seed=3)
    part = whole.crop(cells=(192, 192))

    def power(surface, **options):
        q, c = surface.power_spectrum(0, **options)
        band = (q > 8e4) & (q < 4e5)
        return np.trapezoid(c[band] * q[band], q[band])

    assert power(part, periodic=False) == pytest.approx(power(whole), rel=0.36)
    assert power(part.window("hann")) < 0.3 * power(whole)


def test_holes_and_spikes(rough):
    z = rough.heights.copy()
    z[10:12, 10:12] = np.nan
    z[30, 30] += 1e-3
    holed = asp.Surface(z, size=rough.size)
    clean = holed.outliers(8.0).fill("harmonic", share=0.1)
    assert np.isfinite(clean.heights).all() and abs(clean.heights[30, 30] - rough.heights[30, 30]) < 1e-5
    assert len(clean.history) == 2
    assert "1 removed" in clean.history[0] and "5 filled" in clean.history[1]
    assert holed.crop(defined=True).cells == rough.cells
    with pytest.raises(asp.CaseError, match="share|0.0001|0.01 %"):
        holed.fill(share=1e-4)
    with pytest.raises(asp.CaseError, match="fill"):
        holed.gap()
    words = holed.process("outliers=8", "fill=harmonic share=0.1")
    assert np.array_equal(words.heights, clean.heights) and words.history == clean.history


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda s: s.level("plain"), 'did you mean "plane"'),
        (lambda s: s.flip("z"), "x"),
        (lambda s: s.crop(), "one of them"),
        (lambda s: s.crop(cells=(4, 4), defined=True), "one of them"),
        (lambda s: s.crop(cells=(1000, 4)), "1000"),
        (lambda s: s.crop(cells=(4, 4.5)), "whole"),
        (lambda s: s.crop(size=(1.0, 1.0)), "crop|keep|cells"),
        (lambda s: s.resample((0, 4)), "at least 1"),
        (lambda s: s.resample((10**9, 10**9)), "."),
        (lambda s: s.resample((8, 8), method="cubic"), "bilinear"),
        (lambda s: s.filter(), "longest|shortest"),
        (lambda s: s.filter(longest=-1.0), "longest"),
        (lambda s: s.filter(longest=float("nan")), "."),
        (lambda s: s.window("kaiser"), "hann"),
        (lambda s: s.outliers(0.0), "threshold"),
        (lambda s: s.rotate(1.5), "whole"),
        (lambda s: s.process("polish=1"), "polish"),
        (lambda s: s.bearing_curve(1), "levels"),
        (lambda s: s.height_distribution(0), "bins"),
        (lambda s: s.statistics(longest=1e-5, shortest=2e-4), "."),
        (lambda s: s.power_spectrum(2**40), "1000"),
        (lambda s: asp.Surface.sphere(cells=(10**6, 10**6), size=(1, 1), radius=1.0), "cells need about"),
        (lambda s: asp.Surface.self_affine(cells=(8, 8), size=(1, 1), hurst=0.8, rms_height=1e-6, longest=0.5, shortest=0.3, seed=2**70), "seed"),
    ],
)
def test_wrong_steps_are_named(rough, make, words):
    with pytest.raises(asp.CaseError, match=words):
        make(rough)


def test_statistics_are_those_of_the_command_and_of_numpy(rough):
    z = rough.heights - rough.heights.mean()
    told = rough.statistics()
    assert told["sa"] == pytest.approx(np.abs(z).mean(), rel=1e-12) and told["ssk"] == pytest.approx((z**3).mean() / told["sq"] ** 3, rel=1e-10)
    assert told["sz"] == pytest.approx(told["sp"] + told["sv"], rel=1e-12) == pytest.approx(np.ptp(z), rel=1e-12)
    assert told["bandwidth"] == pytest.approx(told["m0"] * told["m4"] / told["m2"] ** 2, rel=1e-12)
    # 5e-4 m to 6e-5 m is less than a decade of a small surface: the exponent is known to a few tenths.
    assert told["hurst"] == pytest.approx(0.7, abs=0.4) and told["hurst_error"] > 0
    banded = rough.statistics(longest=4e-4, shortest=8e-5)
    assert banded["hurst"] != told["hurst"] and banded["sq"] == told["sq"]
    heights, share = rough.bearing_curve(50)
    assert share[0] == 1.0 and np.all(np.diff(share) <= 0) and share[10] == pytest.approx((rough.heights >= heights[10]).mean(), abs=1e-15)
    at, density = rough.height_distribution(20)
    assert density.sum() * (at[1] - at[0]) == pytest.approx(1, rel=1e-9)
    correlation = rough.autocorrelation()
    assert correlation.values[32, 24] == pytest.approx(1, rel=1e-12) and correlation.x[32] == 0 == correlation.y[24]
    shifted = (z * np.roll(z, 3, axis=0)).mean() / (z**2).mean()
    assert correlation.values[35, 24] == pytest.approx(shifted, rel=1e-9)
    assert 0 < correlation.texture_aspect_ratio <= 1 and correlation.length > 0


def test_seeds_keep_all_their_digits():
    kw = dict(cells=(16, 16), size=(1.0, 1.0), hurst=0.8, rms_height=1e-3, longest=0.5, shortest=0.2)
    # As doubles these two are one number.
    a, b = (asp.Surface.self_affine(**kw, seed=seed).heights for seed in (2**60, 2**60 + 1))
    assert not np.array_equal(a, b)


def test_a_lay_and_a_height_distribution():
    kw = dict(cells=(128, 128), size=(1e-3, 1e-3), hurst=0.8, rms_height=1e-6, longest=2e-4, shortest=2e-5, seed=1)
    lay = asp.Surface.self_affine(**kw, lay_angle=0.0, lay_ratio=8.0)
    dx, dy = (np.diff(lay.heights, axis=axis).std() for axis in (0, 1))
    assert dx < 0.35 * dy, "the lay runs along x: heights change slowly along it"
    skewed = asp.Surface.self_affine(**kw, skewness=-1.0, kurtosis=5.0).statistics()
    assert skewed["ssk"] == pytest.approx(-1, abs=0.02) and skewed["sku"] == pytest.approx(5, abs=0.1)
    with pytest.raises(asp.CaseError, match="2000|cells|shortest"):
        asp.Surface.contact_mechanics_challenge(cells=(64, 64))


def test_a_measured_surface_is_prepared_as_in_the_case(tmp_path):
    path = EXAMPLES / "data" / "ground-steel.x3p"
    if not path.exists():
        pytest.skip("the examples are not here")
    raw = asp.Surface.read(path)
    assert np.isnan(raw.heights).any()
    steel = raw.level("plane").outliers(8, radius=2).level("plane").fill("harmonic").window("tukey", share=0.1)
    # The file says itself how it was made.
    assert len(steel.history) == len(raw.history) + 5
    told = asp.check(EXAMPLES / "ground-steel.toml")
    assert told["cells"] == list(steel.cells) and told["size"] == pytest.approx(steel.size)
    result = asp.run(EXAMPLES / "ground-steel.toml", set={"time.steps": 1, "output.every": 1}, output=tmp_path / "steel.zarr")
    assert np.array_equal(result.initial_gap, steel.gap())
    # The command with the step by name, and Python's default: the same heights. X3P keeps all bits.
    steps = "level=plane", "outliers threshold=8 radius=2", "level=plane", "fill=harmonic", "window"
    asperity = [os.environ["ASPERITY_COMMAND"]] if "ASPERITY_COMMAND" in os.environ else [sys.executable, "-m", "asperity"]
    options = [word for step in steps for word in ("--op", step)]
    subprocess.run([*asperity, "surface", "process", str(path), *options, "-o", str(tmp_path / "clean.x3p")], check=True, capture_output=True)
    assert np.array_equal(asp.Surface.read(tmp_path / "clean.x3p").heights, steel.heights)
    assert np.array_equal(raw.process(*steps[:-1]).window().heights, steel.heights)
    short = asp.Surface.read(path, level="plane", fill="nearest")
    assert np.isfinite(short.heights).all() and len(short.history) == len(raw.history) + 2
    # The record travels with the file.
    steel.write(tmp_path / "steel.x3p")
    assert asp.Surface.read(tmp_path / "steel.x3p").history == steel.history


def test_surfaces_are_shown_copied_and_pickled(rough):
    steps = rough.flip("x")
    for way in (copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))):
        again = way(steps)
        assert np.array_equal(again.heights, steps.heights) and again.size == steps.size and again.history == steps.history
    assert "<table>" in steps._repr_html_() and "flip" in steps._repr_html_()


def test_surfaces_are_drawn(rough):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    assert rough.plot.heights().get_xlabel() == "x [mm]"
    assert rough.plot.power_spectrum().get_ylabel() == "power spectrum C [m⁴]"
    assert rough.plot.bearing_curve().get_ylabel().startswith("height [")
    plt.close("all")


def test_a_topography_of_surfacetopography_is_a_surface(rough):
    topography = pytest.importorskip("SurfaceTopography")
    theirs = topography.Topography(rough.heights * 1e6, tuple(length * 1e6 for length in rough.size), unit="µm", periodic=True)
    kw = dict(pressure=1e4, times=[1.0], boundary="periodic", progress=False)
    material = asp.Elastic(young=1e8, poisson=0.3)
    ours, other = (asp.solve(surface, material, **kw) for surface in (rough, theirs))
    # The factor of the unit rounds the heights.
    assert other.approach == pytest.approx(ours.approach, rel=1e-6)


def test_a_format_that_is_not_read_is_named_or_left_to_another_package(tmp_path, monkeypatch):
    path = tmp_path / "cone.vk4"
    path.write_bytes(b"VK4_" + bytes(100))
    # None stands for a package that is not installed.
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(OSError, match="Keyence VK4.*SurfaceTopography"):
        asp.Surface.read(path)
    calls = []

    def other(*given):
        calls.append(given[:4])
        return {"heights": np.ones((3, 2)), "size": [3e-6, 2e-6], "channels": ["Height"], "format": "vk", "history": []}

    monkeypatch.setattr("asperity._foreign.read", other)
    surface = asp.Surface.read(path, channel=0)
    assert surface.cells == (3, 2) and surface.metadata["channels"] == ["Height"]
    assert calls == [(str(path), None, None, "0")]


class _Reader:
    """As a reader of SurfaceTopography: one channel of 4 x 4 points over 160 of a unit."""

    channels: list = []
    default_channel = None

    def __init__(self, unit, fails=None):
        from types import SimpleNamespace

        self.fails, channel = fails, SimpleNamespace(name="Height", dim=2, physical_sizes=(160.0, 160.0))
        self.channels, self.default_channel = [channel], channel
        self.made = SimpleNamespace(
            unit=unit, physical_sizes=(160.0, 160.0), nb_grid_pts=(4, 4), is_periodic=False, info={}, heights=lambda: np.zeros((4, 4))
        )

    def topography(self, **_):
        if self.fails is not None:
            raise self.fails
        return self.made

    def format(self):
        return "nms"


def _other(monkeypatch, reader):
    from types import SimpleNamespace

    units = SimpleNamespace(get_unit_conversion_factor=lambda unit, _: {"m": 1.0, "µm": 1e-6}[unit])
    monkeypatch.setitem(sys.modules, "SurfaceTopography", SimpleNamespace(open_topography=lambda path: reader, __version__="1"))
    monkeypatch.setitem(sys.modules, "SurfaceTopography.Support", SimpleNamespace(UnitConversion=units))


def test_what_another_reader_gives_is_looked_at(tmp_path, monkeypatch):
    path = tmp_path / "scan.vk4"
    path.write_bytes(b"VK4_" + bytes(100))
    _other(monkeypatch, _Reader("µm"))
    assert asp.Surface.read(path).size == pytest.approx((160e-6, 160e-6))
    # 160 m for 160 um.
    _other(monkeypatch, _Reader("m"))
    with pytest.warns(UserWarning, match="160 m x 160 m.*unlikely-unit"):
        asp.Surface.read(path)
    # Mistakes of its readers are not shown.
    _other(monkeypatch, _Reader("m", IndexError("list index out of range")))
    with pytest.raises(OSError, match="its reader fails on this file") as raised:
        asp.Surface.read(path)
    assert "list index" not in str(raised.value)
    _other(monkeypatch, _Reader("m", ValueError("the checksum is wrong")))
    with pytest.raises(OSError, match="the checksum is wrong"):
        asp.Surface.read(path)
