//! What is written is read back as it was, in every format that can be written.

use asperity_files::topography::{
    Format, Problem, ReadOptions, Topography, read, read_bytes, to_bytes, write,
};
use ndarray::Array2;

const WRITABLE: [Format; 6] =
    [Format::Npz, Format::Gwy, Format::X3p, Format::Sdf, Format::NetCdf, Format::Text];

/// 7 x 5 points without any symmetry that could hide an exchange of axes, two of them undefined.
fn surface() -> Topography {
    let mut heights =
        Array2::from_shape_fn((7, 5), |(x, y)| 1e-6 * ((x * x) as f64 / 3.0 - (y as f64).exp()));
    heights[[2, 3]] = f64::NAN;
    heights[[6, 0]] = f64::NAN;
    Topography {
        format: Format::Text,
        heights,
        // No finite binary fractions: spacing and size are not exact in each other.
        size: [7.3e-5, 5.1e-5],
        channel: Some("rough \u{b5} side".into()),
        channels: Vec::new(),
        metadata: Vec::new(),
    }
}

#[test]
fn every_format_gives_the_same_topography_back() {
    let surface = surface();
    let folder = tempfile::tempdir().unwrap();
    for format in WRITABLE {
        let path = folder.path().join("surface");
        write(&path, &surface, format).unwrap();
        let again = read(&path, &ReadOptions::default()).unwrap();
        assert_eq!(again.format, format);
        assert_eq!(again.undefined(), 2, "{format}");
        for (a, b) in again.heights.iter().zip(&surface.heights) {
            // All bits: the formats hold binary64 or its shortest decimal.
            assert!(a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()), "{format}: {a:e} for {b:e}");
        }
        for (a, b) in again.size.iter().zip(surface.size) {
            // SDF and X3P hold the spacing: one rounding of the quotient and one of the product.
            assert!((a / b - 1.0).abs() <= 2.0 * f64::EPSILON, "{format}: {a:e} for {b:e}");
        }
        if matches!(format, Format::Gwy | Format::Text) {
            assert_eq!(again.channel, surface.channel);
        }
    }
}

#[test]
fn a_surface_without_undefined_points_needs_no_mask() {
    let mut surface = surface();
    surface.heights.mapv_inplace(|h| if h.is_nan() { 0.0 } else { h });
    for format in WRITABLE {
        let again = read_bytes(&to_bytes(&surface, format).unwrap(), &ReadOptions::default()).unwrap();
        assert_eq!(again.heights, surface.heights, "{format}");
    }
}

#[test]
fn more_than_65535_points_along_an_axis_are_written_as_sdf_2() {
    let heights = Array2::from_shape_fn((65_536, 2), |(x, y)| (2 * x + y) as f64);
    let surface = Topography { heights, ..surface() };
    let bytes = to_bytes(&surface, Format::Sdf).unwrap();
    assert!(bytes.starts_with(b"bISO-2.0"));
    assert_eq!(read_bytes(&bytes, &ReadOptions::default()).unwrap().heights, surface.heights);
}

#[test]
fn what_cannot_be_written_is_refused() {
    let error = to_bytes(&surface(), Format::Opd).unwrap_err();
    assert!(matches!(error.problem, Problem::Option { .. }), "{error}");
    let flat = Topography { size: [1.0, 0.0], ..surface() };
    assert!(to_bytes(&flat, Format::Npz).is_err());
    let empty = Topography { heights: Array2::zeros((0, 3)), ..surface() };
    assert!(to_bytes(&empty, Format::Npz).is_err());
    let nowhere = std::path::Path::new("/nonexistent-folder/surface.npz");
    let error = write(nowhere, &surface(), Format::Npz).unwrap_err();
    assert!(error.to_string().contains("nonexistent-folder"), "{error}");
}
