//! A drawing as dots.

use tiny_skia::{
    Color, FillRule, FilterQuality, LineJoin, Mask, Paint as Brush, Path, PathBuilder, Pixmap, PixmapPaint,
    Stroke, StrokeDash, Transform,
};

use super::drawing::{BOXES, Colour, Drawing, INK, Mark, Paint, Pen, Pixels, Shape, boxes};
use super::font;

/// White paper of so many dots, of `scale` dots to a point, with the drawing; `None` where the paper has no area.
pub(super) fn draw(drawing: &Drawing, [width, height]: [u32; 2], scale: f64) -> Option<Pixels> {
    let mut paper = Pixmap::new(width, height)?;
    paper.fill(Color::WHITE);
    let scale = Transform::from_scale(scale as f32, scale as f32);
    Canvas { paper: &mut paper, scale, mask: None }.marks(&drawing.marks);
    // Nothing is transparent: the paper is white.
    let rgb = paper.data().chunks_exact(4).flat_map(|dot| [dot[0], dot[1], dot[2]]).collect();
    Some(Pixels { size: [width as usize, height as usize], rgb })
}

/// Where is drawn: paper, how points become dots, and what hides the dots outside of a frame.
struct Canvas<'a> {
    paper: &'a mut Pixmap,
    scale: Transform,
    mask: Option<&'a Mask>,
}

impl Canvas<'_> {
    fn marks(&mut self, list: &[Mark]) {
        for mark in list {
            match mark {
                Mark::Shape(shape, paint) => self.shape(shape.outline(), paint),
                Mark::Text { at, size, anchor, upward, text } => {
                    self.text(text, [*size, anchor.start(text, *size)], *at, *upward);
                    let boxes = boxes(text, *at, *size, *anchor, *upward).and_then(|boxes| boxes.outline());
                    self.shape(boxes, &Paint::outline(BOXES));
                }
                Mark::Image { corner, size, pixels, smooth } => self.image(pixels, *corner, *size, *smooth),
                Mark::Clipped { corner, size, marks } => {
                    let frame = Shape::Rect { corner: *corner, size: *size, round: 0.0 }.outline();
                    let mask = Mask::new(self.paper.width(), self.paper.height());
                    let Some((frame, mut mask)) = frame.zip(mask) else { continue };
                    mask.fill_path(&frame, FillRule::Winding, true, self.scale);
                    Canvas { paper: &mut *self.paper, scale: self.scale, mask: Some(&mask) }.marks(marks);
                }
            }
        }
    }

    fn shape(&mut self, path: Option<Path>, paint: &Paint) {
        let Some(path) = path else { return };
        if let Some((colour, opacity)) = paint.fill {
            let brush = brush(colour, opacity);
            self.paper.fill_path(&path, &brush, FillRule::Winding, self.scale, self.mask);
        }
        // A path whose points are all the same has no line.
        let is_point = path.bounds().width() == 0.0 && path.bounds().height() == 0.0;
        if let Some(Pen { colour, width, dashes }) = paint.pen.filter(|_| !is_point) {
            let dash = StrokeDash::new(dashes.iter().map(|length| *length as f32).collect(), 0.0);
            let stroke =
                Stroke { width: width as f32, line_join: LineJoin::Round, dash, ..Stroke::default() };
            self.paper.stroke_path(&path, &brush(colour, 1.0), &stroke, self.scale, self.mask);
        }
    }

    /// A text of a `size` that starts `start` points beyond its point.
    fn text(&mut self, text: &str, [size, start]: [f64; 2], [x, y]: [f64; 2], upward: bool) {
        let mut path = PathBuilder::new();
        let unit = size / font::EM;
        let mut right = start;
        for (glyph, advance) in font::letters(text) {
            // Letters stand on their line, y upwards; a text that reads upwards is turned about its point.
            let to = |[u, v]: [f64; 2]| {
                let (along, up) = (right + unit * u, unit * v);
                let [x, y] = if upward { [x - up, y - along] } else { [x + along, y - up] };
                [x as f32, y as f32]
            };
            font::outline(&mut path, glyph, &to);
            right += size * advance;
        }
        self.shape(path.finish(), &Paint::fill(INK, 1.0));
    }

    fn image(&mut self, pixels: &Pixels, corner: [f64; 2], size: [f64; 2], smooth: bool) {
        let [columns, rows] = pixels.size;
        let side = |n: usize| u32::try_from(n).unwrap_or(0);
        let Some(mut picture) = Pixmap::new(side(columns), side(rows)) else { return };
        for (to, from) in picture.data_mut().chunks_exact_mut(4).zip(pixels.rgb.chunks_exact(3)) {
            to.copy_from_slice(&[from[0], from[1], from[2], 255]);
        }
        let quality = if smooth { FilterQuality::Bicubic } else { FilterQuality::Nearest };
        let paint = PixmapPaint { quality, ..PixmapPaint::default() };
        let [w, h] = [size[0] / columns as f64, size[1] / rows as f64].map(|v| v as f32);
        let place = Transform::from_translate(corner[0] as f32, corner[1] as f32).pre_scale(w, h);
        self.paper.draw_pixmap(0, 0, picture.as_ref(), &paint, place.post_concat(self.scale), self.mask);
    }
}

fn brush(colour: Colour, opacity: f64) -> Brush<'static> {
    let [r, g, b] = colour;
    let mut brush = Brush { anti_alias: true, ..Brush::default() };
    brush.set_color_rgba8(r, g, b, (255.0 * opacity).round() as u8);
    brush
}
