//! What the changes of a site did in a run.

use super::world_changes::{ChangeEffect, ChangeRecord, WorldChanges};

/// What closures and breakdowns did, each in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChangeResults {
    /// What each closure did.
    pub closures: Vec<ChangeResult>,
    /// What each breakdown did.
    pub breakdowns: Vec<ChangeResult>,
}

/// What a closure or breakdown did.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangeResult {
    /// Whether it began before the run was over.
    pub is_begun: bool,
    /// Vehicles on whose routes it was, and what became of them.
    pub effects: Vec<(usize, ChangeEffect)>,
    /// Where the vehicle that broke down stands: the id of its edge, `None` at a node, and the point \[m\].
    pub place: Option<(Option<String>, [f64; 2])>,
    /// Tasks that could not be done because of it.
    pub unreachable: Vec<UnreachableGoal>,
}

/// Tasks of a vehicle to a goal to which no route led because of a change.
#[derive(Clone, Debug, PartialEq)]
pub struct UnreachableGoal {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Id of the node.
    pub node: String,
    /// Time at which the first of the tasks was found to be unreachable \[s\].
    pub at: f64,
    /// Number of tasks.
    pub tasks: usize,
    /// Whether they were given up; otherwise they waited for the end of the change.
    pub is_given_up: bool,
}

impl WorldChanges {
    /// Returns what the changes of the site did.
    pub(super) fn results(&self) -> ChangeResults {
        let result = |it: &ChangeRecord| ChangeResult {
            is_begun: it.is_begun,
            effects: it.effects.clone(),
            place: it.place.map(|(edge, point)| (edge.map(|edge| self.edges[edge].clone()), point)),
            unreachable: it
                .unreachable
                .iter()
                .map(|lost| UnreachableGoal {
                    vehicle: lost.robot,
                    node: self.nodes[lost.node].clone(),
                    at: lost.at,
                    tasks: lost.tasks,
                    is_given_up: lost.is_given_up,
                })
                .collect(),
        };
        ChangeResults {
            closures: self.closures.iter().map(result).collect(),
            breakdowns: self.breakdowns.iter().map(result).collect(),
        }
    }
}
