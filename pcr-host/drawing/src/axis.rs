//! Axes: from metres and seconds to pixels, with ticks at round numbers.

use super::svg::{PathData, PixelCoordinate, SvgWriter, cut_name, text_width};
use pcr_core::Interval;

/// Smallest span of an axis relative to the magnitude of its values: below it, neighbouring pixels would be the
/// same number, and the labels of the ticks alike.
const RELATIVE_SPAN: f64 = 1e-9;

/// Smallest span of an axis \[m\] or \[s\].
const SMALLEST_SPAN: f64 = 1e-6;

/// A linear map from a range of values to a range of pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    values: Interval<f64>,
    pixels: [f64; 2],
}

/// A labelled mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// In units of the axis.
    pub(super) value: f64,
    /// As it is printed.
    pub(super) label: String,
}

/// The interval, if it is wide enough for an axis, or a wider one about the same middle.
pub(super) fn at_least_visible(values: Interval<f64>) -> Interval<f64> {
    let magnitude = values.lo.abs().max(values.hi.abs());
    let missing = SMALLEST_SPAN.max(RELATIVE_SPAN * magnitude) - values.length();
    if missing > 0.0 { Interval::new(values.lo - missing / 2.0, values.hi + missing / 2.0) } else { values }
}

impl Axis {
    /// The axis on which the ends of `values` lie at these pixels.
    pub(super) fn new(values: Interval<f64>, pixels: [f64; 2]) -> Self {
        Self { values: at_least_visible(values), pixels }
    }

    /// The values it shows.
    pub(super) fn values(&self) -> Interval<f64> {
        self.values
    }

    /// Where a value lies \[px\].
    pub(super) fn at(&self, value: f64) -> f64 {
        let [from, to] = self.pixels;
        from + (value - self.values.lo) / self.values.length() * (to - from)
    }

    /// The value at a pixel.
    pub(super) fn value_at(&self, pixel: f64) -> f64 {
        let [from, to] = self.pixels;
        self.values.lo + (pixel - from) / (to - from) * self.values.length()
    }

    /// Units of a pixel.
    pub(super) fn units_per_pixel(&self) -> f64 {
        self.values.length() / (self.pixels[1] - self.pixels[0]).abs()
    }

    /// Ticks at multiples of 1, 2 or 5 times a power of ten, at least `gap` pixels apart.
    pub(super) fn ticks(&self, gap: f64) -> Vec<Tick> {
        let coarsest = self.units_per_pixel() * gap;
        let power = 10_f64.powf(coarsest.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * power).find(|step| *step >= coarsest);
        let step = step.unwrap_or(10.0 * power);
        // The digits that tell neighbouring ticks apart, by the exponent of the step.
        let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
        // Rounding must not take the tick at an end of the axis away.
        let slack = 1e-6;
        let first = (self.values.lo / step - slack).ceil();
        let last = (self.values.hi / step + slack).floor();
        let count = (last - first).max(-1.0) as usize + usize::from(last >= first);
        let tick = |k: usize| {
            let value = (first + k as f64) * step;
            let label = format!("{value:.decimals$}");
            let zero = label.trim_start_matches('-').bytes().all(|byte| matches!(byte, b'0' | b'.'));
            let label = if zero { label.trim_start_matches('-').to_owned() } else { label.replace('-', "\u{2212}") };
            Tick { value, label }
        };
        (0..count).map(tick).collect()
    }

    /// Width of the widest label of the ticks \[px\].
    fn widest(&self, gap: f64) -> f64 {
        self.ticks(gap).iter().map(|tick| text_width(&tick.label, TICK_SIZE)).fold(0.0, f64::max)
    }
}

/// The area of a plot with its two axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlotArea {
    /// To the right.
    pub(super) x: Axis,
    /// Upward.
    pub(super) y: Axis,
    /// Left, top, right and bottom edge \[px\].
    pub(super) edges: [f64; 4],
}

/// Size of the labels of ticks \[px\].
pub(super) const TICK_SIZE: f64 = 10.0;

/// Size of the titles of axes \[px\].
pub(super) const AXIS_SIZE: f64 = 11.0;

/// Room above a plot for its title \[px\].
pub(super) const ROOM_ABOVE: f64 = 26.0;

/// How far a title may reach beyond either side of its plot \[px\]: as far as nothing else is.
const BEYOND: f64 = 8.0;

/// Room below a plot for its axis \[px\].
pub(super) const ROOM_BELOW: f64 = 36.0;

/// Smallest distances of ticks \[px\].
const GAPS: [f64; 2] = [48.0, 36.0];

/// Room to the left of a plot of this height for an axis with these values \[px\].
pub(super) fn room_at_left(values: Interval<f64>, height: f64) -> f64 {
    Axis::new(values, [height, 0.0]).widest(GAPS[1]) + 14.0 + AXIS_SIZE
}

impl PlotArea {
    /// The frame that shows these values within these edges: left, top, right, bottom \[px\].
    pub(super) fn new(x: Interval<f64>, y: Interval<f64>, edges: [f64; 4]) -> Self {
        let [left, top, right, bottom] = edges;
        Self { x: Axis::new(x, [left, right]), y: Axis::new(y, [bottom, top]), edges }
    }

    /// Where a point lies \[px\].
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.x.at(x), self.y.at(y)]
    }

    /// What is written above the plot: a name with what stands before and after it. It stays within the plot's width.
    pub(super) fn draw_title(&self, svg: &mut SvgWriter, title: [&str; 3]) {
        let [left, top, right, _] = self.edges;
        let size = AXIS_SIZE + 0.5;
        let title = cut_name(title, size, right - left + 2.0 * BEYOND);
        svg.label([(left + right) / 2.0, top - 9.0], "middle", &[("font-size", &PixelCoordinate(size))], &title);
    }

    /// The frame with grid lines, ticks and titles.
    pub(super) fn draw(&self, svg: &mut SvgWriter, titles: [&str; 2]) {
        let [left, top, right, bottom] = self.edges;
        let middle = [(left + right) / 2.0, (top + bottom) / 2.0];
        let gap = f64::max(GAPS[0], self.x.widest(GAPS[0]) + TICK_SIZE);
        let ticks = (self.x.ticks(gap), self.y.ticks(GAPS[1]));
        let mut grid = PathData::default();
        for x in ticks.0.iter().map(|tick| self.x.at(tick.value)) {
            grid.move_to([x, top]);
            grid.line_to([x, bottom]);
        }
        for y in ticks.1.iter().map(|tick| self.y.at(tick.value)) {
            grid.move_to([left, y]);
            grid.line_to([right, y]);
        }
        svg.empty("path", &[("d", &grid), ("stroke", &"#e4e7ea"), ("stroke-width", &"0.6"), ("fill", &"none")]);
        svg.start("g", &[("font-size", &PixelCoordinate(TICK_SIZE)), ("fill", &"#3a3f45")]);
        for tick in &ticks.0 {
            svg.label([self.x.at(tick.value), bottom + 13.0], "middle", &[], &tick.label);
        }
        for tick in &ticks.1 {
            svg.label([left - 5.0, self.y.at(tick.value) + 3.5], "end", &[], &tick.label);
        }
        svg.end();
        svg.start("g", &[("font-size", &PixelCoordinate(AXIS_SIZE)), ("fill", &"#1d2125")]);
        svg.label([middle[0], bottom + 29.0], "middle", &[], titles[0]);
        let at = [left - 12.0 - self.y.widest(GAPS[1]), middle[1]];
        let turned = format!("rotate(-90 {} {})", PixelCoordinate(at[0]), PixelCoordinate(at[1]));
        svg.label(at, "middle", &[("transform", &turned)], titles[1]);
        svg.end();
    }

    /// The border of the plot, to be drawn over its content.
    pub(super) fn draw_border(&self, svg: &mut SvgWriter) {
        let [left, top, right, bottom] = self.edges;
        svg.empty(
            "rect",
            &[
                ("x", &PixelCoordinate(left)),
                ("y", &PixelCoordinate(top)),
                ("width", &PixelCoordinate(right - left)),
                ("height", &PixelCoordinate(bottom - top)),
                ("fill", &"none"),
                ("stroke", &"#3a3f45"),
                ("stroke-width", &"0.8"),
            ],
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(lo: f64, hi: f64) -> Vec<String> {
        Axis::new(Interval::new(lo, hi), [0.0, 400.0]).ticks(60.0).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_and_cover_both_ends() {
        assert_eq!(labels(0.0, 10.0), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(-1.0, 1.0), ["\u{2212}1.0", "\u{2212}0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(0.0, 0.3), ["0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"]);
        assert_eq!(labels(0.0, 1e6).last().map(String::as_str), Some("1000000"));
    }

    #[test]
    fn an_axis_without_extent_is_widened() {
        for value in [0.0, 1.0, -1e6] {
            let axis = Axis::new(Interval::new(value, value), [0.0, 400.0]);
            assert!(axis.at(value).is_finite() && axis.units_per_pixel() > 0.0);
            let ticks = axis.ticks(60.0);
            assert!(!ticks.is_empty() && ticks.len() < 10);
            let distinct: std::collections::HashSet<_> = ticks.iter().map(|tick| &tick.label).collect();
            assert_eq!(distinct.len(), ticks.len());
        }
    }
}
