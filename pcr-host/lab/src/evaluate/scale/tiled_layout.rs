//! Copies of a layout side by side, with random routes: a warehouse of any size with the same density as one copy.

use pcr_formats::import::{self, ImportError, ImportedLayout};
use pcr_formats::scenario::{Agent, Scenario};
use pcr_formats::splitmix64::SplitMix64;

/// Radius of the vehicles \[m\].
pub(super) const RADIUS: f64 = 0.4;

/// Agents of a copy.
pub(super) const AGENTS: usize = 20;

/// Between two copies: nobody reaches the next one \[m\].
const GAP: f64 = 4.0 * RADIUS;

/// A layout, and the routes between all its nodes.
pub(super) struct TiledLayout {
    imported: ImportedLayout,
    /// By the node where they begin, then by that where they end.
    routes: Vec<Option<Agent>>,
    /// From copy to copy \[m\].
    pitch: [f64; 2],
}

impl TiledLayout {
    /// All routes on a layout.
    ///
    /// # Errors
    /// [`ImportError`] where a way is no path.
    pub(super) fn new(imported: ImportedLayout) -> Result<Self, ImportError> {
        let nodes = &imported.layout.nodes;
        let ends = (0..nodes.len()).flat_map(|from| (0..nodes.len()).map(move |to| [from, to]));
        let route = |ends: [usize; 2]| {
            if ends[0] == ends[1] { Ok(None) } else { import::mission(&imported, 0, ends) }
        };
        let routes = ends.map(route).collect::<Result<Vec<_>, _>>()?;
        let pitch = [0, 1].map(|axis| {
            let at = nodes.iter().map(|node| node.point[axis]);
            at.clone().fold(f64::NEG_INFINITY, f64::max) - at.fold(f64::INFINITY, f64::min) + GAP
        });
        Ok(Self { imported, routes, pitch })
    }

    /// Floor of a copy \[m\], and its nodes and edges.
    pub(super) fn size(&self) -> ([f64; 2], [usize; 2]) {
        (self.pitch.map(|side| side - GAP), [self.imported.layout.nodes.len(), self.imported.layout.edges.len()])
    }

    /// So many agents, [`AGENTS`] a copy, each from one of its nodes to another one. The same seed gives the same fleet.
    pub(super) fn fleet(&self, agents: usize, seed: u64) -> Scenario {
        let columns = (agents as f64 / AGENTS as f64).sqrt().ceil() as usize;
        let nodes: Vec<usize> = (0..self.imported.layout.nodes.len()).collect();
        let mut random = SplitMix64(seed);
        let copies = (0..agents.div_ceil(AGENTS)).flat_map(|copy| {
            let ends = random.shuffled(&nodes).into_iter().zip(random.shuffled(&nodes));
            let routes = ends.filter_map(|(from, to)| self.routes.get(from * nodes.len() + to)?.as_ref());
            let offset = [copy % columns, copy / columns];
            let offset = [0, 1].map(|axis| offset[axis] as f64 * self.pitch[axis]);
            routes.take(AGENTS).map(|route| moved(route, offset)).collect::<Vec<_>>()
        });
        let named = copies.take(agents).zip(1..).map(|(agent, id)| Agent { id, ..agent });
        Scenario::new(format!("{agents} agents in copies of a warehouse"), named.collect())
    }
}

fn moved(agent: &Agent, offset: [f64; 2]) -> Agent {
    let [x, y, heading] = agent.start;
    Agent { start: [x + offset[0], y + offset[1], heading], ..agent.clone() }
}

#[cfg(test)]
mod tests {
    use super::super::super::PaperFleets;
    use super::*;
    use pcr_planning::fleet::{Fleet, build_ecm};

    #[test]
    fn agents_of_different_copies_do_not_meet() {
        let fleets = PaperFleets { all: Vec::new(), data: "../../tests/data".into() };
        let warehouse = fleets.warehouse(RADIUS).expect("it is there");
        let copies = TiledLayout::new(warehouse).expect("they are paths");
        let scenario = copies.fleet(5 * AGENTS, 3);
        assert_eq!(scenario.agents.len(), 5 * AGENTS);
        let fleet = Fleet::<f64>::new(&scenario).expect("it fits");
        let motions = fleet.motions();
        let table = build_ecm(&motions).expect("it fits");
        let regions = |ego: usize, others: std::ops::Range<usize>| -> usize {
            others.map(|other| table.pair(&motions, ego, other).expect("the table of the fleet").count()).sum()
        };
        let (mut within, mut between) = (0, 0);
        for ego in 0..motions.len() {
            let copy = ego / AGENTS * AGENTS;
            within += regions(ego, ego + 1..copy + AGENTS);
            between += regions(ego, copy + AGENTS..motions.len());
        }
        assert_eq!(between, 0);
        assert!(within > 5 * AGENTS, "{within}");
    }
}
