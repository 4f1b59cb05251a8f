//! A small writer of SVG. It closes elements, escapes texts, and writes finite and short numbers.

use pcr_formats::scenario::controls;
use std::fmt::{self, Display, Write as _};

/// Decimals of a coordinate \[px\]: a hundredth of a pixel is below what any screen or printer resolves.
const DECIMALS: usize = 2;

/// Font of all texts. The PNG pictures hold the first one; the second has the same widths.
pub(super) const FONT: &str = "DejaVu Sans, Verdana, sans-serif";

/// A text as XML writes it. Characters that XML 1.0 does not know, or that would change the direction of text, become U+FFFD.
pub(crate) struct XmlEscaped<'a>(pub(crate) &'a str);

impl Display for XmlEscaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for character in self.0.chars() {
            match character {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\'' => f.write_str("&#39;")?,
                '\t' | '\n' | '\r' => f.write_char(' ')?,
                '\u{fffe}' | '\u{ffff}' => f.write_char(char::REPLACEMENT_CHARACTER)?,
                control if controls(control) => f.write_char(char::REPLACEMENT_CHARACTER)?,
                other => f.write_char(other)?,
            }
        }
        Ok(())
    }
}

/// A coordinate \[px\] with [`DECIMALS`] decimals at most. What is not finite is written as 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelCoordinate(pub(super) f64);

impl Display for PixelCoordinate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = if self.0.is_finite() { self.0 } else { 0.0 };
        let text = format!("{value:.DECIMALS$}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        f.write_str(if text == "-0" { "0" } else { text })
    }
}

/// An attribute and its value.
pub(super) type Attribute<'a> = (&'a str, &'a dyn Display);

/// A picture in the making.
#[derive(Debug)]
pub(super) struct SvgWriter {
    text: String,
    open: Vec<&'static str>,
}

impl SvgWriter {
    /// An empty picture of this size \[px\], rounded up to whole pixels, on white.
    pub(super) fn new(width: f64, height: f64, title: &str) -> Self {
        let (width, height) = (width.ceil(), height.ceil());
        let mut svg = Self { text: String::new(), open: Vec::new() };
        svg.start(
            "svg",
            &[
                ("xmlns", &"http://www.w3.org/2000/svg"),
                ("width", &PixelCoordinate(width)),
                ("height", &PixelCoordinate(height)),
                ("viewBox", &format_args!("0 0 {} {}", PixelCoordinate(width), PixelCoordinate(height))),
                ("font-family", &FONT),
                ("role", &"img"),
            ],
        );
        svg.start("title", &[]);
        svg.characters(title);
        svg.end();
        svg.empty("rect", &[("width", &"100%"), ("height", &"100%"), ("fill", &"#fff")]);
        svg
    }

    /// Opens an element.
    pub(super) fn start(&mut self, name: &'static str, attributes: &[Attribute<'_>]) {
        self.tag(name, attributes, ">");
        self.open.push(name);
    }

    /// Closes the element that was opened last.
    pub(super) fn end(&mut self) {
        if let Some(name) = self.open.pop() {
            self.text.extend(["</", name, ">\n"]);
        }
    }

    /// An element without content.
    pub(super) fn empty(&mut self, name: &'static str, attributes: &[Attribute<'_>]) {
        self.tag(name, attributes, "/>\n");
    }

    /// A text that starts, is centred or ends at a point of its base line, as `anchor` says.
    pub(super) fn label(&mut self, [x, y]: [f64; 2], anchor: &str, more: &[Attribute<'_>], content: &str) {
        let (x, y) = (PixelCoordinate(x), PixelCoordinate(y));
        let mut attributes: Vec<Attribute<'_>> = vec![("x", &x), ("y", &y)];
        if anchor != "start" {
            attributes.push(("text-anchor", &anchor));
        }
        attributes.extend_from_slice(more);
        self.start("text", &attributes);
        self.characters(content);
        self.end();
    }

    /// The text of the open element.
    pub(super) fn characters(&mut self, content: &str) {
        self.text.push_str(&XmlEscaped(content).to_string());
    }

    /// The finished picture.
    pub(super) fn finish(mut self) -> String {
        while !self.open.is_empty() {
            self.end();
        }
        self.text
    }

    fn tag(&mut self, name: &str, attributes: &[Attribute<'_>], end: &str) {
        self.text.extend(["<", name]);
        for (name, value) in attributes {
            self.text.extend([" ", name, "=\"", &XmlEscaped(&value.to_string()).to_string(), "\""]);
        }
        self.text.push_str(end);
    }
}

/// Data of a `path` element \[px\].
#[derive(Clone, Debug, Default)]
pub(super) struct PathData(String);

impl PathData {
    /// Whether nothing was drawn.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn command(&mut self, letter: char, numbers: &[f64]) {
        self.0.push(letter);
        for (k, number) in numbers.iter().enumerate() {
            if k > 0 {
                self.0.push(' ');
            }
            self.0.push_str(&PixelCoordinate(*number).to_string());
        }
    }

    /// Begins a subpath.
    pub(super) fn move_to(&mut self, [x, y]: [f64; 2]) {
        self.command('M', &[x, y]);
    }

    /// A straight line.
    pub(super) fn line_to(&mut self, [x, y]: [f64; 2]) {
        self.command('L', &[x, y]);
    }

    /// An arc of at most half a turn; `sweep` is clockwise on the screen.
    pub(super) fn arc_to(&mut self, radius: f64, sweep: bool, [x, y]: [f64; 2]) {
        self.command('A', &[radius, radius, 0.0, 0.0, f64::from(u8::from(sweep)), x, y]);
    }

    /// A parabola with this control point.
    pub(super) fn parabola_to(&mut self, [cx, cy]: [f64; 2], [x, y]: [f64; 2]) {
        self.command('Q', &[cx, cy, x, y]);
    }

    /// The head of an arrow at a point, for this heading with y up \[rad\].
    pub(super) fn arrow(&mut self, [x, y]: [f64; 2], heading: f64) {
        let (sin, cos) = heading.sin_cos();
        let point = |along: f64, across: f64| [x + along * cos - across * sin, y - along * sin - across * cos];
        self.polygon([point(4.2, 0.0), point(-3.0, 2.7), point(-1.8, 0.0), point(-3.0, -2.7)]);
    }

    /// A closed polygon.
    pub(super) fn polygon(&mut self, points: impl IntoIterator<Item = [f64; 2]>) {
        for (k, point) in points.into_iter().enumerate() {
            if k == 0 { self.move_to(point) } else { self.line_to(point) }
        }
        self.0.push('Z');
    }
}

impl Display for PathData {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Width of a text \[px\], a little more rather than less: the font's mean letter, its digits being wider.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    let wide = |character: char| match character {
        '.' | ',' | ' ' | 'i' | 'j' | 'l' => 0.32,
        'a'..='z' => 0.6,
        '0'..='9' => 0.64,
        // Capitals as wide as they are high, and signs of East Asia.
        'M' | 'W' | '%' | '@' | '\u{1100}'..='\u{11ff}' | '\u{2e80}'.. => 1.0,
        _ => 0.72,
    };
    text.chars().map(wide).sum::<f64>() * size
}

/// The text, cut behind as many characters as there is width for \[px\].
pub(super) fn cut(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let mut short = text.to_owned();
    while short.pop().is_some() {
        let whole = format!("{}…", short.trim_end());
        if text_width(&whole, size) <= width {
            return whole;
        }
    }
    String::new()
}

/// A name with what stands before and after it, in this width \[px\]: the name is cut first, as it is known elsewhere.
pub(super) fn cut_name([before, name, after]: [&str; 3], size: f64, width: f64) -> String {
    let name = cut(name, size, width - text_width(before, size) - text_width(after, size));
    cut(&format!("{before}{name}{after}"), size, width)
}

/// The text in lines of this width \[px\]; words are kept whole.
pub(super) fn lines(text: &str, size: f64, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), size) <= width => line.extend([" ", word]),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_and_attributes_are_escaped() {
        let mut svg = SvgWriter::new(10.0, 10.0, "a < b & \"c\" \u{1} ]]>");
        svg.label([1.0, 2.0], "middle", &[("class", &"\"<'&")], "1 < 2 & 3 > 2");
        let text = svg.finish();
        let document = roxmltree::Document::parse(&text).unwrap();
        let content = |name| document.descendants().find(|node| node.has_tag_name(name)).unwrap();
        assert_eq!(content("title").text(), Some("a < b & \"c\" \u{fffd} ]]>"));
        assert_eq!(content("text").text(), Some("1 < 2 & 3 > 2"));
        assert_eq!(content("text").attribute("class"), Some("\"<'&"));
    }

    #[test]
    fn elements_that_were_left_open_are_closed() {
        let mut svg = SvgWriter::new(10.0, 10.0, "");
        svg.start("g", &[]);
        assert!(roxmltree::Document::parse(&svg.finish()).is_ok());
    }

    #[test]
    fn names_are_cut_to_their_width() {
        let whole = ["Map of agent ", "7 AGV-2024-0007", ": 3 regions"];
        assert_eq!(cut_name(whole, 10.0, 400.0), whole.concat());
        let short = cut_name(whole, 10.0, 200.0);
        assert!(short.starts_with("Map of agent 7 A") && short.ends_with("…: 3 regions"), "{short}");
        assert!(text_width(&short, 10.0) <= 200.0);
        let shorter = cut_name(whole, 10.0, 60.0);
        assert!(
            shorter.starts_with("Map of") && shorter.ends_with('…') && text_width(&shorter, 10.0) <= 60.0,
            "{shorter}"
        );
        assert_eq!((cut("é漢字", 10.0, 5.0), cut("", 10.0, 5.0)), (String::new(), String::new()));
    }

    #[test]
    fn lines_keep_words_whole() {
        assert_eq!(lines("one two  three", 10.0, 45.0), ["one two", "three"]);
        assert_eq!(lines("", 10.0, 45.0), [""; 0]);
    }

    #[test]
    fn numbers_are_short_and_finite() {
        let written =
            [1.0, -0.001, 0.125, 1e6, f64::NAN, f64::INFINITY, -12.5].map(|value| PixelCoordinate(value).to_string());
        assert_eq!(written, ["1", "0", "0.12", "1000000", "0", "0", "-12.5"]);
    }
}
