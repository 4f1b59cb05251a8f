//! The path of a robot from node to node, where it stops on it, and when it would be where with nobody in its way.

use super::robot::Abilities;
use super::site::{Site, wrapped};

/// Angles below are no corner \[rad\].
const STRAIGHT: f64 = 1e-6;

/// A place where a robot stops and turns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// \[m\]
    pub(super) at: f64,
    /// Time that the turn takes \[s\].
    pub(super) turn: f64,
}

/// A path, and what a robot does on it.
#[derive(Clone, Debug)]
pub(super) struct Way {
    pub(super) atoms: Vec<usize>,
    /// Length before each atom, and that of all \[m\].
    pub(super) offsets: Vec<f64>,
    /// Largest speed on each atom \[m/s\].
    pub(super) speeds: Vec<f64>,
    /// When each atom is left for, and the end reached \[s\].
    times: Vec<f64>,
    pub(super) corners: Vec<Corner>,
    /// Length at which the goal is, if it is still ahead \[m\].
    pub(super) goal: Option<f64>,
    end: usize,
}

impl Way {
    /// A robot that stands at a node.
    pub(super) fn standing(site: &Site, node: usize) -> Self {
        Self::new(site, node, &[], None, &Abilities::NONE)
    }

    /// Along these atoms; the goal is after so many of them.
    pub(super) fn new(site: &Site, from: usize, atoms: &[usize], goal: Option<usize>, abilities: &Abilities) -> Self {
        let atoms = if atoms.is_empty() { vec![site.standing(from)] } else { atoms.to_vec() };
        let goal = goal.map(|goal| if site.atoms[atoms[0]].edge.is_some() { goal } else { 0 });
        let mut offsets = vec![0.0];
        let (mut corners, mut times, mut speeds) = (Vec::new(), Vec::new(), Vec::new());
        let (mut length, mut time) = (0.0, 0.0);
        let mut heading = None;
        for (k, &place) in atoms.iter().enumerate() {
            let atom = &site.atoms[place];
            let turn = heading.zip(atom.headings).map_or(0.0, |(last, next)| wrapped(next[0] - last));
            let stops = goal == Some(k);
            if f64::abs(turn) > STRAIGHT {
                corners.push(Corner { at: length, turn: abilities.turn(turn) });
                time += abilities.turn(turn);
            }
            if f64::abs(turn) > STRAIGHT || stops {
                time += abilities.stop();
            }
            for pair in atom.shapes.windows(2) {
                let turn = wrapped(pair[1].heading - pair[0].heading_at_end());
                if turn.abs() > STRAIGHT {
                    let within: f64 = atom
                        .shapes
                        .iter()
                        .take_while(|shape| **shape != pair[1])
                        .map(|shape| shape.shape.length())
                        .sum();
                    corners.push(Corner { at: length + within, turn: abilities.turn(turn) });
                }
            }
            times.push(time);
            speeds.push(atom.speed);
            length += atom.length;
            if atom.length > 0.0 {
                time += atom.length / atom.speed;
            }
            heading = atom.headings.map(|headings| headings[1]).or(heading);
            offsets.push(length);
        }
        times.push(time);
        let goal = goal.map(|goal| offsets[goal]);
        let end = site.atoms[atoms[atoms.len() - 1]].ends[1];
        Self { atoms, offsets, speeds, times, corners, goal, end }
    }

    pub(super) fn length(&self) -> f64 {
        self.offsets[self.atoms.len()]
    }

    /// When it would be at a length, from its start \[s\].
    pub(super) fn time(&self, length: f64) -> f64 {
        let k = self.atom(length);
        let beyond = length - self.offsets[k];
        if beyond > 0.0 { self.times[k] + beyond / self.speeds[k] } else { self.times[k] }
    }

    /// The atom in which a length is, the earlier one at a node.
    pub(super) fn atom(&self, length: f64) -> usize {
        self.offsets.partition_point(|&offset| offset < length).saturating_sub(1).min(self.atoms.len() - 1)
    }

    /// Where the robot is after so much \[m\].
    pub(super) fn point(&self, site: &Site, length: f64) -> [f64; 2] {
        let k = self.atom(length);
        site.atoms[self.atoms[k]].point(length - self.offsets[k])
    }

    /// The last node.
    pub(super) fn end(&self) -> usize {
        self.end
    }

    /// What is kept if another way is to begin at the first node from `stop` on, for a robot that is at `at` \[m\].
    pub(super) fn kept(&self, site: &Site, at: f64, stop: f64) -> Kept {
        let count = self.atoms.len();
        // At a node, and at rest there, it begins afresh.
        if let Some(k) = self.offsets.iter().position(|&offset| offset == at && offset == stop) {
            let k = k.min(count);
            let node = if k == count { self.end } else { site.atoms[self.atoms[k]].ends[0] };
            return Kept { from: node, atoms: Vec::new(), before: at, node };
        }
        let first = self.atom(at);
        let last = self.offsets.iter().position(|&offset| offset >= stop).unwrap_or(count).clamp(first + 1, count);
        let atoms = self.atoms[first..last].to_vec();
        let node = site.atoms[self.atoms[last - 1]].ends[1];
        Kept { from: site.atoms[self.atoms[first]].ends[0], atoms, before: self.offsets[first], node }
    }
}

/// The part of a way that cannot be changed any more.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    /// Node where it begins.
    pub(super) from: usize,
    pub(super) atoms: Vec<usize>,
    /// Length of the old way before it \[m\].
    pub(super) before: f64,
    /// Node where it ends.
    pub(super) node: usize,
}
