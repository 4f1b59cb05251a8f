//! Rasterizes pictures to PNG, with texts in a font that is part of the program, so that pictures are the same on every machine.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};
use skrifa::{FontRef, MetadataProvider};
use std::collections::BTreeSet;
use std::io;
use std::sync::{Arc, LazyLock};

/// Pixels of the PNG for each of the SVG: 300 dots an inch at the width of a column (85 mm).
const SCALE: f32 = 2.0;

/// Largest width and height of a PNG \[px\].
const LARGEST: f32 = 8192.0;

/// The font of all texts, DejaVu Sans.
static FONT: &[u8] = include_bytes!("font/DejaVuSans-subset.ttf");

/// The font, as texts are laid out with it.
static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    Arc::new(fonts)
});

/// Rasterizes an SVG, with two pixels for each of its own, at most 8192 on a side.
///
/// # Errors
/// If the text is no SVG, or there is no memory for the pixels.
pub(super) fn png(svg: &str) -> io::Result<Vec<u8>> {
    let options = Options { fontdb: Arc::clone(&FONTS), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(io::Error::other)?;
    let (width, height) = (tree.size().width(), tree.size().height());
    let scale = SCALE.min(LARGEST / width).min(LARGEST / height);
    let side = |pixels: f32| (pixels * scale).ceil().max(1.0) as u32;
    let pixels = Pixmap::new(side(width), side(height));
    let mut pixels = pixels.ok_or_else(|| io::Error::other(format!("no memory for {width} x {height} px")))?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    encode(&pixels)
}

/// Returns the letters of a text that the font lacks, which are drawn as boxes.
///
/// # Errors
/// If the font cannot be read.
pub(super) fn missing_letters(text: &str) -> io::Result<BTreeSet<char>> {
    let charmap = FontRef::new(FONT).map_err(io::Error::other)?.charmap();
    Ok(text.chars().filter(|letter| !letter.is_control() && charmap.map(*letter).is_none()).collect())
}

/// Encodes the pixels without their alpha channel, which is 1 everywhere. Line art packs best without any filter.
fn encode(pixmap: &Pixmap) -> io::Result<Vec<u8>> {
    let mut opaque = Vec::with_capacity(pixmap.data().len() / 4 * 3);
    for rgba in pixmap.pixels() {
        opaque.extend([rgba.red(), rgba.green(), rgba.blue()]);
    }
    let mut file = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut file, pixmap.width(), pixmap.height());
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::Balanced);
    encoder.set_filter(::png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&opaque)?;
    writer.finish()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::SvgWriter;

    /// The rows of a picture, in red, green and blue.
    fn pixels(svg: &str) -> Vec<Vec<[u8; 3]>> {
        let mut reader = ::png::Decoder::new(io::Cursor::new(png(svg).unwrap())).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let width = reader.next_frame(&mut pixels).unwrap().width as usize;
        pixels.as_chunks::<3>().0.chunks(width).map(<[_]>::to_vec).collect()
    }

    /// A picture of 20 by 10 pixels with this text in the middle.
    fn text(text: &str, anchor: &'static str) -> String {
        let mut svg = SvgWriter::new(20.0, 10.0, "");
        svg.label([10.0, 10.0], anchor, &[("font-size", &"10")], text);
        svg.finish()
    }

    /// Dark pixels of the left and of the right half of a picture.
    fn dark(svg: &str) -> [usize; 2] {
        let pixels = pixels(svg);
        assert_eq!((pixels.len(), pixels[0].len()), (20, 40));
        [0, 20].map(|from| pixels.iter().flat_map(|row| &row[from..from + 20]).filter(|pixel| pixel[0] < 128).count())
    }

    #[test]
    fn texts_are_drawn_with_the_font_of_the_program() {
        let ink = |letters: &str| dark(&text(letters, "middle")).iter().sum::<usize>();
        assert!(ink("") == 0 && ink("8") > ink("1") && ink("1") > 0);
        for symbol in ["\u{3b8}", "\u{2212}", "\u{e9}"] {
            assert!(ink(symbol) > 0, "{symbol}");
            assert!(missing_letters(&text(symbol, "middle")).unwrap().is_empty(), "{symbol}");
        }
    }

    #[test]
    fn letters_that_the_font_lacks_are_boxes_and_named() {
        let svg = text("a\u{6771}\u{4eac}", "middle");
        assert_eq!(missing_letters(&svg).unwrap(), BTreeSet::from(['\u{6771}', '\u{4eac}']));
        assert!(dark(&svg)[1] > 0);
    }

    #[test]
    fn texts_begin_are_centred_or_end_at_their_point() {
        for (anchor, seen) in [("start", [false, true]), ("middle", [true, true]), ("end", [true, false])] {
            assert_eq!(dark(&text("88", anchor)).map(|pixels| pixels > 0), seen, "{anchor}");
        }
    }

    #[test]
    fn pictures_are_on_white_and_large_ones_are_scaled() {
        let pixels = pixels(&SvgWriter::new(8192.0, 10.0, "").finish());
        assert_eq!((pixels.len(), pixels[0].len()), (10, 8192));
        assert!(pixels.concat().iter().all(|pixel| *pixel == [255; 3]));
    }

    #[test]
    fn what_is_no_svg_is_an_error() {
        assert!(png("<svg").is_err() && png("<html/>").is_err());
    }
}
