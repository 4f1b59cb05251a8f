//! Attributes that say how an element looks. What the writer of SVG does not write is `None`.

use super::refused;
use roxmltree::Node;
use std::io;
use tiny_skia::{LineCap, LineJoin, Stroke, StrokeDash, Transform};

/// What an area or a line is filled with.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fill<'d> {
    Nothing,
    Colour([u8; 3]),
    /// The pattern of this name.
    Pattern(&'d str),
}

/// How an element looks.
#[derive(Clone, Debug)]
pub(super) struct Style<'d> {
    pub(super) fill: Fill<'d>,
    pub(super) fill_opacity: f32,
    pub(super) stroke: Fill<'d>,
    pub(super) stroke_opacity: f32,
    /// Width 0 for none.
    pub(super) line: Stroke,
    /// Whether the stroke lies below what is filled.
    pub(super) stroke_first: bool,
    /// \[px\]
    pub(super) font_size: f64,
    /// Of the element as a whole: what is in it does not inherit it.
    pub(super) opacity: f32,
    /// Into the coordinates around it, in the same way.
    pub(super) transform: Transform,
}

/// What SVG takes for what nobody says.
impl Default for Style<'_> {
    fn default() -> Self {
        Self {
            fill: Fill::Colour([0; 3]),
            fill_opacity: 1.0,
            stroke: Fill::Nothing,
            stroke_opacity: 1.0,
            line: Stroke::default(),
            stroke_first: false,
            font_size: 12.0,
            opacity: 1.0,
            transform: Transform::identity(),
        }
    }
}

impl<'d> Style<'d> {
    /// The style of an element within one of this style.
    ///
    /// # Errors
    /// For an element, an attribute or a value that is not known.
    pub(super) fn within(&self, node: Node<'d, '_>) -> io::Result<Self> {
        let geometry = geometry(node.tag_name().name()).ok_or_else(|| refused(node, "such an element"))?;
        let mut style = Self { opacity: 1.0, transform: Transform::identity(), ..self.clone() };
        for attribute in node.attributes() {
            let (name, value) = (attribute.name(), attribute.value());
            if !geometry.contains(&name) {
                style.set(name, value).ok_or_else(|| refused(node, &format!("{name}=\"{value}\"")))?;
            }
        }
        Ok(style)
    }

    fn set(&mut self, name: &str, value: &'d str) -> Option<()> {
        match name {
            "fill" => self.fill = fill(value)?,
            "fill-opacity" => self.fill_opacity = opacity(value)?,
            "stroke" => self.stroke = fill(value)?,
            "stroke-opacity" => self.stroke_opacity = opacity(value)?,
            "stroke-width" => self.line.width = size(value)?,
            "stroke-dasharray" => self.line.dash = Some(StrokeDash::new(numbers::<2>(value)?.to_vec(), 0.0)?),
            "stroke-linecap" => self.line.line_cap = (value == "round").then_some(LineCap::Round)?,
            "stroke-linejoin" => self.line.line_join = (value == "round").then_some(LineJoin::Round)?,
            "paint-order" => self.stroke_first = (value == "stroke").then_some(true)?,
            "font-size" => self.font_size = f64::from(size(value)?),
            "opacity" => self.opacity = opacity(value)?,
            "transform" => self.transform = rotation(value)?,
            // There is one font, and these say nothing about looks.
            "font-family" | "id" | "class" | "role" => {}
            name if name.starts_with("data-") || name.starts_with("aria-") => {}
            _ => return None,
        }
        Some(())
    }
}

/// Attributes of an element that say where it is; `None` for an element that is not drawn.
fn geometry(element: &str) -> Option<&'static [&'static str]> {
    Some(match element {
        "circle" => &["cx", "cy", "r"],
        "defs" | "g" | "title" => &[],
        "line" => &["x1", "y1", "x2", "y2"],
        "path" => &["d"],
        "pattern" => &["width", "height", "patternUnits", "patternTransform"],
        "polygon" => &["points"],
        "rect" => &["x", "y", "width", "height"],
        "svg" => &["width", "height", "viewBox"],
        "text" => &["x", "y", "text-anchor"],
        _ => return None,
    })
}

/// A finite number.
pub(super) fn number(text: &str) -> Option<f32> {
    text.parse().ok().filter(|value: &f32| value.is_finite())
}

/// A number that is not negative.
pub(super) fn size(text: &str) -> Option<f32> {
    number(text).filter(|value| *value >= 0.0)
}

/// So many numbers.
pub(super) fn numbers<const N: usize>(text: &str) -> Option<[f32; N]> {
    let mut words = text.split_ascii_whitespace();
    let mut numbers = [0.0; N];
    for value in &mut numbers {
        *value = number(words.next()?)?;
    }
    words.next().is_none().then_some(numbers)
}

/// A turn about the origin, or about a point.
pub(super) fn rotation(text: &str) -> Option<Transform> {
    let values = text.strip_prefix("rotate(")?.strip_suffix(')')?;
    let [angle, x, y] = numbers(values).or_else(|| numbers(values).map(|[angle]| [angle, 0.0, 0.0]))?;
    Some(Transform::from_rotate_at(angle, x, y))
}

fn opacity(text: &str) -> Option<f32> {
    number(text).filter(|value| (0.0..=1.0).contains(value))
}

fn fill(text: &str) -> Option<Fill<'_>> {
    if text == "none" {
        return Some(Fill::Nothing);
    }
    if let Some(name) = text.strip_prefix("url(#").and_then(|name| name.strip_suffix(')')) {
        return Some(Fill::Pattern(name));
    }
    let digits = text.strip_prefix('#')?;
    let value = u32::from_str_radix(digits, 16).ok().filter(|_| !digits.starts_with('+'))?;
    let [_, red, green, blue] = value.to_be_bytes();
    match digits.len() {
        6 => Some(Fill::Colour([red, green, blue])),
        // A digit stands for two of it.
        3 => Some(Fill::Colour([green & 15, blue >> 4, blue & 15].map(|digit| 17 * digit))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_have_three_or_six_digits() {
        let colour = |text| match fill(text) {
            Some(Fill::Colour(colour)) => Some(colour),
            _ => None,
        };
        assert_eq!(colour("#2078bf"), Some([0x20, 0x78, 0xbf]));
        assert_eq!(colour("#1af"), Some([0x11, 0xaa, 0xff]));
        for text in ["", "#", "#12", "#1234", "#12345", "#+12345", "#12345g", "#+12", "red", "rgb(1,2,3)", "2078bf"] {
            assert_eq!(colour(text), None, "{text}");
        }
    }

    #[test]
    fn rotations_are_about_the_origin_or_a_point() {
        let quarter = rotation("rotate(90 1 2)").unwrap();
        let mut point = tiny_skia::Point::from_xy(2.0, 2.0);
        quarter.map_point(&mut point);
        assert!((point.x - 1.0).abs() < 1e-6 && (point.y - 3.0).abs() < 1e-6, "{point:?}");
        assert!(rotation("rotate(45)").is_some());
        for text in ["rotate(1 2)", "rotate()", "rotate(1", "scale(2)", "rotate(1)rotate(2)"] {
            assert_eq!(rotation(text), None, "{text}");
        }
    }
}
