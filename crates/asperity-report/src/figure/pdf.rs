//! A drawing as a PDF of one page (ISO 32000). Texts are texts, in the typeface of the figures, which is in the file.

use std::collections::BTreeMap;
use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use tiny_skia::{Path, PathSegment};

use super::drawing::{Anchor, BOXES, Colour, Drawing, INK, Mark, Paint, Pixels, Shape, boxes, rgb};
use super::font;

/// The typeface's name in the file and in its resources.
const TYPEFACE: Name = Name(b"DejaVuSans");
const FACE: Name = Name(b"F");
const GLYPHS: SystemInfo = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// The file, of a page of this width and height \[points\]; the drawing is so many times as large on it.
pub(super) fn write(drawing: &Drawing, paper: [f64; 2], zoom: f64, title: &str) -> std::io::Result<Vec<u8>> {
    let mut page =
        Page { content: Content::new(), images: vec![], opacities: vec![], glyphs: BTreeMap::new() };
    // From here on y points downwards.
    page.content.transform([zoom as f32, 0.0, 0.0, -zoom as f32, 0.0, paper[1] as f32]);
    page.marks(&drawing.marks);
    file(page, paper, title)
}

/// What is written so far, and what it needs.
struct Page<'a> {
    content: Content,
    images: Vec<(&'a Pixels, bool)>,
    /// In hundredths.
    opacities: Vec<u8>,
    /// The glyphs and what they mean.
    glyphs: BTreeMap<u16, char>,
}

impl<'a> Page<'a> {
    fn marks(&mut self, list: &'a [Mark]) {
        for mark in list {
            match mark {
                Mark::Shape(shape, paint) => self.shape(shape, paint),
                Mark::Text { at, size, anchor, upward, text } => {
                    self.text(text, *at, *size, *anchor, *upward);
                    if let Some(shape) = boxes(text, *at, *size, *anchor, *upward) {
                        self.shape(&shape, &Paint::outline(BOXES));
                    }
                }
                Mark::Image { corner, size, pixels, smooth } => {
                    let [x, y, w, h] = [corner[0], corner[1] + size[1], size[0], size[1]].map(|v| v as f32);
                    self.content.save_state().transform([w, 0.0, 0.0, -h, x, y]);
                    self.content.x_object(Name(format!("I{}", self.images.len()).as_bytes()));
                    self.content.restore_state();
                    self.images.push((pixels, *smooth));
                }
                Mark::Clipped { corner, size, marks } => {
                    let [x, y, w, h] = [corner[0], corner[1], size[0], size[1]].map(|v| v as f32);
                    self.content.save_state().rect(x, y, w, h).clip_nonzero().end_path();
                    self.marks(marks);
                    self.content.restore_state();
                }
            }
        }
    }

    fn shape(&mut self, shape: &Shape, paint: &Paint) {
        self.content.save_state();
        if let Some((colour, opacity)) = paint.fill {
            self.opacity(opacity);
            fill(&mut self.content, colour);
        }
        if let Some(pen) = paint.pen {
            let [r, g, b] = pen.colour.map(|v| f32::from(v) / 255.0);
            self.content.set_stroke_rgb(r, g, b).set_line_width(pen.width as f32);
            self.content.set_line_join(LineJoinStyle::RoundJoin);
            self.content.set_dash_pattern(pen.dashes.iter().map(|length| *length as f32), 0.0);
        }
        outline(&mut self.content, shape);
        match (paint.fill, paint.pen) {
            (Some(_), Some(_)) => self.content.fill_nonzero_and_stroke(),
            (Some(_), None) => self.content.fill_nonzero(),
            (None, Some(_)) => self.content.stroke(),
            (None, None) => self.content.end_path(),
        };
        self.content.restore_state();
    }

    fn opacity(&mut self, opacity: f64) {
        let hundredths = (100.0 * opacity).round().clamp(0.0, 100.0) as u8;
        if hundredths < 100 {
            if !self.opacities.contains(&hundredths) {
                self.opacities.push(hundredths);
            }
            self.content.set_parameters(Name(format!("O{hundredths}").as_bytes()));
        }
    }

    fn text(&mut self, text: &str, [x, y]: [f64; 2], size: f64, anchor: Anchor, upward: bool) {
        let mut codes = Vec::with_capacity(2 * text.len());
        for (c, (glyph, _)) in text.chars().zip(font::letters(text)) {
            codes.extend(glyph.to_be_bytes());
            self.glyphs.insert(glyph, c);
        }
        let start = anchor.start(text, size);
        let matrix = match upward {
            false => [1.0, 0.0, 0.0, -1.0, x + start, y],
            true => [0.0, -1.0, -1.0, 0.0, x, y - start],
        };
        fill(&mut self.content, rgb(INK));
        self.content.begin_text().set_font(FACE, size as f32);
        self.content.set_text_matrix(matrix.map(|v| v as f32)).show(Str(&codes)).end_text();
    }
}

fn fill(content: &mut Content, colour: Colour) {
    let [r, g, b] = colour.map(|v| f32::from(v) / 255.0);
    content.set_fill_rgb(r, g, b);
}

fn outline(content: &mut Content, shape: &Shape) {
    for segment in shape.outline().iter().flat_map(Path::segments) {
        match segment {
            PathSegment::MoveTo(at) => content.move_to(at.x, at.y),
            PathSegment::LineTo(at) => content.line_to(at.x, at.y),
            PathSegment::CubicTo(a, b, to) => content.cubic_to(a.x, a.y, b.x, b.y, to.x, to.y),
            PathSegment::Close => content.close_path(),
            // No shape has a parabola.
            PathSegment::QuadTo(..) => content,
        };
    }
}

/// The page with everything that it needs.
fn file(page: Page, paper: [f64; 2], title: &str) -> std::io::Result<Vec<u8>> {
    let mut pdf = Pdf::new();
    let mut last = 0;
    let mut next = || {
        last += 1;
        Ref::new(last)
    };
    let [catalog, pages, leaf, content, info] = [(); 5].map(|()| next());
    let [face, glyphs, descriptor, data, meaning] = [(); 5].map(|()| next());
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([leaf]).count(1);
    pdf.document_info(info).title(TextStr(title)).creator(TextStr("asperity"));

    let images: Vec<(Ref, &Pixels, bool)> =
        page.images.iter().map(|(pixels, smooth)| (next(), *pixels, *smooth)).collect();
    let opacities: Vec<(Ref, u8)> = page.opacities.iter().map(|opacity| (next(), *opacity)).collect();
    let mut one = pdf.page(leaf);
    one.media_box(Rect::new(0.0, 0.0, paper[0] as f32, paper[1] as f32)).parent(pages).contents(content);
    let mut resources = one.resources();
    resources.fonts().pair(FACE, face);
    let mut names = resources.x_objects();
    for (n, (id, ..)) in images.iter().enumerate() {
        names.pair(Name(format!("I{n}").as_bytes()), *id);
    }
    names.finish();
    let mut names = resources.ext_g_states();
    for (id, opacity) in &opacities {
        names.pair(Name(format!("O{opacity}").as_bytes()), *id);
    }
    names.finish();
    resources.finish();
    one.finish();

    pdf.stream(content, &compressed(page.content.finish().as_slice())?).filter(Filter::FlateDecode);
    for (id, opacity) in opacities {
        pdf.ext_graphics(id).non_stroking_alpha(f32::from(opacity) / 100.0);
    }
    for (id, pixels, smooth) in images {
        let rgb = compressed(&pixels.rgb)?;
        let mut image = pdf.image_xobject(id, &rgb);
        let [columns, rows] = pixels.size.map(|n| i32::try_from(n).unwrap_or(i32::MAX));
        image.filter(Filter::FlateDecode);
        image.width(columns).height(rows).bits_per_component(8);
        image.color_space().device_rgb();
        image.interpolate(smooth);
    }

    pdf.type0_font(face)
        .base_font(TYPEFACE)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(glyphs)
        .to_unicode(meaning);
    let mut font = pdf.cid_font(glyphs);
    font.subtype(CidFontType::Type2).base_font(TYPEFACE).system_info(GLYPHS).font_descriptor(descriptor);
    font.cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = font.widths();
    for glyph in page.glyphs.keys() {
        // In thousandths of an em.
        widths.consecutive(*glyph, [(1000.0 * font::advance(*glyph)) as f32]);
    }
    widths.finish();
    font.finish();
    // Its box, ascent, descent, height of capitals and breadth of stems, from the tables of the typeface.
    pdf.font_descriptor(descriptor)
        .name(TYPEFACE)
        .flags(FontFlags::NON_SYMBOLIC)
        .bbox(Rect::new(-1021.0, -463.0, 1794.0, 1233.0))
        .italic_angle(0.0)
        .ascent(928.0)
        .descent(-236.0)
        .cap_height(729.0)
        .stem_v(90.0)
        .font_file2(data);
    pdf.stream(data, &compressed(font::DATA)?)
        .filter(Filter::FlateDecode)
        .pair(Name(b"Length1"), i32::try_from(font::DATA.len()).unwrap_or(i32::MAX));
    let mut codes = UnicodeCmap::new(Name(b"Custom"), GLYPHS);
    page.glyphs
        .iter()
        .filter(|(glyph, _)| **glyph != font::LACKING)
        .for_each(|(glyph, c)| codes.pair(*glyph, *c));
    pdf.cmap(meaning, codes.finish().as_slice());
    Ok(pdf.finish())
}

fn compressed(data: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut out = ZlibEncoder::new(Vec::new(), Compression::default());
    out.write_all(data)?;
    out.finish()
}
