//! Draws the elements of a picture.

use super::style::{Fill, Style, rotation, size};
use super::{font, path, refused};
use roxmltree::Node;
use std::collections::HashMap;
use std::io;
use tiny_skia::{
    Color, FillRule, FilterQuality, Paint, PathBuilder, Pattern, Pixmap, PixmapPaint, SpreadMode, Transform,
};
use ttf_parser::Face;

/// A pattern as it is drawn, and from its pixels to the picture.
struct Tile {
    pixels: Pixmap,
    transform: Transform,
}

/// What all elements of a picture share.
pub(super) struct Drawing<'d> {
    face: Face<'static>,
    /// Width and height of the picture \[px\].
    size: [f32; 2],
    /// Pixels of a pixel of the picture.
    scale: f32,
    tiles: HashMap<&'d str, Tile>,
}

impl<'d> Drawing<'d> {
    /// A picture of this width and height \[px\].
    ///
    /// # Errors
    /// Those of the font.
    pub(super) fn new(size: [f32; 2], scale: f32) -> io::Result<Self> {
        Ok(Self { face: font::face()?, size, scale, tiles: HashMap::new() })
    }

    /// Draws what is in an element.
    ///
    /// # Errors
    /// For what is not known.
    pub(super) fn children(
        &mut self,
        of: Node<'d, '_>,
        style: &Style<'d>,
        transform: Transform,
        onto: &mut Pixmap,
    ) -> io::Result<()> {
        of.children().filter(Node::is_element).try_for_each(|node| {
            let style = style.within(node)?;
            let transform = transform.pre_concat(style.transform);
            if style.opacity >= 1.0 {
                return self.element(node, &style, transform, onto);
            }
            // As a whole: what overlaps in it does not show through.
            let mut layer = pixmap(onto.width(), onto.height())?;
            self.element(node, &style, transform, &mut layer)?;
            let paint = PixmapPaint { opacity: style.opacity, ..PixmapPaint::default() };
            onto.draw_pixmap(0, 0, layer.as_ref(), &paint, Transform::identity(), None);
            Ok(())
        })
    }

    fn element(
        &mut self,
        node: Node<'d, '_>,
        style: &Style<'d>,
        transform: Transform,
        onto: &mut Pixmap,
    ) -> io::Result<()> {
        match node.tag_name().name() {
            "title" => return Ok(()),
            // What else is in it is not drawn where it is, but where it is named.
            "defs" if node.children().any(|child| child.is_element() && !child.has_tag_name("pattern")) => {
                return Err(refused(node, "what is in it"));
            }
            "g" | "defs" => return self.children(node, style, transform, onto),
            "pattern" => return self.pattern(node, style),
            _ => {}
        }
        if node.children().any(|child| child.is_element()) {
            return Err(refused(node, "what is in it"));
        }
        let mut outline = PathBuilder::new();
        let read = match node.tag_name().name() {
            "text" => font::outline(&self.face, node, style.font_size, &mut outline),
            _ => path::shape(node, self.size, &mut outline),
        };
        read.ok_or_else(|| refused(node, "its shape"))?;
        // A point that nothing leads to is not seen.
        if outline.len() < 2 {
            return Ok(());
        }
        let outline = outline.finish().ok_or_else(|| refused(node, "its size"))?;
        let fill = self.paint(node, style.fill, style.fill_opacity)?;
        let stroke = self.paint(node, style.stroke, style.stroke_opacity)?.filter(|_| style.line.width > 0.0);
        for filled in [!style.stroke_first, style.stroke_first] {
            match if filled { &fill } else { &stroke } {
                Some(paint) if filled => onto.fill_path(&outline, paint, FillRule::Winding, transform, None),
                Some(paint) => onto.stroke_path(&outline, paint, &style.line, transform, None),
                None => {}
            }
        }
        Ok(())
    }

    fn paint(&self, node: Node<'_, '_>, fill: Fill<'_>, opacity: f32) -> io::Result<Option<Paint<'_>>> {
        let mut paint = Paint::default();
        match fill {
            Fill::Nothing => return Ok(None),
            Fill::Colour([red, green, blue]) => {
                paint.set_color(Color::from_rgba8(red, green, blue, (255.0 * opacity).round() as u8));
            }
            Fill::Pattern(name) => {
                let Tile { pixels, transform } =
                    self.tiles.get(name).ok_or_else(|| refused(node, &format!("url(#{name})")))?;
                let quality = FilterQuality::Bicubic;
                paint.shader = Pattern::new(pixels.as_ref(), SpreadMode::Repeat, quality, opacity, *transform);
            }
        }
        Ok(Some(paint))
    }

    /// Draws a pattern for what comes after it.
    fn pattern(&mut self, node: Node<'d, '_>, style: &Style<'d>) -> io::Result<()> {
        let read = || {
            let at = |name| node.attribute(name);
            at("patternUnits").filter(|units| *units == "userSpaceOnUse")?;
            let transform = rotation(at("patternTransform")?)?;
            Some((at("id")?, [size(at("width")?)?, size(at("height")?)?], transform))
        };
        let (name, sides, transform) = read().ok_or_else(|| refused(node, "its repetition"))?;
        let [width, height] = sides.map(|side| (side * self.scale).round().max(1.0));
        let mut pixels = pixmap(width as u32, height as u32)?;
        let scale = [width / sides[0], height / sides[1]];
        self.children(node, style, Transform::from_scale(scale[0], scale[1]), &mut pixels)?;
        self.tiles.insert(name, Tile { pixels, transform: transform.pre_scale(1.0 / scale[0], 1.0 / scale[1]) });
        Ok(())
    }
}

/// Pixels that are transparent.
pub(super) fn pixmap(width: u32, height: u32) -> io::Result<Pixmap> {
    Pixmap::new(width, height).ok_or_else(|| io::Error::other("picture without extent"))
}
