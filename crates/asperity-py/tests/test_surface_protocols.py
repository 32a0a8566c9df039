"""Surfaces as numbers: arithmetic, arrays, equality, xarray, and files that numpy wrote."""

import warnings

import numpy as np
import pytest

import asperity as asp


@pytest.fixture(scope="module")
def rough():
    return asp.Surface.self_affine(cells=(24, 20), size=(1e-3, 8e-4), hurst=0.8, rms_height=1e-6, longest=5e-4, shortest=2e-4, seed=3)


RUBBER = asp.Elastic(young=1e6, poisson=0.5)


class LineScan:
    """As a NonuniformLineScan of SurfaceTopography: heights at positions with any distances."""

    unit, is_uniform, is_periodic, info = "mm", False, False, {"instrument": "stylus"}

    def __init__(self, positions, heights):
        self.at, self.values = np.asarray(positions), np.asarray(heights)
        self.physical_sizes = (self.at[-1] - self.at[0],)

    def positions(self):
        return self.at

    def heights(self):
        return self.values


class Topography:
    """As those of SurfaceTopography."""

    physical_sizes, unit, is_periodic = (1000.0, 800.0), "µm", False

    def __init__(self, surface):
        self.values = surface.heights * 1e6

    def heights(self):
        return self.values


def test_surfaces_are_added_and_scaled(rough):
    z = rough.heights
    for surface, heights in (
        (rough * 2, z * 2), (2 * rough, z * 2), (np.float64(2) * rough, z * 2), (rough / 4, z / 4), (-rough, -z), (+rough, z),
        (rough + rough, z + z), (rough - 0.5 * rough, z / 2), (sum([rough, rough]), z + z), (rough + z, 2 * z),
        (rough + Topography(rough), 2 * z), (rough - Topography(rough), 0 * z),
    ):
        assert isinstance(surface, asp.Surface) and np.allclose(surface.heights, heights, rtol=1e-12, atol=1e-20)
    assert (-rough).history[-1] == "inverted" and (rough * 2).history == [*rough.history, "heights times 2"]
    for wrong in (lambda: rough + 1.0, lambda: rough * np.inf, lambda: rough / 0, lambda: rough + np.zeros((3, 3)), lambda: z + rough):
        with pytest.raises(asp.CaseError):
            wrong()
    for wrong in (lambda: rough * rough, lambda: rough + "x", lambda: np.sin(rough)):
        with pytest.raises(TypeError):
            wrong()


def test_a_surface_is_an_array_and_equals_another(rough):
    assert np.asarray(rough) is not None and np.array_equal(np.asarray(rough), rough.heights)
    assert np.asarray(rough, dtype=np.float32).dtype == np.float32
    mine = np.array(rough)
    mine[...] = 0.0
    assert rough.heights.max() > 0
    assert rough == asp.Surface(rough.heights, size=rough.size) and rough != 2 * rough and rough != asp.Surface(rough.heights, size=(1, 1))
    assert rough != "rough" and asp.Surface(np.full((2, 2), np.nan), size=(1, 1)) == asp.Surface(np.full((2, 2), np.nan), size=(1, 1))
    assert np.allclose(rough.x, (np.arange(24) + 0.5) * 1e-3 / 24) and rough.y.shape == (20,)
    assert repr(-rough) == "Surface(24 x 20 cells, 0.001 m x 0.0008 m)" and repr(rough).startswith("Surface.self_affine(cells=(24, 20)")


def test_a_topography_and_a_labelled_array_are_surfaces(rough):
    measured = asp.Surface(Topography(rough))
    assert np.allclose(measured.heights, rough.heights, rtol=1e-12) and measured.size == pytest.approx(rough.size, rel=1e-12)
    # A size that is another one than its own is not taken in place of it.
    assert asp.Surface(Topography(rough), size=rough.size) == measured
    with pytest.raises(asp.CaseError, match="size is .* but the topography has the size"):
        asp.Surface(Topography(rough), size=(1.0, 1.0))
    # What does not repeat is not taken as periodic; what does is not pressed as a single body without a word.
    repeating = Topography(rough)
    repeating.is_periodic = True
    for press in (lambda **how: asp.elastic(repeating, 1e9, load=0.1, **how), lambda **how: asp.solve(repeating, RUBBER, load=1e-3, times=[1.0], **how)):
        with pytest.warns(asp.ResultWarning, match='boundary="periodic"'):
            press()
        with warnings.catch_warnings():
            warnings.filterwarnings("error", message=".*topography is periodic")
            press(boundary="periodic")
    assert measured._repeats(None) is False and (measured * 2)._repeats(None) is False and (measured + rough)._repeats(None) is False
    pytest.importorskip("xarray")
    assert asp.Surface(rough.to_xarray()).size == pytest.approx(rough.size, rel=1e-12)
    assert np.array_equal(asp.Surface(rough.to_xarray()).heights, rough.heights)
    with pytest.raises(asp.CaseError, match="size"):
        asp.Surface(rough.heights)


def test_a_matrix_of_savetxt_is_told_and_turned(rough, tmp_path):
    path = tmp_path / "z.txt"
    np.savetxt(path, rough.heights)
    with pytest.warns(asp.ResultWarning, match="transpose=True"):
        turned = asp.Surface.read(path, size=rough.size[::-1], height_unit=1.0)
    assert turned.cells == (20, 24)
    back = asp.Surface.read(path, size=rough.size, height_unit=1.0, transpose=True)
    assert back == rough and back.history[-1] == "transposed"
    assert asp.Surface.read(path, size=(8e-4, 1e-3), height_unit=1.0, transpose=False) == turned
    rough.write(tmp_path / "own.txt")
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert asp.Surface.read(tmp_path / "own.txt").cells == rough.cells


def test_spectra_keep_the_variance(rough):
    variance = np.var(rough.heights)
    qx, qy, c = rough.power_spectrum_2d()
    assert c.shape == rough.cells and np.sum(c) * (qx[1] - qx[0]) * (qy[1] - qy[0]) / (2 * np.pi) ** 2 == pytest.approx(variance, rel=1e-9)
    for axis, direction in enumerate("xy"):
        q, c = rough.power_spectrum_1d(direction)
        about = rough.heights - rough.heights.mean(axis=axis, keepdims=True)
        assert np.sum(c) * q[0] / np.pi == pytest.approx(np.mean(about**2), rel=1e-9)
    profile = asp.Surface.self_affine(cells=255, size=1e-3, hurst=0.8, rms_height=1e-6, longest=5e-4, shortest=2e-5)
    q, c = profile.power_spectrum()
    assert np.sum(c) * q[0] / np.pi == pytest.approx(1e-12, rel=1e-9)
    with pytest.raises(asp.CaseError, match="fill"):
        asp.Surface(np.where(rough.heights > 1e-6, np.nan, rough.heights), size=rough.size).power_spectrum_2d()


def check_line_scan(scan):
    """A ridge at 0.1 mm of 1 mm, whose flanks rise by 0.01 per length, measured finely there and coarsely elsewhere."""
    with pytest.warns(asp.ResultWarning, match="not evenly spaced.*6 points"):
        profile = asp.Surface(scan)
    # Cells as long as the shortest distance, 0.05 mm; the highest ones lie half a cell beside the ridge.
    assert profile.cells == (20,) and profile.size == pytest.approx((1e-3,)) and "6 points" in profile.history[0]
    assert profile.x[np.argmax(profile.heights)] == pytest.approx(0.1e-3, abs=0.026e-3)
    exact = np.maximum(0.0, 1e-6 - 0.01 * np.abs(profile.x - 0.1e-3))
    assert np.allclose(profile.heights, exact, atol=1e-15)
    assert not profile._repeats(None)
    return profile


def test_a_line_scan_of_uneven_distances_keeps_its_positions():
    positions = [0.0, 0.05, 0.1, 0.15, 0.2, 1.0]
    heights = [0.0, 0.5e-3, 1e-3, 0.5e-3, 0.0, 0.0]
    assert check_line_scan(LineScan(positions, heights)).metadata["metadata"] == [("instrument", "stylus")]
    with pytest.warns(asp.ResultWarning, match="not resolved"):
        assert asp.Surface(LineScan([0.0, 1e-6, 1.0], [0.0, 0.0, 1e-3])).cells == (30,)
    with pytest.raises(asp.CaseError, match="rise"):
        asp.Surface(LineScan([0.0, 0.5, 0.5, 1.0], [0.0, 0.0, 1e-3, 0.0]))
    with pytest.raises(asp.CaseError, match="leave size out"):
        asp.Surface(LineScan(positions, heights), size=2e-3)
    package = pytest.importorskip("SurfaceTopography")
    check_line_scan(package.NonuniformLineScan(np.array(positions), np.array(heights), unit="mm"))
    topography = package.Topography(np.eye(8), (1.0, 1.0), periodic=True, unit="mm")
    with pytest.warns(asp.ResultWarning, match='boundary="periodic"'):
        asp.elastic(topography, 1e9, load=0.1)


def test_names_and_words():
    import builtins

    assert not set(asp.__all__) & set(dir(builtins))
    assert "10.1155/2017/2521903" in asp.cite() and asp.cite("bibtex").count("@") == 4
    with pytest.raises(asp.CaseError, match="bibtex"):
        asp.cite("ris")
    before = asp.threads()
    with asp.set_threads(1) as number:
        assert number == asp.threads() == 1
    assert asp.threads() == before
    surface = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
    with pytest.raises(asp.CaseError, match=r"asperity.Elastic\(young"):
        asp.solve(surface, 1e6, load=1.0, times=[1.0])
    long = asp.Prony(equilibrium=1e6, terms=[(1e6, 10.0**k) for k in range(12)], poisson=0.3)
    for shown in (long, asp.table([(float(t), 1.0) for t in range(50)]), asp.listed(np.arange(1.0, 200.0)), asp.step(1.0)):
        assert len(repr(shown)) < 160
    assert eval(repr(asp.Prony(equilibrium=1e6, terms=[(1e6, 1.0)], poisson=0.3)), vars(asp)).relaxation_terms[0] == 1e6


def test_an_editor_knows_the_types(tmp_path):
    mypy = pytest.importorskip("mypy.api")
    script = tmp_path / "script.py"
    script.write_text("""
import numpy as np
import asperity as asp

sphere = asp.Surface.sphere(cells=(8, 8), size=(1e-3, 1e-3), radius=1e-2)
rubber = asp.Elastic(young=1e6, poisson=0.5)
result = asp.solve(sphere, rubber, load=1e-3, times=np.linspace(0.1, 1, 5), fields=["pressure", "gap"], boundary="free")
fine: np.ndarray = result.approach
for step in asp.march(sphere, rubber, load=1e-3, times=np.linspace(0.1, 1, 5)):
    number: float = step.contact_fraction
one: asp.ElasticContact = asp.elastic(sphere, 1e9, load=1.0)
many: asp.ElasticCurve = asp.elastic(sphere, 1e9, load=[1.0, 2.0])
result.aproach
step.aproach
asp.solve(sphere, rubber, load=1e-3, times=[1.0], boundary="open")
asp.solve(sphere, rubber, load=1e-3, times=[1.0], fields=["presure"])
asp.solve(sphere, rubber, load=1e-3, times=[1.0], quantities=["stiffness"])
""")
    out, _, _ = mypy.run([str(script), "--no-incremental", "--follow-imports=silent"])
    lines = sorted({int(line.split(":")[1]) for line in out.splitlines() if ": error:" in line})
    assert lines == [13, 14, 15, 16, 17], out
