//! What a decision is about: the fleet as it is now, and routes through it.

use super::Method;
use super::abilities::Abilities;
use super::book::Book;
use super::ends::cut_off;
use super::forecast::{Forecast, Stuck, Trial};
use super::locks::Locks;
use super::robot::Robot;
use super::routes::Routes;
use super::site::{From, Site};
use super::timetable::Timetable;
use super::waits::Waits;
use super::way::Kept;

/// What a route costs more: past a robot that stands for good, and for each robot that comes the other way \[s\].
pub(super) const TOLLS: [[f64; 2]; 4] =
    [[f64::INFINITY, 0.0], [f64::INFINITY, 4.0], [f64::INFINITY, 15.0], [20.0, 4.0]];

/// What a decision is about.
#[derive(Clone, Copy)]
pub(super) struct Scene<'s> {
    pub(super) site: &'s Site,
    pub(super) robots: &'s [Robot],
    pub(super) book: &'s Book,
    pub(super) locks: &'s Locks,
    pub(super) abilities: &'s Abilities,
    pub(super) network: &'s Routes,
    /// Whether robots may stand at a node for good.
    pub(super) ends: &'s [bool],
    /// Nodes that can all be reached from one another.
    pub(super) nodes: &'s [usize],
    /// How many robots stand for good in the way of an atom.
    pub(super) parked: &'s [u16],
    pub(super) time: f64,
    /// What the others keep to while one is decided on, in a large fleet.
    pub(super) timetable: Option<&'s Timetable>,
    pub(super) method: Method,
}

impl Scene<'_> {
    /// When all are where with the ways and orders that they have.
    pub(super) fn base(&self) -> Result<Forecast, Vec<Stuck>> {
        let Scene { robots, abilities, time, .. } = *self;
        let waits = &Waits::of(robots, self.book, None);
        Trial { robots, waits, abilities, time, changed: None, kept: None }.forecast()
    }

    pub(super) fn kept(&self, robot: usize) -> Kept {
        let it = &self.robots[robot];
        it.way.kept(self.site, it.at, it.stop(self.abilities), it.turned)
    }

    /// Whether nobody else stands for good where a robot would stand at a node.
    pub(super) fn is_free(&self, robot: usize, node: usize) -> bool {
        let own = self.site.collide(self.robots[robot].way.end(), node);
        let count = usize::from(self.parked[self.site.standing(node)]);
        count <= usize::from(own)
    }

    /// Routes on from where a robot can leave its way.
    pub(super) fn routes(
        &self,
        robot: usize,
        kept: &Kept,
        [standing, coming]: [f64; 2],
        asked: impl Fn(usize) -> bool,
        towards: Option<usize>,
        count: usize,
    ) -> Vec<Vec<usize>> {
        self.onward(robot, kept.on, [standing, coming], asked, towards, count)
    }

    pub(super) fn onward(
        &self,
        robot: usize,
        from: From,
        [standing, coming]: [f64; 2],
        asked: impl Fn(usize) -> bool,
        towards: Option<usize>,
        count: usize,
    ) -> Vec<Vec<usize>> {
        let own = self.site.covers(self.robots[robot].way.end());
        let toll = |atom: usize| {
            let mut parked = self.parked[atom];
            if parked > 0 && own.contains(&atom) {
                parked -= 1;
            }
            let mut toll = if parked > 0 { standing * f64::from(parked) } else { 0.0 };
            if coming > 0.0
                && let Some(back) = self.site.back[atom]
            {
                toll += coming * self.book.others_on(back, robot, self.robots).count() as f64;
            }
            toll
        };
        self.network.quickest(self.site, from, toll, asked, towards, count)
    }

    /// The nodes at which a robot would cut off fewest others, of some.
    pub(super) fn harmless(&self, robot: usize, of: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut parked = self.parked.to_vec();
        self.site.covers(self.robots[robot].way.end()).iter().for_each(|&atom| parked[atom] -= 1);
        let mut more = vec![0; parked.len()];
        let mut lost: Vec<(usize, usize)> = Vec::new();
        for node in self.nodes.iter().copied().filter(|&node| of(node)) {
            let covers = self.site.covers(node);
            covers.iter().for_each(|&atom| more[atom] = 1);
            lost.push((cut_off(self.site, self.nodes, &parked, &more), node));
            covers.iter().for_each(|&atom| more[atom] = 0);
        }
        let least = lost.iter().map(|lost| lost.0).min().unwrap_or(0);
        lost.retain(|lost| lost.0 <= least + 1);
        lost.into_iter().map(|lost| lost.1).collect()
    }
}
