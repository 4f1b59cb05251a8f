//! Our results for the paper's simulation beside the paper's figures.

use super::table::{NumberedCrossing, arc, numbered};
use super::text_table::TextTable;
use crate::regions::RegionsReport;
use pcr_formats::paper_example::{MISPRINT, PaperCrossing, ROUNDING, TABLE_V, TABLE_VII, TABLE_VII_AGENT};
use pcr_formats::scenario::Scenario;
use std::io::{self, Write};
use std::time::Duration;

/// Tables V and VII of the paper with our numbers, and how long the regions took.
///
/// # Errors
/// Errors of the writer.
pub fn overview(scenario: &Scenario, answer: &RegionsReport, took: Duration, out: &mut dyn Write) -> io::Result<()> {
    let crossings = numbered(&answer.regions);
    table_v(scenario, answer, &crossings, out)?;
    writeln!(out)?;
    table_vii(&crossings, out)?;
    let regions = answer.regions.len();
    let milliseconds = 1e3 * took.as_secs_f64();
    writeln!(out, "\nAll {regions} regions computed in {milliseconds:.3} ms (one run, one core, {}).", answer.scalar)
}

fn table_v(
    scenario: &Scenario,
    answer: &RegionsReport,
    crossings: &[NumberedCrossing<'_>],
    out: &mut dyn Write,
) -> io::Result<()> {
    writeln!(out, "Table V: the paper counts crossings of the paths; discs also collide where paths only come near,")?;
    writeln!(out, "and crossings that are close share a region, so the connected regions are counted apart.")?;
    let mut columns =
        TextTable::new(&["agent", "radius [m]", "<path", "length [m]", "time [s]", "crossings", "paper", "regions"]);
    let mut sums = [0; 3];
    for (agent, &paper) in scenario.agents.iter().zip(&TABLE_V) {
        let counts = [
            crossings.iter().filter(|crossing| crossing.i == agent.id).count(),
            paper,
            answer.regions.iter().filter(|region| region.i == agent.id).count(),
        ];
        let mut row = vec![agent.id.to_string(), format!("{:.2}", agent.circumscribed_radius()), agent.structure()];
        row.extend([agent.length(), agent.duration()].map(|number| format!("{number:.2}")));
        row.extend(counts.map(|count| count.to_string()));
        columns.row(row);
        for (sum, count) in sums.iter_mut().zip(counts) {
            *sum += count;
        }
    }
    let mut row = vec!["sum".to_owned()];
    row.extend(vec![String::new(); 4]);
    row.extend(sums.map(|sum| sum.to_string()));
    columns.row(row);
    columns.write(out)
}

fn table_vii(crossings: &[NumberedCrossing<'_>], out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "Table VII: the crossings of agent {TABLE_VII_AGENT}; under each title ours, then as the paper prints it"
    )?;
    let mut columns = TextTable::new(&[
        "row", "<type", "j", "k", "T [s]", "", "L [m]", "", "r_hat", "", "v_j", "", "theta", "", "arc of 3", "",
        "arc of j", "",
    ]);
    let own = crossings.iter().filter(|crossing| crossing.i == TABLE_VII_AGENT);
    let mut rows = 0;
    let mut agree = 0;
    for (index, (ours, paper)) in own.zip(&TABLE_VII).enumerate() {
        let number = index + 1;
        rows += 1;
        let mark = if agrees(ours, paper) {
            agree += 1;
            " "
        } else if number == MISPRINT {
            "*"
        } else {
            "!"
        };
        let crossing = ours.crossing;
        let mut row =
            vec![format!("{number}{mark}"), ours.piece_type.to_owned(), ours.j.to_string(), ours.k.to_string()];
        for (ours, paper) in [
            (crossing.time, paper.time),
            (crossing.length, paper.length),
            (crossing.r_hat, paper.r_hat),
            (crossing.v, paper.v),
            (crossing.theta, paper.theta),
        ] {
            row.extend([format!("{ours:.3}"), format!("{paper:.1}")]);
        }
        let printed = |sigma: Option<f64>| sigma.map_or(String::new(), |sigma| format!("{sigma:.1}"));
        let turn = paper.dir_j.map_or("", |dir| if dir > 0 { " ccw" } else { " cw " });
        row.extend([arc(crossing.sigma_i, crossing.dir_i), printed(paper.sigma_i)]);
        row.extend([arc(crossing.sigma_j, crossing.dir_j), format!("{}{turn}", printed(paper.sigma_j))]);
        columns.row(row);
    }
    columns.write(out)?;
    writeln!(
        out,
        "{agree} of {rows} rows agree to the printed digit; * the paper's sign of the turn in row {MISPRINT} is a misprint."
    )
}

/// Whether a crossing is what a row of the paper says, to the digit that it prints.
fn agrees(ours: &NumberedCrossing<'_>, paper: &PaperCrossing) -> bool {
    let near = |ours: f64, paper: f64| {
        /// The digits beside the printed one are decimal, ours binary.
        const SLIP: f64 = 1e-9;
        (ours - paper).abs() <= ROUNDING + SLIP
    };
    let same_arc = |ours: Option<f64>, paper: Option<f64>| match (ours, paper) {
        (Some(ours), Some(paper)) => near(ours, paper),
        (ours, paper) => ours.is_none() && paper.is_none(),
    };
    let crossing = ours.crossing;
    ours.piece_type == paper.piece_type
        && (ours.j, ours.k) == (paper.j, paper.k)
        && near(crossing.time, paper.time)
        && near(crossing.length, paper.length)
        && near(crossing.r_hat, paper.r_hat)
        && near(crossing.v, paper.v)
        && near(crossing.theta, paper.theta)
        && same_arc(crossing.sigma_i, paper.sigma_i)
        && same_arc(crossing.sigma_j, paper.sigma_j)
        && paper.dir_j.is_none_or(|dir| crossing.dir_j == Some(dir))
}
