"""Figures: what they show, and that they take what matplotlib takes."""

import numpy as np
import pytest

import asperity as asp
from asperity._prefixes import quantity, shown

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.colors import LogNorm  # noqa: E402


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def rough():
    return asp.Surface.self_affine(cells=(40, 32), size=(1e-3, 8e-4), hurst=0.8, rms_gradient=0.05, longest=4e-4, shortest=1e-4, seed=2)


@pytest.fixture(scope="module")
def result(rough):
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    fields = ["pressure", "gap", "displacement", "contact", "flattening"]
    return asp.solve(rough, zener, pressure=1e4, times=[1.0, 5.0], fields=fields, boundary="periodic", progress=False)


def test_maps_take_what_imshow_takes_in_si_units(result):
    figure, (left, right) = plt.subplots(1, 2)
    assert result.plot.pressure(ax=left, cmap="Greys", vmin=1e3, vmax=1e5) is left
    image = left.images[0]
    assert image.get_clim() == (1e3, 1e5) and image.get_cmap().name == "Greys"
    # The image shows the field, x along its width.
    assert np.array_equal(image.get_array(), result.field("pressure").T) and left.get_xlabel() == "x [mm]"
    assert left.get_title() == "t = 5 s" and result.plot.pressure(time=0.0, ax=right, norm=LogNorm(1e2, 1e5)).get_title() == "t = 0 s"
    assert isinstance(right.images[0].norm, LogNorm)
    figure.canvas.draw()
    bar = figure.axes[-1]
    # Ticks are told in the unit of the label.
    assert bar.get_ylabel() in ("pressure [kPa]", "pressure [Pa]")
    for name in ("gap", "displacement", "contact", "spots", "flattening"):
        getattr(result.plot, name)(index=0, alpha=0.5).figure.canvas.draw()


def test_the_colour_bar_counts_in_its_unit(result):
    ax = result.plot.gap()
    bar = ax.figure.axes[-1]
    ax.figure.canvas.draw()
    assert bar.get_ylabel() == "gap [µm]"
    for place, text in zip(bar.get_yticks(), bar.get_yticklabels()):
        assert float(text.get_text().replace("−", "-")) == pytest.approx(1e6 * place, abs=1e-9)


def test_curves_take_labels_and_styles_and_share_axes(result):
    axes = result.plot.evolution(label="soft", color="k")
    again = result.plot.evolution(axes=axes, label="stiff", linestyle=":")
    assert again is axes and [line.get_label() for line in axes.flat[0].lines] == ["soft, counted", "soft, corrected", "stiff, counted", "stiff, corrected"]
    assert axes.flat[1].get_xlabel() == "time [s]" and axes.flat[1].lines[0].get_color() == "k"
    with pytest.raises(asp.CaseError, match="four"):
        result.plot.evolution(axes=axes[0])
    ax = result.plot.load_displacement(label="one", marker="o")
    result.plot.profile(y=1e-4, field="gap", ls="--").figure.canvas.draw()
    assert ax.get_legend() is not None and ax.get_xlabel().startswith("approach [")


def test_a_second_curve_has_the_unit_of_the_first(rough):
    rubber = asp.Elastic(young=1e6, poisson=0.5)
    light, heavy = (asp.solve(rough, rubber, pressure=p, times=[1.0], boundary="periodic", fields=[], progress=False) for p in (1e2, 1e4))
    ax = light.plot.load_displacement()
    heavy.plot.load_displacement(ax=ax)
    unit = {"nN": 1e9, "µN": 1e6, "mN": 1e3, "N": 1.0}[ax.get_ylabel().split("[")[1][:-1]]
    for line, loads in zip(ax.lines, (light.load, heavy.load)):
        assert np.allclose(line.get_ydata(), loads * unit)


def test_spots_are_a_labelled_image(result):
    labels = result.spots()
    sizes = np.bincount(labels.ravel())[1:]
    assert labels.shape == result.cells and np.array_equal(labels > 0, result.field("pressure") > 0)
    assert np.all(np.diff(sizes.astype(int)) <= 0) and result.spots(time=0.0).max() >= 1
    assert result.plot.spots().get_title().startswith(f"{len(sizes)} contact spots")


def test_surfaces_and_curves_are_drawn(rough):
    for name in ("heights", "power_spectrum", "power_spectrum_1d", "power_spectrum_2d", "autocorrelation", "height_distribution", "bearing_curve"):
        figure, ax = plt.subplots()
        assert getattr(rough.plot, name)(ax=ax) is ax
        assert ax.get_xlabel() and ax.get_ylabel()
        figure.canvas.draw()
    assert rough.plot.power_spectrum(label="one", color="r", marker="").get_legend() is not None
    assert rough.plot.heights(cmap="Greys").images[0].get_cmap().name == "Greys"
    profile = asp.Surface.self_affine(cells=64, size=1e-3, hurst=0.8, rms_height=1e-6, longest=5e-4, shortest=5e-5)
    assert "m³" in profile.plot.power_spectrum().get_ylabel()
    curve = asp.elastic(rough, 4e6, pressure=[1e3, 1e4], boundary="periodic")
    assert "mean pressure" in curve.plot.area(label="a").get_xlabel() and curve.plot.load_displacement().get_ylabel().startswith("load")
    curve[0].plot.pressure().figure.canvas.draw()


def test_a_sweep_is_drawn_over_its_velocities():
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    held = asp.steady(wave, rubber, pressure=20e3, velocities=[0.01, 0.1], boundary="periodic", progress=False)
    axes = held.plot.evolution()
    assert axes.flat[0].get_xlabel() == "velocity [mm/s]" and axes.flat[0].get_xscale() == "log"
    assert held.plot.pressure(velocity=0.01).get_title().startswith("v = 10 mm/s")


def test_the_two_curves_of_an_evolution_differ(result):
    def looks(line):
        return line.get_linestyle(), line.get_color(), line.get_fillstyle()

    for style in ({}, dict(label="a"), dict(color="r"), dict(linestyle="--", color="C3"), dict(linestyle="--"), dict(ls="--", c="k", label="a"),
                  dict(linestyle="none", marker="o", color="k")):  # fmt: skip
        for ax in result.plot.evolution(**style).flat:
            assert len(ax.lines) == len({looks(line) for line in ax.lines}) and len(ax.lines) in (1, 2, 3), style
            # Colours that are given, or count the runs, are those of all curves.
            assert not style or len({line.get_color() for line in ax.lines}) == (len(ax.lines) if style == dict(linestyle="--") else 1), style
    axes = result.plot.evolution()
    # Ends of curves do not lie on the frame, and the legend lies above it.
    low, high = axes.flat[0].get_xlim()
    assert low < 0.0 and high > 5.0
    axes.flat[0].figure.canvas.draw()
    assert axes.flat[0].get_legend().get_window_extent().y0 >= axes.flat[0].get_window_extent().y1


def test_decades_of_time_are_logarithmic(rough):
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    given = dict(pressure=1e4, boundary="periodic", fields=[], progress=False)
    decades = asp.solve(rough, zener, times=asp.log(100.0, 8, first=0.01), **given)
    ax = decades.plot.evolution().flat[1]
    assert ax.get_xscale() == "log" and np.array_equal(ax.lines[0].get_xdata(), decades.time[1:])
    assert decades.plot.evolution(log_time=False).flat[1].get_xscale() == "linear"
    assert asp.solve(rough, zener, times=asp.uniform(10.0, 8), **given).plot.evolution().flat[1].get_xscale() == "linear"


def test_units_and_bars_suit_what_is_shown():
    assert shown(9.5e-8, "m", 2) == (pytest.approx(1e6), "mm²") and shown(9e-9, "m", 2) == (pytest.approx(1e12), "µm²")
    wave = asp.Surface.wave(cells=(64, 16), size=(4e-3, 1e-3), amplitude=1e-6, wavelength=(1e-3, 1e-3))
    ax = wave.plot.heights()
    ax.figure.canvas.draw()
    bar = ax.images[0].colorbar.ax
    heights = [place.get_window_extent().height for place in (bar, ax)]
    assert heights[0] < 1.5 * heights[1]
    assert any(text.get_text().startswith("\N{MINUS SIGN}") for text in bar.get_xticklabels())
    flat = asp.Surface.flat_punch(cells=(16, 16), size=(1e-3, 1e-3), radius=3e-4).plot.heights()
    flat.figure.canvas.draw()
    assert [text.get_text() for text in flat.images[0].colorbar.ax.get_yticklabels()] == ["0"]
    rough = asp.Surface.self_affine(cells=(64, 64), size=(1e-3, 1e-3), hurst=0.8, rms_height=1e-6, longest=5e-4, shortest=4e-5)
    spectrum = rough.plot.power_spectrum()
    spectrum.figure.canvas.draw()
    told = [text for text in spectrum.get_xticklabels(which="both") if text.get_text()]
    ends = sorted((text.get_window_extent().x0, text.get_window_extent().x1) for text in told)
    assert all(one[1] <= other[0] for one, other in zip(ends, ends[1:]))


def test_limits_take_units(result):
    class Quantity:
        units = "kPa"

        def m_as(self, wanted):
            assert wanted == "Pa"
            return 2e5

    assert result.plot.pressure(vmin=0, vmax=Quantity()).images[0].get_clim() == pytest.approx((0, 2e5))


def test_a_constant_load_is_not_zoomed_into():
    ball = asp.Surface.sphere(cells=(32, 32), size=(1e-3, 1e-3), radius=20e-3)
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    runs = [asp.solve(ball, zener, load=load, times=asp.log(100.0, 20, first=1e-3), fields=[]) for load in (1e-3, 4e-3)]
    assert np.ptp(runs[0].load) > 0.0, "rounding errors are what the axes must not show"
    axes = runs[0].plot.evolution()
    low, high = axes.flat[2].get_ylim()
    assert low < 0.96 and high > 1.04
    runs[1].plot.evolution(axes=axes)
    axes.flat[2].figure.canvas.draw()
    assert axes.flat[2].get_ylim()[1] > 4.0


def test_a_sweep_shows_its_friction():
    wave = asp.Surface.wave(cells=(32, 4), size=(1e-3, 125e-6), amplitude=1e-6, wavelength=(1e-3, float("inf")))
    rubber = asp.Zener(shear=1e6, shear_kelvin=0.2e6, retardation_time=0.01, poisson=0.5)
    for shear, curves in ((None, ["friction_coefficient"]), (1e4, ["friction_coefficient", "friction_coefficient_total"])):
        held = asp.steady(wave, rubber, pressure=20e3, velocities=[0.01, 0.1], boundary="periodic", shear_stress=shear)
        ax = held.plot.evolution().flat[2]
        assert ax.get_ylabel() == "friction coefficient"
        assert [line.get_ydata().tolist() for line in ax.lines] == [getattr(held, name).tolist() for name in curves]


def test_one_contact_is_a_point(rough):
    contact = asp.elastic(rough, 4e6, pressure=1e4, boundary="periodic")
    for ax in [*contact.plot.evolution().flat, contact.plot.load_displacement()]:
        assert all(line.get_marker() == "o" for line in ax.lines) and ax.lines
    assert "flattening" not in repr(contact.plot) and "pressure()" in repr(contact.plot)
    assert "pressure()" not in repr(asp.solve(rough, asp.Elastic(young=1e6, poisson=0.5), pressure=1e4, times=[1.0], fields=[], boundary="periodic").plot)
    curve = asp.elastic(rough, 4e6, pressure=[1e3, 1e4], boundary="periodic")
    assert curve.plot.area().get_ylabel().startswith("corrected") and curve.plot.area(corrected=False).get_ylabel().startswith("contact area")


@pytest.fixture(scope="module")
def ball():
    surface = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=20e-3)
    return asp.solve(surface, asp.Elastic(young=1e6, poisson=0.5), load=asp.ramp(1e-3, duration=1.0), times=[1.0], every=1, fields=["pressure", "gap"])


def colour_at(ax, i, j):
    image = ax.images[0]
    image.figure.canvas.draw()
    return matplotlib.colors.to_hex(image.to_rgba(image.get_array())[j, i])


def test_maps_are_light_where_there_is_nothing_to_show(ball):
    light = "#f0f0ee"
    nothing = ball.plot.pressure(index=0)
    assert nothing.get_title() == "t = 0 s\nno contact" and colour_at(nothing, 8, 8) == light and nothing.images[0].colorbar is None
    some = ball.plot.pressure()
    assert some.get_title() == "t = 1 s\nlight: no contact" and colour_at(some, 0, 0) == light and colour_at(some, 8, 8) != light
    assert some.images[0].get_clim()[0] == pytest.approx(0.0, abs=1e-300)
    # With the same colours at all times too.
    assert colour_at(ball.plot.pressure(vmin=0, vmax=1e4), 0, 0) == light
    first = ball.plot.pressure(index=0, vmin=0, vmax=1e4)
    assert colour_at(first, 8, 8) == light and first.images[0].colorbar is not None
    gap = ball.plot.gap()
    assert gap.get_title() == "t = 1 s\nlight: contact" and colour_at(gap, 8, 8) == light and colour_at(gap, 0, 0) != light
    # With colours that begin elsewhere, zeros have the lowest one.
    image = ball.plot.pressure(index=0, norm=matplotlib.colors.Normalize()).images[0]
    image.figure.canvas.draw()
    assert image.get_clim()[0] == 0.0 and np.all(image.to_rgba(image.get_array()) == image.get_cmap()(0.0))


def test_full_contact_has_no_gap_but_rounding_errors(rough):
    full = asp.solve(rough, asp.Elastic(young=1e3, poisson=0.5), pressure=1e5, times=[1.0], boundary="periodic", fields=["pressure", "gap"])
    assert full.contact_fraction[-1] == 1.0
    assert full.plot.gap().get_title().endswith("the bodies touch everywhere")
    pressure = full.plot.pressure()
    assert "light" not in pressure.get_title() and pressure.images[0].get_clim()[0] == pytest.approx(0.0, abs=1e-300)


def test_maps_keep_their_places(result, rough):
    upper = result.plot.pressure(origin="upper")
    # The first row of the image is that of the least y, which is above then.
    assert upper.get_ylim()[0] > upper.get_ylim()[1] and upper.images[0].get_extent()[2:] == [0.8, 0.0]
    wide = asp.Surface.wave(cells=(64, 16), size=(4e-3, 1e-3), amplitude=1e-6, wavelength=(1e-3, 1e-3))
    ax = asp.elastic(wide, 4e6, pressure=1e3, boundary="periodic").plot.contact()
    ax.figure.canvas.draw()
    legend, label = ax.get_legend().get_window_extent(), ax.xaxis.label.get_window_extent()
    assert not legend.overlaps(label)
    assert result.plot.profile(y=9e-5).get_title() == "y = 87.5 µm, t = 5 s"


def test_misspelt_arguments_are_told(result, rough):
    for wrong, told in (
        (lambda: result.plot.pressure(cmpa="Greys"), "'cmap'"),
        (lambda: result.plot.load_displacement(colr="r"), "'color'"),
        (lambda: result.plot.evolution(ax=plt.gca()), "axes="),
        (lambda: rough.plot.bearing_curve(linestle="--"), "'linestyle'"),
    ):
        with pytest.raises(TypeError, match=told):
            wrong()
    assert result.plot.evolution(label=5).flat[0].lines[0].get_label() == "5, counted"


def test_an_evolution_shows_the_mean_pressure_over_the_contact_and_the_hardness(ball):
    ax = ball.plot.evolution().flat[3]
    assert [line.get_label() for line in ax.lines] == ["nominal mean", "largest", "mean over the contact"]
    mean = ax.lines[2].get_ydata() / ax.lines[1].get_ydata() * ball.max_pressure
    with np.errstate(invalid="ignore"):
        assert np.isnan(mean[0]) and mean[-1] == pytest.approx(ball.load[-1] / ball.contact_area[-1])
    surface = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=20e-3)
    soft = asp.solve(surface, asp.Elastic(young=1e6, poisson=0.5), load=1e-3, times=[1.0], hardness=3e3, fields=["contact", "gap"])
    assert soft.plot.evolution().flat[0].lines[2].get_label() == "at the hardness"
    for ax in (soft.plot.gap(), soft.plot.profile(field="gap")):
        assert ax.get_title().endswith("below 0: flattened at the hardness")


def test_nothing_that_touches_is_told():
    surface = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=20e-3)
    apart = asp.solve(surface, asp.Elastic(young=1e6, poisson=0.5), approach=asp.ramp(-1e-6, duration=1.0), times=asp.uniform(1.0, 4), fields=["pressure", "gap"])
    axes = apart.plot.evolution()
    for ax in (axes.flat[0], axes.flat[3], apart.plot.load_displacement()):
        assert ax.get_legend().get_texts()[0].get_text() == "nothing touches" and ax.get_ylim() == (0.0, 1.0)
    for ax in (apart.plot.gap(), apart.plot.contact(), apart.plot.spots(), apart.plot.profile()):
        assert ax.get_title().endswith("no contact")


def test_cycles_show_the_last_one_beside():
    punch = asp.Surface.flat_punch(cells=(16, 16), size=(1e-3, 1e-3), radius=0.3e-3)
    zener = asp.Zener(shear=1e6, shear_kelvin=1e6, retardation_time=1.0, poisson=0.5)
    load = asp.sine(mean=0.02, amplitude=0.01, frequency=0.2)
    cyclic = asp.solve(punch, zener, load=load, times=asp.uniform(20.0, 80), fields=[])
    whole = cyclic.plot.load_displacement()
    last = whole.figure.axes[1]
    assert (whole.get_title(), last.get_title()) == ("all cycles", "last cycle, t = 15 s to 20 s")
    # A period of 5 s has 20 steps of 0.25 s.
    assert len(whole.lines[0].get_xdata()) == 81 and len(last.lines[0].get_xdata()) == 21
    # A sine begins and ends a period at its mean of 20 mN.
    assert last.lines[0].get_ydata()[[0, -1]] == pytest.approx([20.0, 20.0])
    zigzag = asp.table([(0.0, 0.0), *((n + 0.0, 0.02 if n % 2 else 0.01) for n in range(1, 7))])
    peaks = asp.solve(punch, zener, load=zigzag, times=asp.uniform(6.0, 24), fields=[]).plot.load_displacement().figure.axes[1]
    assert peaks.get_title() == "last cycle, t = 3 s to 5 s" and peaks.lines[0].get_ydata()[[0, 4, 8]] == pytest.approx([20.0, 10.0, 20.0])
    # The sine of a second stage, on a clock that starts with it.
    staged = asp.solve(punch, zener, stages=[asp.Stage(load=asp.ramp(0.02, duration=1.0), duration=1.0), asp.Stage(load=load)], times=asp.uniform(9.0, 72), fields=[])
    assert staged.plot.load_displacement().figure.axes[1].get_title() == "last cycle, t = 1 s to 6 s"
    for wanted, rows in ((None, 81), (False, 81), (True, 21)):
        ax = cyclic.plot.load_displacement(last_cycle=wanted, ax=plt.subplots()[1])
        assert len(ax.lines[0].get_xdata()) == rows and len(ax.figure.axes) == 1
    held = asp.solve(punch, zener, load=0.02, times=asp.uniform(2.0, 4), fields=[])
    assert len(held.plot.load_displacement().figure.axes) == 1
    with pytest.raises(asp.CaseError, match="three peaks"):
        held.plot.load_displacement(last_cycle=True)


def test_curves_that_stay_at_one_point_are_seen():
    surface = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=20e-3)
    constant = asp.solve(surface, asp.Elastic(young=1e6, poisson=0.5), load=1e-3, times=asp.uniform(1.0, 4), fields=[])
    ax = constant.plot.load_displacement()
    assert ax.lines[0].get_marker() == "o" and ax.get_ylim() == pytest.approx((0.9, 1.1))


def test_a_narrow_map_is_stretched_and_says_so():
    for cells, size, words, names in (((64, 4), (8e-3, 6e-5), "y stretched 17 times", ("x [mm]", "y [µm]")), ((4, 64), (6e-5, 8e-3), "x stretched 17 times", ("x [µm]", "y [mm]"))):  # fmt: skip
        lengths = tuple(8e-3 / 16 if side == 8e-3 else float("inf") for side in size)
        narrow = asp.Surface.wave(cells=cells, size=size, amplitude=1e-6, wavelength=lengths)
        ax = narrow.plot.heights()
        ax.figure.canvas.draw()
        box = ax.get_window_extent()
        # The sides of the picture are rounded to pixels.
        assert max(box.width / box.height, box.height / box.width) == pytest.approx(8.0, rel=0.02)
        assert ax.get_title() == words and (ax.get_xlabel(), ax.get_ylabel()) == names
        for axis in (ax.xaxis, ax.yaxis):
            boxes = [text.get_window_extent() for text in axis.get_ticklabels() if text.get_text()]
            assert not any(one.overlaps(other) for one, other in zip(boxes, boxes[1:]))
        assert narrow.plot.heights(aspect="equal").get_title() == ""


def test_few_spikes_do_not_take_the_colours():
    z = 1e-6 * np.random.default_rng(0).random((64, 64))
    z[3, 5] = 1e-4
    spiked = asp.Surface(z, size=(1e-3, 1e-3)).plot.heights()
    assert np.ptp(spiked.images[0].get_clim()) < 1.1e-6 and spiked.images[0].colorbar.extend == "max"


def test_units_have_powers_of_ten_beyond_the_prefixes():
    assert [shown(number, "N")[1] for number in (1e-14, 2e-9, 0.99998, 3e5, 1e16)] == ["10⁻⁶ nN", "nN", "N", "kN", "10⁹ MN"]
    assert shown(1e16, "N")[0] == pytest.approx(1e-15) and shown(1e6, "m")[1] == "10⁶ m" and shown(8.64e4, "s") == (pytest.approx(1 / 3600), "h")
    assert [quantity(number, "s") for number in (0.0, 0.005, 1e5, 3e8)] == ["0 s", "5 ms", "27.78 h", "9.506 a"]
    assert quantity(-3.9312e-6, "m") == "\N{MINUS SIGN}3.931 µm"


def test_short_runs_count_in_short_times(rough):
    brief = asp.solve(rough, asp.Elastic(young=1e6, poisson=0.5), pressure=1e4, times=[1e-3, 2e-3], boundary="periodic", fields=[])
    axes = brief.plot.evolution()
    assert axes.flat[0].get_xlabel() == "time [ms]" and axes.flat[1].lines[0].get_xdata()[-1] == pytest.approx(2.0)
    longer = asp.solve(rough, asp.Elastic(young=1e6, poisson=0.5), pressure=1e4, times=[1.0], boundary="periodic", fields=[])
    longer.plot.evolution(axes=axes)
    assert axes.flat[0].get_xlabel() == "time [ms]" and axes.flat[1].lines[-1].get_xdata()[-1] == pytest.approx(1000.0)


def texts_of(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_legend_names_each_run_and_each_kind_of_curve_once(ball):
    axes = ball.plot.evolution(label="one")
    ball.plot.evolution(axes=axes, label="two")
    kinds = ["nominal mean", "largest", "mean over the contact"]
    assert texts_of(axes.flat[3]) == ["one", "two", *kinds] and texts_of(axes.flat[1]) == ["one", "two"]
    # Where lines tell the runs apart, they cannot tell the kinds of curves.
    axes = ball.plot.evolution(label="one", color="k")
    ball.plot.evolution(axes=axes, label="two", color="k", linestyle=":")
    assert texts_of(axes.flat[3]) == [f"{run}, {kind}" for run in ("one", "two") for kind in kinds]


def test_legends_fit_in_narrow_axes(ball):
    # One column of a journal.
    with plt.rc_context({"font.size": 6}):
        figure, axes = plt.subplots(2, 2, figsize=(84 / 25.4, 66 / 25.4), layout="constrained")
        ball.plot.evolution(axes=axes, label="steel")
        figure.canvas.draw()
    for ax in axes.flat:
        # The layout moves axes by a few pixels after the legend was made.
        assert ax.get_legend().get_window_extent().width < 1.1 * ax.get_window_extent().width
        assert ax.get_window_extent().width > 0.3 * figure.bbox.width


def test_a_profile_of_the_gap_has_the_undeformed_one_beside(ball):
    ax = ball.plot.profile(field="gap")
    assert texts_of(ax) == ["now", "undeformed"]
    unit = {"nm": 1e9, "µm": 1e6}[ax.get_ylabel()[5:7]]
    assert np.allclose(ax.lines[1].get_ydata(), unit * ball.initial_gap[:, 8])
    ax.figure.canvas.draw()
    assert not ax.get_legend().get_window_extent().overlaps(ax.title.get_window_extent())
    assert len(ball.plot.profile(field="gap", label="one").lines) == 1


def test_profiles_share_the_units_of_their_axes(ball, rough):
    ax = ball.plot.profile(label="ball")
    large = asp.Surface.sphere(cells=(16, 16), size=(0.1, 0.1), radius=1.0)
    asp.solve(large, asp.Elastic(young=1e6, poisson=0.5), load=1.0, times=[1.0]).plot.profile(ax=ax, label="large")
    assert ax.get_xlabel() == "x [mm]" and ax.lines[1].get_xdata()[-1] > 90.0


def test_friction_and_wear_are_drawn():
    ball = asp.Surface.sphere(cells=(32, 32), size=(0.6e-3, 0.6e-3), radius=10e-3)
    steel = asp.Elastic(young=70e9, poisson=0.22)
    pull = asp.tangential(force=asp.table([(0, 0), (1, 2.0), (3, -2.0)]))
    fields = ["pressure", "contact", "traction_x", "slip_x"]
    rubbed = asp.solve(ball, [steel, steel], load=10.0, times=asp.uniform(3.0, 6), friction=0.3, tangential=pull, fields=fields, wear=1e-13)
    # A slipping cell has a colour and a name of its own.
    states = rubbed.plot.contact(time=1.0)
    assert [text.get_text() for text in states.get_legend().get_texts()] == ["open", "contact", "slips"]
    image = states.images[0]
    slipping, sticking = (image.to_rgba(number)[:3] for number in (3, 1))
    assert image.get_clim() == (0, 3) and slipping != sticking != image.to_rgba(2)[:3] != slipping
    assert 3 in rubbed.field("contact", time=1.0)
    drawn = rubbed.plot.field("traction_x", time=3.0)
    assert np.array_equal(drawn.images[0].get_array(), rubbed.field("traction_x", time=3.0).T) and drawn.get_title() == "t = 3 s"
    assert drawn.figure.axes[1].get_ylabel() == "traction x [MPa]"
    half = rubbed.plot.field("traction_x", time=1.5).images[0]
    assert half.get_clim()[0] == -half.get_clim()[1] < 0, "numbers of both signs have 0 in the middle"
    loop = rubbed.plot.tangential_loop(color="k").lines[0]
    assert np.allclose(loop.get_ydata(), rubbed.tangential_force[:, 0]) and np.allclose(loop.get_xdata(), 1e9 * rubbed.tangential_displacement[:, 0])
    axes = rubbed.plot.wear(label="run")
    assert axes.shape == (2, 2) and np.argmax(axes[0, 0].lines[0].get_ydata()) == 6
    assert {"wear()", "tangential_loop()"} <= set(repr(rubbed.plot).strip("<>").replace(",", "").split()) and "friction()" not in repr(rubbed.plot)
    with pytest.raises(asp.CaseError, match="was not kept"):
        rubbed.plot.field("displacement")
    plain = asp.solve(ball, steel, load=1.0, times=[1.0])
    for missing in (plain.plot.wear, plain.plot.tangential_loop):
        with pytest.raises(AttributeError, match="the result has no"):
            missing()
    # Of a line the names stand at the axis.
    line = asp.solve(
        asp.Surface.cylinder(cells=64, size=1e-3, radius=1e-2), [steel, steel], load=1e4, boundary="periodic", times=asp.uniform(1.0, 2), friction=0.3,
        tangential=asp.tangential(force=asp.ramp(2e3, duration=1.0)),
    )
    assert [text.get_text() for text in line.plot.contact().get_yticklabels()] == ["open", "contact", "at hardness", "slips"]
    assert line.plot.field("traction_x").get_ylabel() == "traction x [MPa]"
