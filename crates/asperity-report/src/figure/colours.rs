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
    /// Dark violet to yellow, but 0 light: where there is no gap the bodies touch.
    Gap,
}

/// Where bodies do not touch, in a map of the pressure; and where they do, in one of the gap.
pub(crate) const OPEN: [u8; 3] = [240, 240, 238];

/// A colour map to be used instead of the usual one; its name is a [`choice`](asperity_io::choice).
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Palette {
    /// Dark violet to yellow.
    Viridis,
    /// Dark blue to yellow, the same for red-green blind eyes.
    Cividis,
    /// Black over red to light yellow.
    Inferno,
    /// Black over violet to light yellow.
    Magma,
    /// Dark blue over red to yellow.
    Plasma,
    /// All colours of the rainbow, of even lightness steps.
    Turbo,
    /// Black to white.
    Grey,
    /// Blue over white to red.
    RedBlue,
}

impl Palette {
    /// The colour beside it, of what is left out: light, and none of its own.
    pub(super) fn aside(self) -> [u8; 3] {
        match self {
            Palette::Grey | Palette::RedBlue => [190, 226, 170],
            _ => OPEN,
        }
    }

    /// The colour at a share of the range, 0 to 1: red, green, blue.
    pub fn at(self, share: f64) -> [u8; 3] {
        let share = share.clamp(0.0, 1.0);
        let (gradient, share) = match self {
            Palette::Viridis => (colorous::VIRIDIS, share),
            Palette::Cividis => (colorous::CIVIDIS, share),
            Palette::Inferno => (colorous::INFERNO, share),
            Palette::Magma => (colorous::MAGMA, share),
            Palette::Plasma => (colorous::PLASMA, share),
            Palette::Turbo => (colorous::TURBO, share),
            // The greys start with white, and the scale from red to blue with its warm end; here high is light or warm.
            Palette::Grey => (colorous::GREYS, 1.0 - share),
            Palette::RedBlue => (colorous::RED_BLUE, 1.0 - share),
        };
        let colour = gradient.eval_continuous(share);
        [colour.r, colour.g, colour.b]
    }
}

impl Colours {
    /// The colour at a share of the range, 0 to 1: red, green, blue.
    pub fn at(self, share: f64) -> [u8; 3] {
        if self.leave_out_zero() && share <= 0.0 { OPEN } else { self.palette().at(share) }
    }

    /// Whether 0 has a colour of its own.
    pub(super) fn leave_out_zero(self) -> bool {
        matches!(self, Colours::Pressure | Colours::Gap)
    }

    /// The colour map that is usual for it.
    pub(super) fn palette(self) -> Palette {
        match self {
            Colours::Sequential | Colours::Gap => Palette::Viridis,
            Colours::Diverging => Palette::RedBlue,
            Colours::Heat | Colours::Pressure => Palette::Inferno,
        }
    }

    /// Ends of the range for values from `low` to `high`: for diverging colours zero in the middle.
    pub(crate) fn ends(self, [low, high]: [f64; 2]) -> [f64; 2] {
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
    use asperity_io::choice;

    use super::*;

    fn light([r, g, b]: [u8; 3]) -> u32 {
        u32::from(r) + u32::from(g) + u32::from(b)
    }

    #[test]
    fn high_values_are_light_or_warm() {
        assert_eq!(Colours::Pressure.at(0.0), OPEN);
        assert_eq!(Colours::Pressure.at(1e-9), Colours::Heat.at(0.0));
        assert_eq!(Colours::Gap.at(0.0), OPEN);
        assert_eq!(Colours::Gap.at(1e-9), Colours::Sequential.at(0.0));
        for colours in [Colours::Sequential, Colours::Heat] {
            let steps: Vec<u32> = (0..=10).map(|k| light(colours.at(f64::from(k) / 10.0))).collect();
            assert!(steps[10] > 2 * steps[0] && steps.windows(2).all(|pair| pair[1] >= pair[0]), "{steps:?}");
        }
        let [low, middle, high] = [0.0, 0.5, 1.0].map(|share| Colours::Diverging.at(share));
        assert!(low[2] > low[0] && high[0] > high[2] && middle.iter().all(|c| *c > 235));
    }

    #[test]
    fn colour_maps_have_names_and_rise_in_lightness() {
        for name in choice::words::<Palette>() {
            let palette: Palette = choice::parse(name).unwrap();
            let rises = light(palette.at(1.0)) > light(palette.at(0.0)) + 200;
            assert!(rises || matches!(palette, Palette::Turbo | Palette::RedBlue), "{palette:?}");
        }
        assert_eq!(choice::parse("red-blue"), Some(Palette::RedBlue));
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
