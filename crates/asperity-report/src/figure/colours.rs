//! Colours of values.

/// Which colours values take: perceptually uniform, safe for any kind of colour vision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colours {
    /// Dark violet to yellow (viridis).
    Sequential,
    /// Blue over white to red, white at zero.
    Diverging,
    /// Black over red to light yellow (inferno).
    Heat,
    /// The same from 0 on, but 0 itself light: where there is no pressure there is no contact.
    Pressure,
}

/// Where bodies do not touch.
pub(crate) const OPEN: [u8; 3] = [240, 240, 238];

impl Colours {
    /// The colour at a share of the range, 0 to 1: red, green, blue.
    pub fn at(self, share: f64) -> [u8; 3] {
        let share = share.clamp(0.0, 1.0);
        let colour = match self {
            Colours::Sequential => colorous::VIRIDIS.eval_continuous(share),
            // The scale from red to blue starts with its warm end; here warm is high.
            Colours::Diverging => colorous::RED_BLUE.eval_continuous(1.0 - share),
            Colours::Pressure if share <= 0.0 => return OPEN,
            Colours::Heat | Colours::Pressure => colorous::INFERNO.eval_continuous(share),
        };
        [colour.r, colour.g, colour.b]
    }

    /// Ends of the range for values from `low` to `high`: for diverging colours zero in the middle.
    pub(super) fn ends(self, [low, high]: [f64; 2]) -> [f64; 2] {
        match self {
            _ if low > high || (low == 0.0 && high == 0.0) => [0.0, 1.0],
            Colours::Diverging => {
                let most = low.abs().max(high.abs());
                [-most, most]
            }
            Colours::Pressure => [0.0, high],
            _ if low == high => [low, low + low.abs()],
            _ => [low, high],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn high_values_are_light_or_warm() {
        let light = |[r, g, b]: [u8; 3]| u32::from(r) + u32::from(g) + u32::from(b);
        assert_eq!(Colours::Pressure.at(0.0), OPEN);
        assert_eq!(Colours::Pressure.at(1e-9), Colours::Heat.at(0.0));
        for colours in [Colours::Sequential, Colours::Heat] {
            let steps: Vec<u32> = (0..=10).map(|k| light(colours.at(f64::from(k) / 10.0))).collect();
            assert!(steps[10] > 2 * steps[0] && steps.windows(2).all(|pair| pair[1] >= pair[0]), "{steps:?}");
        }
        let [low, middle, high] = [0.0, 0.5, 1.0].map(|share| Colours::Diverging.at(share));
        assert!(low[2] > low[0] && high[0] > high[2] && middle.iter().all(|c| *c > 235));
    }

    #[test]
    fn a_range_without_width_still_has_ends() {
        for colours in [Colours::Sequential, Colours::Diverging, Colours::Heat] {
            for range in [[0.0, 0.0], [2.0, 2.0], [-2.0, -2.0], [f64::INFINITY, f64::NEG_INFINITY]] {
                let [low, high] = colours.ends(range);
                assert!(low < high && low.is_finite() && high.is_finite(), "{colours:?} {range:?}");
            }
        }
    }
}
