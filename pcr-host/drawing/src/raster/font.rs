//! Texts as outlines, in a font that is part of the program, so that pictures are the same on every machine. A text engine
//! for all languages would take longer to build than the rest of the drawing code.

use super::style::number;
use roxmltree::Node;
use std::collections::BTreeSet;
use std::io;
use tiny_skia::PathBuilder;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

static FONT: &[u8] = include_bytes!("../font/DejaVuSans-subset.ttf");

/// The font.
///
/// # Errors
/// Those of its reader.
pub(super) fn face() -> io::Result<Face<'static>> {
    Face::parse(FONT, 0).map_err(io::Error::other)
}

/// The letters of a picture that the font does not have: they are boxes as PNG.
pub(crate) fn boxes(svg: &[u8]) -> BTreeSet<char> {
    let (Ok(text), Ok(face)) = (std::str::from_utf8(svg), face()) else { return BTreeSet::new() };
    // All that is printed of ASCII is in the font.
    text.chars().filter(|letter| !letter.is_ascii() && face.glyph_index(*letter).is_none()).collect()
}

/// Adds the outlines of the letters of a text of this size \[px\]; `None` if it is not known where they are.
pub(super) fn outline(face: &Face<'_>, text: Node<'_, '_>, size: f64, to: &mut PathBuilder) -> Option<()> {
    let scale = size / f64::from(face.units_per_em());
    let letters = text.text().unwrap_or_default().chars();
    // The first glyph is a box.
    let glyphs: Vec<GlyphId> = letters.map(|letter| face.glyph_index(letter).unwrap_or_default()).collect();
    let advance = |&glyph: &GlyphId| scale * f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    let width: f64 = glyphs.iter().map(advance).sum();
    let before = match text.attribute("text-anchor") {
        None => 0.0,
        Some("middle") => width / 2.0,
        Some("end") => width,
        Some(_) => return None,
    };
    let [x, y] = [number(text.attribute("x")?)?, number(text.attribute("y")?)?].map(f64::from);
    let mut pen = Pen { x: x - before, y, scale, to };
    for glyph in &glyphs {
        face.outline_glyph(*glyph, &mut pen);
        pen.x += advance(glyph);
    }
    Some(())
}

/// Draws glyphs from a point of the base line on.
struct Pen<'p> {
    x: f64,
    y: f64,
    scale: f64,
    to: &'p mut PathBuilder,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        ((self.x + self.scale * f64::from(x)) as f32, (self.y - self.scale * f64::from(y)) as f32)
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.to.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.to.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.to.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.to.cubic_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.to.close();
    }
}
