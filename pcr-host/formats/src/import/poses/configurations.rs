//! Results of LaCAM and its relatives: lines `key=value`, then `solution=` and a line `t:(x,y),(x,y),` for each step, with the cell of each
//! agent.
//!
//! A step to a neighbouring cell takes 1 s and goes straight; agents stay in their last cells.

use super::super::ImportError;
use super::pose_log::{PoseLogBuilder, PoseTime, RawPose};

/// Largest number of a cell.
const FARTHEST: u32 = 1_000_000;

/// A cell, and the number of characters before it in its line.
type PlacedCell = ([i32; 2], usize);

/// Reads the plan in a text.
pub(super) fn read(text: &str, log: &mut PoseLogBuilder<'_>) -> Result<(), ImportError> {
    (log.stands_at_ends, log.is_straight) = (true, true);
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    let (mut agents, mut makespan) = (None, None);
    for (number, line) in lines.by_ref() {
        let Some((key, value)) = line.trim().split_once('=') else {
            return Err(ImportError::at(number, Some(1), "`key=value` or `solution=` is expected"));
        };
        let count = || {
            let column = line.find('=').map(|at| at + 2);
            value
                .parse::<usize>()
                .map_err(|_| ImportError::at(number, column, format!("{key}: a whole number is expected")))
        };
        match key {
            "solution" => break,
            "agents" => agents = Some(count()?),
            "makespan" => makespan = Some(count()?),
            "solved" if count()? == 0 => {
                return Err(ImportError::at(number, Some(1), "solved=0: the file says that there is no plan"));
            }
            _ => {}
        }
    }
    let (mut before, mut steps): (Vec<[i32; 2]>, usize) = (Vec::new(), 0);
    for (number, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let cells =
            cells(line, steps).map_err(|(column, problem)| ImportError::at(number, Some(column + 1), problem))?;
        let expected = agents.unwrap_or(if steps == 0 { cells.len() } else { before.len() });
        if cells.len() != expected {
            let problem = format!("{} cells for {expected} agents", cells.len());
            return Err(ImportError::at(number, Some(line.chars().count() + 1), problem));
        }
        for (k, (cell, column)) in cells.iter().enumerate() {
            let place = (number, Some(column + 1));
            if let Some(last) = before.get(k)
                && last[0].abs_diff(cell[0]) + last[1].abs_diff(cell[1]) > 1
            {
                let problem = format!("agent {k}: this cell shares no side with the one before");
                return Err(ImportError::at(place.0, place.1, problem));
            }
            let (agent, map) = (log.agent(&k.to_string()), log.map(""));
            let (time, point) = (PoseTime::seconds(steps as f64), cell.map(f64::from));
            log.add(agent, RawPose { time, point, heading: None, error: 0.0, map, is_joined: true, place })?;
        }
        before = cells.into_iter().map(|(cell, _)| cell).collect();
        steps += 1;
    }
    match makespan {
        Some(makespan) if makespan + 1 != steps => Err(ImportError::new(format!(
            "makespan={makespan}, and there are {steps} configurations: the file was cut, or is another one"
        ))),
        _ => Ok(()),
    }
}

/// The cells of a step; or the number of characters before what is wrong, and why.
fn cells(line: &str, step: usize) -> Result<Vec<PlacedCell>, (usize, String)> {
    let column = |byte: usize| line.get(..byte).map_or(0, |before| before.chars().count());
    let list = line.strip_prefix(&format!("{step}:")).ok_or_else(|| (0, format!("`{step}:` is expected")))?;
    let mut at = line.len() - list.len();
    let mut cells = Vec::new();
    let end = line.trim_end().len();
    while at < end {
        let wrong = || (column(at), format!("`(x,y)` with whole numbers up to {FARTHEST} is expected"));
        let rest = line.get(at..end).unwrap_or_default();
        let close = rest.find(')').ok_or_else(wrong)?;
        let inner = rest.get(..close).and_then(|field| field.strip_prefix('(')).ok_or_else(wrong)?;
        let (x, y) = inner.split_once(',').ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse::<i32>().ok().filter(|it| it.unsigned_abs() <= FARTHEST);
        let (Some(x), Some(y)) = (number(x), number(y)) else { return Err(wrong()) };
        cells.push(([x, y], column(at)));
        at += close + 1;
        match line.as_bytes().get(at) {
            Some(b',') => at += 1,
            None => {}
            Some(_) if at == end => {}
            Some(_) => return Err((column(at), "`,` is expected".into())),
        }
    }
    Ok(cells)
}
