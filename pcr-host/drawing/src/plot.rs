//! Charts with two logarithmic axes.

use super::axis::{AXIS_SIZE, TICK_SIZE};
use super::palette::{Colour, colour};
use super::svg::{PathData, PixelCoordinate, SvgWriter, text_width};

/// Some points, and whether a line goes through them.
#[derive(Clone, Debug)]
pub struct DataSeries {
    /// As in the legend.
    pub name: String,
    /// What is drawn.
    pub points: Vec<[f64; 2]>,
    /// Whether a line goes through them.
    pub line: bool,
}

/// A chart.
#[derive(Clone, Debug)]
pub struct Chart<'a> {
    /// What is written above it.
    pub title: &'a str,
    /// Titles of the axes.
    pub axes: [&'a str; 2],
    /// What is drawn.
    pub series: Vec<DataSeries>,
}

/// Size of the plot \[px\].
const SIZE: [f64; 2] = [380.0, 260.0];

/// Room to the left of the plot, and above it \[px\].
const ROOM: [f64; 2] = [64.0, 28.0];

/// Room between the plot and the legend, and height of an entry \[px\].
const LEGEND: [f64; 2] = [14.0, 15.0];

/// Least distance of a value from the border, in powers of ten: marks stay within the plot, apart from its labels.
const MARGIN: f64 = 0.15;

/// Whole powers of ten, as exponents, and where they lie \[px\].
struct LogAxis {
    lo: f64,
    hi: f64,
    pixels: [f64; 2],
}

impl LogAxis {
    fn new(values: impl Iterator<Item = f64> + Clone, pixels: [f64; 2]) -> Self {
        let exponents = values.filter(|value| *value > 0.0).map(f64::log10);
        let lo = exponents.clone().fold(f64::INFINITY, f64::min);
        let hi = exponents.fold(f64::NEG_INFINITY, f64::max);
        let (lo, hi) = if lo <= hi { ((lo - MARGIN).floor(), (hi + MARGIN).ceil()) } else { (0.0, 1.0) };
        Self { lo, hi: hi.max(lo + 1.0), pixels }
    }

    fn at(&self, value: f64) -> f64 {
        // What is 0 lies on the border.
        let exponent = if value > 0.0 { value.log10() } else { self.lo };
        let [from, to] = self.pixels;
        from + (to - from) * (exponent - self.lo) / (self.hi - self.lo)
    }

    /// Values with their labels, so many at most.
    fn ticks(&self, most: f64) -> Vec<(f64, String)> {
        let step = ((self.hi - self.lo) / most).ceil().max(1.0);
        let count = ((self.hi - self.lo) / step) as usize;
        (0..=count)
            .map(|k| {
                let exponent = self.lo + step * k as f64;
                (10_f64.powf(exponent), label(exponent))
            })
            .collect()
    }
}

fn label(exponent: f64) -> String {
    match exponent {
        -3.0..=-1.0 => format!("{:.*}", -exponent as usize, 10_f64.powf(exponent)),
        0.0..=4.0 => format!("{}", 10_f64.powf(exponent)),
        _ => format!("1e{exponent}").replace('-', "\u{2212}"),
    }
}

impl Chart<'_> {
    /// The picture.
    pub fn draw(&self) -> String {
        let [left, top] = ROOM;
        let (right, bottom) = (left + SIZE[0], top + SIZE[1]);
        let values = |axis: usize| self.series.iter().flat_map(move |s| s.points.iter().map(move |point| point[axis]));
        let (x, y) = (LogAxis::new(values(0), [left, right]), LogAxis::new(values(1), [bottom, top]));
        let widest = self.series.iter().map(|series| text_width(&series.name, TICK_SIZE)).fold(0.0, f64::max);
        let height = (bottom + 40.0).max(top + LEGEND[1] * self.series.len() as f64 + 10.0);
        let mut svg = SvgWriter::new(right + 2.0 * LEGEND[0] + 8.0 + widest, height, self.title);
        let title_size = PixelCoordinate(AXIS_SIZE + 0.5);
        svg.label([(left + right) / 2.0, top - 10.0], "middle", &[("font-size", &title_size)], self.title);
        self.frame(&mut svg, &x, &y);
        for (place, series) in self.series.iter().enumerate() {
            let points: Vec<[f64; 2]> = series.points.iter().map(|point| [x.at(point[0]), y.at(point[1])]).collect();
            draw_series(&mut svg, &points, series.line, place);
            let at = [right + LEGEND[0], top + LEGEND[1] * (place as f64 + 0.5)];
            mark(&mut svg, at, place);
            svg.label(
                [at[0] + 10.0, at[1] + 3.5],
                "start",
                &[("font-size", &PixelCoordinate(TICK_SIZE))],
                &series.name,
            );
        }
        svg.finish()
    }

    fn frame(&self, svg: &mut SvgWriter, x: &LogAxis, y: &LogAxis) {
        let ([left, right], [bottom, top]) = (x.pixels, y.pixels);
        let mut grid = PathData::default();
        svg.start("g", &[("font-size", &PixelCoordinate(TICK_SIZE)), ("fill", &"#3a3f45")]);
        for (value, label) in x.ticks(8.0) {
            grid.move_to([x.at(value), top]);
            grid.line_to([x.at(value), bottom]);
            svg.label([x.at(value), bottom + 13.0], "middle", &[], &label);
        }
        for (value, label) in y.ticks(8.0) {
            grid.move_to([left, y.at(value)]);
            grid.line_to([right, y.at(value)]);
            svg.label([left - 5.0, y.at(value) + 3.5], "end", &[], &label);
        }
        svg.end();
        svg.empty("path", &[("d", &grid), ("stroke", &"#dfe3e6"), ("stroke-width", &"0.6"), ("fill", &"none")]);
        let (width, height) = (PixelCoordinate(right - left), PixelCoordinate(bottom - top));
        let corner = (PixelCoordinate(left), PixelCoordinate(top));
        svg.empty(
            "rect",
            &[
                ("x", &corner.0),
                ("y", &corner.1),
                ("width", &width),
                ("height", &height),
                ("fill", &"none"),
                ("stroke", &"#3a3f45"),
                ("stroke-width", &"0.8"),
            ],
        );
        let middle = [(left + right) / 2.0, (top + bottom) / 2.0];
        svg.start("g", &[("font-size", &PixelCoordinate(AXIS_SIZE)), ("fill", &"#1d2125")]);
        svg.label([middle[0], bottom + 31.0], "middle", &[], self.axes[0]);
        let turned = format!("rotate(-90 {} {})", PixelCoordinate(16.0), PixelCoordinate(middle[1]));
        svg.label([16.0, middle[1]], "middle", &[("transform", &turned)], self.axes[1]);
        svg.end();
    }
}

fn draw_series(svg: &mut SvgWriter, points: &[[f64; 2]], line: bool, place: usize) {
    if line {
        let mut path = PathData::default();
        for (k, point) in points.iter().enumerate() {
            if k == 0 { path.move_to(*point) } else { path.line_to(*point) }
        }
        let ink: Colour = colour(place);
        svg.empty("path", &[("d", &path), ("stroke", &ink), ("stroke-width", &"1.4"), ("fill", &"none")]);
    }
    for point in points {
        mark(svg, *point, place);
    }
}

/// A disc, a square, a triangle or a rhomb, so that nobody has to tell colours apart.
fn mark(svg: &mut SvgWriter, [x, y]: [f64; 2], place: usize) {
    const R: f64 = 4.0;
    let corners: &[[f64; 2]] = match place % 4 {
        1 => &[[-0.85, -0.85], [0.85, -0.85], [0.85, 0.85], [-0.85, 0.85]],
        2 => &[[0.0, -1.1], [1.0, 0.8], [-1.0, 0.8]],
        3 => &[[0.0, -1.2], [1.2, 0.0], [0.0, 1.2], [-1.2, 0.0]],
        _ => {
            let (cx, cy) = (PixelCoordinate(x), PixelCoordinate(y));
            svg.empty("circle", &[("cx", &cx), ("cy", &cy), ("r", &PixelCoordinate(R)), ("fill", &colour(place))]);
            return;
        }
    };
    let mut path = PathData::default();
    path.polygon(corners.iter().map(|[dx, dy]| [x + R * dx, y + R * dy]));
    svg.empty("path", &[("d", &path), ("fill", &colour(place))]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten_are_written_short() {
        let labels = [-7.0, -2.0, 0.0, 3.0, 6.0].map(label);
        assert_eq!(labels, ["1e\u{2212}7", "0.01", "1", "1000", "1e6"]);
    }

    #[test]
    fn decades_hold_all_values_and_zero_is_on_the_border() {
        let decades = LogAxis::new([0.3, 50.0, 0.0].into_iter(), [0.0, 300.0]);
        assert_eq!((decades.lo, decades.hi), (-1.0, 2.0));
        assert_eq!((decades.at(0.1), decades.at(100.0), decades.at(0.0)), (0.0, 300.0, 0.0));
    }
}
