//! From a value to its colour, and the colour bar that says so.

use ndarray::Array2;

use super::axis::{Axis, Ruler};
use super::colours::{Colours, Palette};
use super::drawing::{Anchor, Drawing, INK, Paint, Pen};
use super::raster::{self, BLANK};

use super::{Place, SMALL, TEXT};

/// How values become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ColourScale {
    pub(super) colours: Colours,
    pub(super) palette: Palette,
    /// Values at the ends.
    pub(super) ends: [f64; 2],
    /// Whether the colours go by the logarithm.
    pub(super) log: bool,
}

/// Share of the values that may lie beyond either end of the colours.
const OUTLIERS: f64 = 1e-3;
/// A logarithmic scale shows so many decades below the greatest value at most: what is lower is rounding error.
const DECADES: f64 = 6.0;

impl ColourScale {
    /// Between the ends that suit the values, or the ones given. `whole` holds the least and the greatest value, also where the
    /// values are means over blocks of them.
    pub(super) fn of(
        values: &Array2<f64>,
        whole: [f64; 2],
        colours: Colours,
        palette: Option<Palette>,
        range: Option<[f64; 2]>,
        log: bool,
    ) -> ColourScale {
        // Colours that change their hue in the middle have zero there.
        let centred = if palette == Some(Palette::RedBlue) { Colours::Diverging } else { colours };
        let own = || match log {
            true => decades(values, whole[1]),
            false => centred.ends(suited(values, whole, colours)),
        };
        // A logarithmic scale has no place for a range that begins at 0.
        let ends = range.filter(|ends| !log || ends[0] > 0.0).unwrap_or_else(own);
        ColourScale { colours, palette: palette.unwrap_or(colours.palette()), ends, log }
    }

    /// Place of a value between the ends, 0 to 1.
    fn share(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        if self.log { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) }
    }

    /// The least and the greatest value that has a colour of the scale, where it lies beyond the ends by half of a colour or
    /// more; less than that nobody sees.
    pub(super) fn beyond(&self, values: &Array2<f64>, whole: [f64; 2]) -> [Option<f64>; 2] {
        const HALF: f64 = 0.5 / 256.0;
        let all = values.iter().copied().chain(whole);
        let coloured = all.filter(|value| self.at(*value) != self.palette.aside());
        let [least, most] = extent(coloured);
        let found = [(least, -self.share(least)), (most, self.share(most) - 1.0)];
        found.map(|(value, beyond)| (value.is_finite() && beyond > HALF).then_some(value))
    }

    /// The colour of a value.
    pub(super) fn at(&self, value: f64) -> [u8; 3] {
        if !value.is_finite() {
            BLANK
        } else if (value <= 0.0 && self.log) || (value == 0.0 && self.colours.leave_out_zero()) {
            self.palette.aside()
        } else {
            self.palette.at(self.share(value))
        }
    }

    /// The value at a share of the colour bar.
    fn value(&self, share: f64) -> f64 {
        let [low, high] = self.ends;
        if self.log { low * (high / low).powf(share) } else { low + (high - low) * share }
    }

    /// The ruler of the bar.
    fn ruler(&self, label: &str, unit: &str, height: f64) -> Ruler {
        let axis = if self.log { Axis::log(label, unit) } else { Axis::linear(label, unit) };
        Ruler::new(&axis.between(self.ends[0], self.ends[1]), self.ends, 0.0, height / 32.0)
    }
}

/// A colour bar beside a frame.
pub(super) struct Bar {
    scale: ColourScale,
    ruler: Ruler,
}

impl Bar {
    pub(super) fn new(scale: ColourScale, label: &str, unit: &str, place: &Place) -> Bar {
        Bar { scale, ruler: scale.ruler(label, unit, place.size[1] - 2.0 * TEXT) }
    }

    /// Room that it takes beside the frame.
    pub(super) fn width(&self) -> f64 {
        8.0 + 10.0 + 6.0 + self.ruler.widest() + TEXT + 9.0
    }

    /// What it shows, beside its numbers.
    pub(super) fn title(&self) -> &str {
        &self.ruler.title
    }

    /// Draws it from `left` on.
    pub(super) fn draw(self, drawing: &mut Drawing, [left, top, bottom]: [f64; 3]) {
        let ruler = self.ruler.placed(bottom, top);
        let right = left + 10.0;
        let colour = |[_, j]: [usize; 2]| self.scale.at(self.scale.value((j as f64 + 0.5) / 256.0));
        let picture = raster::coloured([1, 256], colour);
        drawing.image([left, top], [10.0, bottom - top], picture, true);
        drawing.rect([left, top], [10.0, bottom - top], Paint::outline(Pen::new(INK, 0.6)));
        for (value, text) in &ruler.ticks {
            if let Some(at) = ruler.place(*value) {
                drawing.line([right, at], [right + 3.0, at], Pen::new(INK, 0.7));
                drawing.text([right + 5.0, at + 0.36 * SMALL], SMALL, Anchor::Start, text);
            }
        }
        let title = right + 5.0 + ruler.widest() + TEXT + 4.0;
        drawing.upward_text([title, 0.5 * (top + bottom)], TEXT, &ruler.title);
    }
}

/// The least and the greatest value that colours show of values from `whole[0]` to `whole[1]`: without the few that would leave
/// the others one colour.
fn suited(values: &Array2<f64>, whole: [f64; 2], colours: Colours) -> [f64; 2] {
    match colours {
        Colours::Pressure => [whole[0], fence(values).map_or(whole[1], |fence| fence.min(whole[1]))],
        Colours::Heat => whole,
        _ => robust(values.iter().copied()).unwrap_or(whole),
    }
}

/// The outer fence of the positive values, Q3 + 3 (Q3 - Q1) with their quartiles, where those beyond it take more than a third of
/// their range: the edge of a punch, a single asperity. Source: Tukey, Exploratory Data Analysis, 1977, section 2D.
fn fence(values: &Array2<f64>) -> Option<f64> {
    let mut positive: Vec<f64> = values.iter().copied().filter(|v| v.is_finite() && *v > 0.0).collect();
    let most = positive.iter().copied().fold(0.0, f64::max);
    let count = positive.len();
    if count < 100 {
        return None;
    }
    let mut quartile = |n: usize| *positive.select_nth_unstable_by(n * count / 4, f64::total_cmp).1;
    let [first, third] = [quartile(1), quartile(3)];
    let fence = third + 3.0 * (third - first);
    (most > 1.5 * fence).then_some(fence)
}

/// The quantiles at a thousandth and at all but a thousandth, where a few pits or spikes take more than a third of the range of
/// the values.
pub(crate) fn robust(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let mut finite: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    let last = finite.len().saturating_sub(1);
    let few = (OUTLIERS * last as f64).ceil() as usize;
    if last < 1000 {
        return None;
    }
    let low = *finite.select_nth_unstable_by(few, f64::total_cmp).1;
    let high = *finite.select_nth_unstable_by(last - few, f64::total_cmp).1;
    let whole = extent(finite);
    (high > low && whole[1] - whole[0] > 1.5 * (high - low)).then_some([low, high])
}

/// The range of logarithmic colours: from the quantile at a hundredth of the positive values to `high`, the greatest.
fn decades(values: &Array2<f64>, high: f64) -> [f64; 2] {
    let mut positive: Vec<f64> = values.iter().copied().filter(|v| v.is_finite() && *v > 0.0).collect();
    if positive.is_empty() {
        return [0.1, 1.0];
    }
    let few = positive.len() / 100;
    let low = *positive.select_nth_unstable_by(few, f64::total_cmp).1;
    let low = low.max(high * 10f64.powf(-DECADES));
    if low < high { [low, high] } else { [0.1 * high, high] }
}

/// Least and greatest of the finite values.
pub fn extent(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let finite = values.into_iter().filter(|v| v.is_finite());
    finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends_of(values: &Array2<f64>) -> [f64; 2] {
        extent(values.iter().copied())
    }

    /// p = p0 / (2 sqrt(1 - r²/a²)) below a flat punch, in rings of one area: 1 - r²/a² = (n + 1/2)/N.
    #[test]
    fn the_edge_of_a_punch_does_not_darken_its_middle_and_a_hertzian_contact_keeps_its_peak() {
        let share = |n: usize| (n as f64 + 0.5) / 1000.0;
        let punch = Array2::from_shape_fn((1000, 1), |(n, _)| 0.5 / share(n).sqrt());
        let whole = ends_of(&punch);
        let scale = ColourScale::of(&punch, whole, Colours::Pressure, None, None, false);
        // Quartiles 1/√3 and 1: the fence is at 4 - √3 = 2.268; one ring shifts a quartile by 2e-3 at most, the fence by 8e-3.
        assert!((scale.ends[1] - (4.0 - 3f64.sqrt())).abs() < 8e-3, "{:?}", scale.ends);
        assert_eq!(scale.beyond(&punch, whole), [None, Some(whole[1])]);
        let hertz = punch.mapv(|p| 0.5 / p);
        let scale = ColourScale::of(&hertz, ends_of(&hertz), Colours::Pressure, None, None, false);
        assert_eq!(scale.ends, [0.0, ends_of(&hertz)[1]]);
    }

    #[test]
    fn means_over_blocks_keep_the_greatest_value_at_the_end_of_the_colours() {
        let means = Array2::from_shape_fn((40, 40), |(i, j)| (i + j) as f64);
        let scale = ColourScale::of(&means, [-2.0, 90.0], Colours::Sequential, None, None, false);
        assert_eq!(scale.ends, [-2.0, 90.0]);
        let scale = ColourScale::of(&means, [0.0, 90.0], Colours::Pressure, None, None, true);
        assert_eq!(scale.ends[1], 90.0);
    }

    #[test]
    fn a_logarithmic_scale_leaves_out_rounding_errors_and_shows_contact_as_such() {
        let values = Array2::from_shape_fn((100, 10), |(i, _)| match i {
            0..10 => 0.0,
            10 => 1e-24,
            i => 1e-9 * 10f64.powf(f64::from(i as u32) / 33.0),
        });
        let scale = ColourScale::of(&values, ends_of(&values), Colours::Sequential, None, None, true);
        // Of the 90 positive values in each column the rounding error is the least one, the hundredth quantile.
        assert!(scale.ends[0] >= 1e-12 && scale.ends[0] < 3e-9, "{:?}", scale.ends);
        assert_eq!(scale.ends[1], values[[99, 0]]);
        assert_eq!(scale.at(0.0), Palette::Viridis.aside());
        let middle = scale.value(0.5);
        assert!((middle / (scale.ends[0] * scale.ends[1]).sqrt() - 1.0).abs() < 1e-12);
        assert_eq!(scale.at(middle), Palette::Viridis.at(0.5));
    }

    #[test]
    fn values_beyond_the_colours_are_told_unless_by_rounding() {
        let values = Array2::from_shape_fn((40, 40), |(i, j)| 1e-6 + 1e-9 * (i + j) as f64);
        let whole = ends_of(&values);
        let scale = |range, log| ColourScale::of(&values, whole, Colours::Sequential, None, range, log);
        let of = |range| scale(range, false).beyond(&values, whole);
        let [low, high] = [1e-6, 1.078e-6];
        assert_eq!(of(Some([low * (1.0 + 1e-12), high * (1.0 - 1e-12)])), [None, None]);
        assert_eq!(of(Some([1.03e-6, 1.2e-6])), [Some(values[[0, 0]]), None]);
        let log = scale(Some([low, 1.05e-6]), true);
        assert_eq!(log.beyond(&values, whole), [None, Some(values[[39, 39]])]);
    }

    #[test]
    fn colours_from_blue_to_red_are_white_at_zero() {
        let values = Array2::from_shape_fn((40, 40), |(i, j)| (i + j) as f64 - 3.0);
        for colours in [Colours::Sequential, Colours::Heat, Colours::Pressure] {
            let scale =
                ColourScale::of(&values, ends_of(&values), colours, Some(Palette::RedBlue), None, false);
            assert_eq!(scale.ends, [-75.0, 75.0]);
        }
    }

    #[test]
    fn limits_and_names_of_colours_replace_the_usual_ones() {
        let values = Array2::from_shape_fn((40, 40), |(i, j)| (i * j) as f64);
        let (whole, range) = (ends_of(&values), Some([100.0, 200.0]));
        let scale = ColourScale::of(&values, whole, Colours::Pressure, Some(Palette::Grey), range, false);
        assert_eq!([scale.at(100.0), scale.at(150.0)], [Palette::Grey.at(0.0), Palette::Grey.at(0.5)]);
        // Small pressure is still contact; none is not.
        assert_eq!([scale.at(1.0), scale.at(0.0)], [Palette::Grey.at(0.0), Palette::Grey.aside()]);
    }
}
