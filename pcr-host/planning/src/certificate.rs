//! Tables as plain numbers for [`pcr_certify`], which shares no code with the library that computed them.
//!
//! All numbers are those that the library holds; this module neither rounds nor computes.

use crate::fleet::{Fleet, Format, HostEcm};
use pcr_certify::data::{Agent, Pair, Path, Phase, Piece, Region, Segment, Share, Table, Travel};
use pcr_core::{Curve, Interval, Motion, RegionRef, Turn, excess};

/// A motion: `heading` is the heading at the start of its path, `turns` are its turns in place, each before the segment with
/// this index.
pub fn agent<S: Format>(id: u64, motion: &Motion<'_, S>, heading: S::Angle, turns: &[(usize, S::Angle)]) -> Agent {
    let path = motion.path();
    let parts = path.segments();
    let ends = parts.iter().skip(1).map(|next| next.from()).chain([path.length()]);
    let segments = parts.iter().zip(ends).enumerate().map(|(place, (segment, to))| Segment {
        length: segment.length().to_f64(),
        radius: match segment.curve() {
            Curve::Line => None,
            Curve::Arc { radius, turn: Turn::Left } => Some(radius.to_f64()),
            Curve::Arc { radius, turn: Turn::Right } => Some(-radius.to_f64()),
        },
        turns: turns.iter().filter(|(before, _)| *before == place).map(|&(_, by)| S::held_angle(by)).collect(),
        from: segment.from().to_f64(),
        to: to.to_f64(),
    });
    let start = path.point_at(S::ZERO);
    let phases = motion.profile().phases().iter().map(|phase| Phase {
        time: ends_of(phase.time()),
        length: ends_of(phase.length()),
        speed: phase.speed().map(S::to_f64),
    });
    Agent {
        id,
        radius: motion.radius().to_f64(),
        path: Path {
            start: [start.x.to_f64(), start.y.to_f64()],
            heading: S::held_angle(heading),
            segments: segments.collect(),
            rounding: S::EPSILON * path.length().to_f64(),
            step: S::STEP,
        },
        travel: Some(Travel {
            start: motion.time().lo.to_f64(),
            phases: phases.collect(),
            lag: motion.lag().to_f64(),
            time_excess: motion.time_excess().to_f64(),
        }),
    }
}

fn ends_of<S: Format>(interval: Interval<S>) -> [f64; 2] {
    [interval.lo.to_f64(), interval.hi.to_f64()]
}

/// The discs of a fleet; the numbers tell which ones are of one body.
pub fn agents<S: Format>(fleet: &Fleet<S>, motions: &[Motion<'_, S>], ids: &[u64]) -> Vec<Agent> {
    let all = motions.iter().zip(ids).enumerate();
    all.filter_map(|(place, (motion, &id))| {
        let (heading, turns) = fleet.headings(place)?;
        Some(agent(id, motion, heading, turns))
    })
    .collect()
}

/// A whole table of these discs, pair by pair.
pub fn table<S: Format>(agents: Vec<Agent>, motions: &[Motion<'_, S>], ecm: &HostEcm<S>) -> Table {
    let mut pairs = Vec::new();
    for (i, own) in agents.iter().enumerate() {
        for (j, other) in agents.iter().enumerate().skip(i + 1) {
            if own.id != other.id {
                let regions = ecm.pair(motions, i, j).expect("the table of the fleet");
                pairs.push(pair([i, j], [&motions[i], &motions[j]], regions));
            }
        }
    }
    Table { agents, pairs, apart: None }
}

/// Two discs with their regions, in the order of the table.
pub fn pair<'a, S: Format + 'a>(
    agents: [usize; 2],
    [first, second]: [&Motion<'_, S>; 2],
    all: impl Iterator<Item = RegionRef<'a, S>>,
) -> Pair {
    let (mut regions, mut pieces) = (Vec::new(), Vec::new());
    for (number, region) in all.enumerate() {
        regions.push(Region {
            lengths: [ends_of(region.length()), ends_of(region.other_length())],
            times: Some([ends_of(region.clone().swapped().time()), ends_of(region.time())]),
        });
        pieces.extend(region.pieces().map(|piece| Piece {
            segments: piece.segments,
            lengths: [ends_of(piece.length), ends_of(piece.other_length)],
            share: match piece.share {
                pcr_core::Share::Only => Share::Only,
                pcr_core::Share::Start => Share::Start,
                pcr_core::Share::End => Share::End,
            },
            region: number,
        }));
    }
    Pair { agents, excess: excess(first, second).to_f64(), regions, pieces }
}
