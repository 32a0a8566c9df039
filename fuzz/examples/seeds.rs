//! Writes valid files of every format, and those that once broke a reader, into the corpora of the fuzz targets:
//! `cargo run --example seeds` in `fuzz/`.

#[path = "../../crates/asperity-files/tests/all/samples/mod.rs"]
mod samples;

use std::io::{Cursor, Write};
use std::path::Path;

fn main() -> std::io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join("corpus/surface");
    std::fs::create_dir_all(&folder)?;
    let seed = |name: &str, format: &str, bytes: &[u8]| {
        std::fs::write(folder.join(name), [format.as_bytes(), b"\n", bytes].concat())
    };
    for (i, (format, bytes)) in samples::files().into_iter().enumerate() {
        seed(&format!("{format}-{i}"), format.name(), &bytes)?;
    }
    // The name starts with the format.
    for entry in std::fs::read_dir(root.join("../crates/asperity-files/tests/regressions"))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if let Some((format, _)) = name.split_once('-') {
            seed(&name, format, &std::fs::read(&path)?)?;
        }
    }
    curves()
}

/// A text table, and the same as spreadsheets of both kinds, with shared texts.
fn curves() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus/curve");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(
        folder.join("text"),
        "f [Hz];E' [MPa];E'' [MPa];T [C]\n0,1;10;1;20\n1;12;2;20\n10;15;3;20\n",
    )?;
    std::fs::write(folder.join("xls"), xls()?)?;
    std::fs::write(folder.join("xlsx"), xlsx()?)
}

fn xls() -> std::io::Result<Vec<u8>> {
    let record =
        |kind: u16, data: &[u8]| [&kind.to_le_bytes()[..], &(data.len() as u16).to_le_bytes(), data].concat();
    let at = |row: u16, column: u16| [row.to_le_bytes(), column.to_le_bytes(), [0, 0]].concat();
    let texts = [&[2, 0, 0, 0, 2, 0, 0, 0][..], b"\x05\0\0t [s]", b"\x07\0\0E [MPa]"].concat();
    let (begin, end, strings) = (record(0x0809, &[0, 6]), record(0x000a, &[]), record(0x00fc, &texts));
    let sheet = |start: usize| record(0x0085, &[&(start as u32).to_le_bytes()[..], b"\0\0\x01\0S"].concat());
    let mut stream = [
        &begin[..],
        &sheet(begin.len() + sheet(0).len() + strings.len() + end.len()),
        &strings,
        &end,
        &begin,
    ]
    .concat();
    for column in 0..2_u8 {
        stream.extend(record(0x00fd, &[&at(0, column.into())[..], &[column, 0, 0, 0]].concat()));
        for row in 1..4 {
            let value = f64::from(row) * if column == 0 { 1.0 } else { -1.0 } + 9.0;
            stream.extend(record(0x0203, &[&at(row, column.into())[..], &value.to_le_bytes()].concat()));
        }
    }
    stream.extend(end);
    let mut file = cfb::CompoundFile::create(Cursor::new(Vec::new()))?;
    file.create_stream("/Workbook")?.write_all(&stream)?;
    Ok(file.into_inner().into_inner())
}

fn xlsx() -> std::io::Result<Vec<u8>> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let parts = [
        ("xl/workbook.xml", "<workbook><sheets><sheet name=\"S\" r:id=\"a\"/></sheets></workbook>"),
        (
            "xl/_rels/workbook.xml.rels",
            "<Relationships><Relationship Id=\"a\" Type=\"/worksheet\" Target=\"s.xml\"/><Relationship Id=\"b\" Type=\"/sharedStrings\" Target=\"t.xml\"/></Relationships>",
        ),
        ("xl/t.xml", "<sst><si><t>t [s]</t></si><si><t>E [MPa]</t></si></sst>"),
        (
            "xl/s.xml",
            "<worksheet><sheetData><row r=\"1\"><c r=\"A1\" t=\"s\"><v>0</v></c><c t=\"s\"><v>1</v></c></row><row><c><v>1</v></c><c><v>9</v></c></row><row><c><v>2</v></c><c><v>8</v></c></row></sheetData></worksheet>",
        ),
    ];
    for (name, text) in parts {
        zip.start_file(name, zip::write::SimpleFileOptions::default())?;
        zip.write_all(text.as_bytes())?;
    }
    Ok(zip.finish()?.into_inner())
}
