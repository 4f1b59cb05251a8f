//! Keeps the passing orders of a plan: each robot looks at the regions ahead that it passes second.

use super::{ExecutionRule, ROOM};
use crate::error::LabError;
use pcr_core::{CheckState, CheckTolerances, Motion, MovementAuthority, PassingState, Progress, RegionRef};
use pcr_planning::fleet::{HostPrecedenceTable, build_orders};

/// Distance ahead for which a robot computes its hold at a time: holds do not decrease \[m\].
const AHEAD: f64 = 2.0;

/// The orders in which the motions pass their regions; with these all robots can finish.
pub(super) fn table(motions: &[Motion<'_, f64>]) -> Result<HostPrecedenceTable, LabError> {
    let mut table = build_orders(motions)?;
    table.as_planned(motions)?;
    let progress = vec![Progress::at_rest(0.0); motions.len()];
    let tolerances = CheckTolerances { width: 0.0, gain: 1e-3 };
    let mut reaches = vec![CheckState::EMPTY; motions.len()];
    table.check(motions, &progress, tolerances, &mut reaches)?;
    Ok(table)
}

/// A region that a robot passes second.
struct YieldRegion<'a> {
    /// Index of the region.
    place: usize,
    region: RegionRef<'a, f64>,
    first: usize,
    /// Least and largest length of the robot in the region \[m\].
    entry: f64,
    over: f64,
    /// Length at which the first robot has left the region \[m\].
    exit: f64,
}

/// A region of two robots, the first of which is the ego, and which of the two passes it second.
pub(super) struct GridPrecedence<'a> {
    pub(super) region: RegionRef<'a, f64>,
    pub(super) robots: [usize; 2],
    pub(super) second: usize,
}

impl<'a> GridPrecedence<'a> {
    /// The region seen from one of the two.
    pub(super) fn seen(&self, side: usize) -> RegionRef<'a, f64> {
        if side == 0 { self.region.clone() } else { self.region.clone().swapped() }
    }
}

/// For each robot its orders, by their entries.
pub(super) struct FixedPrecedences<'a> {
    pub(super) pairs: Vec<GridPrecedence<'a>>,
    rows: Vec<Vec<YieldRegion<'a>>>,
    /// Holds computed so far.
    known: Vec<f64>,
}

impl<'a> FixedPrecedences<'a> {
    pub(super) fn new(table: &'a HostPrecedenceTable, motions: &'a [Motion<'a, f64>]) -> Result<Self, LabError> {
        let mut pairs = Vec::new();
        for robot in 0..motions.len() {
            let row = table.row(motions, robot)?;
            for (_, region, pass) in row.filter(|(_, region, _)| region.other() > robot) {
                let robots = [robot, region.other()];
                pairs.push(GridPrecedence { region, robots, second: usize::from(pass == PassingState::First) });
            }
        }
        let mut rows: Vec<Vec<YieldRegion<'a>>> = motions.iter().map(|_| Vec::new()).collect();
        for (place, pair) in pairs.iter().enumerate() {
            rows[pair.robots[pair.second]].push(YieldRegion::of(place, pair.seen(pair.second)));
        }
        rows.iter_mut().for_each(|row| row.sort_by(|a, b| a.entry.total_cmp(&b.entry)));
        Ok(Self { known: vec![f64::NEG_INFINITY; rows.len()], rows, pairs })
    }

    /// Makes the other robot pass a region second.
    pub(super) fn switch(&mut self, place: usize) {
        let pair = &mut self.pairs[place];
        self.rows[pair.robots[pair.second]].retain(|order| order.place != place);
        pair.second = 1 - pair.second;
        let (robot, order) = (pair.robots[pair.second], YieldRegion::of(place, pair.seen(pair.second)));
        let row = &mut self.rows[robot];
        row.insert(row.partition_point(|other| other.entry < order.entry), order);
        self.known[robot] = f64::NEG_INFINITY;
    }
}

impl<'a> YieldRegion<'a> {
    fn of(place: usize, region: RegionRef<'a, f64>) -> Self {
        let (own, their) = (region.length(), region.other_length());
        let leaves = their.hi < region.other_motion().path().length();
        let exit = if leaves { their.hi } else { f64::INFINITY };
        Self { place, first: region.other(), entry: own.lo, over: own.hi, exit, region }
    }
}

impl ExecutionRule for FixedPrecedences<'_> {
    fn authority(&mut self, robot: usize, at: &[f64], wanted: f64) -> f64 {
        if self.known[robot] >= wanted {
            return self.known[robot];
        }
        let own = at[robot];
        let row = &mut self.rows[robot];
        row.retain(|order| at[order.first] <= order.exit && own <= order.over);
        let mut least = own + AHEAD;
        for order in row.iter() {
            if order.entry >= least {
                break;
            }
            least = match order.region.hold(0.0, at[order.first]) {
                MovementAuthority::Free => least,
                MovementAuthority::At(hold) => least.min(hold - ROOM),
                MovementAuthority::Inside => own,
            };
        }
        self.known[robot] = least;
        least
    }
}
