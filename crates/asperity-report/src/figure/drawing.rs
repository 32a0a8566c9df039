//! What a figure consists of: shapes, texts and pictures on paper, in points (1/72 inch), y downwards. [`svg`](super::svg),
//! [`dots`](super::dots) and [`pdf`](super::pdf) write it.

use super::font;

/// Text and frames.
pub(crate) const INK: &str = "#222222";
/// Lines behind the curves.
pub(super) const GRID: &str = "#e3e3e3";

/// Red, green, blue.
pub(super) type Colour = [u8; 3];

/// Where a text hangs on its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    /// Where a text starts along its line, from its point \[points\].
    pub(super) fn start(self, text: &str, size: f64) -> f64 {
        match self {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * font::width(text, size),
            Anchor::End => -font::width(text, size),
        }
    }
}

/// A line's colour, width \[points\] and dashes (lengths of strokes and gaps \[points\]; empty for a solid line).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pen {
    pub(super) colour: Colour,
    pub(super) width: f64,
    pub(super) dashes: &'static [f64],
}

/// How a shape is filled (colour and opacity) and outlined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Paint {
    pub(super) fill: Option<(Colour, f64)>,
    pub(super) pen: Option<Pen>,
}

/// The outline of a shape.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Rect {
        corner: [f64; 2],
        size: [f64; 2],
        /// Radius of the corners.
        round: f64,
    },
    Circle {
        at: [f64; 2],
        radius: f64,
    },
    /// Lines through points.
    Lines(Vec<Vec<[f64; 2]>>),
}

/// Colours of cells, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pixels {
    pub(crate) size: [usize; 2],
    pub(crate) rgb: Vec<u8>,
}

/// One thing on the paper.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Mark {
    Shape(Shape, Paint),
    Text {
        at: [f64; 2],
        size: f64,
        anchor: Anchor,
        /// It reads upwards.
        upward: bool,
        text: String,
    },
    /// Pixels stretched over a rectangle.
    Image {
        corner: [f64; 2],
        size: [f64; 2],
        pixels: Pixels,
        smooth: bool,
    },
    /// Marks of which only what lies within a rectangle is seen.
    Clipped {
        corner: [f64; 2],
        size: [f64; 2],
        marks: Vec<Mark>,
    },
}

/// Boxes for the letters of a text that the typeface lacks.
pub(super) fn boxes(text: &str, [x, y]: [f64; 2], size: f64, anchor: Anchor, upward: bool) -> Option<Shape> {
    let mut right = anchor.start(text, size);
    let mut lines = vec![];
    for (glyph, advance) in font::letters(text) {
        if glyph == font::LACKING {
            let [left, top, end, foot] = font::BOX.map(|side| size * side);
            let corners = [[left, foot], [end, foot], [end, top], [left, top], [left, foot]];
            let to = |[along, down]: [f64; 2]| match upward {
                true => [x + down, y - right - along],
                false => [x + right + along, y + down],
            };
            lines.push(corners.map(to).to_vec());
        }
        right += size * advance;
    }
    (!lines.is_empty()).then_some(Shape::Lines(lines))
}

/// The pen of these boxes.
pub(super) const BOXES: Pen = Pen { colour: [0x22; 3], width: 0.5, dashes: &[] };

/// Marks on paper, the first below the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Drawing {
    pub(super) marks: Vec<Mark>,
}

impl Pen {
    pub(super) fn new(colour: &str, width: f64) -> Pen {
        Pen { colour: rgb(colour), width, dashes: &[] }
    }

    pub(super) fn dashed(self, dashes: &'static [f64]) -> Pen {
        Pen { dashes, ..self }
    }
}

impl Paint {
    /// A shape of this opacity without an outline.
    pub(super) fn fill(colour: &str, opacity: f64) -> Paint {
        Paint { fill: Some((rgb(colour), opacity)), pen: None }
    }

    /// An outline alone.
    pub(super) fn outline(pen: Pen) -> Paint {
        Paint { fill: None, pen: Some(pen) }
    }
}

impl Drawing {
    pub(super) fn text(&mut self, at: [f64; 2], size: f64, anchor: Anchor, text: &str) {
        let at = at.map(finite);
        self.marks.push(Mark::Text { at, size, anchor, upward: false, text: text.into() });
    }

    /// All texts outside of clipped frames, where there are only curves.
    pub(super) fn texts(&self) -> impl Iterator<Item = &str> {
        self.marks.iter().filter_map(|mark| match mark {
            Mark::Text { text, .. } => Some(text.as_str()),
            _ => None,
        })
    }

    /// A text that reads upwards, its middle at a point.
    pub(super) fn upward_text(&mut self, at: [f64; 2], size: f64, text: &str) {
        let at = at.map(finite);
        self.marks.push(Mark::Text { at, size, anchor: Anchor::Middle, upward: true, text: text.into() });
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], pen: Pen) {
        self.path([Some(from), Some(to)].into_iter(), pen);
    }

    pub(super) fn rect(&mut self, corner: [f64; 2], size: [f64; 2], paint: Paint) {
        self.rounded(corner, size, 0.0, paint);
    }

    /// A rectangle with round corners.
    pub(super) fn rounded(&mut self, corner: [f64; 2], size: [f64; 2], round: f64, paint: Paint) {
        let (corner, size) = (corner.map(finite), size.map(|v| finite(v).max(0.0)));
        self.marks.push(Mark::Shape(Shape::Rect { corner, size, round }, paint));
    }

    pub(super) fn circle(&mut self, at: [f64; 2], radius: f64, paint: Paint) {
        self.marks.push(Mark::Shape(Shape::Circle { at: at.map(finite), radius }, paint));
    }

    /// A line through points; `None` breaks it.
    pub(super) fn path(&mut self, points: impl Iterator<Item = Option<[f64; 2]>>, pen: Pen) {
        let mut lines: Vec<Vec<[f64; 2]>> = vec![vec![]];
        for point in points {
            match (point, lines.last_mut()) {
                (Some(at), Some(line)) => line.push(at.map(finite)),
                _ => lines.push(vec![]),
            }
        }
        lines.retain(|line| !line.is_empty());
        if !lines.is_empty() {
            self.marks.push(Mark::Shape(Shape::Lines(lines), Paint::outline(pen)));
        }
    }

    /// Pixels stretched over a rectangle.
    pub(super) fn image(&mut self, corner: [f64; 2], size: [f64; 2], pixels: Pixels, smooth: bool) {
        self.marks.push(Mark::Image { corner, size, pixels, smooth });
    }

    /// Draws what `draw` draws within a rectangle only.
    pub(super) fn clipped(&mut self, corner: [f64; 2], size: [f64; 2], draw: impl FnOnce(&mut Drawing)) {
        let mut inside = Drawing::default();
        draw(&mut inside);
        self.marks.push(Mark::Clipped { corner, size, marks: inside.marks });
    }
}

/// The colour that "#rgb" or "#rrggbb" means; black for anything else.
pub(super) fn rgb(text: &str) -> Colour {
    let digits: Vec<u8> = text.chars().filter_map(|c| c.to_digit(16)).map(|digit| digit as u8).collect();
    match digits[..] {
        [r, g, b] => [17 * r, 17 * g, 17 * b],
        [r1, r0, g1, g0, b1, b0] => [16 * r1 + r0, 16 * g1 + g0, 16 * b1 + b0],
        _ => [0; 3],
    }
}

/// Numbers that no paper has become 0.
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_in_a_line_breaks_it() {
        let mut drawing = Drawing::default();
        let points =
            [Some([0.0, f64::NAN]), Some([1.0, 2.0]), None, None, Some([3.0, 4.0]), Some([5.0, 6.0])];
        drawing.path(points.into_iter(), Pen::new(INK, 1.0));
        let lines = vec![vec![[0.0, 0.0], [1.0, 2.0]], vec![[3.0, 4.0], [5.0, 6.0]]];
        assert!(matches!(&drawing.marks[..], [Mark::Shape(Shape::Lines(found), _)] if *found == lines));
    }

    #[test]
    fn a_letter_that_the_typeface_lacks_is_a_box() {
        assert_eq!(boxes("contact", [0.0; 2], 10.0, Anchor::Start, false), None);
        let Some(Shape::Lines(found)) = boxes("a接b触", [5.0, 20.0], 10.0, Anchor::Start, false) else {
            panic!("no box")
        };
        assert_eq!(found.len(), 2);
        let before = font::width("a接b", 10.0);
        assert!((found[1][0][0] - (5.0 + before + 10.0 * font::BOX[0])).abs() < 1e-12, "{found:?}");
        assert!(found.iter().flatten().all(|[_, y]| (13.0..=20.0).contains(y)));
    }

    #[test]
    fn colours_have_three_or_six_digits() {
        assert_eq!(rgb("#d55e00"), [0xd5, 0x5e, 0]);
        assert_eq!(rgb("#fa0"), [255, 170, 0]);
        assert_eq!(rgb("blue!"), [0; 3]);
    }
}
