//! NetCDF, classic (CDF-1, -2, -5) and NetCDF-4, as contact.engineering writes it, and other HDF5.
//!
//! A topography is the variable `heights` over the dimensions x and y; the attribute `length` of the variables `x`
//! and `y` is the physical size, `unit` of all three the unit. A variable `mask` that is not 0 marks undefined
//! points, as do `_FillValue`, `missing_value` and the valid range of the NetCDF conventions. Other files: every
//! two-dimensional variable of numbers is a channel, the first dimension is x unless the names say (y, x), and the
//! coordinates give the size where they are equally spaced.

use std::sync::Arc;

use ndarray::{Array2, ArrayD, Ix2};
use netcdf_reader::{NcAttrValue, NcFile, NcFormat, NcOpenOptions, NcType, NcVariable};

use super::finish::{Lateral, Measured, Unit, unit_of};
use super::groups::broken;
use super::unit::LoneA;
use super::unpack::most_unpacked;
use super::{Format, Problem, Reader, Request, Result, foreign, grid, groups, write};

/// What NetCDF writes where a variable was never written.
const DEFAULT_FILL: f64 = 9.969_209_968_386_869e36;

// NetCDF-4 is HDF5; reading tells which.
pub(super) const NETCDF: Reader =
    Reader::new("nc", |bytes| matches!(bytes, [b'C', b'D', b'F', 1 | 2 | 5, ..]), read)
        .also_called(&["netcdf"])
        .written_by(write::netcdf::encode);

pub(super) const HDF5: Reader = Reader::new("h5", is_hdf5, read).also_called(&["hdf5"]);

fn is_hdf5(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89HDF\r\n\x1a\n")
}

/// Reads the variable asked for, and tells NetCDF-4 from other HDF5.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    foreign::refuse_look_alikes(bytes)?;
    let most = usize::try_from(most_unpacked(bytes.len())).unwrap_or(usize::MAX);
    let options =
        || NcOpenOptions { max_read_bytes: most, max_chunk_bytes: most, ..NcOpenOptions::default() };
    let bytes: Arc<[u8]> = bytes.into();
    if is_hdf5(&bytes) {
        groups::check(bytes.clone(), options().into())?;
    }
    let available = bytes.len() as u64;
    let file = NcFile::from_owner(bytes, options()).map_err(|e| broken("the file", e))?;
    let maps = maps(&file)?;
    let is_netcdf = !matches!(file.format(), NcFormat::Nc4 | NcFormat::Nc4Classic)
        || file.dimensions().is_ok_and(|d| !d.is_empty());
    let request = &Request { format: if is_netcdf { Format::NetCdf } else { Format::Hdf5 }, ..*request };
    let names: Vec<String> = maps.iter().map(|(name, _)| name.clone()).collect();
    let index = match names.iter().position(|n| n == "heights") {
        Some(heights) if request.channel.is_none() => heights,
        _ => {
            let unit = |i: usize| unit_of(&label(maps[i].1).unwrap_or_default(), LoneA::Angstrom);
            request.choose_heights(&names, unit)?
        }
    };
    let (name, variable) = &maps[index];

    let shape = variable.shape();
    let points = grid::points(shape[0], shape[1])?;
    // Classic files hold every number; packed ones are bounded by `most_unpacked`.
    if (points as u64).saturating_mul(width(&variable.dtype)) > most as u64 {
        return Err(Problem::truncated(format!("the variable {name:?}"), points as u64, available));
    }
    let mut heights = two_dimensional(file.read_variable_unpacked_masked(name), name)?;
    let fill = |h: f64| (h / DEFAULT_FILL - 1.0).abs() < 1e-6;
    grid::replace(&mut heights, |h| if fill(h) { f64::NAN } else { h });
    if let Ok(mask) = file.variable(&sibling(name, "mask"))
        && mask.shape() == shape
    {
        let mask = two_dimensional(file.read_variable_as_f64(&sibling(name, "mask")), "mask")?;
        grid::undefine(&mut heights, &mask, |masked| masked != 0.0);
    }
    let dimension = |axis: usize| variable.dimensions().get(axis).map_or("", |d| d.name.as_str());
    let y_first =
        dimension(0).to_lowercase().starts_with('y') && dimension(1).to_lowercase().starts_with('x');
    let (x, y) = if y_first { (dimension(1), dimension(0)) } else { (dimension(0), dimension(1)) };
    let lengths = [length(&file, &sibling(name, x)), length(&file, &sibling(name, y))];
    if y_first {
        heights = heights.reversed_axes().as_standard_layout().into_owned();
    }

    let (lateral, lateral_label) = lateral(lengths);
    let label = label(variable).or_else(|| {
        // contact.engineering gives one unit for lengths and heights.
        lateral_label.filter(|_| name == "heights")
    });
    let unit = label.map_or(Unit::Unstated, |label| unit_of(&label, LoneA::Angstrom));
    let metadata = file.global_attributes().unwrap_or_default().iter();
    let metadata = metadata.filter_map(|a| Some((a.name.clone(), text(&a.value)?)));
    let measured = Measured::new(heights, unit, lateral).of_channel(names, index).with(metadata);
    Ok(Measured { format: Some(request.format), ..measured })
}

/// The two-dimensional variables of numbers with their paths, those of outer groups first.
fn maps(file: &NcFile) -> Result<Vec<(String, &NcVariable)>> {
    const MOST: usize = 10_000;
    let root = file.root_group().map_err(|e| broken("the root group", e))?;
    let mut maps = Vec::new();
    let mut groups = std::collections::VecDeque::from([(String::new(), root)]);
    while let Some((path, group)) = groups.pop_front() {
        for variable in &group.variables {
            let is_map =
                variable.shape().len() == 2 && width(&variable.dtype) > 0 && variable.name() != "mask";
            if is_map && maps.len() < MOST {
                maps.push((format!("{path}{}", variable.name()), variable));
            }
        }
        for inner in &group.groups {
            groups.push_back((format!("{path}{}/", inner.name), inner));
        }
    }
    Ok(maps)
}

/// Bytes of a number of this type; 0 for another type.
fn width(kind: &NcType) -> u64 {
    match kind {
        NcType::Byte | NcType::UByte => 1,
        NcType::Short | NcType::UShort => 2,
        NcType::Int | NcType::UInt | NcType::Float => 4,
        NcType::Int64 | NcType::UInt64 | NcType::Double => 8,
        _ => 0,
    }
}

fn two_dimensional(read: Result<ArrayD<f64>, impl std::fmt::Display>, name: &str) -> Result<Array2<f64>> {
    let what = format!("the variable {name:?}");
    let array = read.map_err(|e| broken(&what, e))?;
    let array = array.into_dimensionality::<Ix2>().map_err(|e| broken(&what, e))?;
    Ok(array.as_standard_layout().into_owned())
}

/// The path of another variable in the same group.
fn sibling(path: &str, name: &str) -> String {
    match path.rsplit_once('/') {
        Some((group, _)) => format!("{group}/{name}"),
        None => name.to_owned(),
    }
}

/// Length along an axis from its coordinate variable, with the label of its unit.
fn length(file: &NcFile, name: &str) -> Option<(f64, Option<String>)> {
    let variable = file.variable(name).ok()?;
    let stated = variable.attribute("length").and_then(|a| a.value.as_f64());
    let length = stated.or_else(|| spaced(&file.read_variable_as_f64(name).ok()?))?;
    Some((length, label(variable)))
}

/// n times the spacing of equally spaced coordinates.
fn spaced(coordinates: &ArrayD<f64>) -> Option<f64> {
    let (first, last) = (coordinates.first()?, coordinates.last()?);
    let n = coordinates.len();
    let spacing = (last - first) / (n.checked_sub(1).filter(|n| *n > 0)? as f64);
    // Binary32 coordinates keep seven digits of the whole range.
    let tolerance = 1e-3 * spacing.abs();
    let is_spaced = |(i, x): (usize, &f64)| (x - (first + i as f64 * spacing)).abs() <= tolerance;
    let equal = coordinates.ndim() == 1 && coordinates.iter().enumerate().all(is_spaced);
    (equal && spacing != 0.0).then_some(spacing.abs() * n as f64)
}

/// `unit` of contact.engineering or `units` of the NetCDF conventions.
fn label(variable: &NcVariable) -> Option<String> {
    let attribute = variable.attribute("unit").or_else(|| variable.attribute("units"))?;
    text(&attribute.value).filter(|t| !t.is_empty())
}

fn text(value: &NcAttrValue) -> Option<String> {
    match value {
        NcAttrValue::Chars(text) => Some(text.trim_matches(['\0', ' ']).to_owned()),
        NcAttrValue::Strings(texts) => texts.first().map(|t| t.trim().to_owned()),
        _ => None,
    }
}

/// The size, and the label of its unit if both axes have the same unit.
fn lateral(lengths: [Option<(f64, Option<String>)>; 2]) -> (Lateral, Option<String>) {
    let [Some((x, x_label)), Some((y, y_label))] = lengths else {
        return (Lateral::Unstated(String::new()), None);
    };
    let unit = |label: &Option<String>| unit_of(label.as_deref().unwrap_or_default(), LoneA::Angstrom);
    let lateral = Lateral::of([x, y], [unit(&x_label), unit(&y_label)]);
    (lateral, x_label.filter(|label| y_label.as_ref() == Some(label)))
}
