//! Small files of every format, built by hand after the formats' descriptions.
//!
//! Unless a function says otherwise the map has 3 x 2 points with the number `NUMBERS[y][x]` at (x, y).

#![allow(dead_code)] // each test uses its part

pub mod instruments;

use std::io::{Read, Write};

use asperity_files::topography::{Format, ReadOptions, read_bytes, to_bytes};
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};

/// Line by line: x runs fastest.
pub const NUMBERS: [i32; 6] = [10, 20, 30, 40, 50, 60];

/// Text of fixed length, padded by blanks.
fn padded(text: &str, length: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(length, b' ');
    bytes
}

/// What varies in a SUR object; lengths in mm, steps 2 and 3, heights 1/4 um per unit.
#[derive(Clone)]
pub struct Sur {
    pub packed: bool,
    pub bits: i16,
    pub objects: u16,
    pub kind: i16,
    pub name: &'static str,
    pub special: bool,
    pub absolute: bool,
    pub inversion: i16,
    pub offset: f32,
    pub numbers: [i32; 6],
}

impl Default for Sur {
    fn default() -> Self {
        Sur {
            packed: false,
            bits: 32,
            objects: 1,
            kind: 2,
            name: "sample",
            special: false,
            absolute: false,
            inversion: 0,
            offset: 0.0,
            numbers: NUMBERS,
        }
    }
}

impl Sur {
    /// One object; the least height is 10.
    pub fn bytes(&self) -> Vec<u8> {
        let mut b = if self.packed { b"DSCOMPRESSED".to_vec() } else { b"DIGITAL SURF".to_vec() };
        b.extend([0i16, self.objects as i16, 1, self.kind].map(i16::to_le_bytes).concat());
        b.extend(padded(self.name, 30));
        b.extend(padded("operator", 30));
        let flags = [0, 0, 0, i16::from(self.special), i16::from(self.absolute)];
        b.extend(flags.map(i16::to_le_bytes).concat());
        b.extend([0; 8]);
        b.extend(self.bits.to_le_bytes());
        b.extend([10i32, 60, 3, 2, 6].map(i32::to_le_bytes).concat());
        b.extend([2f32, 3.0, 0.25].map(f32::to_le_bytes).concat());
        for text in ["X", "Y", "Z", "mm", "mm", "\u{b5}m", "mm", "mm", "\u{b5}m"] {
            // Latin-1, as the instruments write it.
            let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
            b.extend(&latin1);
            b.extend(vec![b' '; 16 - latin1.len()]);
        }
        b.extend([1f32; 3].map(f32::to_le_bytes).concat());
        b.extend([0, self.inversion, 0].map(i16::to_le_bytes).concat());
        b.extend([0; 12]);
        b.extend([1i16, 2, 3, 4, 5, 2026, 0].map(i16::to_le_bytes).concat());
        b.extend([0; 4 + 4 + 6]);
        b.extend([7i16, 4].map(i16::to_le_bytes).concat());
        b.extend([0; 128]);
        b.extend([0f32, 0.0, self.offset].map(f32::to_le_bytes).concat());
        b.extend([0; 34]);
        assert_eq!(b.len(), 512);
        b.extend(b"commentPRIV");
        let data: Vec<u8> = match self.bits {
            16 => self.numbers.iter().flat_map(|n| (*n as i16).to_le_bytes()).collect(),
            _ => self.numbers.iter().flat_map(|n| n.to_le_bytes()).collect(),
        };
        if self.packed {
            // Two streams.
            let (first, second) = data.split_at(8);
            let streams = [first, second].map(|part| {
                let mut zlib = ZlibEncoder::new(Vec::new(), Compression::default());
                zlib.write_all(part).unwrap();
                (part.len() as u32, zlib.finish().unwrap())
            });
            b.extend(2u32.to_le_bytes());
            for (length, stream) in &streams {
                b.extend([*length, stream.len() as u32].map(u32::to_le_bytes).concat());
            }
            streams.iter().for_each(|(_, stream)| b.extend(stream));
        } else {
            b.extend(data);
        }
        b
    }
}

/// Pixels of 0.5 x 0.25 um; lines of three binary32 are padded to 16 bytes; the last point is undefined.
pub fn al3d() -> Vec<u8> {
    let mut b = b"AliconaImaging\0\r\n".to_vec();
    let mut tag = |key: &str, value: &str| {
        let mut bytes = key.as_bytes().to_vec();
        bytes.resize(20, 0);
        bytes.extend(value.bytes());
        bytes.resize(50, 0);
        bytes.extend(b"\r\n");
        b.extend(bytes);
    };
    tag("Version", "1");
    tag("TagCount", "6");
    tag("Cols", "3");
    tag("Rows", "2");
    tag("PixelSizeXMeter", "5e-07");
    tag("PixelSizeYMeter", "2.5e-07");
    tag("InvalidPixelValue", "3.00000e+15");
    tag("DepthImageOffset", "800");
    b.extend(b"a comment");
    b.resize(800, 0);
    for line in NUMBERS.chunks(3) {
        line.iter().for_each(|n| b.extend(if *n == 60 { 3e15 } else { *n as f32 }.to_le_bytes()));
        b.extend([0; 4]);
    }
    b
}

/// Wavelength 600 nm, Mult 2 (short), pixels of 0.01 mm, aspect 0.5; columns from the top down; `width` bytes per
/// number; one point undefined where the type has a mark.
pub fn opd(width: u16) -> Vec<u8> {
    let mut array = [3u16, 2, width].map(u16::to_le_bytes).concat();
    for x in 0..3 {
        for y in [1, 0] {
            let n = NUMBERS[3 * y + x];
            let undefined = n == 60;
            match width {
                1 => array.push(n as u8),
                2 => array.extend(if undefined { i16::MAX } else { n as i16 }.to_le_bytes()),
                _ => array.extend(if undefined { 1e38 } else { n as f32 }.to_le_bytes()),
            }
        }
    }
    let image = [3u16, 2, 1].map(u16::to_le_bytes).concat().into_iter().chain([7; 6]).collect();
    let blocks: [(&str, u16, Vec<u8>); 8] = [
        ("Image", 3, image),
        ("Title", 5, b"some steel\0".to_vec()),
        ("RAW_DATA", 3, array),
        ("Wavelength", 7, 600f32.to_le_bytes().into()),
        ("Mult", 6, 2i16.to_le_bytes().into()),
        ("Empty", 5, Vec::new()),
        ("Pixel_size", 7, 0.01f32.to_le_bytes().into()),
        ("Aspect", 7, 0.5f32.to_le_bytes().into()),
    ];
    let mut b = vec![1, 0];
    let mut entry = |name: &str, kind: u16, length: usize| {
        let mut bytes = name.as_bytes().to_vec();
        bytes.resize(16, 0);
        bytes.extend(kind.to_le_bytes());
        bytes.extend((length as u32).to_le_bytes());
        bytes.extend([0xff, 0xff]);
        b.extend(bytes);
    };
    entry("Directory", 1, 24 * (blocks.len() + 1));
    for (name, kind, content) in &blocks {
        entry(name, *kind, content.len());
    }
    b.extend(blocks.into_iter().flat_map(|(_, _, content)| content));
    b
}

/// 6 x 4 um, heights in pm; integers of 0.5 pm (`wide`: header in UTF-16, big-endian binary32 in pm).
pub fn bcr(wide: bool) -> Vec<u8> {
    let (format, scale) = if wide { ("bcrf_unicode", "") } else { ("bcrstm", "bit2nm = 0.5\n") };
    let mut header = format!(
        "fileformat = {format}\nheadersize = 2048\nxpixels = 3\nypixels = 2\nxlength = 6\nylength = 4\n\
         xunit = um\nyunit = um\nzunit = pm\n{scale}% a remark\nintelmode = {}\n",
        i32::from(!wide)
    );
    header.extend(std::iter::repeat_n(' ', 2048 - header.len()));
    let mut b = if wide {
        [0xfeff].into_iter().chain(header.encode_utf16()).flat_map(u16::to_be_bytes).collect()
    } else {
        header.into_bytes()
    };
    if wide {
        // The byte order mark counts as one character of the header.
        b.truncate(2 * 2048);
    }
    for n in NUMBERS {
        match (wide, n == 60) {
            (true, undefined) => b.extend(if undefined { 3e38 } else { n as f32 }.to_be_bytes()),
            (false, undefined) => b.extend(if undefined { i16::MAX } else { n as i16 }.to_le_bytes()),
        }
    }
    b
}

/// Points 1 x 2 um apart, heights of 1 nm per number, the last one undefined; wrapped lines, a remark, a trailer.
pub fn sdf_text() -> Vec<u8> {
    b"aISO-1.0\r\nManufacID = maker\r\nCreateDate = 010120260000\r\nModDate = 010120260000\r\nNumPoints = 3\r\n\
      ; a remark with a * in it\r\nNumProfiles = 2\r\nXscale = 1e-6\r\nYscale = 2E-6\r\nZscale = 1e-9\r\n\
      Zresolution = -1\r\nCompression = 0\r\nDataType = 5\r\nCheckType = 0\r\n*\r\n10 20 30 40\r\n50 BAD\r\n*\r\n\
      Remark = 2 * 3\r\n*\r\n"
        .to_vec()
}

/// The same as binary of the type with this code; the last point undefined where the type has a mark.
pub fn sdf_binary(data_type: u8) -> Vec<u8> {
    let mut b = b"bISO-1.0maker     010120260000010120260000".to_vec();
    b.extend([3u16, 2].map(u16::to_le_bytes).concat());
    b.extend([1e-6f64, 2e-6, 1e-9, -1.0].map(f64::to_le_bytes).concat());
    b.extend([0, data_type, 0]);
    for n in NUMBERS {
        let undefined = n == 60;
        match data_type {
            0 => b.push(n as u8),
            1 => b.extend(if undefined { u16::MAX } else { n as u16 }.to_le_bytes()),
            2 => b.extend(if undefined { u32::MAX } else { n as u32 }.to_le_bytes()),
            3 => b.extend(if undefined { f32::MIN } else { n as f32 }.to_le_bytes()),
            4 => b.push(if undefined { i8::MIN as u8 } else { n as u8 }),
            5 => b.extend(if undefined { i16::MIN } else { n as i16 }.to_le_bytes()),
            6 => b.extend(if undefined { i32::MIN } else { n }.to_le_bytes()),
            _ => b.extend(if undefined { f64::NAN } else { f64::from(n) }.to_le_bytes()),
        }
    }
    b
}

/// What varies in an X3P file.
#[derive(Clone, Copy, PartialEq)]
pub enum X3p {
    /// int16 with increment and offset, the last point masked.
    Masked,
    /// A list of heights, the last one empty; the increment does not concern them.
    List,
    /// Two layers of binary32 on an incremental axis; the second has twice the heights.
    Layers,
}

/// Points 1 x 2 um apart; heights are (number - 10) nm where the type says so (`Masked`), else number nm.
pub fn x3p(kind: X3p) -> Vec<u8> {
    let (axis, data_type, scale) = match kind {
        X3p::Masked => ("A", "I", "<Increment>1e-9</Increment><Offset>-1e-8</Offset>"),
        X3p::List => ("A", "D", "<Increment>1e-9</Increment>"),
        X3p::Layers => ("I", "F", "<Increment>1e-9</Increment>"),
    };
    let list: String = NUMBERS
        .iter()
        .map(|n| match n {
            60 => "<Datum/>".to_owned(),
            50 => "<Datum>1;1;50e-9</Datum>".to_owned(),
            n => format!("<Datum> {n}.0e-9 </Datum>"),
        })
        .collect();
    let data = match kind {
        X3p::List => format!("<DataList>{list}</DataList>"),
        X3p::Masked => "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>\
             <ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink>"
            .to_owned(),
        X3p::Layers => "<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink>".to_owned(),
    };
    let layers = if kind == X3p::Layers { 2 } else { 1 };
    let xml = format!(
        "\u{feff}<?xml version=\"1.0\" encoding=\"UTF-8\"?><!-- remark --><p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\">\
         <Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>\
         <CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1e-6</Increment><Offset>0</Offset></CX>\
         <CY><AxisType>I</AxisType><DataType>D</DataType><Increment>2e-6</Increment><Offset>0</Offset></CY>\
         <CZ><AxisType>{axis}</AxisType><DataType>{data_type}</DataType>{scale}</CZ></Axes></Record1>\
         <Record2><Comment>3 &lt; 4 &amp; 5</Comment></Record2>\
         <Record3><MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>{layers}</SizeZ></MatrixDimension>{data}</Record3>\
         </p:ISO5436_2>"
    );
    let points: Vec<u8> = match kind {
        X3p::Layers => {
            [1.0, 2.0].iter().flat_map(|f| NUMBERS.map(|n| (f * n as f32).to_le_bytes()).concat()).collect()
        }
        _ => NUMBERS.iter().flat_map(|n| (*n as i16).to_le_bytes()).collect(),
    };
    let mut members = vec![("main.xml", xml.into_bytes())];
    if kind != X3p::List {
        members.push(("bindata/data.bin", points));
        members.push(("bindata/valid.bin", vec![0b01_1111]));
    }
    zip(&members)
}

/// A zip archive of packed members.
pub fn zip(members: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, content) in members {
        zip.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// A component of a GWY object.
pub fn gwy_component(name: &str, kind: u8, value: &[u8]) -> Vec<u8> {
    [name.as_bytes(), &[0, kind], value].concat()
}

/// A GWY object: type, length, content.
pub fn gwy_object(kind: &str, content: &[u8]) -> Vec<u8> {
    [kind.as_bytes(), &[0], &(content.len() as u32).to_le_bytes(), content].concat()
}

/// A data field over 6 x 4 `lateral` units with heights in `unit`.
pub fn gwy_field(numbers: [f64; 6], lateral: &str, unit: &str) -> Vec<u8> {
    let label = |text: &str| {
        gwy_object("GwySIUnit", &gwy_component("unitstr", b's', &[text.as_bytes(), &[0]].concat()))
    };
    let data = [&6u32.to_le_bytes()[..], &numbers.map(f64::to_le_bytes).concat()].concat();
    let content = [
        gwy_component("xres", b'i', &3i32.to_le_bytes()),
        gwy_component("yres", b'i', &2i32.to_le_bytes()),
        gwy_component("xreal", b'd', &6f64.to_le_bytes()),
        gwy_component("yreal", b'd', &4f64.to_le_bytes()),
        gwy_component("si_unit_xy", b'o', &label(lateral)),
        gwy_component("si_unit_z", b'o', &label(unit)),
        gwy_component("data", b'D', &data),
    ];
    gwy_object("GwyDataField", &content.concat())
}

/// Channel 0 "Amplitude" in V, channel 3 "Height" in nm over 6 x 4 um with the last point masked, channel 12
/// "Height (back)" with ten times the heights; values of every other type in between.
pub fn gwy() -> Vec<u8> {
    let numbers = NUMBERS.map(f64::from);
    let text = |t: &str| [t.as_bytes(), &[0]].concat();
    let two_texts = [&2u32.to_le_bytes()[..], b"a\0b\0"].concat();
    let meta = gwy_object("GwyContainer", &gwy_component("Tip", b's', &text("sharp")));
    let objects = [&1u32.to_le_bytes()[..], &gwy_object("GwySelection", b"")].concat();
    let content = [
        gwy_component("/filename", b's', &text("old.gwy")),
        gwy_component("/0/data", b'o', &gwy_field(numbers, "um", "V")),
        gwy_component("/0/data/title", b's', &text("Amplitude")),
        gwy_component("/0/data/visible", b'b', &[1]),
        gwy_component("/12/data", b'o', &gwy_field(numbers.map(|n| 10.0 * n), "um", "nm")),
        gwy_component("/12/data/title", b's', &text("Height (back)")),
        gwy_component("/3/data", b'o', &gwy_field(numbers, "um", "nm")),
        gwy_component("/3/data/title", b's', &text("Height")),
        gwy_component("/3/mask", b'o', &gwy_field([0.0, 0.0, 0.0, 0.0, 0.0, 1.0], "um", "")),
        gwy_component("/3/meta", b'o', &meta),
        gwy_component("texts", b'S', &two_texts),
        gwy_component("objects", b'O', &objects),
        gwy_component("int64", b'q', &7i64.to_le_bytes()),
        gwy_component("bytes", b'C', &[&3u32.to_le_bytes()[..], b"abc"].concat()),
    ];
    [b"GWYP", &gwy_object("GwyContainer", &content.concat())[..]].concat()
}

/// `tests/data/netcdf4.nc.gz`, unpacked.
pub fn netcdf4() -> Vec<u8> {
    gunzip(include_bytes!("../../data/netcdf4.nc.gz"))
}

/// `tests/data/plain.h5.gz`, unpacked.
pub fn hdf5() -> Vec<u8> {
    gunzip(include_bytes!("../../data/plain.h5.gz"))
}

fn gunzip(packed: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(packed).read_to_end(&mut bytes).unwrap();
    bytes
}

/// One valid file or more of every format.
pub fn files() -> Vec<(Format, Vec<u8>)> {
    let sur = Sur::default();
    let series = Sur { kind: 5, objects: 2, ..sur.clone() };
    let plain = read_bytes(&al3d(), &ReadOptions::default()).unwrap();
    let written = |format| (format, to_bytes(&plain, format).unwrap());
    let npy = || {
        let header = "{'descr': '<f4', 'fortran_order': True, 'shape': (3, 2), }\n";
        let data = NUMBERS.map(|n| (n as f32).to_le_bytes()).concat();
        [b"\x93NUMPY\x01\x00", &(header.len() as u16).to_le_bytes()[..], header.as_bytes(), &data].concat()
    };
    let text = |text: &str| text.as_bytes().to_vec();
    vec![
        (
            Format::Text,
            text(
                "# Channel: Z\n# Width: 10,0 \u{b5}m\n# H\u{f6}he: 20 nm\n# Einheiten: m\n1,5 2 nan\n-3e-4 5 6\n",
            ),
        ),
        (
            Format::Text,
            text("h=2 w=4\npixel size=3.7e-7 m\nheight conversion factor (-> m)=2.9e-8\n1 2 3 4\n5 6 7 8\n"),
        ),
        (
            Format::Text,
            text(concat!(
                "Wyko ASCII Data File Format 0 0 1\nX Size 2\nY Size 2\nWavelength 7 4 600\nMult 7 4 1\n",
                "Pixel_size 7 4 1\nRAW_DATA 3 9\n1 2\n3 Bad\n"
            )),
        ),
        (Format::Csv, text("a,b,c,d\n1,2,,4\n5,6,7,8\n")),
        (Format::Xyz, text("x [mm];y [mm];z [um]\n1;1;5\n2;1;6\n1;2;7\n2;2;8\n3;1;nan\n")),
        (Format::Npy, npy()),
        (Format::Sdf, sdf_text()),
        (Format::Sdf, sdf_binary(5)),
        (Format::Bcr, bcr(false)),
        (Format::Bcr, bcr(true)),
        (Format::X3p, x3p(X3p::Masked)),
        (Format::X3p, x3p(X3p::List)),
        (Format::X3p, x3p(X3p::Layers)),
        (Format::Sur, sur.bytes()),
        (Format::Sur, Sur { packed: true, bits: 16, ..sur.clone() }.bytes()),
        (Format::Sur, [series.bytes(), series.bytes()].concat()),
        (Format::Gwy, gwy()),
        (Format::Gsf, gsf()),
        (Format::Al3d, al3d()),
        (Format::Opd, opd(2)),
        (Format::Opd, opd(4)),
        (Format::Nanoscope, instruments::Nanoscope::default().file()),
        (Format::MetroPro, instruments::metropro(0, false)),
        (Format::Plu, instruments::plu(3)),
        (Format::Mnt, instruments::mnt(true)),
        (Format::Ibw, instruments::ibw(false, true)),
        (Format::Nid, instruments::nid(true)),
        (Format::Frt, instruments::frt(false)),
        (Format::NetCdf, netcdf4()),
        (Format::Hdf5, hdf5()),
        (Format::Sdf, gzip(&sdf_text())),
        written(Format::Npz),
        written(Format::NetCdf),
    ]
}

/// Lengths 6 um and 4 um, heights in nm, the last undefined.
pub fn gsf() -> Vec<u8> {
    let mut b = b"Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 2\nXReal = 6e-06\nYReal = 4e-06\n".to_vec();
    b.extend(b"XYUnits = m\nZUnits = nm\nTitle = Topography\n");
    b.resize(b.len() / 4 * 4 + 4, 0);
    let numbers = NUMBERS.map(|n| if n == 60 { f32::NAN } else { n as f32 });
    b.extend(numbers.iter().flat_map(|n| n.to_le_bytes()));
    b
}

/// Packed by gzip.
pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    gzip.write_all(bytes).unwrap();
    gzip.finish().unwrap()
}
