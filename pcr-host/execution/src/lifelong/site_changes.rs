//! Closures and breakdowns in the answers of `pcr traffic`: what became of the vehicles on whose routes they were.

use super::change_results::{ChangeResult, ChangeResults, UnreachableGoal};
use super::world_changes::ChangeEffect;
use pcr_formats::import::Layout;
use pcr_formats::missions::{ClosedElement, SiteChanges};
use serde::Serialize;

/// A closure or a limit of the speed, and what became of the vehicles on whose routes it was when it began. A vehicle can be in several lists:
/// one that drives through and would have come back gets another route.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClosureEntry {
    /// The edge, if it is one.
    pub edge: Option<String>,
    /// The node, if it is one.
    pub node: Option<String>,
    /// The zone, if it is one.
    pub zone: Option<String>,
    /// The largest speed there \[m/s\], if it is limited and open.
    pub speed: Option<f64>,
    /// From when \[s\].
    pub at: f64,
    /// Until when \[s\]; none: for ever.
    pub until: Option<f64>,
    /// Whether it began before the run was over.
    pub begun: bool,
    /// Vehicles that were on it, or too near to stop before it, and drove through; of a limit: faster than it until they had braked.
    pub through: Vec<String>,
    /// Vehicles that could stop before it, and got another route to their goals.
    pub rerouted: Vec<String>,
    /// Vehicles that could stop before it, and had to wait there or elsewhere.
    pub waited: Vec<String>,
    /// Vehicles that go on over what is limited, slower than before.
    pub slowed: Vec<String>,
    /// Tasks to which no route led because of it.
    pub unreachable: Vec<UnreachableEntry>,
}

/// A breakdown, and what became of the vehicles that would have waited for this one for ever.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BreakdownEntry {
    /// The vehicle.
    pub vehicle: String,
    /// From when \[s\].
    pub at: f64,
    /// Until when \[s\]; none: for ever.
    pub until: Option<f64>,
    /// Whether it began before the run was over.
    pub begun: bool,
    /// Edge on which the vehicle stands; none at a node, or if the breakdown did not begin.
    pub edge: Option<String>,
    /// Where it stands \[m\].
    pub x: Option<f64>,
    /// Where it stands \[m\].
    pub y: Option<f64>,
    /// Vehicles that got another route.
    pub rerouted: Vec<String>,
    /// Vehicles that had to wait.
    pub waited: Vec<String>,
    /// Tasks that could not be done because of it, also its own.
    pub unreachable: Vec<UnreachableEntry>,
}

/// Tasks of a vehicle to a node that it could not reach.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnreachableEntry {
    /// The vehicle.
    pub vehicle: String,
    /// The node.
    pub node: String,
    /// When the first of them was found to be unreachable \[s\].
    pub at: f64,
    /// Number of tasks.
    pub tasks: usize,
    /// Whether they were given up; otherwise they waited for the end of the change.
    pub given_up: bool,
}

/// The closures and breakdowns of a run, in the order of the files. `id` is the name of a vehicle.
pub(crate) fn entries(
    layout: &Layout,
    changes: &SiteChanges,
    results: &ChangeResults,
    id: impl Fn(usize) -> String,
) -> (Vec<ClosureEntry>, Vec<BreakdownEntry>) {
    let named = |result: &ChangeResult, effect: ChangeEffect| -> Vec<String> {
        result.effects.iter().filter(|it| it.1 == effect).map(|it| id(it.0)).collect()
    };
    let unreachable = |result: &ChangeResult| -> Vec<UnreachableEntry> {
        let entry = |lost: &UnreachableGoal| UnreachableEntry {
            vehicle: id(lost.vehicle),
            node: lost.node.clone(),
            at: lost.at,
            tasks: lost.tasks,
            given_up: lost.is_given_up,
        };
        result.unreachable.iter().map(entry).collect()
    };
    let closures = changes.closures.iter().zip(&results.closures).map(|(it, result)| {
        let (mut edge, mut node, mut zone) = (None, None, None);
        match it.element {
            ClosedElement::Edge(place) => edge = Some(layout.edges[place].id.to_string()),
            ClosedElement::Node(place) => node = Some(layout.nodes[place].id.to_string()),
            ClosedElement::Zone(place) => zone = Some(layout.zones[place].id.clone()),
        }
        ClosureEntry {
            edge,
            node,
            zone,
            speed: it.speed,
            at: it.at,
            until: it.until,
            begun: result.is_begun,
            through: named(result, ChangeEffect::Through),
            rerouted: named(result, ChangeEffect::Rerouted),
            waited: named(result, ChangeEffect::Waits),
            slowed: named(result, ChangeEffect::Slowed),
            unreachable: unreachable(result),
        }
    });
    let breakdowns = changes.breakdowns.iter().zip(&results.breakdowns).map(|(it, result)| BreakdownEntry {
        vehicle: id(it.vehicle),
        at: it.at,
        until: it.until,
        begun: result.is_begun,
        edge: result.place.as_ref().and_then(|place| place.0.clone()),
        x: result.place.as_ref().map(|place| place.1[0]),
        y: result.place.as_ref().map(|place| place.1[1]),
        rerouted: named(result, ChangeEffect::Rerouted),
        waited: named(result, ChangeEffect::Waits),
        unreachable: unreachable(result),
    });
    (closures.collect(), breakdowns.collect())
}
