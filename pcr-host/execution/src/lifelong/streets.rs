//! A generated site of any size: crossing one-way streets, with bays on both sides.

use pcr_formats::import::{ElementId, ImportedLayout, Layout, LayoutEdge, LayoutNode, SizeSource, VehicleTraits};
use pcr_formats::scenario::{PathSegment, PlacedSegment};

/// Distance between two crossings \[m\].
const BLOCK: f64 = 6.0;

/// Distance from the street to the end of a bay \[m\].
const BAY: f64 = 1.8;

/// Vehicles as in a warehouse.
const VEHICLE: VehicleTraits = VehicleTraits {
    name: None,
    radius: 0.4,
    footprint: None,
    size: SizeSource::Option,
    margin: 0.0,
    speed: 1.0,
    acceleration: 0.5,
    rotation: 1.0,
    rotation_acceleration: 1.0,
};

/// `count` streets each way, an even number of at least 2, one-way in alternating directions; in the middle of each block a bay
/// on either side. Each node can be reached from all others, and robots in bays are in no other robot's way.
pub fn streets(count: usize) -> ImportedLayout {
    let count = count.next_multiple_of(2).max(2);
    let mut plan = StreetLayout::default();
    let crossings: Vec<usize> =
        (0..count * count).map(|k| plan.node([(k % count) as f64 * BLOCK, (k / count) as f64 * BLOCK])).collect();
    for street in 0..count {
        for block in 1..count {
            // The four streets at the border form a ring.
            let along = [crossings[street * count + block - 1], crossings[street * count + block]];
            let across = [crossings[(block - 1) * count + street], crossings[block * count + street]];
            for (mut ends, turned) in [(along, street % 2 == 1), (across, street % 2 == 0)] {
                if turned {
                    ends.reverse();
                }
                plan.block(ends);
            }
        }
    }
    let name = format!("{count} streets each way");
    let layout =
        Layout { name, levels: vec![String::new()], nodes: plan.nodes, edges: plan.edges, ..Layout::default() };
    ImportedLayout { layout, vehicle: VEHICLE }
}

/// Distance between the middles of the two lanes of an aisle \[m\].
const LANES: f64 = 0.9;

/// Distance between two aisles, and length of an aisle between two cross aisles \[m\].
const AISLES: [f64; 2] = [6.0, 12.0];

/// `count` aisles of a warehouse, at least 2, between two cross aisles, with bays on both sides; all of them have a lane for each direction, so
/// near each other that vehicles pass each other only if they are narrow.
pub fn aisles(count: usize) -> ImportedLayout {
    let count = count.max(2);
    let mut plan = StreetLayout::default();
    let half = 0.5 * LANES;
    // At a crossing, lanes form a ring: those to the east, north, west and south begin at the corners south-east, north-east and so on.
    let corners = [[half, -half], [half, half], [-half, half], [-half, -half]];
    let rings: Vec<[usize; 4]> = (0..2 * count)
        .map(|place| {
            let at = [(place % count) as f64 * AISLES[0], (place / count) as f64 * AISLES[1]];
            let ring = corners.map(|corner| plan.node([at[0] + corner[0], at[1] + corner[1]]));
            (0..4).for_each(|k| plan.edge([ring[(k + 3) % 4], ring[k]], false));
            ring
        })
        .collect();
    for aisle in 0..count {
        let [south, north] = [rings[aisle], rings[count + aisle]];
        plan.lane([south[1], north[0]]);
        plan.lane([north[3], south[2]]);
        for row in [0, count].into_iter().filter(|_| aisle > 0) {
            let [west, east] = [rings[row + aisle - 1], rings[row + aisle]];
            plan.edge([west[0], east[3]], false);
            plan.edge([east[2], west[1]], false);
        }
    }
    let name = format!("{count} aisles of two lanes");
    let layout =
        Layout { name, levels: vec![String::new()], nodes: plan.nodes, edges: plan.edges, ..Layout::default() };
    ImportedLayout { layout, vehicle: VEHICLE }
}

#[derive(Default)]
struct StreetLayout {
    nodes: Vec<LayoutNode>,
    edges: Vec<LayoutEdge>,
}

impl StreetLayout {
    fn node(&mut self, at: [f64; 2]) -> usize {
        self.nodes.push(LayoutNode { id: ElementId::Number(self.nodes.len() as u64), name: None, level: 0, point: at });
        self.nodes.len() - 1
    }

    fn edge(&mut self, ends: [usize; 2], two_way: bool) {
        let [[x, y], [u, v]] = ends.map(|node| self.nodes[node].point);
        let shape = PathSegment::Line { length: (u - x).hypot(v - y) };
        let curve = vec![PlacedSegment { start: [x, y], heading: (v - y).atan2(u - x), shape }];
        let id = ElementId::Number(self.edges.len() as u64);
        self.edges.push(LayoutEdge { ways: [true, two_way], ..LayoutEdge::new(id, ends, curve) });
    }

    /// The lane of an aisle, with bays to its right.
    fn lane(&mut self, ends: [usize; 2]) {
        /// Number of bays.
        const BAYS: usize = 3;
        let [[x, y], [u, v]] = ends.map(|node| self.nodes[node].point);
        let length = (u - x).hypot(v - y);
        let right = [(v - y) / length * BAY, (x - u) / length * BAY];
        let mut last = ends[0];
        for k in 1..=BAYS {
            let share = k as f64 / (BAYS + 1) as f64;
            let at = [x + (u - x) * share, y + (v - y) * share];
            let node = self.node(at);
            let bay = self.node([at[0] + right[0], at[1] + right[1]]);
            self.edge([last, node], false);
            self.edge([node, bay], true);
            last = node;
        }
        self.edge([last, ends[1]], false);
    }

    /// The part of a street between two crossings, with its bays.
    fn block(&mut self, ends: [usize; 2]) {
        let [[x, y], [u, v]] = ends.map(|node| self.nodes[node].point);
        let (middle, side) = ([0.5 * (x + u), 0.5 * (y + v)], [(v - y) / BLOCK * BAY, (x - u) / BLOCK * BAY]);
        let node = self.node(middle);
        self.edge([ends[0], node], false);
        self.edge([node, ends[1]], false);
        for sign in [1.0, -1.0] {
            let bay = self.node([middle[0] + sign * side[0], middle[1] + sign * side[1]]);
            self.edge([node, bay], true);
        }
    }
}
