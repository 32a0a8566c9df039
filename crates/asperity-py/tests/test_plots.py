"""Figures: what they show, and that they take what matplotlib takes."""

import numpy as np
import pytest

import asperity as asp
from asperity._drawing import _shown

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
    assert bar.get_ylabel() in ("contact pressure [kPa]", "contact pressure [Pa]")
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
    assert axes.flat[0].get_xlabel() == "velocity [m/s]" and axes.flat[0].get_xscale() == "log"
    assert held.plot.pressure(velocity=0.01).get_title() == "v = 0.01 m/s"


def test_the_two_curves_of_an_evolution_differ(result):
    def looks(line):
        return line.get_linestyle(), line.get_color(), line.get_markerfacecolor()

    for style in ({}, dict(label="a"), dict(color="r"), dict(linestyle="--", color="C3"), dict(linestyle="--"), dict(ls="--", c="k", label="a"),
                  dict(linestyle="none", marker="o", color="k")):  # fmt: skip
        for ax in result.plot.evolution(**style).flat:
            assert len(ax.lines) == len({looks(line) for line in ax.lines}) and len(ax.lines) in (1, 2), style
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
    assert _shown(9.5e-8, "m", 2) == (pytest.approx(1e6), "mm²") and _shown(9e-9, "m", 2) == (pytest.approx(1e12), "µm²")
    wave = asp.Surface.wave(cells=(64, 16), size=(4e-3, 1e-3), amplitude=1e-6, wavelength=(1e-3, 1e-3))
    ax = wave.plot.heights()
    ax.figure.canvas.draw()
    bar = ax.images[0].colorbar.ax
    heights = [place.get_window_extent().height for place in (bar, ax)]
    assert heights[0] < 1.5 * heights[1]
    assert any(text.get_text().startswith("\N{MINUS SIGN}") for text in bar.get_yticklabels())
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

    assert result.plot.pressure(vmin=0, vmax=Quantity()).images[0].get_clim() == (0, 2e5)


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


def test_a_map_of_zeros_has_the_lowest_colour():
    ball = asp.Surface.sphere(cells=(16, 16), size=(1e-3, 1e-3), radius=20e-3)
    result = asp.solve(ball, asp.Elastic(young=1e6, poisson=0.5), load=asp.ramp(1e-3, duration=1.0), times=[1.0], every=1)
    for style in ({}, {"norm": matplotlib.colors.Normalize()}):
        image = result.plot.pressure(index=0, **style).images[0]
        image.figure.canvas.draw()
        assert image.get_clim()[0] == 0.0 and np.all(image.to_rgba(image.get_array()) == image.get_cmap()(0.0))


def test_maps_keep_their_places(result, rough):
    upper = result.plot.pressure(origin="upper")
    # The first row of the image is that of the least y, which is above then.
    assert upper.get_ylim()[0] > upper.get_ylim()[1] and upper.images[0].get_extent()[2:] == [0.8, 0.0]
    wide = asp.Surface.wave(cells=(64, 16), size=(4e-3, 1e-3), amplitude=1e-6, wavelength=(1e-3, 1e-3))
    ax = asp.elastic(wide, 4e6, pressure=1e3, boundary="periodic").plot.contact()
    ax.figure.canvas.draw()
    legend, label = ax.get_legend().get_window_extent(), ax.xaxis.label.get_window_extent()
    assert not legend.overlaps(label)
    assert result.plot.profile(y=9e-5).get_title() == "y = 0.0875 mm, t = 5 s"


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
