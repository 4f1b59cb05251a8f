//! Converts pictures to PNG: those that the writer of SVG writes, and no more of SVG than it writes. What is not known is an
//! error, so that no part of a picture is left out silently.

mod draw;
mod font;
mod path;
mod style;

pub(super) use font::boxes;

use draw::{Drawing, pixmap};
use roxmltree::{Document, Node};
use std::io;
use style::{Style, numbers, size};
use tiny_skia::{Pixmap, Transform};

/// Pixels of the PNG for each of the SVG: 300 dots an inch at the width of a column (85 mm).
const SCALE: f32 = 2.0;

/// Largest width and height of a PNG \[px\].
const LARGEST: f32 = 8192.0;

/// The PNG of a picture.
///
/// # Errors
/// For what is no SVG, and for what the writer of SVG does not write.
pub(super) fn png(svg: &str) -> io::Result<Vec<u8>> {
    let document = Document::parse(svg).map_err(io::Error::other)?;
    let root = document.root_element();
    let [width, height] = extent(root).ok_or_else(|| refused(root, "its size"))?;
    let scale = SCALE.min(LARGEST / width).min(LARGEST / height);
    let side = |pixels: f32| (pixels * scale).ceil().max(1.0) as u32;
    let mut pixels = pixmap(side(width), side(height))?;
    let style = Style::default().within(root)?;
    let mut drawing = Drawing::new([width, height], scale)?;
    drawing.children(root, &style, Transform::from_scale(scale, scale), &mut pixels)?;
    encode(&pixels)
}

/// Width and height of a picture whose coordinates are pixels from its corner on.
fn extent(root: Node<'_, '_>) -> Option<[f32; 2]> {
    let sides = [size(root.attribute("width")?)?, size(root.attribute("height")?)?];
    let shown: [f32; 4] = numbers(root.attribute("viewBox")?)?;
    (root.has_tag_name("svg") && shown == [0.0, 0.0, sides[0], sides[1]]).then_some(sides)
}

/// The error of an element with something that is not known.
fn refused(node: Node<'_, '_>, what: &str) -> io::Error {
    io::Error::other(format!("<{}>: {what} cannot be drawn as PNG", node.tag_name().name()))
}

/// The PNG without its alpha channel, which is 1 everywhere. Line art packs best without any filter.
fn encode(pixmap: &Pixmap) -> io::Result<Vec<u8>> {
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

    /// The rows of a picture, in red, green and blue.
    fn pixels(svg: &str) -> Vec<Vec<[u8; 3]>> {
        let mut reader = png::Decoder::new(io::Cursor::new(png(svg).unwrap())).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let width = reader.next_frame(&mut pixels).unwrap().width as usize;
        pixels.as_chunks::<3>().0.chunks(width).map(<[_]>::to_vec).collect()
    }

    /// The picture of these elements, 20 pixels wide and 10 high.
    fn svg(elements: &str) -> String {
        let empty = Svg::new(20.0, 10.0, "").finish();
        empty.replace("</svg>", &format!("{elements}</svg>"))
    }

    /// The colour at a point \[px\] of these elements.
    fn at(elements: &str, [x, y]: [f32; 2]) -> [u8; 3] {
        pixels(&svg(elements))[(SCALE * y) as usize][(SCALE * x) as usize]
    }

    const WHITE: [u8; 3] = [255; 3];
    const BLACK: [u8; 3] = [0; 3];
    const RED: [u8; 3] = [255, 0, 0];

    #[test]
    fn texts_are_drawn_with_the_font_of_the_program() {
        let dark = |text: &str| {
            let mut svg = Svg::new(40.0, 20.0, "");
            svg.label([4.0, 14.0], "start", &[("font-size", &"12")], text);
            let pixels = pixels(&svg.finish());
            assert_eq!((pixels.len(), pixels[0].len()), (40, 80));
            pixels.concat().iter().filter(|pixel| pixel[0] < 128).count()
        };
        assert!(dark("") == 0 && dark("8") > dark("1") && dark("1") > 0);
        for symbol in ["\u{3b8}", "\u{2212}", "\u{e9}"] {
            assert!(dark(symbol) > 0, "{symbol}");
        }
    }

    #[test]
    fn texts_begin_are_centred_or_end_at_their_point() {
        for (anchor, seen) in [("start", [false, true]), ("middle", [true, true]), ("end", [true, false])] {
            let mut picture = Svg::new(20.0, 10.0, "");
            picture.label([10.0, 10.0], anchor, &[("font-size", &"10")], "88");
            let pixels = pixels(&picture.finish());
            let dark = |from: usize| pixels.iter().flat_map(|row| &row[from..from + 20]).any(|pixel| pixel[0] < 128);
            assert_eq!([dark(0), dark(20)], seen, "{anchor}");
        }
    }

    #[test]
    fn elements_have_the_looks_of_what_they_are_in_and_their_own() {
        let rects = "<rect width='5' height='5'/><rect x='5' width='5' height='5' fill='none'/>\
            <path d='M12 1L18 1L18 9L12 9Z' fill='#00f'/>";
        let all = format!("<g fill='#f00' stroke='#000' stroke-width='2'>{rects}</g>");
        assert_eq!([at(&all, [2.5, 2.5]), at(&all, [7.5, 2.5]), at(&all, [15.0, 5.0])], [RED, WHITE, [0, 0, 255]]);
        // Strokes lie half within, over what is filled.
        assert_eq!([at(&all, [0.5, 2.5]), at(&all, [12.5, 5.0]), at(&all, [11.5, 5.0])], [BLACK; 3]);
        // No width is no line, and no extent no rectangle.
        let none =
            "<g stroke='#000'><line x2='20' y1='5' y2='5' stroke-width='0'/><rect y='3' width='20' height='0'/></g>";
        assert!(pixels(&svg(none)).concat().iter().all(|pixel| *pixel == WHITE));
    }

    #[test]
    fn strokes_may_lie_below() {
        let rect = |order: &str| {
            format!("<rect x='5' width='9' height='9' fill='#f00' stroke='#000' stroke-width='4'{order}/>")
        };
        assert_eq!(at(&rect(""), [6.0, 5.0]), BLACK);
        assert_eq!(at(&rect(" paint-order='stroke'"), [6.0, 5.0]), RED);
        assert_eq!(at(&rect(" paint-order='stroke'"), [4.0, 5.0]), BLACK);
    }

    #[test]
    fn opacity_is_of_an_area_or_of_a_group_as_a_whole() {
        let twice = "<rect width='9' height='9'/><rect width='9' height='9'/>";
        assert_eq!(at(&format!("<g opacity='0.4'>{twice}</g>"), [5.0, 5.0]), [153; 3]);
        assert_eq!(at(&format!("<g fill-opacity='0.4'>{twice}</g>"), [5.0, 5.0]), [92; 3]);
        let line = "<line x1='1' y1='5' x2='9' y2='5' stroke='#000' stroke-width='4' stroke-opacity='0.4'/>";
        assert_eq!(at(line, [5.0, 5.0]), [153; 3]);
    }

    #[test]
    fn lines_have_dashes_and_round_ends() {
        let line = |more: &str| format!("<line x1='4' y1='5' x2='16' y2='5' stroke='#000' stroke-width='4'{more}/>");
        assert_eq!([at(&line(""), [3.0, 5.0]), at(&line(""), [9.0, 5.0])], [WHITE, BLACK]);
        assert_eq!(at(&line(" stroke-linecap='round'"), [3.0, 5.0]), BLACK);
        let dashed = line(" stroke-dasharray='4 3'");
        assert_eq!([5.0, 9.5, 12.0].map(|x| at(&dashed, [x, 5.0])), [BLACK, WHITE, BLACK]);
    }

    #[test]
    fn patterns_repeat() {
        let rect = "<rect width='20' height='10' fill='url(#a)'/>";
        let pattern = |turn: &str| {
            format!(
                "<defs><pattern id='a' width='4' height='4' patternUnits='userSpaceOnUse' patternTransform='rotate({turn})'>\
                <rect width='2' height='4' fill='#f00'/></pattern></defs>{rect}"
            )
        };
        assert_eq!([1.0, 3.0, 9.0, 11.0].map(|x| at(&pattern("0"), [x, 5.0])), [RED, WHITE, RED, WHITE]);
        assert_eq!([1.0, 3.0, 5.0, 7.0].map(|y| at(&pattern("90"), [3.0, y])), [RED, WHITE, RED, WHITE]);
        assert!(png(&svg(rect)).unwrap_err().to_string().contains("url(#a)"));
    }

    #[test]
    fn elements_turn() {
        let turned = "<polygon points='10,0 12,0 12,4 10,4' transform='rotate(90 10 5)'/>";
        assert_eq!([at(turned, [13.0, 6.0]), at(turned, [11.0, 2.0])], [BLACK, WHITE]);
    }

    #[test]
    fn large_pictures_are_scaled() {
        let pixels = pixels(&Svg::new(8192.0, 10.0, "").finish());
        assert_eq!((pixels.len(), pixels[0].len()), (10, 8192));
    }

    #[test]
    fn what_is_not_known_is_refused() {
        for (elements, why) in [
            ("<ellipse rx='3'/>", "<ellipse>: such an element"),
            ("<style>path { fill: red }</style>", "<style>: such an element"),
            ("<g><svg/></g>", "<svg>: its shape"),
            ("<rect rx='1'/>", "<rect>: rx=\"1\""),
            ("<g><path d='M0 0' fill-rule='evenodd'/></g>", "<path>: fill-rule=\"evenodd\""),
            ("<g stroke-linecap='square'/>", "<g>: stroke-linecap=\"square\""),
            ("<g transform='scale(2)'/>", "<g>: transform=\"scale(2)\""),
            ("<g x='1'/>", "<g>: x=\"1\""),
            ("<circle r='1' fill='red'/>", "<circle>: fill=\"red\""),
            ("<circle r='1' opacity='2'/>", "<circle>: opacity=\"2\""),
            ("<circle r='1' stroke-dasharray='0 0'/>", "<circle>: stroke-dasharray=\"0 0\""),
            ("<circle r='1cm'/>", "<circle>: its shape"),
            ("<circle r='1e39'/>", "<circle>: its shape"),
            ("<circle r='-1'/>", "<circle>: its shape"),
            ("<path d='M1 2H3'/>", "<path>: its shape"),
            ("<path/>", "<path>: its shape"),
            ("<polygon points='1 2 3 4'/>", "<polygon>: its shape"),
            ("<text x='1' y='2' text-anchor='centre'>a</text>", "<text>: its shape"),
            ("<text x='1' y='2'>a<tspan>b</tspan></text>", "<text>: what is in it"),
            ("<defs><circle r='1'/></defs>", "<defs>: what is in it"),
            ("<line x1='-3e38' x2='3e38'/>", "<line>: its size"),
            ("<defs><pattern id='a' width='1' height='1'/></defs>", "<pattern>: its repetition"),
        ] {
            let refused = png(&svg(elements)).unwrap_err().to_string();
            assert_eq!(refused, format!("{why} cannot be drawn as PNG"), "{elements}");
        }
        assert!(png("<svg").is_err() && png("<html/>").is_err());
        let bare = "<svg xmlns='http://www.w3.org/2000/svg' width='2' height='2'";
        assert!(png(&format!("{bare} viewBox='0 0 2 2'/>")).is_ok());
        for other in ["", " viewBox='0 0 1 1'", " viewBox='1 0 2 2'"] {
            assert!(png(&format!("{bare}{other}/>")).is_err(), "{other}");
        }
    }
}
