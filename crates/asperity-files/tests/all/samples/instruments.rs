//! Small files of instruments, built by hand after the formats' descriptions; maps as in the parent module.

use std::io::{Cursor, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::NUMBERS;

/// The numbers from the bottom line up.
fn upward() -> impl Iterator<Item = i32> {
    NUMBERS[3..].iter().chain(&NUMBERS[..3]).copied()
}

/// Text of fixed length, padded by zeros.
fn zeroed(text: &str, length: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(length, 0);
    bytes
}

/// What varies in a Nanoscope file.
#[derive(Clone, Copy)]
pub struct Nanoscope {
    pub version: &'static str,
    /// As the header says.
    pub bytes: u32,
    /// As they are.
    pub width: usize,
    pub size: &'static str,
    /// Of the image.
    pub aspect: &'static str,
    /// Lines of the scan list.
    pub scan: &'static str,
}

impl Default for Nanoscope {
    fn default() -> Self {
        let size = "3 2 ~m";
        let aspect = "\\Aspect Ratio: 1:1\r\n";
        Nanoscope {
            version: "0x07200000",
            bytes: 2,
            width: 2,
            size,
            aspect,
            scan: "\\Scan Size: 3000 nm\r\n",
        }
    }
}

impl Nanoscope {
    /// Images: the deflection in nm, the height "ZSensor" of 0.5 nm per number, the phase in degrees.
    pub fn file(&self) -> Vec<u8> {
        const HEADER: usize = 2048;
        let length = 6 * self.width;
        let mut header = format!(
            "\\*File list\r\n\\Version: {}\r\n\\Date: 01:33:51 PM Mon Dec 15 2014\r\n\\Start context: OL2\r\n\
             \\*Equipment list\r\n\\Description: Dimension Icon\r\n\\*Scanner list\r\n\\@Sens. Zsens: V 2 nm/V\r\n\
             \\*Ciao scan list\r\n{}\\Samps/line: 3\r\n\\Lines: 2\r\n\\@Sens. DeflSens: V 60 nm/V\r\n\
             \\@Sens. Phase: V 1.0 \r\n",
            self.version, self.scan
        );
        // 2^14 V over 2^16 numbers (or 2^30 over 2^32) times 2 nm/V.
        let hard = if self.bytes == 2 { "16384" } else { "1073741824" };
        let scales = [
            ("[DeflectionError] \"Deflection Error\"", format!("[Sens. DeflSens] (0.003 V/LSB) {hard} V")),
            ("[ZSensor] \"Height Sensor\"", format!("[Sens. Zsens] (0.25 log(V)/LSB) {hard}000 mV")),
            ("[Phase] \"Phase\"", format!("[Sens. Phase] (0.005 \u{ba}/LSB) {hard} \u{ba}")),
        ];
        for (i, (name, scale)) in scales.iter().enumerate() {
            header += &format!(
                "\\*Ciao image list\r\n\\Data offset: {}\r\n\\Data length: {length}\r\n\\Bytes/pixel: {}\r\n\
                 \\Samps/line: 3\r\n\\Number of lines: 2\r\n{}\\Scan Size: {}\r\n\
                 \\Line Direction: Retrace\r\n\\@2:Image Data: S {name}\r\n\\@Z magnify: C [2:Z scale] 0.015\r\n\
                 \\@2:Z scale: V {scale}\r\n\\@2:Z offset: V [Sens. Zsens] (0.25 V/LSB) 7 V\r\n",
                HEADER + i * length,
                self.bytes,
                self.aspect,
                self.size
            );
        }
        header += "\\*File list end\r\n\u{1a}";
        let mut b: Vec<u8> = header.chars().map(|c| c as u8).collect();
        assert!(b.len() <= HEADER, "{}", b.len());
        b.resize(HEADER, 0);
        for image in 0..3 {
            for n in upward().map(|n| if image == 1 { n } else { n + 100 * (image + 1) }) {
                b.extend(&n.to_le_bytes()[..self.width]);
            }
        }
        b
    }
}

/// Phases of 2^-33 m per number, points 2^-20 m apart, the last one undefined; before them an image of intensity.
pub fn metropro(sign: u16, long_header: bool) -> Vec<u8> {
    let header: u32 = if long_header { 4096 } else { 834 };
    let mut b = vec![0; header as usize];
    let mut put = |at: usize, bytes: &[u8]| b[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, &[0x88, 0x1b, 0x03, if long_header { 0x71 } else { 0x6f }]);
    put(6, &header.to_be_bytes());
    put(12, b"Fri Jun 23 15:37:19 2006");
    put(52, &[0, 3, 0, 2, 0, 1]);
    put(60, &12u32.to_be_bytes());
    put(68, &[0, 3, 0, 2, 0, 0, 0, 24]);
    put(80, b"a comment");
    let [scale, wavelength, obliquity] = [1f32, 2f32.powi(-20), 0.5];
    for (at, value) in [(164, scale), (168, wavelength), (176, obliquity), (184, 2f32.powi(-20))] {
        put(at, &value.to_be_bytes());
    }
    put(232, &sign.to_be_bytes());
    put(246, b"20X Mirau");
    b.extend([7; 12]);
    b.extend(NUMBERS.iter().flat_map(|n| if *n == 60 { i32::MAX } else { *n }.to_be_bytes()));
    b
}

/// Points 2 x 3 um apart, heights in um, the last one undefined; two layers (the second of twice the heights), each with
/// an image.
pub fn plu(kind: u32) -> Vec<u8> {
    let mut b = zeroed("Fri Mar 10 16:35:59 2023", 128);
    b.extend([0; 4]);
    b.extend(zeroed("a comment", 256));
    b.extend([2u32, 3, 3].map(u32::to_le_bytes).concat());
    b.extend([28f32, 2.0, 3.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat());
    b.extend([kind, 3, 0, 14, 3].map(u32::to_le_bytes).concat());
    b.extend([0; 40]);
    b.extend([0, 2, 0xfb, 6, 1, 0, 0, 0, 1, 0, 0, 0]);
    for factor in [1, 2] {
        b.extend([2u32, 3].map(u32::to_le_bytes).concat());
        b.extend(
            NUMBERS
                .iter()
                .flat_map(|n| if *n == 60 { 1_000_001.0 } else { (factor * n) as f32 }.to_le_bytes()),
        );
        b.extend([0; 8]);
        b.extend([0; 18]);
    }
    b
}

/// Layers "DeflectionRetrace" (m), "HeightRetrace" (m) with the last point undefined, "PhaseRetrace" (deg) over points
/// 1 x 2 um apart; `big`: the other order of bytes. Without `labels`: one layer without a name.
pub fn ibw(big: bool, labels: bool) -> Vec<u8> {
    let short = |n: i16| if big { n.to_be_bytes() } else { n.to_le_bytes() };
    let long = |n: i32| if big { n.to_be_bytes() } else { n.to_le_bytes() };
    let single = |x: f32| if big { x.to_be_bytes() } else { x.to_le_bytes() };
    let double = |x: f64| if big { x.to_be_bytes() } else { x.to_le_bytes() };
    let layers = if labels { 3 } else { 1 };
    let note: &[u8] = if labels { b"ScanSize: 1e-6\rMicroscopeModel: MFP3D\r" } else { b"" };
    let names: Vec<u8> = ["", "DeflectionRetrace", "HeightRetrace", "PhaseRetrace"]
        .iter()
        .flat_map(|name| zeroed(name, 32))
        .collect();
    let names = if labels { names } else { Vec::new() };
    let mut b = Vec::new();
    b.extend(short(5));
    b.extend(short(0));
    b.extend(long(320 + 24 * layers));
    for length in [0, note.len() as i32, 0, 0, 0, 0, 0, 0, 0, names.len() as i32, 0, 0, 0, 0] {
        b.extend(long(length));
    }
    assert_eq!(b.len(), 64);
    b.extend([0; 12]);
    b.extend(long(6 * layers));
    b.extend(short(2));
    b.extend([0; 10]);
    b.extend(zeroed("scan0000", 32));
    b.extend([0; 8]);
    for n in [3, 2, if labels { 3 } else { 0 }, 0] {
        b.extend(long(n));
    }
    for x in [1e-6, 2e-6, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0] {
        b.extend(double(x));
    }
    let unit = if labels { "m" } else { "" };
    [unit, unit, unit, "", ""].iter().for_each(|unit| b.extend(zeroed(unit, 4)));
    b.resize(384, 0);
    for layer in 0..layers {
        let offset = if labels && layer != 1 { 100 } else { 0 };
        upward().for_each(|n| b.extend(single(if n == 60 { f32::NAN } else { (n + offset) as f32 })));
    }
    b.extend(note);
    b.extend(names);
    b
}

/// Data sets "Scan forward (Deflection)" in N and "Scan forward (Z-Axis)" of 0.5 um per number, with or without sign.
pub fn nid(signed: bool) -> Vec<u8> {
    let set = |n: u32, name: &str, unit: &str| {
        let sign = if signed { "Signed" } else { "Unsigned" };
        format!(
            "[DataSet-0:{n}]\r\nVersion=2\r\nPoints=3\r\nLines=2\r\nFrame=Scan forward\r\nDim0Name=X*\r\nDim0Unit=m\r\n\
             Dim0Range=3e-06\r\nDim1Name=Y*\r\nDim1Unit=m\r\nDim1Range=2e-06\r\nDim2Name={name}\r\nDim2Unit={unit}\r\n\
             Dim2Range=32768\r\nDim2Min={}\r\nSaveMode=Binary\r\nSaveBits=16\r\nSaveSign={sign}\r\nSaveOrder=Intel\r\n\r\n",
            if signed { -16384 } else { 0 }
        )
    };
    let text = format!(
        "[DataSet]\r\nVersion=2\r\nGroupCount=1\r\nGr0-Name=Scan forward\r\nGr0-Count=8\r\nGr0-Ch0=DataSet-0:0\r\n\
         Gr0-Ch1=DataSet-0:1\r\nGr0-Ch2=DataSet-0:2\r\n\r\n[DataSet-Info]\r\n-- Scan --=--\r\nImage size=3\u{b5}m\r\n\r\n{}{}#!",
        set(0, "Deflection", "N"),
        set(1, "Z-Axis", "\u{b5}m")
    );
    let mut b: Vec<u8> = text.chars().map(|c| c as u8).collect();
    upward().for_each(|n| b.extend((n as i16 + 100).to_le_bytes()));
    upward().for_each(|n| b.extend((n as i16).to_le_bytes()));
    b
}

/// Heights of 1/4 um per number over 6 x 4 um, the last one undefined; the same again, and a thickness of twice the
/// numbers, as images. `wide`: version 1.01 with 32 bits.
pub fn frt(wide: bool) -> Vec<u8> {
    let numbers = |factor: i32| -> Vec<u8> {
        let number = |n: i32| if n == 60 { 1 } else { factor * n };
        let width = if wide { 4 } else { 2 };
        upward().flat_map(|n| number(n).to_le_bytes()[..width].to_vec()).collect()
    };
    let plane = [3u32, 2, if wide { 32 } else { 16 }].map(u32::to_le_bytes).concat();
    let image = |kind: u32, data: Vec<u8>| [&kind.to_le_bytes()[..], &plane, &data].concat();
    let size = [6e-6f64, 4e-6, 0.0, 0.0, 2.0].map(f64::to_le_bytes).concat();
    let images = [image(4, numbers(1)), image(0x20, numbers(5)), image(0x80, numbers(2))].concat();
    let blocks: [(u16, Vec<u8>); 7] = [
        (0x65, b"a comment\0".to_vec()),
        (0x77, b"setup\0".to_vec()),
        (0x66, plane.clone()),
        (0x67, [size, vec![1, 0, 0, 0]].concat()),
        (0x6c, [&5u32.to_le_bytes()[..], &0.25e-6f64.to_le_bytes()].concat()),
        (0x0b, numbers(1)),
        (0x7d, [vec![0; 8], images].concat()),
    ];
    let mut b = if wide { b"FRTM_GLIDERV1.01".to_vec() } else { b"FRTM_GLIDERV1.00".to_vec() };
    b.extend((blocks.len() as u16).to_le_bytes());
    for (tag, content) in blocks {
        b.extend(tag.to_le_bytes());
        match wide {
            true => b.extend((content.len() as u64).to_le_bytes()),
            false => b.extend((content.len() as u32).to_le_bytes()),
        }
        b.extend(content);
    }
    b
}

/// An entry of a MountainsMap document.
fn entry(tag: u16, content: &[u8]) -> Vec<u8> {
    [&tag.to_le_bytes()[..], &(content.len() as u64).to_le_bytes(), content].concat()
}

/// Blocks of zlib, the second one first.
fn blocks(elements: &[u8], width: usize) -> Vec<u8> {
    let count = elements.len() / width;
    let half = count / 2;
    let mut b = (elements.len() as u64).to_le_bytes().to_vec();
    for (first, last) in [(half, count), (0, half)] {
        let mut zlib = ZlibEncoder::new(Vec::new(), Compression::default());
        zlib.write_all(&elements[first * width..last * width]).unwrap();
        let packed = zlib.finish().unwrap();
        b.extend((first as u64).to_le_bytes());
        b.extend([(last - first) as u32, packed.len() as u32].map(u32::to_le_bytes).concat());
        b.extend(packed);
    }
    let array = [entry(1, &(count as u32).to_le_bytes()), entry(2, &b)].concat();
    entry(2, &array)
}

/// A surface "Steel" of 1/4 um per count with the origin 5 um, points 2 x 3 um apart, and with a mask the last point
/// undefined.
pub fn mnt(masked: bool) -> Vec<u8> {
    const BASE: u16 = 0xffff;
    let class = |n: u32| entry(1, &entry(1, &n.to_le_bytes()));
    let text = |tag: u16, text: &str| {
        let characters: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        entry(tag, &[&[4], &characters[..]].concat())
    };
    let scale = |step: f64, unit: &str, display: &str, ratio: f64, origin: f64| {
        let numbers = [(1, step), (4, ratio), (5, origin)].map(|(tag, x)| entry(tag, &x.to_le_bytes()));
        let [step, ratio, origin] = numbers;
        entry(BASE, &[step, text(2, unit), text(3, display), ratio, origin].concat())
    };
    let axis = |tag: u16, points: u32, step: f64| {
        let axis = [scale(step, "mm", "\u{b5}m", 1e-3, 0.0), entry(1, &points.to_le_bytes())].concat();
        entry(tag, &entry(BASE, &axis))
    };
    let counts: Vec<u8> = NUMBERS.iter().flat_map(|n| n.to_le_bytes()).collect();
    let mut mask = vec![22u8; 5 * 4];
    [6, 7, 8, 11, 12].iter().for_each(|at| mask[*at] = 9);
    let mask = entry(5, &[class(9048), blocks(&mask, 1)].concat());
    let mask = [entry(1, &3u32.to_le_bytes()), entry(2, &2u32.to_le_bytes()), mask].concat();
    let mask = entry(3, &[class(9056), entry(2, &mask)].concat());
    let name = entry(BASE, &entry(BASE, &text(1, "Steel")));
    let grid = [name, axis(1, 3, 2e-3), axis(2, 2, 3e-3), if masked { mask } else { Vec::new() }].concat();
    let heights = entry(1, &[class(9049), blocks(&counts, 4)].concat());
    // 1/4 um per count, in mm; the origin in um.
    let z = entry(2, &[scale(0.25e-3, "mm", "\u{b5}m", 1e-3, 5.0), entry(1, &10i32.to_le_bytes())].concat());
    let measurement = entry(BASE, &[entry(BASE, &grid), heights, z].concat());
    let object = entry(1, &[class(9062), entry(2, &measurement)].concat());
    let surface = [entry(BASE, &text(4, "Steel, ground")), object].concat();
    let object = |class: Vec<u8>, body: &[u8]| {
        let object = entry(1, &[class, entry(2, body)].concat());
        [&(object.len() as u64).to_le_bytes()[..], &object].concat()
    };
    let objects = [object(class(77), b"a view"), object(class(9012), &surface)].concat();
    let list = entry(0x2bd, &[entry(1, &[2]), entry(2, &entry(1, &objects))].concat());
    let tree = [entry(3, &[1]), entry(1, &[entry(0xc8, &[0; 4300]), list].concat())].concat();
    compound("ScopedContents", &[&(tree.len() as u64).to_le_bytes()[..], &tree].concat())
}

/// A compound document with one stream.
pub fn compound(name: &str, stream: &[u8]) -> Vec<u8> {
    let memory = Cursor::new(Vec::new());
    let mut file = cfb::CompoundFile::create_with_version(cfb::Version::V3, memory).unwrap();
    file.create_stream(name).unwrap().write_all(stream).unwrap();
    file.into_inner().into_inner()
}
