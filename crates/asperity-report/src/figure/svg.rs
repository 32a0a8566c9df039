//! A drawing as SVG.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::drawing::{Anchor, Colour, Drawing, INK, Mark, Paint, Shape};
use super::font::FAMILY;
use super::raster;

/// The whole file, on paper of this width and height \[points\], where the drawing is so many times as large; `title` is read out
/// by screen readers.
pub(super) fn write(drawing: &Drawing, paper: [f64; 2], zoom: f64, title: &str) -> String {
    let [width, height] = paper.map(short);
    let [across, down] = paper.map(|side| short(side / zoom));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}pt\" height=\"{height}pt\" \
         viewBox=\"0 0 {across} {down}\" role=\"img\" font-family=\"{FAMILY}\" fill=\"{INK}\">\n\
         <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        escaped(title)
    );
    // Writing to a String cannot fail.
    let _ = marks(&mut out, &drawing.marks, &mut 0);
    out.push_str("</svg>\n");
    out
}

fn marks(out: &mut String, list: &[Mark], clips: &mut usize) -> std::fmt::Result {
    for mark in list {
        match mark {
            Mark::Shape(shape, paint) => outline(out, shape, paint)?,
            Mark::Text { at, size, anchor, upward, text } => {
                let [x, y] = at.map(short);
                let anchor = match anchor {
                    Anchor::Start => "start",
                    Anchor::Middle => "middle",
                    Anchor::End => "end",
                };
                let turn =
                    if *upward { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
                writeln!(
                    out,
                    "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\"{turn}>{}</text>",
                    short(*size),
                    escaped(text)
                )?;
            }
            Mark::Image { corner, size, pixels, smooth } => {
                let ([x, y], [w, h]) = (corner.map(short), size.map(short));
                let rendering = if *smooth { "auto" } else { "pixelated" };
                writeln!(
                    out,
                    "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" \
                     style=\"image-rendering:{rendering}\" href=\"data:image/png;base64,{}\"/>",
                    STANDARD.encode(raster::png(pixels).unwrap_or_default())
                )?;
            }
            Mark::Clipped { corner, size, marks: inside } => {
                *clips += 1;
                let ([x, y], [w, h]) = (corner.map(short), size.map(short));
                writeln!(
                    out,
                    "<clipPath id=\"clip{clips}\"><rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/></clipPath>\n\
                     <g clip-path=\"url(#clip{clips})\">"
                )?;
                marks(out, inside, clips)?;
                out.push_str("</g>\n");
            }
        }
    }
    Ok(())
}

fn outline(out: &mut String, shape: &Shape, paint: &Paint) -> std::fmt::Result {
    match shape {
        Shape::Rect { corner, size, round } => {
            let ([x, y], [w, h]) = (corner.map(short), size.map(short));
            write!(out, "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"")?;
            if *round > 0.0 {
                write!(out, " rx=\"{}\"", short(*round))?;
            }
        }
        Shape::Circle { at, radius } => {
            let [x, y] = at.map(short);
            write!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\"", short(*radius))?;
        }
        Shape::Lines(lines) => {
            out.push_str("<path d=\"");
            for line in lines {
                for (n, at) in line.iter().enumerate() {
                    let [x, y] = at.map(short);
                    write!(out, "{}{x} {y}", if n == 0 { 'M' } else { 'L' })?;
                }
            }
            out.push_str("\" stroke-linejoin=\"round\"");
        }
    }
    match paint.fill {
        None => out.push_str(" fill=\"none\""),
        Some((colour, opacity)) => {
            write!(out, " fill=\"{}\"", hex(colour))?;
            if opacity < 1.0 {
                write!(out, " fill-opacity=\"{}\"", short(opacity))?;
            }
        }
    }
    if let Some(pen) = paint.pen {
        write!(out, " stroke=\"{}\" stroke-width=\"{}\"", hex(pen.colour), short(pen.width))?;
        if !pen.dashes.is_empty() {
            let dashes: Vec<String> = pen.dashes.iter().map(|length| short(*length).to_string()).collect();
            write!(out, " stroke-dasharray=\"{}\"", dashes.join(" "))?;
        }
    }
    out.push_str("/>\n");
    Ok(())
}

fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// A number to a hundredth.
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
        drawing.text([1.0, f64::NAN], 8.0, Anchor::Start, "</svg><script>");
        let svg = write(&drawing, [10.0, 10.0], 1.0, "<&>");
        assert_eq!(svg.matches("</svg>").count(), 1);
        assert!(!svg.contains("NaN") && !svg.contains("<script>"));
    }

    #[test]
    fn numbers_have_two_decimals() {
        let mut drawing = Drawing::default();
        let pen = super::super::drawing::Pen::new("#d55e00", 0.9).dashed(&[5.0, 2.5]);
        drawing.path([Some([0.0, 0.004]), Some([1.006, 2.0])].into_iter(), pen);
        let svg = write(&drawing, [10.0, 10.0], 1.0, "");
        let path = "<path d=\"M0 0L1.01 2\" stroke-linejoin=\"round\" fill=\"none\" stroke=\"#d55e00\" \
                    stroke-width=\"0.9\" stroke-dasharray=\"5 2.5\"/>";
        assert!(svg.contains(path), "{svg}");
    }
}
