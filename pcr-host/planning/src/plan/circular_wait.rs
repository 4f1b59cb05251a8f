//! Circular waits: agents of which each one has to let the next one pass first, all around, so that none of them can
//! arrive.
//!
//! If a region contains the end of the ego's path, or the start of the other's, the other agent passes it first,
//! however both move: the ego reaches the length l of any of its points (l, s) after the other agent has left s. These
//! points are gates. Beginning at the starts, every agent advances as far as the closed gates allow, again and again.
//! An agent that is stuck in the end can never arrive, and waits for another one that is stuck.

use crate::fleet::HostEcm;
use pcr_core::{Interval, Motion, RegionRef};

/// Why the agents of a circle have no plan.
pub(super) const CIRCULAR_WAIT: &str = "circular wait: however they move, each has to let the next one pass first, and the last one \
    has to let the first one pass first";

/// Parts of a region, at whose borders its gates are.
const PARTS: u32 = 32;

/// The ego may reach the length only when the other is beyond.
struct CircularWaitGate {
    ego: usize,
    other: usize,
    length: f64,
    beyond: f64,
}

/// The agents of a circle, each of which waits for the next one and the last one for the first; nothing if there is none.
/// With radii that are larger by what rounding adds it is a proof that no plan exists for the true ones but touching.
pub(super) fn circle(ecm: &HostEcm<f64>, motions: &[Motion<'_, f64>]) -> Option<Vec<usize>> {
    let gates: Vec<CircularWaitGate> = ecm
        .regions(motions)
        .expect("the table of the fleet")
        .filter(is_second)
        .flat_map(|region| gates(&region))
        .collect();
    let mut reach = vec![0.0; motions.len()];
    loop {
        let further: Vec<f64> = (0..motions.len())
            .map(|agent| closed(&gates, &reach, agent).map_or(motions[agent].path().length(), |gate| gate.length))
            .collect();
        // It ends: every change opens a gate for good.
        if further == reach {
            break;
        }
        reach = further;
    }
    let mut waiting: Vec<usize> = vec![(0..motions.len()).find(|&agent| closed(&gates, &reach, agent).is_some())?];
    loop {
        let next = closed(&gates, &reach, *waiting.last()?)?.other;
        if let Some(first) = waiting.iter().position(|&agent| agent == next) {
            return Some(waiting.split_off(first));
        }
        waiting.push(next);
    }
}

/// Whether the ego has to pass the region after the other, and can.
fn is_second(region: &RegionRef<'_, f64>) -> bool {
    sides(region) == [true, false]
}

/// Whether the ego has to pass a region after the other agent, and whether before it, whenever they start and however they move:
/// the region holds the end of its path or the start of the other's, or the start of its own or the end of the other's.
pub fn sides(region: &RegionRef<'_, f64>) -> [bool; 2] {
    sides_of(region, [true; 2], [true; 2])
}

/// The same for discs of which it is known whether they are there before the start of their path, and after its end.
pub(crate) fn sides_of(region: &RegionRef<'_, f64>, own: [bool; 2], other: [bool; 2]) -> [bool; 2] {
    let length = region.length();
    let at_end = length.hi >= region.ego_motion().path().length();
    let after = (own[1] && at_end) || (other[0] && region.is_open_at_start());
    let before = (own[0] && length.lo <= 0.0) || (other[1] && region.is_open_at_end());
    [after, before]
}

fn gates(region: &RegionRef<'_, f64>) -> Vec<CircularWaitGate> {
    let (range, other) = (region.other_length(), region.other_motion());
    let at = |k: u32| {
        let length = range.lo + range.length() * f64::from(k) / f64::from(PARTS);
        let time = other.time_in(Interval::new(length, length)).lo;
        let slice = region.slice_at(time).next()?;
        let beyond = other.length_at(time);
        Some(CircularWaitGate { ego: region.ego(), other: region.other(), length: slice.lo, beyond })
    };
    (0..=PARTS).filter_map(at).collect()
}

/// The first gate of an agent that is closed yet.
fn closed<'a>(gates: &'a [CircularWaitGate], reach: &[f64], agent: usize) -> Option<&'a CircularWaitGate> {
    let own = gates.iter().filter(|gate| gate.ego == agent && reach[gate.other] <= gate.beyond);
    own.min_by(|a, b| a.length.total_cmp(&b.length))
}
