//! X3P (ISO 25178-72): heights in metres as binary64, undefined points as NaN, with the checksums of the standard.

use std::io::{Cursor, Write};
use std::time::{SystemTime, UNIX_EPOCH};

use quick_xml::escape::escape;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::{lines, title};
use crate::digest::md5;
use crate::topography::{Format, HISTORY, Problem, Result, Topography};

const DATA: &str = "bindata/data.bin";

pub(in crate::topography) fn encode(topography: &Topography) -> Result<Vec<u8>> {
    let data = lines(topography);
    let xml = main(topography, &md5(&data));
    let checksums = format!("{} *main.xml\n", md5(xml.as_bytes()));
    let mut zip = ZipWriter::new(Cursor::new(Vec::with_capacity(data.len() + 4096)));
    let failed = |e: zip::result::ZipError| Problem::Io(std::io::Error::other(e));
    // Little is gained by packing binary64 harder than this.
    let packed = SimpleFileOptions::default().compression_level(Some(1));
    for (name, content) in
        [("main.xml", xml.as_bytes()), (DATA, &data), ("md5checksum.hex", checksums.as_bytes())]
    {
        zip.start_file(name, packed.large_file(content.len() > 1 << 31)).map_err(failed)?;
        zip.write_all(content)?;
    }
    Ok(zip.finish().map_err(failed)?.into_inner())
}

fn main(topography: &Topography, checksum: &str) -> String {
    let (nx, ny) = topography.heights.dim();
    let [dx, dy] = [topography.size[0] / nx as f64, topography.size[1] / ny as f64];
    // Only entries of an X3P file are known to be in the form that the standard wants.
    let known: &[(String, String)] =
        if topography.format == Format::X3p { &topography.metadata } else { &[] };
    let stated = |key: &str| known.iter().find(|(k, _)| k == key).map(|(_, v)| v.as_str());
    let entry = |key: &str, default: &str| escape(stated(key).unwrap_or(default)).into_owned();
    let now = now();
    let date = entry("Date", &now);
    let calibration = entry("CalibrationDate", &now);
    let [manufacturer, model, serial, version] = ["Manufacturer", "Model", "Serial", "Version"]
        .map(|key| entry(&format!("Instrument/{key}"), "not available"));
    let probing = stated("ProbingSystem/Type").filter(|t| ["Contacting", "NonContacting"].contains(t));
    let probing = probing.unwrap_or("Software");
    let identification = entry("ProbingSystem/Identification", "asperity");
    let mut comment = entry("Comment", title(topography));
    if let Some(history) = topography.history_line() {
        comment = format!("{comment} {HISTORY}: {}", escape(history));
    }
    format!(
        r#"<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="http://www.opengps.eu/2008/ISO5436_2 http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd">
  <Record1>
    <Revision>ISO5436 - 2000</Revision>
    <FeatureType>SUR</FeatureType>
    <Axes>
      <CX><AxisType>I</AxisType><DataType>D</DataType><Increment>{dx:e}</Increment><Offset>0</Offset></CX>
      <CY><AxisType>I</AxisType><DataType>D</DataType><Increment>{dy:e}</Increment><Offset>0</Offset></CY>
      <CZ><AxisType>A</AxisType><DataType>D</DataType><Increment>1</Increment><Offset>0</Offset></CZ>
    </Axes>
  </Record1>
  <Record2>
    <Date>{date}</Date>
    <Instrument>
      <Manufacturer>{manufacturer}</Manufacturer>
      <Model>{model}</Model>
      <Serial>{serial}</Serial>
      <Version>{version}</Version>
    </Instrument>
    <CalibrationDate>{calibration}</CalibrationDate>
    <ProbingSystem>
      <Type>{probing}</Type>
      <Identification>{identification}</Identification>
    </ProbingSystem>
    <Comment>{comment}</Comment>
  </Record2>
  <Record3>
    <MatrixDimension><SizeX>{nx}</SizeX><SizeY>{ny}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
    <DataLink>
      <PointDataLink>{DATA}</PointDataLink>
      <MD5ChecksumPointData>{}</MD5ChecksumPointData>
    </DataLink>
  </Record3>
  <Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>
</p:ISO5436_2>
"#,
        checksum.to_uppercase()
    )
}

/// The present instant in UTC as ISO 8601 writes it; the standard wants a date.
fn now() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let ([year, month, day], rest) = (civil(seconds / 86400), seconds % 86400);
    format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}Z", rest / 3600, rest / 60 % 60, rest % 60)
}

/// Year, month and day of the Gregorian calendar from the days since 1970-01-01, in years that begin in March.
fn civil(days: u64) -> [u64; 3] {
    // 1970-01-01 is day 719468 since 0000-03-01; 400 years have 146097 days.
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    [era * 400 + year_of_era + u64::from(month <= 2), month, day]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_dates() {
        assert_eq!(civil(0), [1970, 1, 1]);
        assert_eq!(civil(11_016), [2000, 2, 29]);
        assert_eq!(civil(20_454), [2026, 1, 1]);
    }
}
