//! Converts SVG to PNG.

mod font;

pub(super) use font::boxes;

use resvg::{tiny_skia, usvg};
use std::io;

/// Pixels of the PNG for each of the SVG: 300 dots an inch at the width of a column (85 mm).
const SCALE: f32 = 2.0;

/// Largest width and height of a PNG \[px\].
const LARGEST: f32 = 8192.0;

/// The PNG of a picture.
///
/// # Errors
/// Those of the drawing library.
pub(super) fn png(svg: &str) -> io::Result<Vec<u8>> {
    let tree = usvg::Tree::from_str(&font::outlined(svg)?, &usvg::Options::default()).map_err(io::Error::other)?;
    let size = tree.size();
    let scale = SCALE.min(LARGEST / size.width()).min(LARGEST / size.height());
    let side = |pixels: f32| (pixels * scale).ceil().max(1.0) as u32;
    let mut pixmap = tiny_skia::Pixmap::new(side(size.width()), side(size.height()))
        .ok_or_else(|| io::Error::other("picture without extent"))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    encode(&pixmap)
}

/// The PNG without its alpha channel, which is 1 everywhere. Line art packs best without any filter.
fn encode(pixmap: &tiny_skia::Pixmap) -> io::Result<Vec<u8>> {
    let mut opaque = Vec::with_capacity(pixmap.data().len() / 4 * 3);
    for rgba in pixmap.pixels() {
        opaque.extend([rgba.red(), rgba.green(), rgba.blue()]);
    }
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, pixmap.width(), pixmap.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&opaque)?;
    writer.finish()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::Svg;

    fn pixels(text: &str) -> (u32, Vec<u8>) {
        let mut svg = Svg::new(40.0, 20.0, "");
        svg.label([4.0, 14.0], "start", &[("font-size", &"12")], text);
        let file = png(&svg.finish()).unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(file)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut pixels).unwrap();
        (frame.width, pixels)
    }

    #[test]
    fn texts_are_drawn_with_the_font_of_the_program() {
        let (width, empty) = pixels("");
        assert_eq!(width, 80);
        assert!(empty.iter().all(|value| *value == 255));
        let dark = |text| pixels(text).1.iter().filter(|value| **value < 128).count();
        assert!(dark("8") > dark("1") && dark("1") > 0);
        for symbol in ["\u{3b8}", "\u{2212}", "\u{e9}"] {
            assert!(dark(symbol) > 0, "{symbol}");
        }
    }

    #[test]
    fn what_is_no_svg_is_refused() {
        assert!(png("<svg").is_err());
    }
}
