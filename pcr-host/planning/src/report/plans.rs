//! Plans as text.

use super::proofs::proof_line;
use super::text_table::TextTable;
use super::{all_called, display_name, heading, quoted};
use crate::figures::{above, below, exact};
use crate::plan::{PlanCosts, PlanEntry, PlanReport};
use std::collections::HashMap;
use std::io::{self, Write};

/// Largest number of reasons that are told to people.
const REASONS: usize = 40;

/// The header line of [`plan_csv`].
pub const PLAN_CSV_HEADER: &str = "name,id,delay,t_end,label\n";

/// A line an agent, in the order of the file: numbers that read back exactly.
///
/// # Errors
/// Errors of the writer.
pub fn plan_csv(plan: &PlanReport, out: &mut dyn Write) -> io::Result<()> {
    let name = quoted(&plan.name);
    for agent in &plan.agents {
        writeln!(out, "{name},{},{},{},{}", agent.id, agent.delay, agent.t_end, quoted(plan.labels.get(agent.id)))?;
    }
    Ok(())
}

/// The plan for reading: the agents by priority.
///
/// # Errors
/// Errors of the writer.
pub fn plan_table(plan: &PlanReport, out: &mut dyn Write) -> io::Result<()> {
    let name = heading(&plan.name);
    let left_out = all_called(&plan.labels, &plan.left_out);
    match (plan.costs, plan.left_out.is_empty()) {
        (None, _) => writeln!(out, "{name}: no plan")?,
        (Some(_), true) => writeln!(out, "{name}: a plan without conflicts, by {}", means(plan))?,
        (Some(_), false) => {
            writeln!(out, "{name}: a plan without conflicts for some, by {}; left out: {left_out}", means(plan))?;
        }
    }
    reasons(plan).try_for_each(|reason| writeln!(out, "  {reason}"))?;
    let Some(costs) = plan.costs else { return Ok(()) };
    let title = if plan.labels.is_empty() { "agent" } else { "<agent" };
    let mut columns = TextTable::new(&[title, "delay [s]", "t_end [s]"]);
    let agents: HashMap<u64, &PlanEntry> = plan.agents.iter().map(|agent| (agent.id, agent)).collect();
    let by_priority = plan.order.iter().filter_map(|id| agents.get(id));
    for agent in by_priority {
        columns.row(vec![display_name(&plan.labels, agent.id), exact(agent.delay), above(agent.t_end)]);
    }
    columns.write(out)?;
    writeln!(out, "{}", costs_line(costs, plan.objective))?;
    match &plan.certificate {
        Some(proof) => writeln!(out, "{}", proof_line(proof, &plan.labels)),
        None => Ok(()),
    }
}

/// Why there is no plan for all, a line a reason; of many the first ones.
pub fn reasons(plan: &PlanReport) -> impl Iterator<Item = String> {
    let more = plan.unsolved.len().checked_sub(REASONS).filter(|more| *more > 0);
    let reasons = plan.unsolved.iter().take(REASONS).map(|unsolved| match unsolved.ids.as_slice() {
        [] => unsolved.why.clone(),
        [id] => format!("agent {}: {}", display_name(&plan.labels, *id), unsolved.why),
        ids => format!("agents {}: {}", all_called(&plan.labels, ids), unsolved.why),
    });
    reasons.chain(more.map(|more| format!("and {more} more (--json)")))
}

/// What a plan leaves open, in a line: all agents, or those that it leaves out; `None` if it is for all.
pub fn left_open(plan: &PlanReport) -> Option<String> {
    match (plan.costs, plan.left_out.as_slice()) {
        (None, _) => Some("no plan".into()),
        (Some(_), []) => None,
        (Some(_), ids) => Some(format!("left out: {}", all_called(&plan.labels, ids))),
    }
}

fn means(plan: &PlanReport) -> &'static str {
    if plan.method == "speed" { "speeds" } else { "start delays" }
}

/// The costs of a plan, and the gap to its lower bound.
fn costs_line(PlanCosts { makespan, sum_of_costs, lower_bound, gap, proved }: PlanCosts, objective: &str) -> String {
    let what = if objective == "makespan" { "makespan" } else { "sum of costs" };
    let good = match proved {
        true => format!("the {what} is proved to be the least"),
        false => format!("the {what} is at least {} s, gap {:.2} %", below(lower_bound), 100.0 * gap),
    };
    format!("makespan {makespan:.3} s, sum of costs {sum_of_costs:.3} s; {good}")
}
