//! Line profiles: heights along a line, as a stylus writes them.
//!
//! Two columns of text or CSV, position and height, below any header: of Dektak ("Lateral um, Total Profile A"), with units in
//! brackets ("x [mm]; z [µm]"), or bare, with the units as options. Points that are not evenly spaced are resampled to as many
//! that are, straight in between; the history of the profile says so. Or one column of evenly spaced heights, with the length of the
//! profile as an option.

use std::path::Path;

use asperity::Grid;
use asperity::surface::Surface;
use ndarray::Array2;

use super::finish::Unit;
use super::text::{is_profile, read_columns};
use super::unit::line_with_length;
use super::{Format, Problem, ReadOptions, Result, TopographyError, format, unpack};

/// Spacings that agree to this share of their mean are equal: instruments round their positions.
const EVEN: f64 = 1e-3;

/// Where neighbouring points are farther apart than so many times the median, points between them are missing.
const GAP: f64 = 3.0;

/// A profile that was read.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Heights \[m\] on a line of cells, undefined ones NaN.
    pub surface: Surface,
    /// What was done to the points of the file.
    pub history: Vec<String>,
    /// What else the file says.
    pub metadata: Vec<(String, String)>,
    /// Share of its length in gaps between its points or without heights.
    pub gaps: f64,
}

/// The profile of a file, or `None` where its content is none (one or two columns of text).
///
/// `options.size[0]` is the length of the profile \[m\], its number of points times their spacing; `options.height_unit` the unit of its heights and, where the file states no
/// unit at all, of its positions.
///
/// # Errors
/// [`TopographyError`] with the path: positions that do not increase, too few points, or no unit.
pub fn read_profile(path: &Path, options: &ReadOptions) -> Result<Option<Profile>, TopographyError> {
    let in_file = TopographyError::at(path);
    let bytes = super::bytes_of(path, options).map_err(&in_file)?;
    let unpacked = unpack::gunzip(&bytes).map_err(&in_file)?;
    let bytes = unpacked.as_deref().unwrap_or(&bytes);
    // Formats with a name of their own may hold a single column of text too.
    let plain = |format| matches!(format, Format::Text | Format::Csv);
    if format::detect(bytes).is_some_and(|format| !plain(format)) || !is_profile(bytes) {
        return Ok(None);
    }
    profile(bytes, options).map(Some).map_err(in_file)
}

/// A profile from the bytes of a file; see [`read_profile`].
///
/// ```
/// use asperity_files::topography::{ReadOptions, profile_of};
/// let file = "Lateral um, Total Profile A\n0, 10\n1, 20\n2, 40\n3, 20\n";
/// let profile = profile_of(file.as_bytes(), &ReadOptions::default())?;
/// assert_eq!(profile.surface.grid().cells(), [4, 1]);
/// assert!((profile.surface.grid().size()[0] / 4e-6 - 1.0).abs() < 1e-12);
/// assert!((profile.surface.heights()[[2, 0]] / 4e-9 - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity_files::topography::TopographyError>(())
/// ```
///
/// # Errors
/// As [`read_profile`], without a path.
pub fn profile_of(bytes: &[u8], options: &ReadOptions) -> Result<Profile, TopographyError> {
    Ok(profile(bytes, options)?)
}

fn profile(bytes: &[u8], options: &ReadOptions) -> Result<Profile> {
    let columns = read_columns(bytes)?;
    let count = columns.heights.len();
    if count < 2 {
        return Err(Problem::malformed("the number of points of the profile", count, "2 at least"));
    }
    let (stated, detail) = match columns.unit {
        Unit::Metres(metres) => (Some(metres), String::new()),
        Unit::Unstated => (None, String::new()),
        Unit::Other(label) => (None, format!(" (it says {label:?})")),
    };
    let is_bare = columns.positions.is_none() && options.size.is_none() && detail.is_empty();
    let named = line_with_length(&columns.metadata);
    let missing = || match is_bare {
        true => Problem::MissingLengthAndHeightUnit(count),
        false => Problem::MissingHeightUnit { format: Format::Text, detail },
    };
    let height_unit = options.height_unit.or(stated).ok_or_else(missing)?;
    if columns.positions.is_none() && options.size.is_none() {
        return Err(Problem::MissingLength(count));
    }
    let even = || (0..count).map(|n| n as f64).collect();
    let (mut x, mut z) = (columns.positions.unwrap_or_else(even), columns.heights);
    let mut history = vec![];
    if x[0] > x[count - 1] {
        x.reverse();
        z.reverse();
        history.push("turned round: its positions decrease".to_owned());
    }
    if let Some(n) = (0..count).find(|n| !x[*n].is_finite() || (*n > 0 && x[*n] <= x[*n - 1])) {
        let before = if n > 0 { format!(" after {}", x[n - 1]) } else { String::new() };
        return Err(Problem::malformed(
            format!("position {} of the profile", n + 1),
            format!("{}{before}", x[n]),
            "finite and farther than the one before it",
        ));
    }
    let spacing = (x[count - 1] - x[0]) / (count - 1) as f64;
    let off = x.windows(2).map(|pair| ((pair[1] - pair[0]) / spacing - 1.0).abs()).fold(0.0, f64::max);
    let length = spacing * count as f64;
    let length = match (options.size, columns.lateral) {
        (Some([length, _]), _) => length,
        (None, Some(metres)) => length * metres,
        // Bare numbers throughout: one unit for all of them.
        (None, None) if stated.is_none() && named.is_none() => {
            history.push(format!(
                "the positions, without a unit in the file, are taken in the unit given for the heights, {height_unit:e} m"
            ));
            length * height_unit
        }
        (None, None) => {
            let beside = named.map_or(String::new(), |line| format!(" (it says {line:?}, which may be one)"));
            let detail = format!(" with a unit for its positions{beside}");
            return Err(Problem::MissingSize { format: Format::Text, detail });
        }
    };
    let gaps = gaps(&x, &z);
    if off > EVEN {
        z = resampled(&x, &z, spacing);
        history.push(format!(
            "resampled from {count} unevenly spaced points (spacings up to {:.3} times the mean) to {count} evenly spaced ones, \
             straight in between; undefined where neighbours are more than {GAP} times the median spacing apart",
            1.0 + off
        ));
    }
    let clean = |z: f64| if z.is_finite() { z * height_unit } else { f64::NAN };
    let heights: Vec<f64> = z.into_iter().map(clean).collect();
    let made = Grid::line(count, length).and_then(|grid| {
        let heights = Array2::from_shape_vec((count, 1), heights).unwrap_or_default();
        Surface::new(grid, heights)
    });
    let wrong =
        |error: asperity::Error| Problem::malformed("the profile", error, "a line of positive length");
    Ok(Profile { surface: made.map_err(wrong)?, history, metadata: columns.metadata, gaps })
}

/// The largest spacing that is no gap.
fn largest_spacing(x: &[f64]) -> f64 {
    let mut spacings: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
    spacings.sort_by(f64::total_cmp);
    GAP * spacings[spacings.len() / 2]
}

/// Share of the length that lies in gaps, between points or without heights.
fn gaps(x: &[f64], z: &[f64]) -> f64 {
    let largest = largest_spacing(x);
    let measured: Vec<f64> = x.iter().zip(z).filter(|(_, z)| z.is_finite()).map(|(x, _)| *x).collect();
    let wide = measured.windows(2).map(|pair| pair[1] - pair[0]).filter(|apart| *apart > largest);
    wide.sum::<f64>() / (x[x.len() - 1] - x[0])
}

/// Heights at evenly spaced places, straight between the points; undefined where a neighbour is, and in gaps.
fn resampled(x: &[f64], z: &[f64], spacing: f64) -> Vec<f64> {
    let largest = largest_spacing(x);
    let mut after = 1;
    let mut at = |k: usize| {
        let place = x[0] + k as f64 * spacing;
        while after + 1 < x.len() && x[after] < place {
            after += 1;
        }
        let share = ((place - x[after - 1]) / (x[after] - x[after - 1])).clamp(0.0, 1.0);
        match share {
            0.0 => z[after - 1],
            1.0 => z[after],
            _ if x[after] - x[after - 1] > largest => f64::NAN,
            _ => z[after - 1] + share * (z[after] - z[after - 1]),
        }
    };
    (0..x.len()).map(&mut at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Profile {
        profile_of(text.as_bytes(), &ReadOptions::default())
            .unwrap_or_else(|error| panic!("{error}:\n{text}"))
    }

    fn unit_of(metres: f64) -> ReadOptions {
        ReadOptions { height_unit: Some(metres), ..ReadOptions::default() }
    }

    fn message(text: &str, options: &ReadOptions) -> String {
        profile_of(text.as_bytes(), options).unwrap_err().to_string()
    }

    #[test]
    fn missing_points_stay_undefined() {
        // Ten points every micrometre, of which those from 3 to 6 are missing.
        let points = [0, 1, 2, 7, 8, 9, 10, 11, 12, 13].map(|x| format!("{x} {}\n", 10 * x));
        let profile = read(&format!("x [um] z [um]\n{}", points.concat()));
        // Places every 13/9 um: 2.89, 4.33 and 5.78 um lie in the gap.
        assert_eq!(profile.surface.undefined(), 3);
        let heights = profile.surface.heights().to_owned();
        assert!((heights[(5, 0)] - 10e-6 * 5.0 * 13.0 / 9.0).abs() < 1e-12, "{heights}");
        assert!(profile.history.iter().any(|step| step.contains("undefined")), "{:?}", profile.history);
    }

    #[test]
    fn headers_separators_and_decimal_commas() {
        for text in [
            "x [mm]; z [um]\n0; 1\n0,5; 2\n1; 0,5\n",
            "x [mm]\tz [um]\n0\t1\n0.5\t2\n1\t0.5\n",
            "x (um), z (nm)\n0, 1000\n500.0, 2000\n1000, 500\n",
            "META DATA\nStylus, 2 um\nScan Length, 1000\n\nLateral um, Total Profile um\n0.0, 1\n500, 2\n1000, 0.5\n",
            "Lateral(um)\tRaw(A)\n0.0\t10000\n500.0\t20000\n1000.0\t5000\n",
            "x [mm]; z [um]\n1; 0,5\n0,5; 2\n0; 1\n",
            "# x [mm]  z [um]\n0.0 1.0\n0.5 2.0\n1.0 0.5\n",
            "x (mm) z (um)\n0 1\n0.5 2\n1 0.5\n",
            "x[mm] z[um]\n0 1\n0.5 2\n1 0.5\n",
        ] {
            let profile = read(text);
            let (grid, z) = (profile.surface.grid(), profile.surface.heights());
            assert!(grid.is_line() && grid.cells() == [3, 1], "{text}");
            assert!((grid.size()[0] / 1.5e-3 - 1.0).abs() < 1e-12, "{text}: {:?}", grid.size());
            for (n, wanted) in [1e-6, 2e-6, 0.5e-6].into_iter().enumerate() {
                assert!((z[[n, 0]] / wanted - 1.0).abs() < 1e-12, "{text}: {z}");
            }
        }
    }

    #[test]
    fn bare_numbers_need_a_unit_and_may_have_a_length() {
        let text = "0 1\n1 2\n2 1\n3 nan\n";
        assert!(message(text, &ReadOptions::default()).contains("height_unit"));
        let unit = ReadOptions { height_unit: Some(1e-6), ..ReadOptions::default() };
        let profile = profile_of(text.as_bytes(), &unit).unwrap();
        assert!((profile.surface.grid().size()[0] / 4e-6 - 1.0).abs() < 1e-12);
        assert_eq!(profile.surface.undefined(), 1);
        let long = ReadOptions { size: Some([1.0, 1.0]), ..unit };
        assert_eq!(profile_of(text.as_bytes(), &long).unwrap().surface.grid().size()[0], 1.0);
        assert!(message("x; z [um]\n0; 1\n1; 2\n", &ReadOptions::default()).contains("size"));
        // One unit for all is told; not where a line above the numbers names one.
        let told = profile_of(text.as_bytes(), &unit_of(1e-6)).unwrap().history;
        assert!(told[0].contains("unit given for the heights"), "{told:?}");
        // A line that names both columns is their heading.
        let headed =
            profile_of(format!("Position in mm, height in um\n{text}").as_bytes(), &unit_of(1e-6)).unwrap();
        assert!((headed.surface.grid().size()[0] / 4e-3 - 1.0).abs() < 1e-12);
        for above in ["Einheit x: mm", "Scan: 3 µm"] {
            let asked = message(&format!("{above}\n{text}"), &unit_of(1e-6));
            assert!(asked.contains("--size") && asked.contains(above), "{asked}");
        }
    }

    #[test]
    fn heights_alone_are_a_profile_of_the_given_length() {
        let long = ReadOptions { size: Some([3e-6, 1.0]), ..ReadOptions::default() };
        for text in ["z [nm]\n1\n2\n0.5\n", "# height (nm)\n1.0\n2.0\n0.5\n"] {
            let profile =
                profile_of(text.as_bytes(), &long).unwrap_or_else(|error| panic!("{error}:\n{text}"));
            assert_eq!(profile.surface.grid().cells(), [3, 1], "{text}");
            assert!((profile.surface.grid().spacing()[0] / 1e-6 - 1.0).abs() < 1e-12, "{text}");
            for (n, wanted) in [1e-9, 2e-9, 0.5e-9].into_iter().enumerate() {
                assert!((profile.surface.heights()[[n, 0]] / wanted - 1.0).abs() < 1e-12, "{text}");
            }
        }
        // With a comma this is two columns of integers, or one of decimals: no heights are read with the unit of the one.
        assert!(message("z [nm]\n1,0\n2,0\n0,5\n", &long).contains("--height-unit"));
        let both = message("1\n2\n", &ReadOptions::default());
        assert!(both.contains("--size '4 mm' --height-unit um"), "{both}");
        assert!(message("z [nm]\n1\n2\n", &ReadOptions::default()).contains("--size '4 mm'"));
    }

    #[test]
    fn gaps_are_a_share_of_the_length_whether_points_or_heights_are_missing() {
        let line = |points: &[u32], bad: &[u32]| {
            let height = |x: &u32| if bad.contains(x) { "nan".to_owned() } else { format!("{}", x % 3) };
            points.iter().map(|x| format!("{x} {}\n", height(x))).collect::<String>()
        };
        let all: Vec<u32> = (0..=20).collect();
        let without: Vec<u32> = (0..=20).filter(|x| !(5..=8).contains(x)).collect();
        let share = |text: &str| read(&format!("# x [mm] z [um]\n{text}")).gaps;
        assert_eq!(share(&line(&all, &[])), 0.0);
        // From 4 to 9 of 20.
        assert_eq!([share(&line(&without, &[])), share(&line(&all, &[5, 6, 7, 8]))], [0.25; 2]);
        // Single points without heights are filled from their neighbours on both sides.
        assert_eq!(share(&line(&all, &[5, 11])), 0.0);
    }

    #[test]
    fn uneven_points_are_resampled_and_the_history_says_so() {
        // On a straight line resampling changes nothing.
        let profile = read("x [mm]; z [mm]\n0; 0\n1; 2\n1.5; 3\n4; 8\n");
        assert!(
            profile.history[0].contains("resampled from 4 unevenly spaced points"),
            "{:?}",
            profile.history
        );
        for n in 0..4 {
            let wanted = 8e-3 * n as f64 / 3.0;
            assert!((profile.surface.heights()[[n, 0]] - wanted).abs() < 1e-15);
        }
        assert!(read("x [mm]; z [mm]\n0; 0\n1; 2\n2.0001; 3\n3; 8\n").history.is_empty());
    }

    #[test]
    fn what_is_no_profile_is_named() {
        let all = ReadOptions { height_unit: Some(1.0), ..ReadOptions::default() };
        for (text, words) in [
            ("0 1\n1 2\n1 3\n2 1\n", "position 3 of the profile is 1 after 1"),
            ("0 1\nnan 2\n2 3\n", "position 2"),
            ("0 1\n", "number of points"),
            ("1 2 3\n4 5 6\n", "3 numbers"),
            ("z [um]\n4\n5\n6\n", "3 heights without their positions"),
            ("header only\n", "no line of numbers"),
            ("x [s]; z [V]\n0; 1\n1; 2\n", ""),
        ] {
            let message = message(text, &if words.is_empty() { ReadOptions::default() } else { all.clone() });
            assert!(message.contains(words), "{text:?}: {message}");
        }
        assert!(!is_profile(b"1 2 3\n4 5 6\n") && !is_profile(b"\x89PNG\x00"));
        assert!(!is_profile(b"# Width: 2 um\n1 2\n3 4\n"), "a matrix of two columns");
        assert!(is_profile(b"1 2\n3 4\n") && is_profile(b"1\n2\n"));
    }

    #[test]
    fn every_truncation_is_read_or_refused() {
        let text = "META\nLateral um, Total Profile A\n0.0, 1e3\n0.5, nan\n1.0, 5\n1.5, -2\n";
        for end in 0..text.len() {
            let _ = profile_of(&text.as_bytes()[..end], &ReadOptions::default());
        }
    }
}
