//! Holds as a list: places where the second of two robots has to wait, and the event that it waits for. Holds are
//! computed at some lengths of the first robot and rounded down in between, so they are never too high. The checker
//! checks the stored list.

use pcr_core::{Interval, Motion, MovementAuthority, RegionRef};
use pcr_planning::fleet::build_ecm;

/// The second waits at `at` \[m\] until the first is at `needs` \[m\] of its path or beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// Where the second waits on its path \[m\].
    pub wait_position: f64,
    /// Where the first has to be on its path \[m\].
    pub required_position: f64,
}

/// A gate of two ways, with the times of both ways: if no robot was in the way, counted from the starts of the ways \[s\].
#[derive(Clone, Copy, Debug)]
pub(super) struct TimedGate {
    pub(super) gate: Gate,
    /// Time at which the second robot comes to the gate.
    pub(super) arrival_time: f64,
    /// Time at which the first robot opens the gate; infinite if it never does.
    pub(super) opening_time: f64,
}

/// A robot has left a region when it is this far beyond the last contact \[m\].
const LEFT: f64 = 1e-6;

/// How robots on two pieces of paths touch.
#[derive(Clone, Debug)]
pub(super) struct ElementContact {
    /// Range of lengths on each of the two at which they may touch \[m\].
    pub(super) hull: [Interval<f64>; 2],
    /// Gates of each of the two as the second robot. `at` is minus infinity if it has to wait before this piece; `needs` is infinity if
    /// the first robot does not leave the contact on this piece.
    pub(super) gates: [Vec<Gate>; 2],
}

impl ElementContact {
    /// The contact of two motions at 1 m/s, with gates for steps of the first robot of `pitch` \[m\]; `None` if they never touch.
    pub(super) fn compute(motions: [Motion<'_, f64>; 2], pitch: f64) -> Option<Self> {
        // Two pieces of a layout have a few segments each.
        let ecm = build_ecm(&motions).expect("two short paths");
        let own: Vec<RegionRef<'_, f64>> = ecm.pair(&motions, 0, 1).expect("the table of the two").collect();
        let their: Vec<RegionRef<'_, f64>> = own.iter().cloned().map(RegionRef::swapped).collect();
        let hull = [&own, &their].map(|regions| regions.iter().map(|region| region.length()).reduce(Interval::hull));
        let [Some(first), Some(second)] = hull else { return None };
        Some(Self { hull: [first, second], gates: [gates(&own, pitch), gates(&their, pitch)] })
    }
}

/// The gates of the ego as the second robot, for its regions with one other robot.
pub fn gates(regions: &[RegionRef<'_, f64>], pitch: f64) -> Vec<Gate> {
    let Some(extent) = regions.iter().map(|region| region.other_length()).reduce(Interval::hull) else {
        return Vec::new();
    };
    let end = regions.first().map_or(0.0, |region| region.other_motion().path().length());
    let hold = |other: f64| {
        let holds = regions.iter().map(|region| match region.hold(0.0, other) {
            MovementAuthority::Free => f64::INFINITY,
            MovementAuthority::At(hold) => hold,
            MovementAuthority::Inside => f64::NEG_INFINITY,
        });
        holds.fold(f64::INFINITY, f64::min)
    };
    let mut gates = Vec::new();
    let mut at = hold(0.0);
    let steps = ((extent.hi - extent.lo) / pitch).ceil().max(1.0) as u32;
    for k in 1..steps {
        let other = extent.lo + (extent.hi - extent.lo) * f64::from(k) / f64::from(steps);
        let next = hold(other);
        if next > at + 0.5 * LEFT {
            gates.push(Gate { wait_position: at, required_position: other });
            at = next;
        }
    }
    if at < f64::INFINITY {
        let exit = extent.hi + LEFT;
        gates.push(Gate { wait_position: at, required_position: if exit < end { exit } else { f64::INFINITY } });
    }
    gates
}

/// The gates that matter: a gate counts if it needs more than all before it.
pub(super) fn pruned(mut gates: Vec<Gate>) -> Vec<Gate> {
    gates.sort_unstable_by(|a, b| {
        a.wait_position.total_cmp(&b.wait_position).then(b.required_position.total_cmp(&a.required_position))
    });
    let mut most = f64::NEG_INFINITY;
    gates.retain(|gate| {
        let counts = gate.required_position > most;
        most = most.max(gate.required_position);
        counts
    });
    gates
}

/// Length up to which the second robot may go when the first is at `first` \[m\].
pub(super) fn authority(gates: &[TimedGate], first: f64) -> f64 {
    let next = gates.partition_point(|timed| timed.gate.required_position <= first);
    gates.get(next).map_or(f64::INFINITY, |timed| timed.gate.wait_position)
}
