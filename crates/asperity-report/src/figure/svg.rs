//! The drawing that panels write on: points on paper, y downwards.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Text, grey lines, frames.
pub(super) const INK: &str = "#222";
pub(super) const GRID: &str = "#e3e3e3";

/// Where a text hangs on its point.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// The text of an SVG that grows.
#[derive(Default)]
pub(super) struct Drawing {
    body: String,
    clips: usize,
}

impl Drawing {
    /// The whole file, on paper of `width` by `height` points; `title` is read out by screen readers.
    pub(super) fn finish(self, width: f64, height: f64, title: &str, family: &str) -> String {
        let (width, height) = (short(width), short(height));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}pt\" height=\"{height}pt\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"{family}\" fill=\"{INK}\">\n\
             <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}</svg>\n",
            escaped(title),
            self.body
        )
    }

    pub(super) fn text(&mut self, at: [f64; 2], size: f64, anchor: Anchor, style: &str, text: &str) {
        let [x, y] = at.map(short);
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        self.put(format_args!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" {style}>{}</text>\n",
            short(size),
            escaped(text)
        ));
    }

    /// A text that reads upwards.
    pub(super) fn upward_text(&mut self, at: [f64; 2], size: f64, text: &str) {
        let [x, y] = at.map(short);
        let turn = format!("transform=\"rotate(-90 {x} {y})\"");
        self.text(at, size, Anchor::Middle, &turn, text);
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: &str, width: f64, style: &str) {
        let ([x1, y1], [x2, y2]) = (from.map(short), to.map(short));
        self.put(format_args!(
            "<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{stroke}\" stroke-width=\"{}\" {style}/>\n",
            short(width)
        ));
    }

    pub(super) fn rect(&mut self, corner: [f64; 2], size: [f64; 2], style: &str) {
        let ([x, y], [w, h]) = (corner.map(short), size.map(|v| short(v.max(0.0))));
        self.put(format_args!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" {style}/>\n"));
    }

    pub(super) fn circle(&mut self, at: [f64; 2], radius: f64, style: &str) {
        let [x, y] = at.map(short);
        self.put(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" {style}/>\n", short(radius)));
    }

    /// A line through points; `None` breaks it.
    pub(super) fn path(&mut self, points: impl Iterator<Item = Option<[f64; 2]>>, style: &str) {
        let mut data = String::new();
        let mut pen = 'M';
        for point in points {
            match point {
                Some(at) => {
                    let [x, y] = at.map(short);
                    let _ = write!(data, "{pen}{x} {y}");
                    pen = 'L';
                }
                None => pen = 'M',
            }
        }
        if !data.is_empty() {
            self.put(format_args!("<path d=\"{data}\" fill=\"none\" {style}/>\n"));
        }
    }

    /// A picture (PNG) stretched over a rectangle.
    pub(super) fn image(&mut self, corner: [f64; 2], size: [f64; 2], png: &[u8], smooth: bool) {
        let ([x, y], [w, h]) = (corner.map(short), size.map(short));
        let rendering = if smooth { "optimizeQuality" } else { "optimizeSpeed" };
        self.put(format_args!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
             image-rendering=\"{rendering}\" href=\"data:image/png;base64,{}\"/>\n",
            STANDARD.encode(png)
        ));
    }

    /// Draws what `draw` draws within a rectangle only.
    pub(super) fn clipped(&mut self, corner: [f64; 2], size: [f64; 2], draw: impl FnOnce(&mut Drawing)) {
        self.clips += 1;
        let id = self.clips;
        let ([x, y], [w, h]) = (corner.map(short), size.map(short));
        self.put(format_args!(
            "<clipPath id=\"clip{id}\"><rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/></clipPath>\n\
             <g clip-path=\"url(#clip{id})\">\n"
        ));
        draw(self);
        self.put(format_args!("</g>\n"));
    }

    fn put(&mut self, text: std::fmt::Arguments) {
        // Writing to a String cannot fail.
        let _ = self.body.write_fmt(text);
    }
}

/// A number to a hundredth of a point.
fn short(value: f64) -> Short {
    Short(if value.is_finite() { value } else { 0.0 })
}

#[derive(Clone, Copy)]
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{}", (self.0 * 100.0).round() / 100.0 + 0.0)
    }
}

/// A text inside of XML; characters that XML forbids are left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '\n' | '\t' => out.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => {}
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_cannot_break_the_file() {
        assert_eq!(escaped("a<b & c>\u{0}\u{1b}[0m\n"), "a&lt;b &amp; c&gt;[0m ");
        let mut drawing = Drawing::default();
        drawing.text([1.0, f64::NAN], 8.0, Anchor::Start, "", "</svg><script>");
        let svg = drawing.finish(10.0, 10.0, "<&>", "sans-serif");
        assert_eq!(svg.matches("</svg>").count(), 1);
        assert!(!svg.contains("NaN") && !svg.contains("<script>"));
    }

    #[test]
    fn a_gap_in_a_line_lifts_the_pen() {
        let mut drawing = Drawing::default();
        let points = [Some([0.0, 0.004]), Some([1.006, 2.0]), None, Some([3.0, 4.0]), Some([5.0, 6.0])];
        drawing.path(points.into_iter(), "");
        assert!(drawing.body.contains("d=\"M0 0L1.01 2M3 4L5 6\""), "{}", drawing.body);
    }
}
