//! Selects agents that can all arrive if they start in some order.
//!
//! If a region of two agents contains the start of the first, or the end of the second, the first passes it before the
//! second, whenever they start. If two agents have to go before one another, or several in a cycle, there is no order.

use pcr_core::CapacityError;
use pcr_core::Motion;
use pcr_formats::scenario::{Agent, Scenario};
use pcr_planning::bodies::BodyFleet;
use pcr_planning::fleet::{FormatRangeError, build_ecm_of};
use pcr_planning::plan::sides;
use std::fmt;

/// More room than agents have in plans and checks \[m\]: what is decided here holds there.
const ROOM: f64 = 1e-6;

/// Why an agent cannot start among others.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum StartError {
    /// There is no order of starts in which all arrive.
    NoOrder,
    /// Its motion is out of range.
    Range(FormatRangeError),
    /// The table of its regions is too large.
    Full(CapacityError),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoOrder => f.write_str("no order of starts lets it through with those before it"),
            Self::Range(refused) => refused.fmt(f),
            Self::Full(full) => full.fmt(f),
        }
    }
}

/// Agents, each with those that have to start after it.
#[derive(Default)]
pub(super) struct StartableAgents {
    agents: Vec<BodyFleet<f64>>,
    after: Vec<Vec<usize>>,
}

impl StartableAgents {
    /// Adds an agent if there still is an order for all.
    ///
    /// # Errors
    /// Why it cannot be added.
    pub(super) fn add(&mut self, agent: &Agent) -> Result<(), StartError> {
        let alone = Scenario::new("", vec![agent.clone()]);
        let bodies = BodyFleet::<f64>::new(&alone).map_err(StartError::Range)?;
        let [before, after] = self.order(&bodies)?.ok_or(StartError::NoOrder)?;
        before.iter().for_each(|&agent| self.after[agent].push(self.agents.len()));
        self.agents.push(bodies);
        self.after.push(after);
        Ok(())
    }

    /// The agents that have to start before an agent, and after it; `None` if there is no order.
    ///
    /// # Errors
    /// The limit of the table that is exceeded.
    fn order(&self, agent: &BodyFleet<f64>) -> Result<Option<[Vec<usize>; 2]>, StartError> {
        let others: Vec<(usize, Motion<'_, f64>)> = self
            .agents
            .iter()
            .enumerate()
            .flat_map(|(k, bodies)| grown(bodies).into_iter().map(move |motion| (k, motion)))
            .collect();
        let mut marks = [vec![false; self.agents.len()], vec![false; self.agents.len()]];
        for own in grown(agent) {
            let pair: Vec<Motion<'_, f64>> =
                std::iter::once(own).chain(others.iter().map(|(_, motion)| *motion)).collect();
            let ecm = build_ecm_of(&pair, 0).map_err(StartError::Full)?;
            for region in ecm.row(&pair, 0).expect("the table of the fleet") {
                let Some((other, _)) = others.get(region.other().wrapping_sub(1)) else { continue };
                let [goes_after, goes_before] = sides(&region);
                marks[0][*other] |= goes_after;
                marks[1][*other] |= goes_before;
            }
        }
        let places = |marks: &[bool]| -> Vec<usize> { (0..marks.len()).filter(|&agent| marks[agent]).collect() };
        let [before, after] = marks.map(|marks| places(&marks));
        // An order exists if no agent that has to come before can be reached from those that come after.
        let mut reached = vec![false; self.agents.len()];
        let mut open = after.clone();
        while let Some(next) = open.pop() {
            if !std::mem::replace(&mut reached[next], true) {
                open.extend(&self.after[next]);
            }
        }
        let circle = before.iter().any(|&agent| reached[agent]);
        Ok((!circle).then_some([before, after]))
    }
}

/// The motions of the bodies of an agent, with their margins and a little more.
fn grown(bodies: &BodyFleet<f64>) -> Vec<Motion<'_, f64>> {
    let motions = bodies.fleet.motions().into_iter();
    motions.map(|motion| motion.with_margin(motion.margin() + ROOM).unwrap_or(motion).inflated()).collect()
}
