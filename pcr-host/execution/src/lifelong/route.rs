//! The path of a robot from node to node, its stops, and its times if no other robot is in the way.

use super::kinematic_limits::KinematicLimits;
use super::route_element::{RouteElement, STRAIGHT};
use super::route_graph::{DeparturePose, RouteGraph};
use pcr_core::Curve;
use pcr_formats::plane_geometry::wrapped;

/// A place where a robot stops, and turns if it is a disc.
#[derive(Clone, Copy, Debug)]
pub(super) struct RouteCorner {
    /// \[m\]
    pub(super) at: f64,
    /// Time that the turn takes \[s\].
    pub(super) turn: f64,
}

/// A path, with the stops and times of a robot on it.
#[derive(Clone, Debug)]
pub(super) struct Route {
    pub(super) atoms: Vec<usize>,
    /// Length before each atom, and the length of the whole way \[m\].
    pub(super) offsets: Vec<f64>,
    /// Largest speed on each atom \[m/s\].
    pub(super) speeds: Vec<f64>,
    /// Time at which each atom is entered, and time of arrival at the end \[s\].
    times: Vec<f64>,
    pub(super) corners: Vec<RouteCorner>,
    /// Lengths of the goals that are still ahead \[m\].
    pub(super) goals: Vec<f64>,
    end: usize,
    /// Heading of a robot at its start, if it is known \[rad\].
    heading: Option<f64>,
    /// Whether it ends within its last atom.
    pub(super) is_cut: bool,
    /// The atoms of a robot that stands at its start, and at its end.
    pub(super) poses: [usize; 2],
}

impl Route {
    /// The way of a robot that stands at a node.
    pub(super) fn standing(site: &RouteGraph, node: usize) -> Self {
        let heading = site.first_heading(node);
        Self::new(site, DeparturePose { node, heading }, &[], &[], &KinematicLimits::NONE)
    }

    /// A way along these atoms; each goal is after its number of atoms. Turns of outlines at nodes are added.
    pub(super) fn new(
        site: &RouteGraph,
        from: DeparturePose,
        atoms: &[usize],
        goals: &[usize],
        abilities: &KinematicLimits,
    ) -> Self {
        let stands = atoms.is_empty();
        let asked = if stands { vec![site.pose(from.node, from.heading)] } else { atoms.to_vec() };
        let mut atoms = Vec::with_capacity(asked.len());
        let mut offsets = vec![0.0];
        let (mut corners, mut times, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
        let (mut length, mut time) = (0.0, 0.0);
        let mut heading = from.heading;
        // Number of all atoms before each of those that were asked for.
        let mut before = Vec::with_capacity(asked.len());
        for (k, &next) in asked.iter().enumerate() {
            before.push(atoms.len());
            let ends = heading.zip(site.atoms[next].headings).map(|(last, headings)| [last, headings[0]]);
            let turn = ends.filter(|ends| f64::abs(wrapped(ends[1] - ends[0])) > STRAIGHT);
            let turning = turn.and_then(|ends| site.turn(site.atoms[next].ends[0], ends));
            for place in turning.into_iter().chain([next]) {
                let atom = &site.atoms[place];
                let turn = heading.zip(atom.headings).map_or(0.0, |(last, next)| wrapped(next[0] - last));
                // Where the way goes on in another direction, and the robot does not turn, it stops.
                let shifts = atoms.last().is_some_and(|&last| site.changes_facing(last, place));
                let stops = before.len() > 1 && place != next || (turning.is_none() && goals.contains(&k)) || shifts;
                if f64::abs(turn) > STRAIGHT && !site.is_outline(atom.layer) {
                    corners.push(RouteCorner { at: length, turn: abilities.turn(turn) });
                    time += abilities.turn(turn);
                }
                if !atoms.is_empty() && (f64::abs(turn) > STRAIGHT || stops) {
                    time += abilities.stop();
                }
                if shifts {
                    corners.push(RouteCorner { at: length, turn: 0.0 });
                }
                corners.extend(within(site, atom, length, abilities));
                times.push(time);
                speeds.push(atom.speed);
                length += atom.length;
                if atom.length > 0.0 {
                    time += atom.length / atom.speed;
                }
                heading = atom.headings.map(|headings| headings[1]).or(heading);
                offsets.push(length);
                atoms.push(place);
            }
        }
        times.push(time);
        before.push(atoms.len());
        let goals = goals.iter().map(|&goal| if stands { 0.0 } else { offsets[before[goal]] }).collect();
        let end = site.atoms[atoms[atoms.len() - 1]].ends[1];
        let start = site.atoms[atoms[0]].ends[0];
        let first = from.heading.or_else(|| site.atoms[atoms[0]].headings.map(|headings| headings[0]));
        let poses = [site.pose(start, first), site.pose(end, heading)];
        Self { atoms, offsets, speeds, times, corners, goals, end, heading: from.heading, is_cut: false, poses }
    }

    /// The same way up to a length, which may be within an atom.
    pub(super) fn cut(&self, site: &RouteGraph, length: f64) -> Self {
        let last = self.atom(length);
        let mut cut = self.clone();
        cut.atoms.truncate(last + 1);
        cut.speeds.truncate(last + 1);
        cut.offsets.truncate(last + 2);
        cut.times.truncate(last + 2);
        cut.times[last + 1] = self.time(length);
        cut.offsets[last + 1] = length;
        cut.corners.retain(|corner| corner.at < length);
        cut.goals.retain(|&goal| goal <= length);
        cut.end = site.atoms[self.atoms[last]].ends[1];
        cut.poses[1] = site.pose(cut.end, self.heading(site, last + 1));
        cut.is_cut = self.offsets[last + 1] != length;
        cut
    }

    /// Takes the speeds that the edges have now. Returns whether that changes its times; turns and stops take as long as before.
    pub(super) fn retime(&mut self, site: &RouteGraph) -> bool {
        let mut later = 0.0;
        let mut is_other = false;
        for (k, &atom) in self.atoms.iter().enumerate() {
            self.times[k] += later;
            let speed = site.atoms[atom].speed;
            if speed != self.speeds[k] {
                let length = self.offsets[k + 1] - self.offsets[k];
                later += length / speed - length / self.speeds[k];
                self.speeds[k] = speed;
                is_other = true;
            }
        }
        self.times[self.atoms.len()] += later;
        is_other
    }

    pub(super) fn length(&self) -> f64 {
        self.offsets[self.atoms.len()]
    }

    /// Time of a robot alone, from rest to rest, with stops at the corners only \[s\]. It speeds up and brakes so that it is nowhere
    /// faster than an atom allows.
    pub(super) fn unimpeded_time(&self, abilities: &KinematicLimits) -> f64 {
        let acceleration = abilities.acceleration;
        let mut borders: Vec<f64> = self.offsets.iter().copied().chain(self.corners.iter().map(|it| it.at)).collect();
        borders.sort_unstable_by(f64::total_cmp);
        borders.dedup();
        let pieces: Vec<(f64, f64)> = borders
            .windows(2)
            .map(|ends| (ends[1] - ends[0], self.speeds[self.atom(0.5 * (ends[0] + ends[1]))]))
            .collect();
        // Largest speed at each border: the limits of both pieces, then braking, then acceleration.
        let stops = |border: usize| self.corners.iter().any(|corner| corner.at == borders[border]);
        let mut speeds = vec![0.0; borders.len()];
        for k in (1..pieces.len()).rev() {
            let allowed = if stops(k) { 0.0 } else { f64::min(pieces[k - 1].1, pieces[k].1) };
            speeds[k] = f64::min(allowed, (speeds[k + 1] * speeds[k + 1] + 2.0 * acceleration * pieces[k].0).sqrt());
        }
        let mut time: f64 = self.corners.iter().map(|corner| corner.turn).sum();
        for (k, &(length, fastest)) in pieces.iter().enumerate() {
            let before: f64 = speeds[k];
            let after = f64::min(speeds[k + 1], (before * before + 2.0 * acceleration * length).sqrt());
            speeds[k + 1] = after;
            let squares = 0.5 * (before * before + after * after);
            let peak = f64::min(fastest, (squares + acceleration * length).sqrt());
            time += (2.0 * peak - before - after) / acceleration;
            time += f64::max(0.0, length - (peak * peak - squares) / acceleration) / peak;
        }
        time
    }

    /// Time at which the robot would be at a length, counted from the start \[s\].
    pub(super) fn time(&self, length: f64) -> f64 {
        // At its start the robot still has to turn.
        if length <= 0.0 {
            return 0.0;
        }
        self.time_on(self.atom(length), length)
    }

    /// The same, on an atom that contains this length or ends there.
    #[inline]
    fn time_on(&self, atom: usize, length: f64) -> f64 {
        let beyond = length - self.offsets[atom];
        if beyond > 0.0 { self.times[atom] + beyond / self.speeds[atom] } else { self.times[atom] }
    }

    /// Time at which it would leave a corner at a length, which may be within an atom, counted from the start \[s\].
    pub(super) fn left_for(&self, length: f64) -> f64 {
        let next = self.offsets.partition_point(|&offset| offset <= length).saturating_sub(1);
        if next < self.atoms.len() { self.time_on(next, length) } else { self.times[next] }
    }

    /// Index of the atom that contains a length; at a node the earlier one.
    #[inline]
    pub(super) fn atom(&self, length: f64) -> usize {
        self.offsets.partition_point(|&offset| offset < length).saturating_sub(1).min(self.atoms.len() - 1)
    }

    /// Position of the robot at a length \[m\].
    pub(super) fn point(&self, site: &RouteGraph, length: f64) -> [f64; 2] {
        let k = self.atom(length);
        site.atoms[self.atoms[k]].point(length - self.offsets[k])
    }

    /// Heading of the robot at a length \[rad\].
    pub(super) fn heading_at(&self, site: &RouteGraph, length: f64) -> f64 {
        let k = self.atom(length);
        site.atoms[self.atoms[k]].heading(length - self.offsets[k])
    }

    /// The node at exactly this length, if there is one.
    pub(super) fn node(&self, site: &RouteGraph, length: f64) -> Option<usize> {
        let k = self.offsets.iter().position(|&offset| offset == length)?;
        if self.is_cut && k == self.atoms.len() {
            return None;
        }
        Some(self.atoms.get(k).map_or(self.end, |&next| site.atoms[next].ends[0]))
    }

    /// The nodes beyond a length, up to another one.
    pub(super) fn nodes(&self, site: &RouteGraph, from: f64, to: f64) -> Vec<usize> {
        let ends = self.atoms.iter().zip(&self.offsets[1..]);
        ends.filter(|(_, at)| from < **at && **at <= to).map(|(&atom, _)| site.atoms[atom].ends[1]).collect()
    }

    /// The last node.
    pub(super) fn end(&self) -> usize {
        self.end
    }

    /// Direction in which a robot arrives at the node before an atom \[rad\].
    fn heading(&self, site: &RouteGraph, atom: usize) -> Option<f64> {
        let before = self.atoms[..atom].iter().rev().find_map(|&before| site.atoms[before].headings);
        before.map(|headings| headings[1]).or(self.heading)
    }

    /// The part that is kept if another way is to begin at the first node from `stop` on. The robot is at `at` \[m\] and has
    /// done `turned` turns at corners.
    pub(super) fn committed_part(&self, site: &RouteGraph, at: f64, stop: f64, turned: usize) -> CommittedRoute {
        let count = self.atoms.len();
        // If it stands at a node, the new way begins there.
        let node = self.offsets.iter().position(|&offset| offset == at && offset == stop);
        if let Some(k) = node.filter(|&k| !self.is_cut || k < count) {
            let k = k.min(count);
            let node = if k == count { self.end } else { site.atoms[self.atoms[k]].ends[0] };
            let corner = turned.checked_sub(1).and_then(|last| self.corners.get(last));
            let has_turned = corner.is_some_and(|corner| corner.at == at);
            let next = self.atoms.get(k).and_then(|&next| site.atoms[next].headings).map(|headings| headings[0]);
            let heading = if has_turned { next } else { self.heading(site, k) };
            let from = DeparturePose { node, heading };
            return CommittedRoute { from, atoms: Vec::new(), before: at, end_pose: from };
        }
        let first = self.atom(at);
        let last = self.offsets.iter().position(|&offset| offset >= stop).unwrap_or(count).clamp(first + 1, count);
        let atoms = self.atoms[first..last].to_vec();
        let on = DeparturePose { node: site.atoms[self.atoms[last - 1]].ends[1], heading: self.heading(site, last) };
        let from = DeparturePose { node: site.atoms[self.atoms[first]].ends[0], heading: None };
        CommittedRoute { from, atoms, before: self.offsets[first], end_pose: on }
    }
}

/// The corners of an atom that begins at a length \[m\], beyond a turn before it.
fn within(site: &RouteGraph, atom: &RouteElement, length: f64, abilities: &KinematicLimits) -> Vec<RouteCorner> {
    if !site.is_outline(atom.layer) {
        let mut within = 0.0;
        let corner = |pair: &[pcr_formats::scenario::PlacedSegment]| {
            within += pair[0].shape.length();
            let turn = wrapped(pair[1].heading - pair[0].heading_at_end());
            (turn.abs() > STRAIGHT).then(|| RouteCorner { at: length + within, turn: abilities.turn(turn) })
        };
        return atom.shapes.windows(2).filter_map(corner).collect();
    }
    // A turn of an outline has a length; at a node it is so slow that the robot need not stop before and after it.
    if atom.is_turn() {
        let ends = if site.stops_at_turns { vec![length, length + atom.length] } else { Vec::new() };
        return ends.into_iter().map(|at| RouteCorner { at, turn: 0.0 }).collect();
    }
    let turns = atom.segments.iter().filter(|segment| match segment.curve() {
        Curve::Pivot { lever, .. } => segment.length() > STRAIGHT * lever,
        _ => false,
    });
    let ends = turns.flat_map(|turn| [turn.from(), turn.from() + turn.length()]);
    ends.map(|end| RouteCorner { at: length + end, turn: 0.0 }).collect()
}

/// The part of a way that cannot be changed any more.
#[derive(Clone, Debug)]
pub(super) struct CommittedRoute {
    /// Where it begins.
    pub(super) from: DeparturePose,
    pub(super) atoms: Vec<usize>,
    /// Length of the old way before it \[m\].
    pub(super) before: f64,
    /// Where it ends.
    pub(super) end_pose: DeparturePose,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lifelong::streets;

    #[test]
    fn a_robot_alone_takes_the_time_of_its_ramps() {
        let mut imported = streets(2);
        (imported.vehicle.speed, imported.vehicle.acceleration) = (2.0, 0.5);
        imported.layout.edges.iter_mut().for_each(|edge| edge.speed = [Some(1.0); 2]);
        let site = RouteGraph::new(&imported).expect("a site");
        let abilities = KinematicLimits::of(&imported.vehicle);
        let long = (0..site.atoms.len()).max_by(|&a, &b| site.atoms[a].length.total_cmp(&site.atoms[b].length));
        let long = long.expect("an atom");
        let length = site.atoms[long].length;
        let from = DeparturePose { node: site.atoms[long].ends[0], heading: None };
        let alone = |acceleration: f64| {
            let mut abilities = abilities;
            abilities.acceleration = acceleration;
            Route::new(&site, from, &[long], &[], &abilities).unimpeded_time(&abilities)
        };
        // v = 1 m/s: L / v + v / a where that speed is reached, else 2 √(L / a).
        let long_enough = 1.0 / length;
        assert!((alone(4.0 * long_enough) - (length + 0.25 * length)).abs() < 1e-12);
        assert!((alone(0.25 * long_enough) - 2.0 * (length / (0.25 * long_enough)).sqrt()).abs() < 1e-9);
        assert!((alone(f64::INFINITY) - length).abs() < 1e-12);
    }

    /// Steps of a millisecond at the largest speed from which all limits ahead can be kept.
    #[test]
    fn nobody_is_quicker_alone() {
        let mut imported = streets(3);
        let edges = imported.layout.edges.iter_mut().enumerate();
        edges.for_each(|(k, edge)| edge.speed = [Some([0.3, 1.0, 0.6][k % 3]); 2]);
        let site = RouteGraph::new(&imported).expect("a site");
        let abilities = KinematicLimits::of(&imported.vehicle);
        for start in 0..20 {
            let mut atoms = vec![start];
            while atoms.len() < 6 {
                let end = site.atoms[atoms[atoms.len() - 1]].ends[1];
                let Some(&next) = site.leaving[end].iter().find(|&&next| !atoms.contains(&next)) else { break };
                atoms.push(next);
            }
            let way = Route::new(
                &site,
                DeparturePose { node: site.atoms[start].ends[0], heading: None },
                &atoms,
                &[],
                &abilities,
            );
            let (mut at, mut speed, mut time) = (0.0, 0.0, way.corners.iter().map(|corner| corner.turn).sum::<f64>());
            const STEP: f64 = 1e-3;
            while at < way.length() - 1e-4 {
                let limits = (way.atom(at + 1e-9)..atoms.len()).map(|k| (way.offsets[k], way.speeds[k]));
                let stops = way.corners.iter().map(|corner| corner.at).chain([way.length()]).filter(|&stop| stop > at);
                let ahead = limits.chain(stops.map(|stop| (stop, 0.0)));
                let most = ahead.map(|(place, limit)| {
                    let way: f64 = f64::max(0.0, place - at - speed * STEP);
                    (limit * limit + 2.0 * abilities.acceleration * way).sqrt()
                });
                speed = f64::min(speed + abilities.acceleration * STEP, most.fold(f64::INFINITY, f64::min)).max(1e-3);
                at += speed * STEP;
                time += STEP;
            }
            let alone = way.unimpeded_time(&abilities);
            assert!((alone - time).abs() < 0.02 * time, "{start}: {alone} and {time}");
        }
    }
}
