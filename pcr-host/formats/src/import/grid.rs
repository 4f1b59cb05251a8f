//! Plans on grids, in the format of CBS, PBS, LNS and similar planners: one line for each agent, one cell for each
//! step.
//!
//! ```text
//! 2
//! Agent 0: (3,1)->(3,2)->(3,2)->
//! Agent 1: (0,0)->(1,0)->
//! ```
//!
//! Cells are squares of 1 m, steps take 1 s; the first number of a cell is x. A repeated cell is a wait. Agents stay in
//! their last cells.

use super::ImportError;
use super::json_access::is_open;
use super::timed_paths::{self, TimedPoint};
use crate::byte_order_mark::unmarked;
use crate::scenario::Scenario;

/// Radius where no other is given \[m\]. Two agents of a valid plan come as near as √2/2 m, where one leaves a cell that another one enters
/// around a corner. This leaves 3.5 mm of each radius to what turns in place and rounding displace, and to the tolerance of the search for
/// conflicts, which is 0.2 mm at the farthest cell.
pub(super) const RADIUS: f64 = 0.35;

/// Most cells of a file, waits counted.
const MOST: usize = 2_000_000;

/// Largest number of a cell.
const FARTHEST: u32 = 1_000_000;

/// A plan on a grid: the cells of each agent, one a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GridPlan {
    /// None of them empty; the cell after a cell is the same one or shares a side with it.
    cells: Vec<Vec<[i32; 2]>>,
}

/// Whether a text begins like one.
pub(super) fn is_plan(text: &str) -> bool {
    let mut lines = unmarked(text).lines().map(str::trim).filter(|line| !line.is_empty());
    let first = lines.next().unwrap_or_default();
    let line = if first.parse::<u32>().is_ok() { lines.next().unwrap_or_default() } else { first };
    line.strip_prefix("Agent ").is_some_and(|rest| rest.contains(':') && rest.contains('('))
}

impl GridPlan {
    /// Reads the plan in a file.
    ///
    /// # Errors
    /// [`ImportError`] with the line, also for a step to a cell that shares no side with the one before.
    pub fn read(text: &str) -> Result<Self, ImportError> {
        let lines = unmarked(text).lines().enumerate().map(|(number, whole)| (number, whole, whole.trim()));
        let (mut cells, mut told, mut count) = (Vec::new(), None, 0);
        let mut arrow = None;
        for (number, whole, line) in lines.filter(|(_, _, line)| !line.is_empty()) {
            let wrong = |problem: String| ImportError::at(number + 1, None, problem);
            if cells.is_empty() && told.is_none() && !line.starts_with("Agent") {
                told = Some(line.parse::<usize>().map_err(|_| wrong("a number of agents is expected".into()))?);
                continue;
            }
            let place = cells.len();
            let path = line.strip_prefix(&format!("Agent {place}:"));
            let path = path.ok_or_else(|| wrong(format!("`Agent {place}:` and its cells are expected")))?;
            // Planners write an arrow after each cell, or between two cells: a line that differs was cut after a cell.
            if *arrow.get_or_insert(path.ends_with("->")) != path.ends_with("->") {
                return Err(wrong(
                    "it ends with an arrow and the lines before do not, or the other way round: it was cut".into(),
                ));
            }
            let path = steps(path).map_err(|(field, problem)| {
                // The field is a part of the line.
                let before = (field.as_ptr() as usize).checked_sub(whole.as_ptr() as usize);
                let column = before.and_then(|bytes| whole.get(..bytes)).map(|before| before.chars().count() + 1);
                ImportError::at(number + 1, column, problem)
            })?;
            count += path.len();
            if count > MOST {
                return Err(wrong(format!("more than {MOST} cells up to here")));
            }
            cells.push(path);
        }
        // Planners end the last line as well. What was cut after an arrow is only to be told by that.
        if arrow == Some(true) && is_open(text) {
            let problem = "the last line does not end: the file may have been cut there, after an arrow";
            return Err(ImportError::new(problem));
        }
        match told {
            Some(told) if told != cells.len() => {
                Err(ImportError::new(format!("{told} agents are announced, {} are there", cells.len())))
            }
            _ if cells.is_empty() => Err(ImportError::new("there is no agent in it")),
            _ => Ok(Self { cells }),
        }
    }

    /// The cells of each agent, one a step.
    pub fn cells(&self) -> &[Vec<[i32; 2]>] {
        &self.cells
    }

    /// Discs of this radius \[m\] that follow the plan, numbered from 0.
    ///
    /// # Errors
    /// [`ImportError`]; none for plans that were read.
    pub fn scenario(&self, radius: f64) -> Result<Scenario, ImportError> {
        let agent = |(id, cells): (usize, &Vec<[i32; 2]>)| timed_paths::agent(id as u64, radius, &stops(cells));
        let agents = self.cells.iter().enumerate().map(agent).collect::<Result<_, _>>()?;
        Ok(Scenario::new("", agents))
    }
}

/// The cells of an agent: `(3,1)->(3,2)->`; or the part of the text that is wrong, and why.
fn steps(path: &str) -> Result<Vec<[i32; 2]>, (&str, String)> {
    let mut cells: Vec<[i32; 2]> = Vec::new();
    let path = path.trim();
    // There may be an arrow after the last cell, but only one: what follows another one would be left out.
    for (number, field) in path.strip_suffix("->").unwrap_or(path).split("->").map(str::trim).enumerate() {
        let inner = field.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
        let cell = inner.and_then(|inner| {
            let (x, y) = inner.split_once(',')?;
            let number = |text: &str| text.trim().parse::<i32>().ok().filter(|it| it.unsigned_abs() <= FARTHEST);
            Some([number(x)?, number(y)?])
        });
        let cell =
            cell.ok_or_else(|| (field, format!("cell {number}: two whole numbers up to {FARTHEST} are expected")))?;
        if let Some(last) = cells.last()
            && last[0].abs_diff(cell[0]) + last[1].abs_diff(cell[1]) > 1
        {
            return Err((field, format!("cell {number}: it shares no side with the one before")));
        }
        cells.push(cell);
    }
    Ok(cells)
}

/// The cells where an agent turns, sets off or stops, and the times.
fn stops(cells: &[[i32; 2]]) -> Vec<TimedPoint> {
    let step = |k: usize| cells.get(k + 1).map(|next| [next[0] - cells[k][0], next[1] - cells[k][1]]);
    let way = cells.iter().rposition(|cell| Some(cell) != cells.last()).map_or(0, |last| last + 1);
    let turns = (0..=way).filter(|&k| k == 0 || k == way || step(k) != step(k - 1));
    turns.map(|k| (cells[k].map(f64::from), k as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_runs_and_waits_are_one_stop_each() {
        let plan = GridPlan::read("1\nAgent 0: (0,0)->(1,0)->(2,0)->(2,0)->(2,0)->(2,1)->(2,1)->\n").expect("a plan");
        let expected = [([0.0, 0.0], 0.0), ([2.0, 0.0], 2.0), ([2.0, 0.0], 4.0), ([2.0, 1.0], 5.0)];
        assert_eq!(stops(&plan.cells()[0]), expected);
        assert_eq!(stops(&[[3, 3], [3, 3]]), [([3.0, 3.0], 0.0)]);
        assert_eq!(stops(&[[3, 3], [3, 4], [3, 5]]), [([3.0, 3.0], 0.0), ([3.0, 5.0], 2.0)]);
    }

    #[test]
    fn what_is_no_plan_is_refused_with_its_line() {
        let message = |text: &str| {
            let error = GridPlan::read(text).unwrap_err();
            error.line.map_or_else(String::new, |line| format!("line {line}: ")) + &error.problem
        };
        assert_eq!(message("x"), "line 1: a number of agents is expected");
        assert_eq!(message("2\nAgent 0: (0,0)->\n"), "2 agents are announced, 1 are there");
        assert_eq!(message("1\nAgent 1: (0,0)->"), "line 2: `Agent 0:` and its cells are expected");
        assert_eq!(message("Agent 0: (0,0)->(1,1)"), "line 1: cell 1: it shares no side with the one before");
        let error = GridPlan::read("1\n  Agent 0: (0,0)->(1,1)\n").unwrap_err();
        assert_eq!(error.in_file("p.txt"), "p.txt:2:19: cell 1: it shares no side with the one before");
        assert_eq!(message("Agent 0:"), "line 1: cell 0: two whole numbers up to 1000000 are expected");
        for (cell, path) in [
            (1, "(0,0)->->(1,0)->"),
            (1, "(0,0)-> ->(1,0)"),
            (1, "(0,0)->->"),
            (0, "->(0,0)"),
            (0, "->"),
            (0, "(-2147483648,0)"),
            (0, "(0,2147483648)"),
        ] {
            let expected = format!("line 1: cell {cell}: two whole numbers up to 1000000 are expected");
            assert_eq!(message(&format!("Agent 0: {path}")), expected);
        }
        assert_eq!(
            message("Agent 0: (0,0)->(0,9999999)"),
            "line 1: cell 1: two whole numbers up to 1000000 are expected"
        );
        for [first, last] in [["(0,0)->(1,0)->", "(0,2)->(1,2)"], ["(0,0)->(1,0)", "(0,2)->(1,2)->"]] {
            let expected =
                "line 3: it ends with an arrow and the lines before do not, or the other way round: it was cut";
            assert_eq!(message(&format!("2\nAgent 0: {first}\nAgent 1: {last}\n")), expected);
        }
        let cut = "the last line does not end: the file may have been cut there, after an arrow";
        assert_eq!(message("2\nAgent 0: (0,0)->(1,0)->(2,0)->\nAgent 1: (2,2)->(2,1)->"), cut);
        assert!(GridPlan::read("Agent 0: (0,0)->(1,0)").is_ok() && GridPlan::read("Agent 0: (0,0)->\n").is_ok());
        assert_eq!(message("0"), "there is no agent in it");
        assert_eq!(message("2\n3\nAgent 0: (0,0)->"), "line 2: `Agent 0:` and its cells are expected");
        assert!(!is_plan("Agent Smith: here") && !is_plan("Agent (1,2)"));
        assert!(is_plan("3\n\nAgent 0: (1,2)") && !is_plan("Agent") && !is_plan("1 2\n3 4"));
    }
}
