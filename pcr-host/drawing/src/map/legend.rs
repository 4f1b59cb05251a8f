//! The legend of the lines and colours of a map.

use super::super::axis::TICK_SIZE;
use super::super::palette::{Colour, DISTINCT};
use super::super::region_scene::{DrawnRegion, RegionScene};
use super::super::svg::{PathData, PixelCoordinate, SvgWriter, lines, text_width};
use super::entry_mark;

/// Height of a row \[px\].
const ROW: f64 = 15.0;

/// Width of the sample of an entry \[px\].
const WIDTH: f64 = 14.0;

/// The same with its gap \[px\].
const SAMPLE: f64 = 19.0;

/// Distance from one entry to the next \[px\].
const GAP: f64 = 9.0;

/// The legend of a map, laid out in rows.
#[derive(Debug)]
pub(in super::super) struct Legend {
    entries: Vec<LegendEntry>,
    rows: usize,
}

#[derive(Debug)]
struct LegendEntry {
    row: usize,
    /// Left end \[px\].
    x: f64,
    sample: LegendSymbol,
    text: String,
}

#[derive(Clone, Copy, Debug)]
enum LegendSymbol {
    Trajectory,
    Region,
    Entry,
    Strip,
    Agent(Colour),
    /// A sentence, without a sample.
    Note,
}

impl Legend {
    /// The legend of a map with some notes, between two abscissas \[px\].
    pub(in super::super) fn new(
        scene: &RegionScene<'_>,
        ego: usize,
        shapes: &[DrawnRegion],
        notes: impl IntoIterator<Item = String>,
        [from, to]: [f64; 2],
    ) -> Self {
        let mut all = vec![(LegendSymbol::Trajectory, format!("motion of agent {}", scene.display_name(ego)))];
        if !shapes.is_empty() {
            let region = if scene.has_hulls() {
                "region of the convex hulls of all outlines, labelled by the other agent"
            } else {
                "collision region, labelled by the other agent"
            };
            all.push((LegendSymbol::Region, region.into()));
        }
        if !scene.entries(ego, shapes).is_empty() {
            all.push((LegendSymbol::Entry, "a conflict begins".into()));
        }
        if shapes.iter().any(|shape| !shape.before.is_empty() || !shape.after.is_empty()) {
            all.push((LegendSymbol::Strip, "the other agent stands at its start or end".into()));
        }
        // More colours than a dozen cannot be told apart: there the labels of the regions alone say whose they are.
        let told_apart = scene.motions.len() <= DISTINCT;
        let mut others: Vec<usize> = shapes.iter().map(|shape| shape.other).filter(|_| told_apart).collect();
        others.sort_unstable();
        others.dedup();
        let explained = all.len();
        all.extend(others.iter().map(|other| (LegendSymbol::Agent(scene.colour(*other)), scene.display_name(*other))));
        let (mut row, mut x) = (0, from);
        let mut entries = Vec::new();
        for (k, (sample, text)) in all.into_iter().enumerate() {
            let width = SAMPLE + text_width(&text, TICK_SIZE);
            if x > from && (k == explained || x + width > to) {
                (row, x) = (row + 1, from);
            }
            entries.push(LegendEntry { row, x, sample, text });
            x += width + GAP;
        }
        let mut legend = Self { entries, rows: row + 1 };
        notes.into_iter().for_each(|note| legend.note(&note, [from, to]));
        legend
    }

    /// Notes alone.
    pub(in super::super) fn of_notes(notes: impl IntoIterator<Item = String>, within: [f64; 2]) -> Self {
        let mut legend = Self { entries: Vec::new(), rows: 0 };
        notes.into_iter().for_each(|note| legend.note(&note, within));
        legend
    }

    /// One more, in rows of its own.
    fn note(&mut self, note: &str, [x, to]: [f64; 2]) {
        for text in lines(note, TICK_SIZE, to - x) {
            self.entries.push(LegendEntry { row: self.rows, x, sample: LegendSymbol::Note, text });
            self.rows += 1;
        }
    }

    /// \[px\]
    pub(in super::super) fn height(&self) -> f64 {
        self.rows as f64 * ROW
    }

    /// Draws it below `top` \[px\].
    pub(in super::super) fn draw(&self, svg: &mut SvgWriter, top: f64) {
        svg.start("g", &[("font-size", &PixelCoordinate(TICK_SIZE)), ("fill", &"#1d2125")]);
        for entry in &self.entries {
            let y = top + (entry.row as f64 + 0.5) * ROW;
            let rect =
                |svg: &mut SvgWriter, fill: &dyn std::fmt::Display, opacity: f64, stroke: &dyn std::fmt::Display| {
                    svg.empty(
                        "rect",
                        &[
                            ("x", &PixelCoordinate(entry.x)),
                            ("y", &PixelCoordinate(y - 4.0)),
                            ("width", &PixelCoordinate(WIDTH)),
                            ("height", &"8"),
                            ("fill", fill),
                            ("fill-opacity", &opacity),
                            ("stroke", stroke),
                            ("stroke-width", &"0.9"),
                        ],
                    );
                };
            match entry.sample {
                LegendSymbol::Trajectory => {
                    let mut line = PathData::default();
                    line.move_to([entry.x, y]);
                    line.line_to([entry.x + WIDTH, y]);
                    svg.empty("path", &[("d", &line), ("stroke", &"#111"), ("stroke-width", &"1.7")]);
                }
                LegendSymbol::Entry => entry_mark(svg, [entry.x + WIDTH / 2.0, y]),
                LegendSymbol::Region => rect(svg, &"#6b7178", 0.3, &"#6b7178"),
                LegendSymbol::Strip => {
                    rect(svg, &"none", 1.0, &"#6b7178");
                    let mut lines = PathData::default();
                    for x in [0.0, 5.0, 10.0].map(|x| entry.x + x) {
                        lines.move_to([x, y + 4.0]);
                        lines.line_to([x + 4.0, y - 4.0]);
                    }
                    svg.empty("path", &[("d", &lines), ("stroke", &"#6b7178"), ("stroke-width", &"0.7")]);
                }
                LegendSymbol::Agent(colour) => rect(svg, &colour, 0.3, &colour),
                LegendSymbol::Note => {}
            }
            let sample = if matches!(entry.sample, LegendSymbol::Note) { 0.0 } else { SAMPLE };
            svg.label([entry.x + sample, y + 0.35 * TICK_SIZE], "start", &[], &entry.text);
        }
        svg.end();
    }
}
