"""Force curves with times and segments, and files of instruments that this package reads itself."""

import struct

import numpy as np
import pytest

import asperity as asp

CONE = {"indenter": "cone", "angle": np.radians(35), "poisson": 0.5}


def held(seed, modulus=1e3, alpha=0.2, offset=0.3e-9, **metadata):
    """1 um of free way, 1 um of contact within 1 s, held for 2 s: approach and hold of a power law under a cone, with noise of 2 pN."""
    t = np.linspace(0, 4, 801)
    into, late = np.clip(t - 1, 0, None), np.clip(t - 2, 0, None)
    # (2/pi) tan E* int (t - s)^-alpha 2 v^2 s ds, to the end of the ramp at most.
    shape = (into ** (2 - alpha) - late ** (1 - alpha) * ((1 - alpha) + into)) / ((1 - alpha) * (2 - alpha))
    force = 2 / np.pi * np.tan(CONE["angle"]) * modulus / 0.75 * 2e-12 * shape + offset
    force = force + np.random.default_rng(seed).normal(0, 2e-12, t.size)
    segments = (asp.Segment("approach", 0, 401, 1e-6), asp.Segment("hold", 401, 801, 0.0, "height"))
    return asp.ForceCurve(force, 1e-6 * np.minimum(t - 1, 1), time=t, segments=segments, metadata=metadata)


def test_segments_follow_from_the_way_of_the_cantilever():
    way = np.concatenate([np.linspace(-4e-6, 0, 200), np.zeros(150), np.linspace(0, -4e-6, 200)])
    bent = np.maximum(way + 0.5e-6, 0) * 0.1
    bent[200:350] *= np.exp(-np.arange(150) / 50)
    curve = asp.ForceCurve.from_deflection(way, bent, spring_constant=0.1, time=1e-3 * np.arange(way.size))
    assert [segment.kind for segment in curve.segments] == ["approach", "hold", "retract"]
    up, hold, down = curve.segments
    # 2 % of the way belongs to the pause.
    assert abs(up.stop - 200) <= 5 and abs(down.start - 350) <= 5 and hold.clamp == "height"
    assert up.rate == pytest.approx(4e-6 / 0.2, rel=0.02) and down.rate == pytest.approx(-4e-6 / 0.2, rel=0.02)
    picked = curve.select("approach", "hold")
    assert [segment.kind for segment in picked.segments] == ["approach", "hold"] and picked.segments[1].stop == len(picked.force) == down.start
    np.testing.assert_array_equal(picked.height, curve.height[: down.start])
    for kinds, word in [(("retraction",), "retract"), ((), "none is named")]:
        with pytest.raises(asp.CaseError, match=word):
            curve.select(*kinds)
    with pytest.raises(asp.CaseError, match="no segments"):
        asp.ForceCurve(way, way).select("approach")


def test_approach_and_hold_are_one_record():
    fit = asp.fit_indentation(held(1), model="power-law", **CONE)
    assert fit.given == "depth" and fit.modulus[1] <= 1e3 <= fit.modulus[2] and fit.exponent[1] <= 0.2 <= fit.exponent[2]
    # 200 free rows of 2 pN know the offset to 0.15 pN at their middle.
    assert fit.baseline[0] == pytest.approx(0.3e-9, abs=3e-12) and not fit.notes
    # The hold alone: what relaxed during the ramp is missing, and a note says so.
    hold = held(1, offset=0.0).select("hold")
    alone = asp.fit_indentation(hold.time - hold.time[0], hold.force, hold.depth, model="power-law", **CONE)
    assert any("begins at" in note for note in alone.notes)
    with pytest.raises(asp.CaseError, match="times"):
        asp.fit_indentation(asp.ForceCurve(hold.force, hold.depth), model="power-law", **CONE)
    with pytest.raises(asp.CaseError, match="leave them out"):
        asp.fit_indentation(hold, hold.force, hold.depth, model="power-law", **CONE)
    with pytest.raises(asp.CaseError, match="load and depth are missing"):
        asp.fit_indentation(hold.time, model="power-law", **CONE)


def test_a_map_of_power_laws_has_moduli_and_exponents():
    truth = [(1e3, 0.2), (2e3, 0.1)]
    cells = [held(n, *pair, **{"grid index x": n, "grid index y": 0}) for n, pair in enumerate(truth)]
    found = asp.fit_force_map(cells, model="power-law", **CONE)
    for n, (modulus, alpha) in enumerate(truth):
        # A percent each: the noise is 0.1 % of the load.
        assert found.young[n, 0] == pytest.approx(modulus, rel=1e-2) and found.exponent[n, 0] == pytest.approx(alpha, rel=1e-2)
        assert found.exponent_low[n, 0] < found.exponent[n, 0] < found.exponent_high[n, 0]
    assert np.isnan(found.work).all() and found.to_xarray().exponent.attrs["units"] == "1"


def test_an_elastic_fit_of_a_curve_takes_its_branch():
    depth = np.concatenate([np.linspace(-2e-6, 1e-6, 300), np.linspace(1e-6, -2e-6, 300)])
    force = 4 / 3 * 1e3 / 0.75 * np.sqrt(5e-6) * np.maximum(depth, 0) ** 1.5
    force[300:] *= 0.5
    segments = (asp.Segment("approach", 0, 300), asp.Segment("retract", 300, 600))
    curve = asp.ForceCurve(force + 1e-9 + 5e-5 * depth, depth, segments=segments)
    how = {"radius": 5e-6, "indenter": "paraboloid", "poisson": 0.5, "model": "hertz"}
    for branch, young in (("approach", 1e3), ("retraction", 500.0)):
        fit = asp.fit_indentation(curve, branch=branch, **how)
        # Exact numbers: the fit takes 1e-7 of the ranges as noise.
        assert fit.young[0] == pytest.approx(young, rel=1e-4) and fit.tilt[0] == pytest.approx(5e-5, rel=1e-3)
        assert len(fit.rows) == 300
    plain = asp.fit_indentation(curve, branch="approach", weights="none", **how)
    assert plain.young[0] == pytest.approx(1e3, rel=1e-4)


def test_a_thin_sample_is_fitted_without_adhesion():
    layer = asp.Body(layers=[asp.Layer(thickness=2e-6, material=asp.Elastic(young=1e3, poisson=0.49))])
    sphere = asp.Surface.sphere(cells=(64, 64), size=(6e-6, 6e-6), radius=10e-6)
    pressed = asp.solve(sphere, layer, approach=asp.ramp(0.2e-6, duration=1.0), times=asp.uniform(1.0, 20))
    # The load grows as depth^1.5 times a smooth function, which is interpolated.
    depth = np.linspace(-1e-6, 0.2e-6, 300)
    known = slice(1, None)
    smooth = np.interp(depth, pressed.approach[known], pressed.load[known] / pressed.approach[known] ** 1.5)
    force = smooth * depth.clip(0) ** 1.5
    how = {"radius": 10e-6, "indenter": "paraboloid", "poisson": 0.49, "model": "hertz", "branch": "approach"}
    thin = asp.fit_indentation(None, force, depth, thickness=2e-6, **how)
    thick = asp.fit_indentation(None, force, depth, **how)
    # 64 cells along 6 um: the edge of the contact is known to a cell, some percent of its load.
    assert thin.young[0] == pytest.approx(1e3, rel=0.05) and thick.young[0] > 1.3e3
    wide = asp.fit_indentation(None, force, depth, thickness=2e-6, thickness_uncertainty=0.2e-6, **how)
    assert wide.young[2] / wide.young[0] > 1.05
    with pytest.raises(asp.CaseError, match="adhesion"):
        asp.fit_indentation(None, force, depth, thickness=2e-6, **{**how, "model": "jkr"})


def nanoscope(curves, *, points=64, width=4, sensitivity="27.39", spring="0.1", volume=None, more=""):
    """A Nanoscope file of these deflections [m] from contact outwards, approach and retraction."""
    lsb = 0.000375
    context = "FVOL" if volume else "FOL"
    image = f"\\*Ciao image list\r\n\\Number of lines: {volume[1]}\r\n" if volume else ""
    per_line = f"\\force/line: {volume[0]}\r\n" if volume else ""
    head = (
        f"\\*Force file list\r\n\\Version: 0x0920B046\r\n\\Start context: {context}\r\n"
        "\\*Ciao scan list\r\n\\Scan Size: 2000 nm\r\n\\@Sens. Zsens: V 13.2 nm/V\r\n"
        f"\\@Sens. DeflSens: V {sensitivity}\r\n"
        f"\\*Ciao force list\r\n{per_line}\\Forward vel.: 400\r\n\\Reverse vel.: 200\r\n\\Trigger mode: Relative\r\n"
        f"\\@4:Trig Threshold Deflection: V [Sens. DeflSens] (0.000375 V/LSB) 1.2 V\r\n{more}{image}"
        "\\*Ciao force image list\r\n\\Data offset: 4096\r\n"
        f"\\Data length: {len(curves) * 2 * points * width}\r\n\\Bytes/pixel: 2\r\n\\Samps/line: {points} {points}\r\n"
        f"\\Spring Constant: {spring}\r\n\\@4:Image Data: S [DeflectionError] \"Deflection Error\"\r\n"
        "\\@4:Z scale: V [Sens. DeflSens] (0.0003750000 V/LSB) 2.5 V\r\n"
        "\\@4:Ramp size: V [Sens. Zsens] (0.0067 V/LSB) 200 V\r\n\\*File list end\r\n"
    ).encode()
    numbers = [round(x / 27.39e-9 / lsb) for curve in curves for x in curve]
    return head.ljust(4096, b"\0") + struct.pack(f"<{len(numbers)}{'i' if width == 4 else 'h'}", *numbers)


def blocks(points=64, peak=32e-9):
    """Approach and retraction from contact outwards, bent within the first half micrometre."""
    away = 2.64e-6 * np.arange(points) / points
    approach = np.maximum(peak * (1 - away / 0.5e-6), 0.0) - 3e-9
    return np.concatenate([approach, approach - 2e-9])


@pytest.mark.parametrize("width", [2, 4])
def test_a_nanoscope_curve_is_read(tmp_path, width):
    (tmp_path / "curve.spm").write_bytes(nanoscope([blocks()], width=width))
    (curve,) = asp.read_force_curves(tmp_path / "curve.spm")
    # One unit is 0.000375 V times 27.39 nm/V.
    expected = np.concatenate([blocks()[:64][::-1], blocks()[64:]])
    np.testing.assert_allclose(curve.deflection, expected, atol=0.5 * 0.000375 * 27.39e-9)
    np.testing.assert_allclose(curve.force, 0.1 * curve.deflection, rtol=1e-12)
    assert curve.height[63] == pytest.approx(2.64e-6) and curve.height[0] == pytest.approx(2.64e-6 / 64)
    # 200 V at 400 V/s and 200 V/s.
    assert curve.time[1] == pytest.approx(0.5 / 64) and curve.time[65] - curve.time[64] == pytest.approx(1.0 / 64)
    assert [(one.kind, one.start, one.stop) for one in curve.segments] == [("approach", 0, 64), ("retract", 64, 128)]
    stiffer = asp.read_force_curves(tmp_path / "curve.spm", spring_constant=0.2, sensitivity=2 * 27.39e-9)[0]
    np.testing.assert_allclose(stiffer.force, 4 * curve.force)


def test_a_nanoscope_volume_has_places(tmp_path):
    (tmp_path / "volume.spm").write_bytes(nanoscope([blocks()] * 6, volume=(3, 2)))
    curves = asp.read_force_curves(tmp_path / "volume.spm")
    assert [(c.metadata["grid index x"], c.metadata["grid index y"]) for c in curves] == [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]
    assert curves[0].metadata["grid shape x"] == 3 and curves[0].metadata["grid size y"] == pytest.approx(2e-6)


def test_nanoscope_curves_that_were_not_checked_are_refused(tmp_path):
    path = tmp_path / "curve.spm"
    good = nanoscope([blocks()])
    for data, word in [
        (nanoscope([blocks()], more="\\Hold Samples: 10\r\n"), "hold"),
        (good.replace(b"64 64", b"64 32"), "Samps/line"),
        (good.replace(b"Data length: 512", b"Data length: 500"), "Data length"),
        (good[:4200], "truncated"),
        (nanoscope([blocks()], spring="0"), "spring constant"),
        (good.replace(b"\\@Sens. DeflSens", b"\\@Sens. OtherSens"), "sensitivity"),
        # A byte more: its numbers are 256 times as large.
        (good[:4096] + b"\0" + good[4096:-1], "shifted"),
    ]:
        path.write_bytes(data)
        with pytest.raises(asp.CaseError, match=word):
            asp.read_force_curves(path)
    path = tmp_path / "curve.xyz"
    path.write_text("text")
    pytest.importorskip("afmformats")
    with pytest.raises(asp.CaseError, match="ForceCurve.from_deflection"):
        asp.read_force_curves(path)
