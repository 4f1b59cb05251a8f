//! What closures and breakdowns did, for reading.

use crate::lifelong::site_changes::{BreakdownEntry, ClosureEntry, UnreachableEntry};
use pcr_planning::report::{counted, printable};
use std::io::{self, Write};

/// One line for each, and one for the tasks that could not be done because of it.
pub(super) fn site_changes(
    closures: &[ClosureEntry],
    breakdowns: &[BreakdownEntry],
    out: &mut dyn Write,
) -> io::Result<()> {
    let until = |until: Option<f64>| until.map_or_else(|| "for ever".to_owned(), |until| format!("until {until} s"));
    let list = |ids: &[String]| match ids {
        [] => "nobody".to_owned(),
        ids => printable(&ids.join(", ")).to_string(),
    };
    for it in closures {
        let names = [("edge", &it.edge), ("node", &it.node), ("zone", &it.zone)];
        let named = names.iter().find_map(|(kind, name)| Some(format!("{kind} {}", name.as_deref()?)));
        let what = printable(&named.unwrap_or_default()).to_string();
        let done = it.speed.map_or_else(|| "closed".to_owned(), |speed| format!("limited to {speed} m/s"));
        if !it.begun {
            writeln!(out, "{what} would have been {done} from {} s, after the end", it.at)?;
            continue;
        }
        if it.speed.is_some() {
            writeln!(
                out,
                "{what} {done} from {} s {}: {} slowed down, {} could not brake before it, {} went another way",
                it.at,
                until(it.until),
                list(&it.slowed),
                list(&it.through),
                list(&it.rerouted)
            )?;
            continue;
        }
        writeln!(
            out,
            "{what} {done} from {} s {}: {} drove through, {} went another way, {} waited",
            it.at,
            until(it.until),
            list(&it.through),
            list(&it.rerouted),
            list(&it.waited)
        )?;
        unreachable(&it.unreachable, out)?;
    }
    for it in breakdowns {
        let vehicle = printable(&it.vehicle);
        let place = match (it.x, it.y, &it.edge) {
            (Some(x), Some(y), Some(edge)) => format!(" on edge {edge} at ({x:.2}, {y:.2})"),
            (Some(x), Some(y), None) => format!(" at ({x:.2}, {y:.2})"),
            _ if it.begun => {
                writeln!(out, "{vehicle} is not on the layout and cannot break down at {} s", it.at)?;
                continue;
            }
            _ => {
                writeln!(out, "{vehicle} would have broken down at {} s, after the end", it.at)?;
                continue;
            }
        };
        writeln!(
            out,
            "{vehicle} stands still from {} s {}{}: {} went another way, {} waited",
            it.at,
            until(it.until),
            printable(&place),
            list(&it.rerouted),
            list(&it.waited)
        )?;
        unreachable(&it.unreachable, out)?;
    }
    Ok(())
}

/// The tasks that could not be done.
fn unreachable(tasks: &[UnreachableEntry], out: &mut dyn Write) -> io::Result<()> {
    for is_given_up in [true, false] {
        let mut nodes: Vec<(&str, usize)> = Vec::new();
        for it in tasks.iter().filter(|it| it.given_up == is_given_up) {
            match nodes.iter_mut().find(|node| node.0 == it.node) {
                Some(node) => node.1 += it.tasks,
                None => nodes.push((&it.node, it.tasks)),
            }
        }
        if !nodes.is_empty() {
            /// More nodes are counted only.
            const MOST: usize = 20;
            let count = nodes.iter().map(|node| node.1).sum();
            let names: Vec<&str> = nodes.iter().take(MOST).map(|node| node.0).collect();
            let more = if nodes.len() > MOST { format!(" and {} more", nodes.len() - MOST) } else { String::new() };
            let what = if is_given_up { "given up" } else { "had to wait for the end of it" };
            let where_to = printable(&names.join(", ")).to_string();
            writeln!(out, "  no way to {where_to}{more}: {} {what}", counted(count, "task"))?;
        }
    }
    Ok(())
}
