//! Draws text as outlines, in a font that is part of the program, so that pictures are the same on every machine. A
//! text engine for all languages would take longer to build than the rest of the drawing code.

use crate::svg::{Escaped, Pixels};
use roxmltree::{Document, Node};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

static FONT: &[u8] = include_bytes!("../font/DejaVuSans-subset.ttf");

/// The letters of a picture that the font does not have: they are boxes as PNG.
pub(crate) fn boxes(svg: &[u8]) -> BTreeSet<char> {
    let (Ok(text), Ok(face)) = (std::str::from_utf8(svg), Face::parse(FONT, 0)) else { return BTreeSet::new() };
    // All that is printed of ASCII is in the font.
    text.chars().filter(|letter| !letter.is_ascii() && face.glyph_index(*letter).is_none()).collect()
}

/// Size of texts for which nothing says it \[px\].
const SIZE: f64 = 12.0;

/// Attributes that a text has and its outline has not.
const OF_TEXTS: [&str; 4] = ["x", "y", "text-anchor", "font-size"];

/// The picture with a `path` in place of each `text`.
///
/// # Errors
/// For what is no SVG.
pub(super) fn outlined(svg: &str) -> io::Result<String> {
    let face = Face::parse(FONT, 0).map_err(io::Error::other)?;
    let document = Document::parse(svg).map_err(io::Error::other)?;
    let (mut outlined, mut done) = (String::with_capacity(svg.len()), 0);
    for text in document.descendants().filter(|node| node.has_tag_name("text")) {
        let range = text.range();
        outlined.push_str(svg.get(done..range.start).unwrap_or_default());
        outlined.push_str("<path");
        for attribute in text.attributes().filter(|attribute| !OF_TEXTS.contains(&attribute.name())) {
            // Writing to a string does not fail.
            let _ = write!(outlined, " {}=\"{}\"", attribute.name(), Escaped(attribute.value()));
        }
        let _ = write!(outlined, " d=\"{}\"/>", outline(&face, text));
        done = range.end;
    }
    outlined.push_str(svg.get(done..).unwrap_or_default());
    Ok(outlined)
}

/// Path data of a text.
fn outline(face: &Face<'_>, text: Node<'_, '_>) -> String {
    let number = |name| text.attribute(name).and_then(|value| value.parse::<f64>().ok());
    let size = text.ancestors().find_map(|node| node.attribute("font-size")?.parse().ok()).unwrap_or(SIZE);
    let scale = size / f64::from(face.units_per_em());
    let letters = text.text().unwrap_or_default().chars();
    // The first glyph is a box.
    let glyphs: Vec<GlyphId> = letters.map(|letter| face.glyph_index(letter).unwrap_or_default()).collect();
    let advance = |&glyph: &GlyphId| scale * f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    let width: f64 = glyphs.iter().map(advance).sum();
    let before = match text.attribute("text-anchor") {
        Some("middle") => width / 2.0,
        Some("end") => width,
        _ => 0.0,
    };
    let (x, y) = (number("x").unwrap_or(0.0) - before, number("y").unwrap_or(0.0));
    let mut pen = Pen { x, y, scale, data: String::new() };
    for glyph in &glyphs {
        face.outline_glyph(*glyph, &mut pen);
        pen.x += advance(glyph);
    }
    pen.data
}

/// Writes glyphs from a point of the base line on.
struct Pen {
    x: f64,
    y: f64,
    scale: f64,
    data: String,
}

impl Pen {
    fn command(&mut self, letter: char, points: &[[f32; 2]]) {
        self.data.push(letter);
        for [x, y] in points {
            let at = [self.x + self.scale * f64::from(*x), self.y - self.scale * f64::from(*y)];
            // Writing to a string does not fail.
            let _ = write!(self.data, "{} {} ", Pixels(at[0]), Pixels(at[1]));
        }
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.command('M', &[[x, y]]);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.command('L', &[[x, y]]);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.command('Q', &[[x1, y1], [x, y]]);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.command('C', &[[x1, y1], [x2, y2], [x, y]]);
    }
    fn close(&mut self) {
        self.data.push('Z');
    }
}
