//! Plans as text.

use super::columns::Columns;
use super::{all_called, called, heading, quoted};
use crate::plan::Plan;
use std::io::{self, Write};

/// The header line of [`plan_csv`].
pub const PLAN_CSV_HEADER: &str = "name,id,delay,t_end,label\n";

/// A line an agent, in the order of the file: numbers that read back exactly.
///
/// # Errors
/// Those of the writer.
pub fn plan_csv(plan: &Plan, out: &mut impl Write) -> io::Result<()> {
    let name = quoted(&plan.name);
    for agent in &plan.agents {
        writeln!(out, "{name},{},{},{},{}", agent.id, agent.delay, agent.t_end, quoted(plan.labels.get(agent.id)))?;
    }
    Ok(())
}

/// The plan for reading: the agents by priority.
///
/// # Errors
/// Those of the writer.
pub fn plan_table(plan: &Plan, out: &mut impl Write) -> io::Result<()> {
    let name = heading(&plan.name);
    if !plan.unsolved.is_empty() {
        writeln!(out, "{name}: no plan")?;
        for unsolved in &plan.unsolved {
            writeln!(out, "  agents {}: {}", all_called(&plan.labels, &unsolved.ids), unsolved.why)?;
        }
        return Ok(());
    }
    let means = if plan.method == "speed" { "speeds" } else { "start delays" };
    writeln!(out, "{name}: a plan without conflicts, by {means}; priorities from top to bottom")?;
    let title = if plan.labels.is_empty() { "agent" } else { "<agent" };
    let mut columns = Columns::new(&[title, "delay [s]", "t_end [s]"]);
    let by_priority = plan.order.iter().filter_map(|id| plan.agents.iter().find(|agent| agent.id == *id));
    for agent in by_priority {
        columns.row(vec![called(&plan.labels, agent.id), format!("{:.3}", agent.delay), format!("{:.3}", agent.t_end)]);
    }
    columns.write(out)?;
    let Plan { makespan, sum_of_costs, lower_bound, .. } = plan;
    writeln!(out, "makespan {makespan:.3} s, sum of costs {sum_of_costs:.3} s (at least {lower_bound:.3} s)")?;
    match &plan.certificate {
        Some(proof) => writeln!(out, "{}", proof.sentence()),
        None => Ok(()),
    }
}
