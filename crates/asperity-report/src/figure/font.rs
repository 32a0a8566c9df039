//! The typeface of the figures: DejaVu Sans, a part of it shipped with the crate, so that a figure looks the
//! same on every machine.

use std::sync::{Arc, OnceLock};

use resvg::usvg::fontdb;
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// Latin, Greek and the signs of mathematics.
static DATA: &[u8] = include_bytes!("../../fonts/DejaVuSans.ttf");

/// Families in the order in which a viewer of the SVG tries them.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

/// Width of a text \[points\] at a size \[points\]; 0.6 of the size for a letter that the typeface lacks.
pub(super) fn width(text: &str, size: f64) -> f64 {
    static FACE: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    let face = FACE.get_or_init(|| FontRef::new(DATA).ok());
    // In units of the design, of which the size has so many.
    let metrics = face.as_ref().map(|face| {
        let (size, location) = (Size::unscaled(), LocationRef::default());
        (face.charmap(), face.glyph_metrics(size, location), face.metrics(size, location).units_per_em)
    });
    let advance = |c: char| {
        let (letters, glyphs, units_per_em) = metrics.as_ref()?;
        Some(f64::from(glyphs.advance_width(letters.map(c)?)?) / f64::from(*units_per_em))
    };
    size * text.chars().map(|c| advance(c).unwrap_or(0.6)).sum::<f64>()
}

/// The fonts that a renderer draws with: this one.
pub(super) fn database() -> Arc<fontdb::Database> {
    static DATABASE: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    let database = DATABASE.get_or_init(|| {
        let mut database = fontdb::Database::new();
        database.load_font_source(fontdb::Source::Binary(Arc::new(DATA)));
        database.set_sans_serif_family("DejaVu Sans");
        Arc::new(database)
    });
    Arc::clone(database)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_typeface_has_every_sign_that_figures_use() {
        let letters = FontRef::new(DATA).unwrap().charmap();
        for c in "AZaz09 αβδεηλμνρστφωΔΓΩµ°²³⁴⁻⁰¹⁹×·−±≤≥≈∞√∂∫→–—'”/%[]()éüñčß".chars()
        {
            assert!(letters.map(c).is_some_and(|glyph| glyph.to_u32() > 0), "{c}");
        }
        assert_eq!(database().faces().next().unwrap().families[0].0, "DejaVu Sans");
    }

    #[test]
    fn a_text_is_as_wide_as_its_letters() {
        // The width of a digit of this typeface is 1303 / 2048 of the size.
        assert!((width("0123", 10.0) - 40.0 * 1303.0 / 2048.0).abs() < 1e-9);
    }
}
