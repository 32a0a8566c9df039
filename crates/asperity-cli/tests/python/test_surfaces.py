"""Surfaces against independent programs: their files read by `asperity surface info`, ours read by them.

NumPy, h5py and netCDF4 are needed; gwyfile, surfalize and SurfaceTopography are used where they are installed. Prints the
names of those that were used. ASPERITY_COMMAND names the command, the working directory is empty.
"""

import gzip
import importlib
import json
import os
import struct
import subprocess
import warnings
import zipfile

import numpy as np

warnings.filterwarnings("ignore")
COMMAND = os.environ["ASPERITY_COMMAND"]
NX, NY, SIZE = 37, 23, (3.7e-5, 4.6e-5)
UNITS = {"m": 1.0, "mm": 1e-3, "µm": 1e-6, "nm": 1e-9}
GIVEN = ["--size", "37 um,46 um", "--height-unit"]
used = []


def module(name):
    try:
        found = importlib.import_module(name)
    except ImportError:
        return None
    used.append(name)
    return found


def asperity(*arguments):
    done = subprocess.run([COMMAND, "surface", *arguments], capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 0, (arguments, done.stderr)
    return done.stdout


def check(file, expected, *arguments, size=SIZE, tolerance=1e-12):
    """`surface info` finds shape, size, undefined points, range and three corners (they pin the orientation)."""
    found = json.loads(asperity("info", file, "--json", *arguments))
    scale = np.nanmax(np.abs(expected))
    assert found["shape"] == list(expected.shape), (file, found["shape"])
    # Sizes pass through binary32 in some formats.
    assert np.allclose(found["size"], size, rtol=1e-6), (file, found["size"])
    assert found["undefined"] == np.isnan(expected).sum(), (file, found["undefined"])
    for key, value in {
        "h00": expected[0, 0],
        "h10": expected[1, 0],
        "h01": expected[0, 1],
        "min": np.nanmin(expected),
        "max": np.nanmax(expected),
    }.items():
        same = np.isnan(value) if found[key] is None else abs(found[key] - value) <= tolerance * scale
        assert same, (file, key, found[key], value)


def made():
    """A surface of ours in every format that is written."""
    for ending in ["npz", "gwy", "x3p", "sdf", "nc", "txt"]:
        asperity("generate", "--cells", f"{NX},{NY}", "--size", "37 um,46 um", "--hurst", "0.8", "--rms-height", "0.3 um",
                 "--longest", "30 um", "--shortest", "5 um", "--seed", "4", "-o", f"ours.{ending}")
    archive = np.load("ours.npz")
    assert archive["unit"] == "m" and np.allclose(archive["size"], SIZE)
    return archive["heights"]


def holes(heights):
    holed = heights.copy()
    holed[3, 4] = holed[36, 22] = np.nan
    return holed


def numpy_files(z):
    np.save("f4.npy", z.astype("f4"))
    check("f4.npy", z, *GIVEN, "m", tolerance=1e-6)
    np.save("fortran.npy", np.asfortranarray(z * 1e6))
    check("fortran.npy", z, *GIVEN, "um")
    np.save("big.npy", (z * 1e9).astype(">f8"))
    check("big.npy", z, *GIVEN, "nm")
    np.savez_compressed("several.npz", a=z, b=2 * z, scalar=3.0)
    check("several.npz", 2 * z, *GIVEN, "m", "--channel", "b")
    np.savetxt("lines.csv", (z * 1e9).T, delimiter=",", header="heights in nm", fmt="%.17g")
    check("lines.csv", z, *GIVEN, "nm")
    with gzip.open("lines.csv.gz", "wb") as file:
        file.write(open("lines.csv", "rb").read())
    check("lines.csv.gz", z, *GIVEN, "nm")


def sdf_files(z):
    """ISO 25178-71, table of the header and the data types, written here."""
    step = 1e-9
    for code, kind, least in [(4, "i1", None), (5, "<i2", -(2**15)), (6, "<i4", -(2**31)), (3, "<f4", None), (7, "<f8", None)]:
        scale = step if code != 4 else 2e-8
        numbers = (holes(z) / scale).T
        header = b"bISO-1.0" + b"Test      " + b"010120200000" * 2 + struct.pack("<HH", NX, NY)
        header += struct.pack("<dddd", SIZE[0] / NX, SIZE[1] / NY, scale, -1.0) + struct.pack("<bbb", 0, code, 0)
        if kind in ("<f4", "<f8"):
            data, expected = numbers.astype(kind), numbers.astype(kind).astype("f8").T * scale
        else:
            least = -(2**7) if code == 4 else least
            rounded = np.where(np.isnan(numbers), least, np.round(numbers))
            data, expected = rounded.astype(kind), np.where(rounded == least, np.nan, rounded).T * scale
        open("binary.sdf", "wb").write(header + data.tobytes())
        check("binary.sdf", expected)
    text = f"aISO-1.0\r\nManufacID = Test\r\nCreateDate = 010120200000\r\nModDate = 010120200000\r\nNumPoints = {NX}\r\n"
    text += f"NumProfiles = {NY}\r\nXscale = 1.0E-6\r\nYscale = 2.0E-6\r\nZscale = 1.0E-9\r\nZresolution = -1\r\nCompression = 0\r\n"
    text += "DataType = 7\r\nCheckType = 0\r\n*\r\n"
    text += "\r\n".join("BAD" if np.isnan(v) else f"{v:.17g}" for v in (holes(z) * 1e9).T.ravel()) + "\r\n*\r\nfree text\r\n"
    open("text.sdf", "w", newline="").write(text)
    check("text.sdf", holes(z))


def x3p_files(z):
    """ISO 25178-72, written here: every data type, a mask of valid points, scaling of z."""
    for code, kind, scale in [("I", "<i2", 1e-10), ("L", "<i4", 1e-12), ("F", "<f4", 1.0), ("D", "<f8", 1.0)]:
        offset = 1e-7 if code in "IL" else 0.0
        numbers = ((z - offset) / scale).T
        data = np.round(numbers).astype(kind) if code in "IL" else numbers.astype(kind)
        expected = data.astype("f8").T * scale + offset
        valid = ~np.isnan(holes(z)).T.ravel()
        expected[~valid.reshape(NY, NX).T] = np.nan
        bits = np.packbits(valid, bitorder="little").tobytes()
        xml = f"""<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1><Revision>ISO5436 - 2000</Revision>
<FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1e-6</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>2e-6</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>{code}</DataType><Increment>{scale}</Increment><Offset>{offset}</Offset></CZ></Axes></Record1>
<Record3><MatrixDimension><SizeX>{NX}</SizeX><SizeY>{NY}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>0</MD5ChecksumPointData>
<ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink></Record3></p:ISO5436_2>"""
        with zipfile.ZipFile("made.x3p", "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("main.xml", xml)
            archive.writestr("bindata/data.bin", data.tobytes())
            archive.writestr("bindata/valid.bin", bits)
        check("made.x3p", expected)


def text_files(z):
    numbers = (holes(z) * 1e9).T
    lines = lambda mark, separator, decimal: "\n".join(
        separator.join(mark if np.isnan(v) else f"{v:.17g}".replace(".", decimal) for v in line) for line in numbers
    )
    for name, header, decimal in [
        ("german", "# Kanal: Höhe\n# Breite: 37,0 µm\n# Höhe: 46,0 µm\n# Einheiten: nm\n", ","),
        ("french", "# Canal : Z\n# Largeur : 37,0 µm\n# Hauteur : 46,0 µm\n# Unités : nm\n", ","),
        ("english", "# Channel: Z\n# Width: 37.0 µm\n# Height: 46.0 µm\n# Value units: nm\n", "."),
    ]:
        open(f"{name}.txt", "w", encoding="utf-8").write(header + lines("nan", "\t", decimal) + "\n")
        check(f"{name}.txt", holes(z))
    open("semicolon.csv", "w").write(lines("", ";", ",") + "\n")
    check("semicolon.csv", holes(z), *GIVEN, "nm")
    points = [(i + 0.5, 2 * j + 1.0, z[i, j] * 1e6) for i in range(NX) for j in range(NY) if not np.isnan(holes(z)[i, j])]
    np.random.default_rng(1).shuffle(points)
    open("points.xyz", "w").write("".join(f"{x:.6f} {y:.6f} {h:.17g}\n" for x, y, h in points))
    check("points.xyz", holes(z), "--height-unit", "um")


def hdf_files(z):
    h5py = module("h5py")
    if h5py is None:
        return
    for options in [{}, {"compression": "gzip", "chunks": (8, 8)}, {"compression": "gzip", "shuffle": True, "chunks": (16, 5)}]:
        with h5py.File("chunks.h5", "w") as file:
            file.create_dataset("group/heights", data=z * 1e9, **options).attrs["unit"] = "nm"
        check("chunks.h5", z, "--size", "37 um,46 um")
    netcdf = module("netCDF4")
    if netcdf is None:
        return
    for form in ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF4", "NETCDF4_CLASSIC"]:
        with netcdf.Dataset("form.nc", "w", format=form) as file:
            for axis, count, length in [("x", NX, 37.0), ("y", NY, 46.0)]:
                file.createDimension(axis, count)
                variable = file.createVariable(axis, "f8", (axis,))
                variable[:] = np.arange(count) * length / count
                variable.length, variable.units = length, "µm"
            variable = file.createVariable("heights", "f8", ("x", "y"), zlib="NETCDF4" in form)
            variable[:] = z * 1e6
            variable.units = "µm"
        check("form.nc", z)


def peers(z):
    topography = module("SurfaceTopography")
    if topography is not None:
        from SurfaceTopography.IO import open_topography

        for ending in ["gwy", "x3p", "sdf", "nc", "txt"]:
            theirs = open_topography(f"ours.{ending}").topography()
            unit = UNITS[theirs.unit]
            assert np.abs(theirs.heights() * unit - z).max() < 1e-15 * np.abs(z).max() * 4, ending
            assert np.allclose(np.array(theirs.physical_sizes) * unit, SIZE), ending
        masked = topography.Topography(np.ma.masked_invalid(holes(z)) * 1e6, (37, 46), unit="µm")
        masked.to_netcdf("theirs.nc")
        check("theirs.nc", holes(z))
    surfalize = module("surfalize")
    if surfalize is not None:
        for ending in ["sdf", "x3p", "gwy"]:
            theirs = surfalize.Surface.load(f"ours.{ending}")
            assert np.abs(theirs.data.T * 1e-6 - z).max() < 1e-15 * np.abs(z).max() * 4, ending
            assert np.allclose([theirs.step_x, theirs.step_y], [1.0, 2.0]), ending
        for name, heights in [("whole", z), ("holed", holes(z))]:
            for ending in ["sdf", "x3p"]:
                surfalize.Surface((heights * 1e6).T.copy(), 1.0, 2.0).save(f"{name}.{ending}")
                # Some of its writers keep 32 bits.
                check(f"{name}.{ending}", heights, tolerance=1e-6)
    gwyfile = module("gwyfile")
    if gwyfile is not None:
        from gwyfile.objects import GwyContainer, GwyDataField, GwySIUnit

        (field,) = gwyfile.util.get_datafields(gwyfile.load("ours.gwy")).values()
        assert (field.data.T == z).all() and np.allclose([field.xreal, field.yreal], SIZE)
        unit = lambda text: GwySIUnit(unitstr=text)
        container = GwyContainer()
        for n, (title, data, lateral, height) in enumerate(
            [("Current", z.T * 3, "m", "A"), ("Height", z.T, "m", "m"), ("Back", z.T * 2e9, "µm", "nm")]
        ):
            xreal, yreal = (length / UNITS[lateral] for length in SIZE)
            container[f"/{n}/data/title"] = title
            container[f"/{n}/data"] = GwyDataField(
                data.copy(), xreal=xreal, yreal=yreal, si_unit_xy=unit(lateral), si_unit_z=unit(height)
            )
        mask = np.isnan(holes(z)).T.astype("f8")
        container["/2/mask"] = GwyDataField(mask, xreal=xreal, yreal=yreal)
        container.tofile("theirs.gwy")
        check("theirs.gwy", z)
        check("theirs.gwy", 2 * holes(z), "--channel", "Back")


heights = made()
for ending in ["npz", "gwy", "x3p", "sdf", "nc", "txt"]:
    check(f"ours.{ending}", heights)
numpy_files(heights)
sdf_files(heights)
x3p_files(heights)
text_files(heights)
hdf_files(heights)
peers(heights)
print("compared with", ", ".join(["numpy", *used]))
